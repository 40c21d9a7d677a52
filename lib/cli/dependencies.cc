// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/dependencies.h"

#include <filesystem>
#include <set>

#include "base/error.h"
#include "base/file.h"

namespace ispace {

namespace {

/// A file's name as make reads it back.
std::string inMake(const std::string& name) {
    std::string out;
    for (const char c : name) {
        if (c == '$')
            out += '$';
        else if (c == ' ' || c == '\t' || c == '#' || c == ':' || c == '\\' || c == '%')
            out += '\\';
        out += c;
    }
    return out;
}

}  // namespace

std::string dependencyRule(const std::string& target, std::span<const std::string> sources) {
    std::set<std::string> seen;
    std::string rule = inMake(target) + ":";
    std::string alone;
    for (const std::string& source : sources) {
        if (isStream(source) || !seen.insert(source).second) continue;
        const std::string name = inMake(source);
        rule += " \\\n  ";
        rule += name;
        alone += '\n';
        alone += name;
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

void writeDependencies(const CommonOptions& options, std::span<const std::string> files) {
    if (!options.dependencies.wanted) return;
    std::string file = options.dependencies.file;
    if (file.empty()) file = std::filesystem::path(options.output).replace_extension(".d").string();
    writeAll(file, dependencyRule(options.output, files));
}

}  // namespace ispace
