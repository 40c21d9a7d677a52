// SPDX-License-Identifier: GPL-3.0-or-later
#include "draw/text.h"

#include <cstddef>
#include <vector>

#include "base/message.h"

namespace ispace {

std::string fitText(std::string_view text, double width, const TextStyle& style) {
    std::string clean = printable(text);
    if (textWidth(clean, style) <= width) return clean;
    std::vector<std::size_t> ends = {0};  // of each character
    while (ends.back() < clean.size())
        ends.push_back(ends.back() + utf8Length(std::string_view(clean).substr(ends.back())));
    const auto shortened = [&clean, &ends](std::size_t characters) {
        return clean.substr(0, ends[characters]) + "…";
    };
    std::size_t fits = 0, too_long = ends.size() - 1;
    while (too_long - fits > 1) {
        const std::size_t middle = fits + (too_long - fits) / 2;
        (textWidth(shortened(middle), style) <= width ? fits : too_long) = middle;
    }
    return shortened(fits);
}

}  // namespace ispace
