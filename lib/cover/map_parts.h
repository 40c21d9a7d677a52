// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of a coverage map, shared by the map*.cc files only.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cover/coverage.h"
#include "draw/canvas.h"

namespace ispace {

/// Colours of everything that is no data.
namespace map_colors {
constexpr Color kInk = Color::rgb(0x1F2328);
constexpr Color kFaintInk = Color::rgb(0x656D76);
constexpr Color kWhite = Color::rgb(0xFFFFFF);
constexpr Color kUncovered = Color::rgb(0xF6EBD9);
constexpr Color kOutside = Color::rgb(0xDADADA);
constexpr Color kWall = Color::rgb(0x24292F);
constexpr Color kSolid = Color::rgb(0x7D746B);
constexpr Color kSolidEdge = Color::rgb(0x4A443E);
constexpr Color kObject = Color::rgb(0xE2D9CD);
constexpr Color kObjectEdge = Color::rgb(0x9A9085);
constexpr Color kZone = Color::rgb(0x6E3A8E);
}  // namespace map_colors

/// Classes of redundancy that are told apart by colour: class c (1..count) holds the cells seen by
/// (c - 1) * width + 1 to c * width sensors.
struct Shades {
    std::uint32_t width = 1;
    int count = 1;

    [[nodiscard]] int of(std::uint32_t times) const {
        return static_cast<int>((times + width - 1) / width);
    }
    [[nodiscard]] Color color(int shade) const { return sequentialColor(shade, count); }
};
Shades shadesFor(const std::vector<double>& redundancy);

/// What the picture shows of a scene, in the order of the legend.
struct MapContents {
    bool walls = false;    ///< wall lines or bodies
    bool solids = false;   ///< objects that stand at the height of the target
    bool objects = false;  ///< other objects
    bool outside = false;  ///< holes in the indoor region
    bool zones = false;
};
MapContents contentsOf(const Scene& scene, const Coverage& coverage);

/// Line of a sensor's contour: colours repeat, then their dashes differ.
Stroke sensorStroke(std::size_t index, std::size_t sensors, double em);

/// A marker of `radius` with an arrow along the heading (as seen, y up).
void drawSensorMark(Canvas& canvas, Point2 page, Angle heading, double radius, Color color);

/// Everything within the plan. `view` takes metres to the page, `em` is the size of text.
void drawPlan(Canvas& canvas, const Scene& scene, const Coverage& coverage, const PageView& view,
              double em);
/// Sensors' marks and ids, on top of the plan; labels keep within `frame` (page units).
void drawSensors(Canvas& canvas, const Scene& scene, const PageView& view, const Box2& frame,
                 double em);

struct LegendItem {
    enum class Sign { None, Patch, Line, Dashes, Sensor };
    Sign sign = Sign::None;
    Color color, edge;
    std::string text;
    std::string value;  ///< at the right side
};
struct LegendBlock {
    std::string title;
    std::vector<LegendItem> items;
};

std::vector<LegendBlock> legendBlocks(const Scene& scene, const Coverage& coverage);

/// Blocks shared out over columns, in order.
struct LegendLayout {
    std::vector<std::vector<LegendBlock>> columns;
    double height = 0;
};
LegendLayout layOutLegend(std::vector<LegendBlock> blocks, int columns, double em);
void drawLegend(Canvas& canvas, const LegendLayout& layout, Point2 corner, double width, double em);

/// A bar of round length (1, 2, 5 times a power of ten), at most `most` page units long, with its
/// label; `corner` is its lower left end.
void drawScaleBar(Canvas& canvas, Point2 corner, double most, double page_per_metre, double em);

}  // namespace ispace
