// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "draw/color.h"

namespace ispace {

enum class Align { Left, Center, Right };

/// How a line of text is set; sizes are in page units, whatever the view.
struct TextStyle {
    double size = 12;  ///< of the font: about 1.2 times a capital's height plus its descent
    bool bold = false;
    Align align = Align::Left;
    Color color;
    std::optional<Color> halo = {};  ///< a rim of this colour keeps text readable on lines
};

/// Length of the text as Picture::text sets it, in page units. Control characters and bad UTF-8
/// show as '?', here and in all text.
double textWidth(std::string_view text, const TextStyle& style);

/// The text, or its beginning and an ellipsis if it is longer than `width` page units.
std::string fitText(std::string_view text, double width, const TextStyle& style);

}  // namespace ispace
