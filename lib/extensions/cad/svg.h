// SPDX-License-Identifier: GPL-3.0-or-later
// Parsers of SVG's attributes, and the style and names of elements. Private to lib/extensions/cad.
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "extensions/cad/curves.h"
#include "io/import_records.h"

namespace ispace::cad {

/// An error in an attribute; readSvg adds the position.
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
/// Points center + cos(t) major + sin(t) minor for t from `from` to `from + sweep`, in radians.
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

/// Parses the data of a `path`: M L H V C S Q T A Z, absolute and relative. \throws SvgError
std::vector<SvgSubpath> parseSvgPath(std::string_view data);

/// Parses numbers separated by blanks and commas. \throws SvgError
std::vector<double> parseSvgNumbers(std::string_view text);

/// Parses the value of `transform`. \throws SvgError
Affine parseSvgTransform(std::string_view text);

/// Parses a length, a number with mm, cm, in, pt, pc, Q, px or no unit; in metres, at 96 pixels an
/// inch. Returns std::nullopt for percentages and units of font size. \throws SvgError for other
/// text
std::optional<double> parseSvgMetres(std::string_view text);

/// Returns true for a length on paper: with a unit that is not px.
bool isSvgPhysical(std::string_view length);

/// Returns the whole ellipse, as one closed path.
SvgSubpath svgEllipse(Point2 center, double radius_x, double radius_y);

/// Returns the rectangle, its corners rounded. \pre all are at least 0
SvgSubpath svgRectangle(Point2 corner, double width, double height, double radius_x,
                        double radius_y);

/// Properties that decide the visibility and the place of lines, as an element or a rule sets them.
enum class SvgProperty : std::size_t {
    Display,
    Visibility,
    Fill,
    Stroke,
    Opacity,
    FillOpacity,
    StrokeOpacity,
    Transform,
    TransformOrigin,
    TransformBox,
    StrokeWidth,
    StrokeDasharray,
    VectorEffect,
    ClipPath,
    ClipRule,
    Mask
};
class SvgProperties {
  public:
    /// Returns the value; "" if unset.
    std::string_view operator[](SvgProperty key) const {
        return values_[static_cast<std::size_t>(key)];
    }
    /// Parses `a: b; c: d !important`; of two declarations of a key the important one wins, else
    /// the last. O(length)
    void declare(std::string_view declarations);
    /// Returns true if no value is set.
    [[nodiscard]] bool isEmpty() const { return values_ == decltype(values_){}; }
    /// Copies values that are set in `others`, unless an important one here faces one that is not.
    void addStronger(const SvgProperties& others);
    void setIfUnset(SvgProperty key, std::string_view value) {
        std::string_view& own = values_[static_cast<std::size_t>(key)];
        if (own.empty()) own = value;
    }
    /// Drops values that refer to variables. \return true if there are any
    bool dropVariables();
    static constexpr std::array<const char*, 16> kNames{
        "display",          "visibility",    "fill",           "stroke",
        "opacity",          "fill-opacity",  "stroke-opacity", "transform",
        "transform-origin", "transform-box", "stroke-width",   "stroke-dasharray",
        "vector-effect",    "clip-path",     "clip-rule",      "mask"};

  private:
    void set(std::size_t key, std::string_view value, bool is_important);

    std::array<std::string_view, kNames.size()> values_;
    std::array<bool, kNames.size()> important_{};
};

/// The visible parts of an element, including inherited properties.
struct SvgStyle {
    bool visible = true;
    bool no_fill = false, no_stroke = false;  ///< set explicitly: unset means drawn
    bool has_stroke = false;
    bool clear_fill = false, clear_stroke = false;  ///< their opacity is 0
    std::optional<double> stroke_width = {};        ///< in the element's units; empty: not stated
    bool is_dashed = false;
};

/// Rules of `style` elements, as browsers cascade them: selectors of names, classes, ids,
/// attributes, :root, :not(), :is(), :where(), :first-child and :last-child, with the combinators
/// descendant, `>`, `+` and `~`. Rules of @media for the screen and of @supports count; states such
/// as :hover never match. Selectors with other parts, rules in rules, layers of rules and values of
/// variables are left out and listed.
///
/// Written for this reader: Debian's libraries of CSS (libcroco, which its own authors gave up;
/// NetSurf's libcss, which needs a handler of forty callbacks for its document) are larger than the
/// part of CSS that draws lines.
class SvgSheet {
  public:
    SvgSheet() = default;
    /// \param styles texts of style elements, in their order. O(n log n) in their length
    explicit SvgSheet(std::span<const std::string_view> styles);
    SvgSheet(SvgSheet&&) = default;  // not copied: views of texts_
    SvgSheet& operator=(SvgSheet&&) = default;
    /// Sets `properties`, those of the attribute `style`, by these rules: the attribute wins over
    /// rules, important rules over it; the more specific rule over others, and the later of two.
    /// \return units of Budget for the selectors that were compared, at most those of all rules
    std::size_t apply(pugi::xml_node node, SvgProperties& properties) const;
    /// Selectors and at-rules that are not understood, as written, with their numbers of rules.
    [[nodiscard]] const std::map<std::string, std::size_t>& unread() const { return unread_; }

