// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/history.h"

#include "base/utf8.h"

namespace ispace {

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
