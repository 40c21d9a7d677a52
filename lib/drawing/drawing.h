// SPDX-License-Identifier: GPL-3.0-or-later
// lib/drawing: one retained picture with PNG, SVG and PDF behind it. Uses raster; a module links
// Cairo.
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

/// The pixels of a picture, opaque, from the upper left corner row by row.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint32_t> pixels;  ///< 0xRRGGBB

    /// \pre the place lies in the picture
    [[nodiscard]] std::uint32_t at(int x, int y) const {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
};

/// Decodes a PNG, e.g. to check a drawing; transparency counts as black.
/// \throws FormatError if the bytes are no whole PNG
Image decodePng(std::string_view bytes);
std::string encodePng(const Image& image);

enum class PictureFormat { Png, Svg, Pdf };
/// Its suffix, and its name on the command line.
constexpr std::string_view nameOf(PictureFormat format) {
    return format == PictureFormat::Png ? "png" : format == PictureFormat::Svg ? "svg" : "pdf";
}

/// A line's style; widths and dashes are in page units, whatever the view.
struct Stroke {
    Color color;
    double width = 1;
    std::vector<double> dashes = {};  ///< lengths on, off, on, …; empty: solid

    friend bool operator==(const Stroke&, const Stroke&) = default;
};

/// Parallel lines across an area; lengths are in page units, whatever the view. Those of one
/// spacing and direction go through the page's origin (shifted by `offset`), so that areas fit
/// together.
struct Hatch {
    Color color;
    double spacing = 8;  ///< from the middle of a line to that of the next, at least 0.5
    double width = 1;    ///< of a line
    double offset = 0;   ///< to the left of the direction
    Angle direction = Angle::degrees(45);

    friend bool operator==(const Hatch&, const Hatch&) = default;
};

/// What a shape is drawn with: a colour fills it.
using Ink = std::variant<Color, Hatch, Stroke>;
/// Drawn in this order, e.g. a fill and its outline, or a wide pale line below a fine one.
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

/// A page's unit on paper and screen. A PNG has a pixel a unit.
enum class PageUnit {
    Pixel,       ///< px in SVG, points in PDF
    Millimetre,  ///< in SVG and PDF, which print to scale
};

/// The shapes of a picture in the order of drawing, in page units, as its writers read them.
struct DisplayList {
    enum class Kind : std::uint8_t {
        Layer,  ///< begins, clipped by curves first..last if there are any; the next name
        Group,  ///< begins, likewise
        End,    ///< of the innermost layer or group
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
    /// A circle, or a sector of it, counter-clockwise as seen.
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
    std::vector<std::uint32_t> ends = {0};  ///< of each curve in points; the first is no curve
    std::vector<Ink> inks = {};
    std::vector<Name> names = {};  ///< of layers and groups, in order
    std::vector<Arc> arcs = {};
    std::vector<Text> texts = {};
    std::vector<Raster> images = {};

    /// \param index from Shape::first up to Shape::last
    [[nodiscard]] std::span<const Point2> curve(std::uint32_t index) const {
        return std::span(points).subspan(ends[index], ends[index + 1] - ends[index]);
    }
    [[nodiscard]] std::span<const Ink> inksOf(const Shape& shape) const {
        return std::span(inks).subspan(shape.first_ink, shape.last_ink - shape.first_ink);
    }
};

/// A white page with shapes in named layers, retained until it is written, in any format.
///
/// The page's origin is its upper left corner, y down. Places and radii are in the units of the
/// innermost view (without one, of the page); angles turn counter-clockwise as seen, from +x.
/// Nothing depends on the date or the machine: equal calls give equal bytes. Some 100 bytes a shape
/// and 16 a vertex.
class Picture {
  public:
    /// Longest side of a page, in page units.
    static constexpr double kMaxSide = 30000;

    /// \throws UsageError unless both sides are in 1..kMaxSide
    Picture(double width, double height, PageUnit unit = PageUnit::Pixel);

