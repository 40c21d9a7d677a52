// SPDX-License-Identifier: GPL-3.0-or-later
// For lib/io only: the small languages in SVG's attributes, and what attributes of elements mean.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "io/curves.h"
#include "io/import_records.h"

namespace ispace {

/// What is wrong in an attribute; readSvg adds the place.
struct SvgError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Pieces of a path in its own units, each from the end of the one before.
struct SvgLine {
    Point2 to;
};
struct SvgCubic {
    Point2 control1, control2, to;
};
/// center + cos(t) major + sin(t) minor for t from `from` to `from + sweep`, in radians.
struct SvgArc {
    Point2 center;
    Vec2 major, minor;
    double from = 0, sweep = 0;
    Point2 to;
};
using SvgPiece = std::variant<SvgLine, SvgCubic, SvgArc>;

struct SvgSubpath {
    Point2 start;
    std::vector<SvgPiece> pieces;
    bool closed = false;
};

/// The data of a `path`: M L H V C S Q T A Z, absolute and relative. \throws SvgError
std::vector<SvgSubpath> parseSvgPath(std::string_view data);

/// Numbers separated by blanks and commas. \throws SvgError
std::vector<double> parseSvgNumbers(std::string_view text);

/// The value of `transform`. \throws SvgError
Affine parseSvgTransform(std::string_view text);

/// A length: a number with mm, cm, in, pt, pc, Q, px or nothing; in metres, at 96 pixels an inch,
/// or nothing for percentages and sizes of fonts. \throws SvgError where there is no number
std::optional<double> parseSvgMetres(std::string_view text);

/// True for a length on paper: with a unit that is not px.
bool isSvgPhysical(std::string_view length);

/// The whole ellipse, as one closed path.
SvgSubpath svgEllipse(Point2 center, double radius_x, double radius_y);

/// The rectangle, its corners rounded. \pre all are at least 0
SvgSubpath svgRectangle(Point2 corner, double width, double height, double radius_x,
                        double radius_y);

/// Inherited properties that decide what is visible.
struct SvgStyle {
    bool visible = true;
    bool no_fill = false, no_stroke = false;  ///< said explicitly: unset means drawn
    bool has_stroke = false;
};

/// Rules of `style` elements with one plain selector: an element's name, .class or #id.
class SvgSheet {
  public:
    /// Adds the rules of a style element, ignoring other selectors.
    void add(std::string_view css);
    /// The value of a property by these rules; "" if none. Ids win over classes, these over names,
    /// later rules over earlier ones.
    [[nodiscard]] std::string_view property(pugi::xml_node node, std::string_view key) const;

  private:
    std::map<std::string, std::string, std::less<>> rules_;  // declarations by selector
};

/// Without the prefix of a name space.
std::string_view svgName(pugi::xml_node node);

/// A property from `style`, rules or an attribute; "" if unset.
std::string_view svgProperty(pugi::xml_node node, std::string_view key, const SvgSheet& sheet);

/// The style of an element within one of this style.
SvgStyle svgStyle(pugi::xml_node node, SvgStyle style, const SvgSheet& sheet);

/// An attribute in the element's own coordinates; lengths with units come in pixels.
/// \throws SvgError
double svgNumber(pugi::xml_node node, const char* key, double standard = 0);

/// A visible rectangle in its inner coordinates.
struct SvgBox {
    double x = 0, y = 0, width = 0, height = 0;
};

/// The attribute viewBox. \throws SvgError
std::optional<SvgBox> svgViewBox(pugi::xml_node node);

/// What path, line, polyline, polygon, rect, circle and ellipse draw. \throws SvgError
std::vector<SvgSubpath> svgPaths(pugi::xml_node node, std::string_view kind);

}  // namespace ispace
