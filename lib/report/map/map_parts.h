// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of a coverage map, shared by the map*.cc files only.
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

namespace ispace {

/// What is drawn, and where on the page.
struct MapPicture {
    const Scene& scene;
    const Coverage& coverage;
    const MapOptions& options;
    const Coverage* other = nullptr;  ///< what it is compared with, if it is
    double em = 10;                   ///< size of text, page units
    PageView view = {};               ///< from metres to the page
    bool terse = false;               ///< little room: show what matters most

    [[nodiscard]] const Box2& limits() const { return coverage.target.grid.limits; }
};

// Curves for the page (map_floor.cc).

/// The line through points that lies within `tolerance` of all of them (Douglas and Peucker).
std::vector<Point2> thinned(const std::vector<Point2>& points, double tolerance);
/// The part of what a closed curve holds in a box; where the curve leaves the box and comes back
/// the result runs along the box's sides (Sutherland and Hodgman).
Polygon clipped(const Polygon& curve, const Box2& box);
/// The part of a segment in a box, if there is one.
std::optional<Segment2> clipped(const Segment2& segment, const Box2& box);
/// Curves as they are drawn: clipped well outside of the plan, without vertices that nobody sees.
std::vector<Polygon> drawable(const MapPicture& map, std::vector<Polygon> curves);
/// The same of exact curves: chords for arcs.
std::vector<Polygon> drawable(const MapPicture& map, const std::vector<Curve>& curves);

// Floor (map_floor.cc).

/// Classes of redundancy that are told apart by colour: class c (1..count) holds the floor seen by
/// (c - 1) * width + 1 to c * width sensors.
struct Shades {
    std::uint32_t width = 1;
    int count = 1;

    [[nodiscard]] int of(std::uint32_t times) const {
        return static_cast<int>((times + width - 1) / width);
    }
    /// Least number of sensors of a class. \pre shade >= 1
    [[nodiscard]] std::uint32_t least(int shade) const {
        return (static_cast<std::uint32_t>(shade) - 1) * width + 1;
    }
    [[nodiscard]] Color color(int shade) const { return sequentialColor(shade, count); }
};
/// Of the shares in a report, exact ones where they are known.
Shades shadesFor(const CoverageReport& report);

/// Colour of a set and its sensors, of the floor where it alone sees (MapColor::Sensor), and of its
/// stripe where others see, too.
Color setColor(const MapPicture& map, std::size_t set);
Color floorColor(const MapPicture& map, std::size_t set);
Color stripeColor(const MapPicture& map, std::size_t set);
/// Sets more than these share stripes without colours.
constexpr std::size_t kMaxStriped = 6;

/// Of floor that cameras see (MapColor::Density): class 0 has fewer pixels than the least of
/// pixelDensities(), class i + 1 those of the one with index i.
Color densityColor(std::size_t density_class);
/// Share of the indoor region in such a class and no better one.
Metric shareOfDensity(const CoverageReport& report, std::size_t density_class);

/// Indoor floor in the colours of coverage. In metres: a view is open.
void drawCoverage(Picture& picture, const MapPicture& map);

// Sensors (map_marks.cc).

/// The set (of Coverage::sets) to which a sensor belongs: all receivers make one.
std::size_t setOf(const Coverage& coverage, std::size_t sensor);
/// Line of a sensor's contour: colours repeat, then their dashes differ; where floor is coloured
/// by sensor, neighbouring ones have other dashes as well.
Stroke sensorStroke(const MapPicture& map, std::size_t sensor);
/// Colour of its mark.
Color sensorColor(const MapPicture& map, std::size_t sensor);
/// Contours or beams. In metres: a view is open.
void drawViews(Picture& picture, const MapPicture& map);

SensorMark markOf(const MapPicture& map, std::size_t sensor);
/// A number in a disc; its radius is kSpotRadius * em.
constexpr double kSpotRadius = 0.62;
void drawSpotSign(Picture& picture, Point2 page, const std::string& number, double em);

/// Unseen spots that are marked and listed: the first ones, if they are not small beside the room.
std::size_t markedSpots(const MapPicture& map);

/// Marks and ids of the sensors, signs of unseen spots, on top of the plan; all keep within
/// `frame` (page units).
void drawMarks(Picture& picture, const MapPicture& map, const Box2& frame);

// What a search tried (map_marks.cc).

/// A place that was tried: the best value there, of any sensor and heading.
struct TriedPlace {
    Point2 place;
    double value = 0;
    std::optional<Angle> heading = {};  ///< of the best; none: it looks straight up or down
    bool is_chosen = false;             ///< a sensor was placed there
};
/// Each place once, the worst first; of equal ones the first tried comes first.
std::vector<TriedPlace> placesTried(const std::vector<TriedPose>& trace);

/// From pale yellow to dark brown: apart from the blue of covered floor, and darker with each step,
/// for any colour vision and in grey. \param share 0 (worst) to 1 (best)
Color triedColor(double share);

void drawChosenRing(Picture& picture, Point2 page, double radius, double em);
/// Dots with a tick in the best heading, the best on top; places of chosen sensors in rings. All
/// keep within `frame` (page units).
void drawTrace(Picture& picture, const MapPicture& map, const Box2& frame);

// Legend (map_legend.cc, map_legend_draw.cc).

/// What the plan of a map shows, in the order of the legend.
struct MapContents {
    bool walls = false;     ///< wall lines or bodies
    bool openings = false;  ///< what of them lies above or below the height of the target
    bool doors = false;
    bool glass = false;
    bool solids = false;   ///< objects that stand at the height of the target
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
        LineColumn,  ///< a numbered sign; the number is `number`
        Scale,       ///< the colours of triedColor(), worst to best
        Ring,
    };
    Sign sign = Sign::None;
    Color color = {}, edge = {};
    std::string text;
    std::string value;        ///< at the right side; in a block with columns in the first
    std::string second = {};  ///< in the second column
    SensorMark mark = {};
    std::string number = {};
};
struct LegendBlock {
    std::string title;
    std::vector<LegendItem> items;
    std::array<std::string, 2> columns = {};  ///< heads of value and second, or none
};

// What was seen of a run (map_run.cc).

/// On top of the plan, below sensors' marks.
void drawRun(Picture& picture, const MapPicture& map);
LegendBlock runBlock(const RunCoverage& run);

std::vector<LegendBlock> legendBlocks(const MapPicture& map);
/// The main metrics, the most important first, for a line below the title.
std::vector<std::string> mainMetrics(const MapPicture& map);

/// Blocks shared out over columns, in order.
struct LegendLayout {
    std::vector<std::vector<LegendBlock>> columns;
    double height = 0;
};
LegendLayout layOutLegend(std::vector<LegendBlock> blocks, int columns, double em);
void drawLegend(Picture& picture, const LegendLayout& layout, Point2 corner, double width,
                double em);

}  // namespace ispace