    [[nodiscard]] double width() const { return width_; }
    [[nodiscard]] double height() const { return height_; }
    [[nodiscard]] PageUnit unit() const { return unit_; }

    /// What SVG says about the picture: a title, and a sentence or two.
    void describe(std::string title, std::string description);
    [[nodiscard]] const std::string& title() const { return title_; }
    [[nodiscard]] const std::string& description() const { return description_; }

    // What is pushed ends with its pop(). Views replace each other (they do not multiply), clips
    // (by the even-odd rule) add up.
    void pushView(const PageView& view);
    void pushClip(std::span<const Polygon> inside);
    void pushClip(const Polygon& inside) { pushClip(std::span(&inside, 1)); }
    /// A layer of SVG, as Inkscape knows them, clipped if there are curves; the first word of its
    /// name makes its id. Empty ones are left out.
    void pushLayer(std::string_view name, std::span<const Polygon> clip = {});
    /// An element of SVG: its id (characters XML forbids there become `_`, and names that are taken
    /// get a number) or "", and a title that viewers show beside the pointer.
    void pushGroup(std::string_view id, std::string_view title);
    /// \pre a push is open
    void pop();
    /// From the units of the innermost view to the page's.
    [[nodiscard]] Point2 toPage(Point2 p) const;

    /// The area of closed curves by the even-odd rule: curves that meet leave no seam, holes stay
    /// free.
    void area(std::span<const Polygon> curves, Inks inks);
    void area(const Polygon& curve, Inks inks) { area(std::span(&curve, 1), inks); }
    /// Lines from point to point; a line without length is a dot.
    void lines(std::span<const std::vector<Point2>> chains, Inks inks);
    void lines(const std::vector<Point2>& chain, Inks inks) { lines(std::span(&chain, 1), inks); }
    /// Segments; those that share an end are joined.
    void lines(std::span<const Segment2> segments, Inks inks);
    void line(Point2 a, Point2 b, const Stroke& stroke);
    void circle(Point2 center, double radius, Inks inks);
    /// Counter-clockwise from `from` to `to`, with both radii.
    void sector(Point2 center, double radius, Angle from, Angle to, Inks inks);

    /// Pixels as rectangles of this size, without a seam or a blend; `corner` is the upper left
    /// one. Sharp in PNG where corner and size are whole page units.
    void image(Point2 corner, Image image, double pixel_width, double pixel_height);

    /// One line of text; `anchor` lies on its base line, at the side or middle that align names.
    /// In SVG and PDF it can be searched and copied.
    void text(Point2 anchor, std::string_view text, const TextStyle& style);

    [[nodiscard]] const DisplayList& list() const { return list_; }
    /// The file's bytes. \pre every push has its pop
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

// The writers, for lib/drawing only.
std::string writePng(const Picture& picture);
std::string writePdf(const Picture& picture);
std::string writeSvg(const Picture& picture);

/// The lines of a hatch across a box, as from and to.
std::vector<Segment2> hatchLines(const Hatch& hatch, const Box2& box);
/// What shows of the curves first..last: their bounds within the page.
Box2 visibleBox(const Picture& picture, const DisplayList::Shape& shape);

/// 1, 2 or 5 times a power of ten, at least `least`. \pre least > 0
double roundStep(double least);

/// What printers reach of an A3 sheet, in millimetres.
constexpr double kPaperLong = 400, kPaperShort = 277;
/// Denominator of the largest usual scale of plans (1, 2, 5, 10, 20, 25, 50, 100, 200, 250, …) that
/// is at least `least`.
double usualScale(double least);

/// A bar of round length in black and white pieces, at most `most` page units long, with its length
/// and more text; `corner` is its lower left end on the page, `em` the size of text.
void drawScaleBar(Picture& picture, Point2 corner, double most, double page_per_metre, double em,
                  const std::string& more = "");

/// The pixels that write(PictureFormat::Png) encodes, for films. \pre every push has its pop
Image rasterOf(const Picture& picture);

}  // namespace ispace
