// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/drawing/plan: the plan of a scene, its view from above as shapes of a picture. Uses
// scene, drawing, raster.
//
// Plans, maps of coverage and pages draw a room by the same functions, so that a thing looks alike
// in all of them. Walls are cut at 1.2 m, about as in drawings of buildings: lower parts are pale,
// higher ones dashed.
//
//     writeAll("room.pdf", drawPlan(scene, {.format = PictureFormat::Pdf, .title = "Hall"}));
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "drawing/color.h"
#include "drawing/drawing.h"
#include "drawing/plan/elements.h"
#include "drawing/plan/found_rooms.h"
#include "geom/point.h"
#include "scene/scene.h"
#include "scene/sensor/sensor.h"

namespace ispace {

struct PlanOptions {
    PictureFormat format = PictureFormat::Png;
    std::optional<double> slice = {};  ///< draws only the obstacle map at this height, in metres
    int width = 1200;                  ///< of a PNG, in pixels
    std::string title;                 ///< e.g. base name of ENV; "" for no title
    /// Rooms of an import: rooms that were not kept are faint, with area and --inside point; closed
    /// gaps are marked. Null: not an import; ignored with `slice`.
    const FoundRooms* found = nullptr;
};

/// Draws the scene from above, as a plan: floor, zones, walls (cut, with their thickness), doors,
/// windows, things in the colours of their materials, sensors with their fields of view, robots,
/// people, names, a grid of 1 m (coarser if it would be too dense) with coordinates, a scale bar.
/// Walls without thickness are drawn as lines.
///
/// With `slice` draws the obstacle map at that height in the same frame: free floor, solids,
/// sheets.
///
/// SVG and PDF: to scale, on paper of A3 or less at the largest usual scale that fits (or smaller
/// scales for plans of a town), in millimetres. SVG has a layer for each type, in Inkscape's
/// convention, and each element is a group with its id and a title. Equal scenes give equal bytes.
/// O(n log n).
/// \throws UsageError for a width outside 200 to 12000
std::string drawPlan(const Scene& scene, const PlanOptions& options);
/// Draws the same without writing it.
Picture planPicture(const Scene& scene, const PlanOptions& options);

/// Mark of a sensor: a body by its kind, and an arrow if it faces sideways.
struct SensorMark {
    SensorSign sign = SensorSign::Disc;
    std::optional<Angle> heading = {};  ///< as seen, y up; empty: straight up or down
    Color color = palette::kInk;
    bool hollow = false;
};

/// Returns the bearings that a placed sensor shows on a plan.
BearingSpan bearingsOf(const Scene& scene, const PlacedRecord& placed);

/// Returns the horizontal direction of a pose; empty if it is vertical.
std::optional<Angle> headingOf(const Pose3& pose);

/// Draws a mark at a point of the page.
void drawSensorMark(Picture& picture, Point2 page, const SensorMark& mark, double radius);

/// Writes a label about its middle, with a line from its mark if it lies away from it.
void drawMarkLabel(Picture& picture, Point2 mark, Point2 middle, const std::string& text,
                   const TextStyle& style);

/// Returns true if part of a line is inside the box.
bool crosses(const Segment2& line, const Box2& box);

/// Finds positions of signs and labels where they cover little, in page units. Each looks at the
/// shapes near it alone. Greedy: positions depend on the order of calls, never change later, and
/// are no optimum.
class LabelPlacer {
  public:
    LabelPlacer(const Box2& frame, double em);

    /// Adds a mark and its arrow, which labels should not cover.
    void addMark(Point2 page, std::optional<Angle> heading);
    /// Adds a line, such as a wall, which labels cover only where nothing else is free.
    void addLine(const Segment2& page_line);
    /// Finds the position of a sign of this radius: at the point, or the nearest free one around
    /// it.
    Point2 placeSign(Point2 page, double radius);
    /// Finds the middle of a mark's label: beside the mark, preferably behind the heading, or up
    /// to 5 em away if other labels are there. Empty if none is free; in a crowd labels lie beside
    /// their marks only, and cover no mark.
    std::optional<Point2> placeLabel(Point2 page, Angle heading, double width, double size,
                                     bool crowd);
    /// Reserves a box and returns true if it is free. \param over_lines lines do not count
    /// \param own a line added before, which does not count either
    bool take(const Box2& box, bool over_lines = false, std::optional<Segment2> own = {});

