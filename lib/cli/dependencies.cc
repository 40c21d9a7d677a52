// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/dependencies.h"

#include <filesystem>
#include <set>
#include <string_view>

#include "base/error.h"
#include "base/file.h"
#include "base/run_files.h"
#include "base/utf8.h"

namespace ispace {

namespace {

/// A file's name as make reads it back. Blanks, # and colons are quoted by a backslash, and % in a
/// target; backslashes count only before those.
std::string inMake(const std::string& name, bool is_target) {
    if (name.find_first_of("=;\n") != std::string::npos)
        throw UsageError("-MD: make cannot read the name `" + printable(name) +
                         "`: it has = or ; in it");
    constexpr std::string_view kQuoted = " \t#:";
    std::string out;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const char c = name[i];
        const bool quoted = kQuoted.find(c) != std::string_view::npos || (c == '%' && is_target);
        if (quoted) {
            // The backslashes right before it would quote each other.
            for (std::size_t k = i; k > 0 && name[k - 1] == '\\'; --k) out += '\\';
            out += '\\';
        }
        if (c == '$') out += '$';
        out += c;
    }
    return out;
}

std::string ruleFile(const DependencyOptions& options, const std::string& output) {
    if (!options.file.empty()) return options.file;
    return std::filesystem::path(output).replace_extension(".d").string();
}

}  // namespace

std::string dependencyRule(const std::string& target, std::span<const std::string> sources) {
    std::set<std::string> seen;
    std::string rule = inMake(target, true) + ":";
    std::string alone;
    for (const std::string& source : sources) {
        if (isStream(source) || !seen.insert(source).second) continue;
        rule += " \\\n  ";
        rule += inMake(source, false);
        alone += '\n';
        alone += inMake(source, true);
        alone += ":\n";
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
