// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/drawing: a retained picture, and its writers for PNG, SVG and PDF. Uses raster; a
// module links Cairo.
//
// A picture is drawn once and written in any format. Equal calls give equal bytes in SVG; PNG and
// PDF also depend on the release of Cairo, see picture_difference.h. Fonts are those of the module,
// never the machine's. The module is loaded for the first width of a text, PNG or PDF, which throws
// FormatError if Cairo is missing; programs that draw no picture do not pay for it.
//
//     Picture picture(400, 300);
//     picture.pushLayer("room");
//     picture.area(outline, {palette::kFloor, Stroke{palette::kWall, 2}});
//     picture.pop();
//     picture.text({200, 20}, "Hall", {.size = 14, .align = Align::Center});
//     writeAll("room.svg", picture.write(PictureFormat::Svg));
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "drawing/color.h"
#include "geom/polygon.h"

namespace ispace {

enum class Align { Left, Center, Right };

/// Style of a line of text; sizes are in page units, independent of the view.
struct TextStyle {
    double size = 12;  ///< of the font: about 1.2 times a capital's height plus its descent
    bool bold = false;
    Align align = Align::Left;
    Color color;
    std::optional<Color> halo = {};  ///< a rim of this colour keeps text readable on lines
};

/// Computes the width of the text as Picture::text draws it, in page units. Here and in all text,
/// '?' replaces control characters and invalid UTF-8.
double textWidth(std::string_view text, const TextStyle& style);

/// Returns the text, cut and with an ellipsis if it is wider than `width` page units.
std::string fitText(std::string_view text, double width, const TextStyle& style);

/// The pixels of a picture, opaque, row by row from the upper left corner.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint32_t> pixels;  ///< 0xRRGGBB

    /// Returns a pixel. \pre it lies in the picture
    [[nodiscard]] std::uint32_t at(int x, int y) const {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
};

/// Decodes a PNG, e.g. to check a drawing; transparent pixels become black.
/// \throws FormatError if the bytes are not a complete PNG
Image decodePng(std::string_view bytes);
std::string encodePng(const Image& image);

enum class PictureFormat { Png, Svg, Pdf };
/// Returns the suffix of a format, which is its name on the command line.
constexpr std::string_view nameOf(PictureFormat format) {
    return format == PictureFormat::Png ? "png" : format == PictureFormat::Svg ? "svg" : "pdf";
}

/// Style of a line; widths and dashes are in page units, independent of the view.
struct Stroke {
    Color color;
    double width = 1;
    std::vector<double> dashes = {};  ///< lengths on, off, on, …; empty: solid

    friend bool operator==(const Stroke&, const Stroke&) = default;
};

/// Parallel lines across an area; lengths are in page units, independent of the view. Lines of one
/// spacing and direction are aligned to the page's origin (shifted by `offset`), so that adjacent
/// areas match.
struct Hatch {
    Color color;
    double spacing = 8;  ///< between the middles of adjacent lines, at least 0.5
    double width = 1;    ///< of a line
    double offset = 0;   ///< to the left of the direction
    Angle direction = Angle::degrees(45);

    friend bool operator==(const Hatch&, const Hatch&) = default;
};

/// Paint of a shape; a colour fills it.
using Ink = std::variant<Color, Hatch, Stroke>;
/// Applied in this order, e.g. a fill and its outline, or a wide pale line below a fine one.
using Inks = std::initializer_list<Ink>;

/// Maps metres with y up to page units with y down: `world_anchor` lies on `page_anchor`.
struct PageView {
    double scale = 1;  ///< page units per metre
    Point2 world_anchor, page_anchor;