  private:
    /// Shapes by the cells of a grid over the frame; cells at its edges reach outwards without end.
    struct Cell {
        std::vector<Box2> marks, labels;
        std::vector<Segment2> lines;
    };
    struct CellRange {
        std::size_t left, right, low, high;  // all included
    };
    [[nodiscard]] CellRange cellsOf(const Box2& box) const;
    void addBox(const Box2& box, std::vector<Box2> Cell::*list);
    /// Computes the cost of a box, or any number from `enough` on if it is as much.
    [[nodiscard]] double costOf(const Box2& box, double enough, bool over_lines = false,
                                std::optional<Segment2> own = {}) const;

    Box2 frame_;
    double em_, side_;
    std::size_t columns_, rows_;
    std::vector<Cell> cells_;
};

/// Style of a plan, and its position on the page.
struct PlanStyle {
    PageView view = {};
    double em = 10;    ///< text size, page units
    Box2 box = {};     ///< the part shown, metres
    double cut = 1.2;  ///< height at which walls are cut: lower ones are seen from above
    /// Below an overlay: draws things in two greys, dark if they are cut, else pale and
    /// translucent; no coverings, no fills of zones.
    bool neutral = false;
};

/// Draws the plan of a scene layer by layer, in this order; an overlay lies between two layers. A
/// new kind of thing requires one function here, for all pictures.
class PlanDrawing {
  public:
    PlanDrawing(Picture& picture, const Scene& scene, const PlanStyle& style);

    /// Draws rooms of an import that were not kept, without text.
    void drawOtherRooms(const FoundRooms& found);
    /// Draws indoor floor with its coverings, and the holes in it that are not rooms.
    void drawFloor();
    void drawZones();
    /// Draws a sector about each sensor that faces sideways, with its bearings but not its range,
    /// which mostly exceeds the plan.
    void drawFieldsOfView();
    /// Draws things in the room, higher ones on top.
    void drawThings();
    void drawWalls();
    void drawOpenings();
    /// Draws things above people's heads, dashed. (A neutral plan draws them with the others.)
    void drawOverhead();
    void drawRobots();
    void drawSensors();
    /// Writes names of zones, of things with enough space, and of all placed records.
    void drawNames();
    /// Writes areas and --inside points of rooms that were not kept, and marks closed gaps.
    void drawOtherRoomsWords(const FoundRooms& found);
    // The map at a height, instead of the layers above: free floor, then solids and sheets.
    void drawFreeFloor(double height);
    void drawObstacles(double height);

  private:
    friend class PlanLayer;
    struct Thing {
        const Element* element;
        std::vector<OverheadPart> parts;
        Box2 box;
        double bottom = 0, top = 0;
        double height = 0;  ///< of its largest part; sorts things
    };
    [[nodiscard]] static std::vector<Thing> thingsOf(const Environment& environment);
    [[nodiscard]] static std::string thingTitle(const Thing& thing);
    [[nodiscard]] bool isOverhead(const Thing& thing) const;
    void drawThing(const Thing& thing);
    void drawNeutralThing(const Thing& thing);
    void drawZoneName(const Element& element, std::size_t index);
    void drawWall(const Element& element);
    void drawOpening(const Element& element, const ElementLines& lines);
    void drawBolt(const Segment2& leaf, double width);
    void drawPlacedNames();

    /// Returns a pen with a width in text sizes.
    [[nodiscard]] Stroke pen(Color color, double width, std::vector<double> dashes = {}) const;
    [[nodiscard]] double metres(double ems) const { return ems * style_.em / style_.view.scale; }

    Picture& picture_;
    const Scene& scene_;
    PlanStyle style_;
    std::vector<Thing> things_;  ///< sorted by height, the lowest first
    double wall_pen_ = 0;        ///< of walls that are lines, in text sizes
};

/// Opens a layer of the plan for its lifetime: in metres, clipped to the plan's box or to these
/// curves.
class PlanLayer {
  public:
    PlanLayer(PlanDrawing& plan, std::string_view name);
    PlanLayer(PlanDrawing& plan, std::string_view name, std::span<const Polygon> clip);
    PlanLayer(const PlanLayer&) = delete;
    PlanLayer& operator=(const PlanLayer&) = delete;
    ~PlanLayer();

  private:
    Picture& picture_;
};

/// Returns the area that a plan shows: the limits with walls' thickness, and bodies near them.
Box2 planBox(const Scene& scene);

/// Returns holes of the indoor region that are not rooms, as curves by the even-odd rule.
std::vector<Polygon> outsideOf(const Regions& indoor);

/// True for walls and `space` records, which do not count as things in a room.
bool isWall(const Element& element);
bool standsAt(double bottom, double top, double height);

}  // namespace ispace
