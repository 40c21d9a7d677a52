// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of a coverage map, which maps of runs and pages share. Page units with y down unless a view
// is pushed, then metres; `em` is the size of text, by which all pens and marks scale.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coverage/coverage.h"
#include "drawing/color.h"
#include "drawing/drawing.h"
#include "drawing/plan/plan.h"
#include "report/map/map.h"
#include "report/map/sensor_colors.h"
#include "scene/sensor/density_classes.h"

namespace ispace {

/// The input of a map, and its layout on the page.
struct MapPicture {
    const Scene& scene;
    const Coverage& coverage;
    const MapOptions& options;
    const Coverage* other = nullptr;  ///< compared with it; null: not compared
    double em = 10;                   ///< text size, page units
    PageView view = {};               ///< maps metres to the page
    bool terse = false;               ///< little room: only the main elements are shown
    std::vector<std::size_t> hues = sensorHues(coverage);

    [[nodiscard]] const Box2& limits() const { return coverage.target.grid.limits; }
};

// Curves for the page (map_floor.cc).

/// Thins a line to points such that it stays within `tolerance` of all points (Douglas and
/// Peucker).
std::vector<Point2> thinned(const std::vector<Point2>& points, double tolerance);
/// Clips the area of a closed curve to a box; outside the box the result runs along its sides
/// (Sutherland and Hodgman).
Polygon clipped(const Polygon& curve, const Box2& box);
/// Clips a segment to a box; empty if it misses the box.
std::optional<Segment2> clipped(const Segment2& segment, const Box2& box);
/// Returns curves for drawing: clipped well outside the plan, without invisible vertices.
std::vector<Polygon> drawable(const MapPicture& map, std::vector<Polygon> curves);
/// Likewise for exact curves: chords replace arcs.
std::vector<Polygon> drawable(const MapPicture& map, const std::vector<Curve>& curves);

/// Corners that the views of a picture have in sum, and at least each: more would take memory that
/// no reader has, for details that no eye sees.
constexpr std::size_t kMostCorners = 400'000, kLeastCorners = 64;

/// Curves with a bounded number of corners.
struct FittedCurves {
    std::vector<Polygon> curves;
    double tolerance = 0;  ///< that they may be off, in metres; 0: they are as they were
};
std::size_t cornersOf(const std::vector<Polygon>& curves);
/// Returns curves as they are if they have at most `most` corners; otherwise those corners that lie
/// farthest from the outline without them (Douglas and Peucker, largest distance first). Curves
/// with fewer than three of these are left out.
FittedCurves fitted(std::vector<Polygon> curves, std::size_t most);
/// Returns the share of one among `views` in the corners of a picture.
std::size_t cornersFor(std::size_t views);
/// Returns the contours of a sensor's view for drawing, with its share of corners.
FittedCurves fittedContours(const MapPicture& map, const SensorView& view);
/// Returns ", outline within 0.2 m" of curves that were thinned, else an empty text.
std::string toleranceText(const FittedCurves& view);

// Passages (map_passages.cc).

/// Draws stairs with their steps and an arrow upwards, lifts with a cross, and shafts with a dashed
/// rim, each with its id.
void drawPassages(Picture& picture, const MapPicture& map);

// Floor (map_floor.cc).

/// Classes of redundancy with a colour each: class c (1..count) holds the floor seen by (c - 1) *
/// width + 1 to c * width sensors.
struct Shades {
    std::uint32_t width = 1;
    int count = 1;

