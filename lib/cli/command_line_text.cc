// SPDX-License-Identifier: GPL-3.0-or-later
// A command line as text: for --help, for the history of what it made, and for those who run it
// again.
#include <filesystem>
#include <sstream>
#include <utility>

#include "base/message.h"
#include "base/program.h"
#include "cli/command_line_data.h"
#include "cli/outputs.h"

namespace ispace {

namespace {

constexpr std::size_t kHelpWidth = 79, kHelpColumn = 26;

/// "-o, --output FILE"
std::string signature(const CLI::Option& option, const std::string& value) {
    std::string names;
    for (const std::string& name : option.get_snames()) names += "-" + name + ", ";
    for (const std::string& name : option.get_lnames())
        names += (isCompilerName(name) ? "-" : "--") + name + ", ";
    names.resize(names.size() - 2);
    return value.empty() ? names : names + ' ' + value;
}

/// Appends `text` wrapped to kHelpWidth, its lines beginning at `column`; the first line is
/// `used` characters long already.
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

std::string fileInHistory(const std::string& operand) {
    const bool is_folder = std::filesystem::is_directory(operand);
    return isStream(operand) && !is_folder ? "-" : shellQuote(baseName(operand));
}

}  // namespace

template <typename Visit>
void CommandLine::Data::forEachResult(Visit visit) const {
    bool ordered_done = false;
    for (const Entry& entry : entries) {
        const CLI::Option& option = *entry.option;
        if (entry.enters == Enters::Nothing || option.count() == 0) continue;
        if (entry.take) {
            // Where the first of them stands in the man page they all follow, as they came.
            if (!std::exchange(ordered_done, true))
                forEachOrdered([&](const Entry& one, const std::string& text) {
                    visit(nameOf(*one.option), &text, one);
                });
        } else if (entry.value.empty()) {
            visit(nameOf(option), nullptr, entry);
        } else {
            for (const std::string& value : option.results()) visit(nameOf(option), &value, entry);
        }
    }
}

std::string CommandLine::historyLine(const std::vector<std::string>& operands) const {
    std::string line = data_->tool;
    for (const std::string& operand : operands) line += ' ' + fileInHistory(operand);
    data_->forEachResult(
        [&line](const std::string& name, const std::string* value, const Data::Entry& entry) {
            line += ' ' + name;
            if (value == nullptr) return;
            line += ' ';
            line += entry.enters == Enters::BaseName ? fileInHistory(*value) : shellQuote(*value);
        });
    return line;
}

std::vector<std::string> CommandLine::resultWords() const {
    std::vector<std::string> words = {data_->tool};
    data_->forEachResult(
        [&words](const std::string& name, const std::string* value, const Data::Entry&) {
            // A value may begin with a minus.
            const bool is_long = value != nullptr && name.starts_with("--");
            words.push_back(is_long ? name + '=' + *value : name);
            if (value != nullptr && !is_long) words.push_back(*value);
        });
    words.emplace_back("--");
    words.insert(words.end(), data_->operands->begin(), data_->operands->end());
    return words;
}

std::string CommandLine::helpText() const {
    std::string out = "Usage: " + data_->tool + " [OPTION]... " + data_->synopsis + "\n";
    appendWrapped(out, data_->summary, 0, 0);
    out += "\nOptions:\n";
    for (const Data::Entry& entry : data_->entries) {
        const std::string name = "  " + signature(*entry.option, entry.value);
        out += name;
        if (name.size() + 2 > kHelpColumn)
            out += '\n' + std::string(kHelpColumn, ' ');
        else
            out += std::string(kHelpColumn - name.size(), ' ');
        appendWrapped(out, entry.help, kHelpColumn, kHelpColumn);
    }
    out += "\nExit status: " + data_->statuses + ".\n";
    out += "Details: man " + data_->tool + "\n";
    return out;
}

}  // namespace ispace
