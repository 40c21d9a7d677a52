// SPDX-License-Identifier: GPL-3.0-or-later
// For lib/io only: the small languages in SVG's attributes, and what attributes of elements mean.
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <pugixml.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>
#include <variant>
#include <vector>

#include "io/import_records.h"
#include "io/plan/curves.h"

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

/// Properties that decide what is visible, as an element or a rule states them.
enum class SvgProperty : std::size_t { Display, Visibility, Fill, Stroke };
class SvgProperties {
  public:
    /// "" if unset.
    std::string_view operator[](SvgProperty key) const {
        return values_[static_cast<std::size_t>(key)];
    }
    /// Reads `a: b; c: d`; the last one of a key counts. O(length)
    void declare(std::string_view declarations);
    /// Takes those that are unset here.
    void addWeaker(const SvgProperties& others);
    /// Takes those that are set there.
    void addStronger(const SvgProperties& others);
    void setIfUnset(SvgProperty key, std::string_view value) {
        std::string_view& own = values_[static_cast<std::size_t>(key)];
        if (own.empty()) own = value;
    }
    static constexpr std::array<const char*, 4> kNames{"display", "visibility", "fill", "stroke"};

  private:
    std::array<std::string_view, kNames.size()> values_;
};

/// What is visible of an element, with what it inherits.
struct SvgStyle {
    bool visible = true;
    bool no_fill = false, no_stroke = false;  ///< said explicitly: unset means drawn
    bool has_stroke = false;
};

/// Rules of `style` elements with one plain selector: an element's name, .class or #id.
class SvgSheet {
  public:
    /// Adds the rules of a style element, ignoring other selectors. O(length)
    void add(std::string_view css);
    /// Sets what `properties` leave open by these rules. Ids win over classes, these over names,
    /// later rules over earlier ones.
    void apply(pugi::xml_node node, SvgProperties& properties) const;

  private:
    std::deque<std::string> texts_;                         // without comments
    std::unordered_map<std::string, SvgProperties> rules_;  // by selector, views of the texts
};

/// Without the prefix of a name space.
std::string_view svgName(pugi::xml_node node);

/// Those of an element: from `style`, else rules, else attributes. Views of the document.
SvgProperties svgProperties(pugi::xml_node node, const SvgSheet& sheet);

/// The style of an element with these properties within one of this style.
SvgStyle svgStyle(SvgStyle style, const SvgProperties& properties);

/// Names that an element has or inherits, as they stand in the file; null: none.
struct SvgNames {
    const char* option = nullptr;  ///< one that an option gives, of the innermost element
    const char* walls = nullptr;   ///< one that is called walls, see isWallName(); the innermost
    const char* layer = nullptr;   ///< of the innermost Inkscape layer
    const char* group = nullptr;   ///< of the outermost group

    /// Those of an element with its own names within one with these.
    [[nodiscard]] SvgNames with(const SvgNames& own) const;
    /// The layer of a plan's line, see readSvg; "(none)" without any.
    [[nodiscard]] const char* planLayer() const;
};

/// What an element says of itself, wherever it is used. Views of the document and the sheet.
struct SvgElement {
    std::size_t units = 0;  ///< of work that its other attributes make each time it is drawn
    SvgProperties properties;
    Affine transform;
    SvgNames names;
};

/// O(length of the element and its selectors) \throws SvgError
SvgElement readSvgElement(pugi::xml_node node, const SvgSheet& sheet, const ImportOptions& options);

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