    [[nodiscard]] int of(std::uint32_t times) const {
        return static_cast<int>((times + width - 1) / width);
    }
    /// Returns the minimum number of sensors of a class. \pre shade >= 1
    [[nodiscard]] std::uint32_t least(int shade) const {
        return (static_cast<std::uint32_t>(shade) - 1) * width + 1;
    }
    [[nodiscard]] Color color(int shade) const { return sequentialColor(shade, count); }
};
/// Chooses classes by the redundancy of a report, exact if known, or for a scale that reaches
/// farther.
Shades shadesFor(const CoverageReport& report, std::uint32_t scale = 0);

/// Returns the colour of a set and its sensors, of the floor that it alone sees (MapColor::Sensor),
/// and of its stripes on shared floor.
Color setColor(const MapPicture& map, std::size_t set);
Color floorColor(const MapPicture& map, std::size_t set);
Color stripeColor(const MapPicture& map, std::size_t set);
/// If more sets than this share floor, stripes have no colours.
constexpr std::size_t kMaxStriped = 6;

/// Returns the standard whose names a map shows (MapColor::Density or Levels).
DensityStandard standardOf(MapColor color);
/// Returns the colour of a class: class 0 has fewer pixels than the least of a standard, class
/// i + 1 at least those of its index i.
Color densityColor(std::size_t density_class,
                   DensityStandard standard = DensityStandard::Classes2015);
/// Returns the share of the indoor region in this class and no better one of the standard.
Metric shareOfDensity(const CoverageReport& report, std::size_t density_class,
                      DensityStandard standard = DensityStandard::Classes2015);

/// Fills indoor floor with the colours of coverage, in metres. \pre a view is pushed
void drawCoverage(Picture& picture, const MapPicture& map);

// Sensors (map_marks.cc).

/// Returns the set (of Coverage::sets) of a sensor: all receivers form one.
std::size_t setOf(const Coverage& coverage, std::size_t sensor);
/// Returns the stroke of a sensor's contour: repeated colours have different dashes; if floor is
/// coloured by sensor, neighbouring sensors have different dashes, too.
Stroke sensorStroke(const MapPicture& map, std::size_t sensor);
/// Returns the colour of a sensor's mark.
Color sensorColor(const MapPicture& map, std::size_t sensor);
/// Draws contours or beams, in metres. \pre a view is pushed
void drawViews(Picture& picture, const MapPicture& map);

/// Draws a group for each sensor with its region as one path. \pre a view is pushed
void drawRegions(Picture& picture, const MapPicture& map);

SensorMark markOf(const MapPicture& map, std::size_t sensor);
/// Radius of a spot's numbered disc in em.
constexpr double kSpotRadius = 0.62;
void drawSpotSign(Picture& picture, Point2 page, const std::string& number, double em);

/// Returns the number of unseen spots that are marked and listed: the largest ones, unless they are
/// small compared with the room.
std::size_t markedSpots(const MapPicture& map);

/// Draws the marks and ids of sensors and the signs of unseen spots on top of the plan, all within
/// `frame` (page units). \param suffix of the names of their layers
void drawMarks(Picture& picture, const MapPicture& map, const Box2& frame,
               const std::string& suffix = "");

// Poses that a search tried (map_marks.cc).

/// A tried position: the best value there, of any sensor and heading.
struct TriedPlace {
    Point2 place;
    double value = 0;
    std::optional<Angle> heading = {};  ///< of the best pose; empty: it points straight up or down
    bool is_chosen = false;             ///< a sensor was put there
};
/// Merges poses by position, the worst first; equal values keep the order of the trace.
std::vector<TriedPlace> placesTried(const std::vector<TriedPose>& trace);

/// Returns a colour from pale yellow to dark brown: distinct from the blue of covered floor, and
/// darker with each step, for any colour vision and in grey. \param share 0 (worst) to 1 (best)
Color triedColor(double share);

void drawChosenRing(Picture& picture, Point2 page, double radius, double em);
/// Draws dots with a tick in the best heading, the best on top, and rings around positions of
/// chosen sensors, all within `frame` (page units).
void drawTrace(Picture& picture, const MapPicture& map, const Box2& frame);

// Legend (map_legend.cc, map_legend_draw.cc).

/// The elements on the plan of a map, in the order of the legend.
struct MapContents {
    bool walls = false;     ///< wall lines or bodies
    bool openings = false;  ///< parts of openings off the target's height
    bool doors = false;
    bool glass = false;
    bool solids = false;   ///< objects that stand at the target's height
    bool objects = false;  ///< other objects
    bool outside = false;  ///< holes in the indoor region
    bool zones = false;
};
MapContents contentsOf(const Scene& scene, const Coverage& coverage);

struct LegendItem {
    enum class Sign {
        None,
        Patch,
        Hatched,  ///< a patch with lines of the edge's colour
        Line,
        Dashes,
        Sensor,      ///< `mark`; on a patch of `color` unless that is transparent
        LineColumn,  ///< a numbered sign, with `number`
        Scale,       ///< the colours of triedColor(), worst to best
        Ring,
    };
    Sign sign = Sign::None;
    Color color = {}, edge = {};
    std::string text;
    std::string value;        ///< at the right side; in a block with columns, in the first
    std::string second = {};  ///< in the second column
    SensorMark mark = {};
    std::string number = {};
};
struct LegendBlock {
    std::string title;
    std::vector<LegendItem> items;
    std::array<std::string, 2> columns = {};  ///< heads of value and second, or empty
};

std::vector<LegendBlock> legendBlocks(const MapPicture& map);
/// Returns the main metrics, the most important first, for the subtitle.
std::vector<std::string> mainMetrics(const MapPicture& map);

/// Blocks distributed over columns, in order.
struct LegendLayout {
    std::vector<std::vector<LegendBlock>> columns;
    double height = 0;
};
LegendLayout layOutLegend(std::vector<LegendBlock> blocks, int columns, double em);
void drawLegend(Picture& picture, const LegendLayout& layout, Point2 corner, double width,
                double em);

}  // namespace ispace
