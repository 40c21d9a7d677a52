// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/dependencies.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>

#include "base/error.h"
#include "base/file.h"
#include "base/run_files.h"
#include "base/utf8.h"

namespace ispace {

namespace {

bool isControl(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

/// make drops ./ before it looks for ~.
bool isHome(std::string_view name) {
    while (name.starts_with("./"))
        name.remove_prefix(std::min(name.find_first_not_of('/', 1), name.size()));
    return name.starts_with('~');
}

/// Why make cannot read a name in a rule, however it is quoted; "" if it can.
std::string_view reasonAgainst(const std::string& name) {
    constexpr std::string_view kWildcards = "*?[";
    if (name.find_first_of("=;") != std::string::npos) return "it has = or ; in it";
    if (std::any_of(name.begin(), name.end(), isControl)) return "it has a control character in it";
    if (std::count(name.begin(), name.end(), '%') > 1) return "it has more than one % in it";
    if (name.find('\\') != std::string::npos && name.find_first_of(kWildcards) != std::string::npos)
        return "it has both a backslash and a wildcard in it";
    if (isHome(name)) return "it begins with ~, which is somebody's home to make";
    if (name.ends_with(' ')) return "it ends with a blank";
    if (name.ends_with('\\')) return "it ends with a backslash";
    if (name.ends_with(')')) return "it ends like a member of an archive, with )";
    return "";
}

/// A file's name as make reads it back. Blanks, #, colons and wildcards are quoted by a backslash,
/// % in a target and | elsewhere; backslashes count only before those.
std::string inMake(const std::string& name, bool is_target) {
    if (const std::string_view reason = reasonAgainst(name); !reason.empty())
        throw UsageError("-MD: make cannot read the name `" + printable(name) +
                         "`: " + std::string(reason));
    const std::string_view quoted = is_target ? " #:*?[%" : " #:*?[|";
    std::string out;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const char c = name[i];
        if (quoted.find(c) != std::string_view::npos) {
            // The backslashes right before it would quote each other.
            for (std::size_t k = i; k > 0 && name[k - 1] == '\\'; --k) out += '\\';
            out += '\\';
        }
        if (c == '$') out += '$';
        out += c;
    }
    // &: has a meaning.
    if (is_target) out += name.ends_with('&') ? " :" : ":";
    return out;
}

std::string ruleFile(const DependencyOptions& options, const std::string& output) {
    if (!options.file.empty()) return options.file;
    return std::filesystem::path(output).replace_extension(".d").string();
}

}  // namespace

std::string dependencyRule(const std::string& target, std::span<const std::string> sources) {
    std::set<std::string> seen;
    std::string rule = inMake(target, true);
    std::string alone;
    for (const std::string& source : sources) {
        if (isStream(source) || !seen.insert(source).second) continue;
        rule += " \\\n  ";
        rule += inMake(source, false);
        alone += '\n';
        alone += inMake(source, true);
        alone += '\n';
    }
    return rule + '\n' + alone;
}

void checkDependencies(const DependencyOptions& options, const std::string& output) {
    if (!options.wanted && !options.file.empty())
        throw UsageError("-MF says where the rule of -MD goes: give both");
    if (options.wanted && output == "-")
        throw UsageError("-MD writes a rule for the product: name it with -o FILE");
}

void claimOutputs(const CommonOptions& options) {
    claimOutput(options.output, "--output");
    if (!options.dependencies.wanted) return;
    claimOutput(ruleFile(options.dependencies, options.output),
                options.dependencies.file.empty() ? "the rule of -MD" : "-MF");
}

void writeDependencies(const CommonOptions& options, std::span<const std::string> files) {
    if (!options.dependencies.wanted) return;
    writeAll(ruleFile(options.dependencies, options.output), dependencyRule(options.output, files));
}

}  // namespace ispace