    [[nodiscard]] Point2 operator*(Point2 world) const {
        return {page_anchor.x + scale * (world.x - world_anchor.x),
                page_anchor.y - scale * (world.y - world_anchor.y)};
    }
};

/// The page unit on paper and screen. A PNG has a pixel a unit.
enum class PageUnit {
    Pixel,       ///< px in SVG, points in PDF
    Millimetre,  ///< in SVG and PDF, which print to scale
};

/// The shapes of a picture in drawing order, in page units, as its writers read them.
struct DisplayList {
    enum class Kind : std::uint8_t {
        Layer,  ///< begins, clipped by curves first..last if there are any; has the next name
        Group,  ///< begins, likewise
        End,    ///< ends the innermost layer or group
        Area,   ///< closed curves first..last, filled by the even-odd rule
        Lines,  ///< open curves first..last
        Arc,    ///< `first` in arcs
        Text,   ///< `first` in texts
        Image   ///< `first` in images
    };
    struct Shape {
        Kind kind = Kind::End;
        std::uint32_t first = 0, last = 0;
        std::uint32_t first_ink = 0, last_ink = 0;
    };
    struct Name {
        std::string id, title;  ///< a layer has its name as title
    };
    /// A circle or sector, counter-clockwise as seen.
    struct Arc {
        Point2 center;
        double radius = 0;
        Angle from, to;

        [[nodiscard]] bool isCircle() const { return to - from >= Angle::degrees(360); }
    };
    struct Text {
        Point2 anchor;
        std::string text;  ///< printable
        TextStyle style;
    };
    struct Raster {
        Point2 corner;
        Image image;
        double pixel_width = 1, pixel_height = 1;
    };

    std::vector<Shape> shapes = {};
    std::vector<Point2> points = {};
    std::vector<std::uint32_t> ends = {0};  ///< of each curve in points, after a sentinel
    std::vector<Ink> inks = {};
    std::vector<Name> names = {};  ///< of layers and groups, in order
    std::vector<Arc> arcs = {};
    std::vector<Text> texts = {};
    std::vector<Raster> images = {};

    /// Returns a curve. \param index from Shape::first up to Shape::last
    [[nodiscard]] std::span<const Point2> curve(std::uint32_t index) const {
        return std::span(points).subspan(ends[index], ends[index + 1] - ends[index]);
    }
    [[nodiscard]] std::span<const Ink> inksOf(const Shape& shape) const {
        return std::span(inks).subspan(shape.first_ink, shape.last_ink - shape.first_ink);
    }
};

/// A white page with shapes in named layers, stored until it is written in any format.
///
/// The page's origin is its upper left corner, y down. Positions and radii are in the units of the
/// innermost view (of the page without one); angles are counter-clockwise as seen, from +x.
/// Independent of date and machine: equal calls give equal bytes. Memory: about 100 bytes a shape
/// and 16 a vertex.
class Picture {
  public:
    /// Maximum side of a page, in page units.
    static constexpr double kMaxSide = 30000;

    /// Creates an empty page. \throws UsageError unless both sides are in 1..kMaxSide
    Picture(double width, double height, PageUnit unit = PageUnit::Pixel);

    [[nodiscard]] double width() const { return width_; }
    [[nodiscard]] double height() const { return height_; }
    [[nodiscard]] PageUnit unit() const { return unit_; }

    /// Sets the title and description of the SVG.
    void describe(std::string title, std::string description);
    [[nodiscard]] const std::string& title() const { return title_; }
    [[nodiscard]] const std::string& description() const { return description_; }

    // pop() ends a push. Views replace each other (they are not multiplied), clips (by the even-odd
    // rule) intersect.
    void pushView(const PageView& view);
    void pushClip(std::span<const Polygon> inside);
    void pushClip(const Polygon& inside) { pushClip(std::span(&inside, 1)); }
    /// Begins an SVG layer, in Inkscape's convention, clipped if there are curves; its id is the
    /// first word of its name. Empty layers are skipped.
    void pushLayer(std::string_view name, std::span<const Polygon> clip = {});
    /// Begins an SVG group with an id (`_` replaces characters that XML forbids, used ids get a
    /// number) or "", and a title that viewers show as a tooltip.
    void pushGroup(std::string_view id, std::string_view title);
    /// Ends the last push. \pre a push is open
    void pop();
    /// Converts from the units of the innermost view to the page's.
    [[nodiscard]] Point2 toPage(Point2 p) const;

