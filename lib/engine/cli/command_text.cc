// SPDX-License-Identifier: GPL-3.0-or-later
// Help and versions are made from the declarations of the options, in a width of 79 columns,
// counted in bytes.
#include "cli/command_text.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <filesystem>
#include <sstream>

#include "base/json_writer.h"
#include "base/message.h"
#include "cli/outputs.h"
#include "cli/run_tool.h"

namespace ispace {

namespace {

constexpr std::size_t kHelpWidth = 79, kHelpColumn = 26, kWordColumn = 16;

/// Appends `text` wrapped to kHelpWidth, its lines beginning at `column`; the first line already
/// has `used` characters.
void appendWrapped(std::string& out, const std::string& text, std::size_t used,
                   std::size_t column) {
    std::istringstream words(text);
    bool fresh = true;
    for (std::string word; words >> word; fresh = false) {
        if (!fresh && used + 1 + word.size() > kHelpWidth) {
            out += '\n' + std::string(column, ' ');
            used = column;
            fresh = true;
        }
        if (!fresh) out += ' ';
        out += word;
        used += word.size() + (fresh ? 0 : 1);
    }
    out += '\n';
}

/// "Extensions: cad ifc", or "Extensions: none".
void appendExtensions(std::string& out, const std::vector<std::string>& extensions) {
    std::string names = "Extensions:";
    for (const std::string& name : extensions) names.append(" ").append(name);
    appendWrapped(out, extensions.empty() ? names + " none" : names, 0, 2);
}

}  // namespace

std::string helpText(const HelpPage& page) {
    std::string out = "Usage: " + page.tool + " [OPTION]... " + page.synopsis + "\n";
    appendWrapped(out, page.summary, 0, 0);
    for (const HelpPage::Option& option : page.options) {
        if (!option.heading.empty()) out += '\n' + option.heading + ":\n";
        const std::string name = "  " + option.signature;
        out += name;
        const bool fits = name.size() + 2 <= kHelpColumn;
        out += fits ? std::string(kHelpColumn - name.size(), ' ')
                    : '\n' + std::string(kHelpColumn, ' ');
        appendWrapped(out, option.text, kHelpColumn, kHelpColumn);
    }
    if (!page.groups.empty()) {
        out += "\nMore options, by --help WORD; --help all prints all:\n";
        for (const HelpPage::Group& group : page.groups) {
            std::string name = "  " + group.word;
            name.resize(std::max(name.size() + 2, kWordColumn), ' ');
            std::string title = group.title;
            const auto is_upper = [&](std::size_t i) {
                return std::isupper(static_cast<unsigned char>(title[i])) != 0;
            };
            if (title.size() < 2 || !is_upper(1))  // no abbreviation
                title.front() =
                    static_cast<char>(std::tolower(static_cast<unsigned char>(title.front())));
            if (!group.extension.empty()) title += " (extension " + group.extension + ")";
            out += name;
            appendWrapped(out, title, name.size(), kWordColumn);
        }
    }
    if (!page.examples.empty()) out += "\nExamples:\n";
    for (const auto& [command, effect] : page.examples) {
        out += "  " + command + "\n      ";
        appendWrapped(out, effect, 6, 6);
    }
    out += "\nExit status: " + page.statuses + ".\n";
    if (page.extensions) appendExtensions(out, *page.extensions);
    out += "Details: man " + page.tool +
           (page.has_extensions ? "; --version lists the extensions of this build\n" : "\n");
    return out;
}

std::string versionText(const std::string& tool,
                        const std::optional<std::vector<std::string>>& extensions) {
    std::string out = tool + " (ispace) " + std::string(version()) +
                      "\nLicence GPL-3.0-or-later; there is no warranty.\n";
    if (extensions) appendExtensions(out, *extensions);
    return out;
}

std::string versionJson(const std::string& tool,
                        const std::optional<std::vector<std::string>>& extensions) {
    JsonWriter json;
    beginReport(json, "ispace-version/1", tool).key("licence").value("GPL-3.0-or-later");
    if (extensions) {
        json.key("extensions").beginArray();
        for (const std::string& name : *extensions) json.value(name);
        json.endArray();
    }
    json.endObject();
    return json.take() + '\n';
}

std::string fileInHistory(const std::string& operand) {
    const bool is_folder = std::filesystem::is_directory(operand);
    return isStream(operand) && !is_folder ? "-" : shellQuote(baseName(operand));
}

std::string filesInHistory(const std::string& list) {
    const auto colon = list.find(':');
    if (colon == std::string::npos || list.find('/') < colon) return shellQuote(baseName(list));
    std::string names = list.substr(0, colon + 1);
    for (std::size_t at = colon + 1; at <= list.size();) {
        const std::size_t end = std::min(list.find(',', at), list.size());
        names += (at == colon + 1 ? "" : ",") + baseName(list.substr(at, end - at));
        at = end + 1;
    }
    return shellQuote(names);
}

}  // namespace ispace
