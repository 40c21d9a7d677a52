// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers, messages and values in the text of the protocol.
#include <algorithm>
#include <exception>
#include <initializer_list>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/message.h"
#include "base/number.h"
#include "server/session.h"

namespace ispace {

namespace {

/// Larger than practical counts; sums of them cannot overflow.
constexpr std::int64_t kMaxCount = 1'000'000'000;

}  // namespace

Count parseCount(std::string_view text, std::string_view what) {
    const auto value = parseInteger(text);
    std::string found = ", found ";
    found += excerpt(text);
    std::string message(what);
    // Integers with too many digits are numbers, too.
    const bool is_whole = value || text.find_first_not_of("0123456789") == std::string_view::npos;
    if (!is_whole || text.empty())
        return {0, 400, message.append(" is a whole number").append(found)};
    if (!value || *value < 1 || *value > kMaxCount) {
        message.append(" is from 1 to ").append(std::to_string(kMaxCount)).append(found);
        return {0, 416, message};
    }
    return {*value, 0, ""};
}

std::string errorLine(int code, std::initializer_list<std::string_view> text) {
    std::string line = "ERR ";
    line.append(std::to_string(code)).append(" ");
    for (const std::string_view piece : text) line += printable(piece);
    return line += '\n';
}

std::string errorLineOf(const std::exception_ptr& failure) {
    constexpr const char* kNoMemory = "there is not enough memory for this";
    try {
        std::rethrow_exception(failure);
    } catch (const std::bad_alloc&) {
        return errorLine(409, {kNoMemory});
    } catch (const std::length_error&) {
        return errorLine(409, {kNoMemory});
    } catch (const std::exception& error) {
        return errorLine(409, {error.what()});
    }
}

std::string unknownThing(std::string_view kind, std::string_view id,
                         const std::vector<std::string>& known, std::string_view where) {
    constexpr std::size_t kFew = 12, kMany = 256;
    std::string out = "no ";
    out.append(kind).append(" ").append(excerpt(id)).append(where);
    if (known.empty()) return out.append(": there is none");
    // With thousands of names a similar one always exists, and the search is slow.
    if (known.size() <= kMany) {
        if (const std::string hint = didYouMean(id, known); !hint.empty()) return out.append(hint);
    }
    if (known.size() > kFew) return out.append("; LIST of the role WORLD names all");
    return out.append("; there is ").append(joined(known, ", "));
}

std::string measured(double value) { return formatFixed(value, 3); }

std::string headingText(Angle heading) {
    std::string text = measured(heading.degrees());
    if (text == "-180.000") text.erase(0, 1);
    return text;
}

}  // namespace ispace
