// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/io only: what the attributes of SVG's elements say.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "io/svg_path.h"

namespace ispace {

/// What is inherited, as far as it makes things show.
struct SvgStyle {
    bool visible = true;
    bool no_fill = false, no_stroke = false;  ///< where it is said: no word is no reason
    bool has_stroke = false;
};

/// Rules of `style` elements with one plain selector: an element's name, .class or #id.
class SvgSheet {
  public:
    /// Adds the rules of a style element; others than those are passed over.
    void add(std::string_view css);
    /// What they say of a property; "" if nothing. Ids win over classes, these over names, later
    /// rules over earlier ones.
    [[nodiscard]] std::string_view property(pugi::xml_node node, std::string_view key) const;

  private:
    std::map<std::string, std::string, std::less<>> rules_;  // declarations by selector
};

/// Without the prefix of a name space.
std::string_view svgName(pugi::xml_node node);

/// Without blanks around.
std::string_view svgTrimmed(std::string_view text);

/// A property, of `style`, by rules or as an attribute; "" if it is not set.
std::string_view svgProperty(pugi::xml_node node, std::string_view key, const SvgSheet& sheet);

/// The style of an element in one with this style.
SvgStyle svgStyle(pugi::xml_node node, SvgStyle style, const SvgSheet& sheet);

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