  private:
    /// A part of a compound selector: an element's name, .class, #id, [attribute], or :class.
    struct Simple {
        enum class Kind { Name, Class, Id, Attribute, Root, First, Last, Not, Is, Where, Never };
        Kind kind = Kind::Name;
        std::string_view name, value;
        char relation = ' ';  ///< of an attribute: ' ' has it, '=', or the letter before '='
        std::vector<std::vector<Simple>> inner = {};  ///< compounds of Not, Is and Where
    };
    /// A compound selector, and the combinator to the one before it.
    struct Compound {
        std::vector<Simple> parts;
        char combinator = ' ';
    };
    struct Rule {
        std::vector<Compound> selector;  ///< the subject last
        std::array<int, 3> specificity{};
        std::size_t block = 0;  ///< in blocks_
    };
    /// What an element needs at least for a rule: an id, else a class, else a name, or "".
    struct Subject {
        Simple::Kind kind = Simple::Kind::Name;
        std::string_view name = {};
        auto operator<=>(const Subject&) const = default;
    };
    void addRules(std::string_view css, int depth);
    /// Adds a rule for the last of the blocks.
    void addRule(std::string_view selector);
    static std::optional<std::vector<Compound>> parse(std::string_view selector, int depth = 0);
    static std::optional<Simple> parsePseudoClass(std::string_view& selector, int depth);
    static void count(const Simple& part, std::array<int, 3>& specificity);
    /// Steps of a comparison: elements, which are limited, and the work for all.
    struct Steps {
        int elements = 0;
        std::size_t work = 0;
    };
    static bool matches(pugi::xml_node node, const Simple& part, Steps& steps);
    static bool matches(pugi::xml_node node, const std::vector<Simple>& parts, Steps& steps);
    static bool matches(pugi::xml_node node, const std::vector<Compound>& selector,
                        std::size_t last, Steps& steps);

    std::deque<std::string> texts_;                          // without comments
    std::vector<std::pair<Subject, std::size_t>> subjects_;  // of the rules, in their order
    std::vector<SvgProperties> blocks_;  // what the rules of a list of selectors share
    std::vector<Rule> rules_;
    std::map<std::string, std::size_t> unread_;
};

/// Returns the name without the prefix of a namespace.
std::string_view svgName(pugi::xml_node node);

/// Returns the properties of an element: from `style`, else rules, else attributes. Views of the
/// document. \param matching gets the units of work that rules took; may be null
SvgProperties svgProperties(pugi::xml_node node, const SvgSheet& sheet,
                            std::size_t* matching = nullptr);

/// Returns true for an invisible paint: none, transparent, a colour with an alpha of 0.
bool isSvgNone(std::string_view paint);

/// Returns true for an opacity of 0.
bool isSvgClear(std::string_view opacity);

/// Computes the style of an element with these properties within one of this style.
SvgStyle svgStyle(SvgStyle style, const SvgProperties& properties);

/// Names that an element has or inherits, verbatim; null: unnamed.
struct SvgNames {
    const char* option = nullptr;   ///< named by an option, of the innermost element
    const char* walls = nullptr;    ///< the innermost wall name, see isWallName()
    const char* layer = nullptr;    ///< of the innermost Inkscape layer
    const char* group = nullptr;    ///< of the outermost group
    const char* meaning = nullptr;  ///< of the innermost group called as doors, windows, or as what
                                    ///< closes no room, unless one within it is called walls

    /// Merges the names of an element, `own`, into those of its parent.
    [[nodiscard]] SvgNames with(const SvgNames& own) const;
    /// Returns the layer of a plan's line, see readSvg; "(none)" if unnamed.
    [[nodiscard]] const char* planLayer() const;
};

/// The attributes of an element, independent of its uses. Views of the document and the sheet.
struct SvgElement {
    std::size_t units = 0;     ///< of work for its other attributes at each use
    std::size_t matching = 0;  ///< units of work that comparing it with selectors took
    SvgProperties properties;
    Affine transform;  ///< without its origin, see svgOrigin()
    SvgNames names;
};

/// Parses an element. O(length of the element and its selectors) \throws SvgError
SvgElement readSvgElement(pugi::xml_node node, const SvgSheet& sheet, const ImportOptions& options);

/// A visible rectangle in its inner coordinates.
struct SvgBox {
    double x = 0, y = 0, width = 0, height = 0;
};

/// Parses an attribute in the element's own coordinates; lengths with units come in pixels.
/// \param whole of a percentage; 0: unknown \throws SvgError
double svgNumber(pugi::xml_node node, const char* key, double standard = 0, double whole = 0);

/// Returns the point of `transform-origin`, with percentages and words of the size of the viewport;
/// std::nullopt for the default.
std::optional<Vec2> svgOrigin(std::string_view text, const SvgBox& view);

/// Parses the attribute viewBox. \throws SvgError
std::optional<SvgBox> svgViewBox(pugi::xml_node node);

/// Converts path, line, polyline, polygon, rect, circle and ellipse to paths.
/// \param view the viewport around it, for percentages \throws SvgError
std::vector<SvgSubpath> svgPaths(pugi::xml_node node, std::string_view kind, const SvgBox& view);

}  // namespace ispace::cad
