// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/net: what requests of several roles have in common.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geom/pose.h"

namespace ispace {

/// The words of a request and what is between them. \pre they are neighbours, one at least
inline std::string_view textOf(std::span<const std::string_view> words) {
    const std::string_view last = words.back();
    return {words.front().data(),
            static_cast<std::size_t>(last.data() + last.size() - words.front().data())};
}

/// A whole number from 1 to a thousand million, or what is wrong with it.
struct Count {
    std::int64_t value = 0;
    int code = 0;  ///< of the error; 0: none
    std::string message;
};
/// `what` begins the message: "every", "the number of steps".
Count parseCount(std::string_view text, std::string_view what);

/// A measured value, with three decimals.
std::string measured(double value);
/// A heading within (-180, 180], still so when rounded.
std::string headingText(Angle heading);

/// "ERR 404 no robot `r9`\n"
std::string errorLine(int code, std::initializer_list<std::string_view> text);

/// Of a request that failed for want of memory, or because something cannot be written so.
std::string errorLineOf(const std::exception_ptr& failure);

/// "no robot `r9`" with what may have been meant, or what there is.
std::string unknownThing(std::string_view kind, std::string_view id,
                         const std::vector<std::string>& known, std::string_view where = "");

}  // namespace ispace