    /// Adds the area of closed curves by the even-odd rule: curves that meet leave no seam, holes
    /// stay empty.
    void area(std::span<const Polygon> curves, Inks inks);
    void area(const Polygon& curve, Inks inks) { area(std::span(&curve, 1), inks); }
    /// Adds lines from point to point; a line of length 0 is a dot.
    void lines(std::span<const std::vector<Point2>> chains, Inks inks);
    void lines(const std::vector<Point2>& chain, Inks inks) { lines(std::span(&chain, 1), inks); }
    /// Adds segments; segments that share an end are joined.
    void lines(std::span<const Segment2> segments, Inks inks);
    void line(Point2 a, Point2 b, const Stroke& stroke);
    void circle(Point2 center, double radius, Inks inks);
    /// Adds a sector, counter-clockwise from `from` to `to`, with both radii.
    void sector(Point2 center, double radius, Angle from, Angle to, Inks inks);

    /// Adds pixels as rectangles of this size, without seams or blending; `corner` is the upper
    /// left one. Sharp in PNG if corner and size are integer page units.
    void image(Point2 corner, Image image, double pixel_width, double pixel_height);

    /// Adds a line of text; `anchor` lies on its base line, at the side or middle that align names.
    /// SVG and PDF store it as text for searching and copying.
    void text(Point2 anchor, std::string_view text, const TextStyle& style);

    /// Adds the shapes of another picture, scaled, with its upper left corner here, in page units:
    /// lines and text become thinner with them. Its layers and groups become groups without ids.
    /// \pre every push of `other` has its pop
    void inset(const Picture& other, Point2 corner, double scale);

    [[nodiscard]] const DisplayList& list() const { return list_; }
    /// Returns the file's bytes. \pre every push has its pop
    [[nodiscard]] std::string write(PictureFormat format) const;

  private:
    enum class Pushed : std::uint8_t { View, Mark };

    void push(DisplayList::Kind kind, DisplayList::Name name, std::span<const Polygon> clip);
    [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> add(std::span<const Polygon> curves);
    void add(DisplayList::Kind kind, std::pair<std::uint32_t, std::uint32_t> range, Inks inks);
    void addArc(const DisplayList::Arc& arc, Inks inks);
    [[nodiscard]] double toPage(double length) const { return length * scale(); }
    [[nodiscard]] double scale() const { return views_.empty() ? 1 : views_.back().scale; }

    double width_, height_;
    PageUnit unit_;
    std::string title_, description_;
    DisplayList list_;
    std::vector<PageView> views_;
    std::vector<Pushed> pushed_;
};

/// Writes pictures as the pages of one PDF. \pre every push has its pop
std::string writePdf(std::span<const Picture> pages);

/// Writes a picture as an `svg` element of an HTML page: as wide as its parent, and all ids begin
/// with `prefix`, so that several fit on one page. \pre every push has its pop
std::string svgElement(const Picture& picture, std::string_view prefix);

/// Escapes text for the content and the attributes of SVG, XML and HTML; see printable().
std::string escapedXml(std::string_view text);

// The writers, private to lib/engine/drawing.
std::string writePng(const Picture& picture);
std::string writeSvg(const Picture& picture);

/// Computes the lines of a hatch across a box.
std::vector<Segment2> hatchLines(const Hatch& hatch, const Box2& box);
/// Returns the bounds of the visible part of curves first..last, clipped to the page.
Box2 visibleBox(const Picture& picture, const DisplayList::Shape& shape);

/// Returns the least of 1, 2 or 5 times a power of ten that is at least `least`. \pre least > 0
double roundStep(double least);

/// Printable area of an A3 sheet, in millimetres.
constexpr double kPaperLong = 400, kPaperShort = 277;
/// Returns the denominator of the largest usual scale of plans (1, 2, 5, 10, 20, 25, 50, 100, 200,
/// 250, …) that is at least `least`.
double usualScale(double least);

/// Draws a scale bar of round length in black and white pieces, at most `most` page units long,
/// with its length and further text; `corner` is its lower left end on the page, `em` the text
/// size.
void drawScaleBar(Picture& picture, Point2 corner, double most, double page_per_metre, double em,
                  const std::string& more = "");

/// Returns the pixels that write(PictureFormat::Png) encodes, for films. \pre every push has its
/// pop
Image rasterOf(const Picture& picture);

}  // namespace ispace
