// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/io only: what the attributes of SVG's elements say.
#pragma once

#include <optional>
#include <pugixml.hpp>
#include <string_view>
#include <vector>

#include "io/svg_path.h"

namespace ispace {

/// What is inherited, as far as it makes things show.
struct SvgStyle {
    bool visible = true;
    bool no_fill = false, no_stroke = false;  ///< by its own words: style sheets may say otherwise
    bool has_stroke = false;
};

/// Without the prefix of a name space.
std::string_view svgName(pugi::xml_node node);

/// Without blanks around.
std::string_view svgTrimmed(std::string_view text);

/// A property, of `style` or as an attribute; "" if it is not set.
std::string_view svgProperty(pugi::xml_node node, std::string_view key);

/// The style of an element in one with this style.
SvgStyle svgStyle(pugi::xml_node node, SvgStyle style);

/// An attribute in the element's own coordinates; lengths with units come in pixels.
/// \throws SvgError
double svgNumber(pugi::xml_node node, const char* key, double standard = 0);

/// Rectangle that is seen, in the coordinates inside of it.
struct SvgBox {
    double x = 0, y = 0, width = 0, height = 0;
};

/// The attribute viewBox. \throws SvgError
std::optional<SvgBox> svgViewBox(pugi::xml_node node);

/// What path, line, polyline, polygon, rect, circle and ellipse draw. \throws SvgError
std::vector<SvgSubpath> svgPaths(pugi::xml_node node, std::string_view kind);

}  // namespace ispace
