// SPDX-License-Identifier: GPL-3.0-or-later
// lib/draw: one vector picture with PNG, SVG and PDF behind it. Uses geom; Cairo inside.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "draw/color.h"
#include "draw/image.h"
#include "draw/text.h"
#include "geom/polygon.h"

namespace ispace {

enum class PictureFormat { Png, Svg, Pdf };

/// A line's look; widths and dashes are in page units, whatever the view.
struct Stroke {
    Color color;
    double width = 1;
    std::vector<double> dashes = {};  ///< lengths on, off, on, …; empty: solid
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
};

/// Takes metres with y up to page units with y down: `world_anchor` comes to lie on `page_anchor`.
struct PageView {
    double scale = 1;  ///< page units per metre
    Point2 world_anchor, page_anchor;

    [[nodiscard]] Point2 operator*(Point2 world) const {
        return {page_anchor.x + scale * (world.x - world_anchor.x),
                page_anchor.y - scale * (world.y - world_anchor.y)};
    }
};

/// A white page to draw on. Page units are pixels in PNG, user units in SVG, points in PDF; the
/// page's origin is its upper left corner, y down.
///
/// Places and radii are in the units of the innermost view (without one, of the page); angles
/// turn counter-clockwise as seen, from +x. Nothing on the page depends on the date, the machine or
/// what was drawn before: equal calls give equal bytes.
class Canvas {
  public:
    /// Longest side of a page, in page units.
    static constexpr double kLongestSide = 30000;

    /// \throws UsageError unless both sides are in 1..kLongestSide
    Canvas(PictureFormat format, double width, double height);
    Canvas(Canvas&&) noexcept;
    Canvas& operator=(Canvas&&) noexcept;
    ~Canvas();

    [[nodiscard]] double width() const;
    [[nodiscard]] double height() const;

    /// Views replace each other (they do not multiply), clips add up; pop() undoes the last push.
    void pushView(const PageView& view);
    void pushClip(const Polygon& inside);
    void pushClip(const Region& inside);
    /// By the even-odd rule.
    void pushClip(std::span<const Polygon> inside);
    /// \pre a push is open
    void pop();
    /// From the units of the innermost view to the page's.
    [[nodiscard]] Point2 toPage(Point2 p) const;

    void fill(const Polygon& polygon, Color color);
    /// Holes stay free.
    void fill(const Region& region, Color color);
    /// All curves at once by the even-odd rule: curves that meet leave no seam.
    void fill(std::span<const Polygon> curves, Color color);
    /// Lines across what fill() would fill.
    void hatch(std::span<const Polygon> curves, const Hatch& hatch);
    /// The closed curve, or all closed curves.
    void stroke(const Polygon& polygon, const Stroke& stroke);
    void stroke(std::span<const Polygon> curves, const Stroke& stroke);
    void stroke(const Region& region, const Stroke& stroke);

    void line(Point2 a, Point2 b, const Stroke& stroke);
    /// All segments as one path; pieces that share an end are joined.
    void lines(std::span<const Segment2> segments, const Stroke& stroke);
    void polyline(std::span<const Point2> points, const Stroke& stroke);

    void fillCircle(Point2 center, double radius, Color color);
    void strokeCircle(Point2 center, double radius, const Stroke& stroke);
    /// Counter-clockwise from `from` to `to`.
    void strokeArc(Point2 center, double radius, Angle from, Angle to, const Stroke& stroke);
    void fillSector(Point2 center, double radius, Angle from, Angle to, Color color);

    /// A picture's pixels as rectangles of this size, without a seam or a blend; `corner` is the
    /// upper left one. Sharp in PNG where corner and size are whole page units.
    void image(Point2 corner, const Image& picture, double pixel_width, double pixel_height);

    /// One line of text; `anchor` lies on its base line, at the side or middle that align names.
    /// In SVG and PDF it can be searched and copied; in SVG all text lies above everything else and
    /// knows no clips.
    void text(Point2 anchor, std::string_view text, const TextStyle& style);

    /// The file's bytes; the page is finished, nothing can be drawn afterwards.
    [[nodiscard]] std::string encode();

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
