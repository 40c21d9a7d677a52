// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program.h"

#include <filesystem>
#include <system_error>

#include "base/json_writer.h"
#include "base/message.h"

namespace ispace {

std::string programPrefix() {
    std::error_code error;
    const auto folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
    auto prefix = folder.parent_path();
    // Where a package keeps the tools apart from other programs of the same names.
    if (folder.string().ends_with("/lib/ispace/bin")) prefix = prefix.parent_path().parent_path();
    return prefix.string();
}

std::string_view version() { return ISPACE_VERSION; }

JsonWriter& beginReport(JsonWriter& json, std::string_view schema, std::string_view tool) {
    json.beginObject().key("schema").value(schema);
    return json.key("tool").value(tool).key("version").value(version());
}

std::string shellQuote(std::string_view word) {
    constexpr std::string_view kPlain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./:,=%+@";
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string_view::npos)
        return std::string(word);
    std::string quoted = "'";
    for (const char c : printable(word)) {
        if (c == '\'')
            quoted += "'\\''";
        else
            quoted += c;
    }
    return quoted + '\'';
}

std::string baseName(std::string_view operand) {
    while (operand.size() > 1 && operand.ends_with('/')) operand.remove_suffix(1);
    const auto slash = operand.rfind('/');
    return std::string(slash == std::string_view::npos || operand.size() == 1
                           ? operand
                           : operand.substr(slash + 1));
}

}  // namespace ispace
