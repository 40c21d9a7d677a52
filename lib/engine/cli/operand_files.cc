// SPDX-License-Identifier: GPL-3.0-or-later
// Files that operands and their records name, and stdin.
#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "cli/operands.h"
#include "cli/outputs.h"

namespace ispace {

namespace {

namespace fs = std::filesystem;

/// What peekStream() has read and readOperand() has not taken yet, by operand.
std::map<std::string, std::string>& peeked() {
    static std::map<std::string, std::string> bytes;
    return bytes;
}

}  // namespace

void mustReadStdinOnce(const std::vector<std::string>& files) {
    const auto is_stdin = [](const std::string& file) {
        return file == "-" || file == "/dev/stdin" || file == "/dev/fd/0";
    };
    if (std::count_if(files.begin(), files.end(), is_stdin) > 1)
        throw UsageError("stdin cannot be read twice: only one operand can be -");
}

const std::string& peekStream(const std::string& operand) {
    const auto known = peeked().find(operand);
    if (known != peeked().end()) return known->second;
    return peeked().emplace(operand, readOperand(operand)).first->second;
}

std::string readOperand(const std::string& operand) {
    if (auto kept = peeked().extract(operand)) return std::move(kept.mapped());
    return operand == "-" ? readStdin() : readAll(operand);
}

std::string readStdin() {
    if (auto kept = peeked().extract("-")) return std::move(kept.mapped());
    if (isTerminalInput())
        throw UsageError("stdin is a terminal: give a file, or send data through a pipe");
    return readAll("-");
}

std::vector<std::string> filesOf(const SceneInput& input) {
    std::vector<std::string> files{input.environment_operand};
    if (input.layout) files.push_back(input.layout_operand);
    const auto add = [&files](const Document& document) {
        files.insert(files.end(), document.sources.begin(), document.sources.end());
    };
    add(input.environment);
    if (input.layout) add(*input.layout);
    return files;
}

std::string environmentFileFor(const std::string& output, const std::string& environment_operand) {
    // Neither stdin nor a pipe by another name (/dev/stdin, <(…)) can be read again.
    if (isStream(environment_operand)) return "";
    const fs::path folder = output == "-" ? fs::path() : fs::path(output).parent_path();
    const fs::path from = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder);
    // The environment itself may be a deliberate link: only its folder is resolved.
    const fs::path file(environment_operand);
    const fs::path to = fs::weakly_canonical(file.has_parent_path() ? file.parent_path() : ".");
    return (to / file.filename()).lexically_relative(from).string();
}

void rebaseFiles(std::vector<Record>& records, const std::string& from, const std::string& to) {
    if (fs::path(from).lexically_normal() == fs::path(to).lexically_normal()) return;
    const auto canonical = [](const std::string& folder) {
        return fs::weakly_canonical(fs::absolute(folder.empty() ? "." : folder));
    };
    const fs::path old_base = canonical(from), new_base = canonical(to);
    if (old_base == new_base) return;
    for (Record& record : records)
        for (const KeySpec& key : record.schema().keys) {
            if (key.role != Role::File || !record.has(key.name)) continue;
            const std::string& name = record.text(key.name);
            if (fs::path(name).is_absolute() || name.empty()) continue;
            record.set(key.name,
                       (old_base / name).lexically_normal().lexically_relative(new_base).string(),
                       record.keyPlace(key.name));
        }
}

}  // namespace ispace
