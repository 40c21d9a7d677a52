// SPDX-License-Identifier: GPL-3.0-or-later
// lib/drawing/plan: the plan of a scene, its view from above as shapes of a picture. Uses layout,
// draw, raster.
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
    std::optional<double> slice = {};  ///< only the obstacle map at this height, in metres
    int width = 1200;                  ///< of a PNG, in pixels
    std::string title;                 ///< e.g. base name of ENV; "" for none
    /// Rooms of an import: those not kept are faint, with area and --inside point; gaps that were
    /// closed are marked. Null: none; not used with `slice`.
    const FoundRooms* found = nullptr;
};

/// The scene from above, as a plan: floor, zones, walls (cut as plans are, with their thickness),
/// doors, windows, things in the colours of their materials, sensors with what they face, robots,
/// people, names, a grid of 1 m (coarser where that would be a grey area) and its coordinates, a
/// bar of scale. Walls' lines without thickness are drawn with a pen.
///
/// With `slice` the obstacle map at that height in the same frame: free floor, solids, sheets.
///
/// SVG and PDF: to scale, on paper of A3 or less at the largest usual scale that fits (or smaller
/// scales for plans of a town), in millimetres. SVG has a layer a type, as Inkscape knows them, and
/// every element is a group with its id and a title. Equal scenes give equal bytes. O(n log n).
/// \throws UsageError for a width that cannot be laid out (200 to 12000)
std::string drawPlan(const Scene& scene, const PlanOptions& options);

/// Mark of a sensor: a body by its kind, and an arrow if it faces sideways.
struct SensorMark {
    SensorSign sign = SensorSign::Disc;
    std::optional<Angle> heading = {};  ///< as seen, y up; none: straight up or down
    Color color = palette::kInk;
    bool hollow = false;
};

/// The bearings that a placed sensor shows on a plan.
BearingSpan bearingsOf(const Scene& scene, const PlacedRecord& placed);

/// The horizontal direction of a pose, if it has one.
std::optional<Angle> headingOf(const Pose3& pose);

/// Draws it at a place of the page.
void drawSensorMark(Picture& picture, Point2 page, const SensorMark& mark, double radius);

/// Places signs and labels where they cover little, in page units.
class LabelPlacer {
  public:
    LabelPlacer(const Box2& frame, double em) : frame_(frame), em_(em) {}

    /// A mark and its arrow, which nothing should cover.
    void addMark(Point2 page, std::optional<Angle> heading);
    /// Place for a sign of this radius: its own, or the next one around it that is free.
    Point2 placeSign(Point2 page, double radius);
    /// Middle of the label of a mark, or nothing where it would cover another label, or another
    /// mark in a crowd. Of the places around the mark, those behind the heading come first.
    std::optional<Point2> placeLabel(Point2 page, Angle heading, double width, double size,
                                     bool crowd);
    /// True if nothing else lies in the box, which is then taken.
    bool take(const Box2& box);

  private:
    [[nodiscard]] double costOf(const Box2& box) const;

    Box2 frame_;
    double em_;
    std::vector<Box2> marks_, labels_;
};

/// How a plan is drawn, and where on its page.
struct PlanStyle {
    PageView view = {};
    double em = 10;    ///< size of text, page units
    Box2 box = {};     ///< the part shown, metres
    double cut = 1.2;  ///< walls are cut at this height: lower ones are seen from above
    /// Below an overlay: things in two greys, dark where they stand at the cut, else pale and
    /// translucent; no coverings, no fills of zones.
    bool neutral = false;
};

/// The plan of a scene, drawn layer by layer in this order; an overlay lies between two of them. A
/// new thing to draw is one function here, for all pictures.
class PlanDrawing {
  public:
    PlanDrawing(Picture& picture, const Scene& scene, const PlanStyle& style);

    /// Rooms of an import that are not kept, without their words.
    void drawOtherRooms(const FoundRooms& found);
    /// Indoor floor with its coverings, holes of it that are no room.
    void drawFloor();
    void drawZones();
    /// A sector about each sensor that faces sideways, with its bearings but not its range, which
    /// is mostly longer than the plan.
    void drawFieldsOfView();
    /// Things in the room, higher ones on top.
    void drawThings();
    void drawWalls();
    void drawOpenings();
    /// Things above people's heads, dashed. (A neutral plan shows them among the others.)
    void drawOverhead();
    void drawRobots();
    void drawSensors();
    /// Names of zones, of things with enough space, and of all that is placed.
    void drawNames();
    /// Areas and --inside points of rooms that are not kept, and gaps that were closed.
    void drawOtherRoomsWords(const FoundRooms& found);
    // Instead, the map at a height: free floor, then solids and sheets.
    void drawFreeFloor(double height);
    void drawObstacles(double height);

  private:
    friend class PlanLayer;
    struct Thing {
        const Element* element;
        std::vector<OverheadPart> parts;
        Box2 box;
        double bottom = 0, top = 0;
        double height = 0;  ///< of its largest part, by which things are laid over each other
    };
    [[nodiscard]] static std::vector<Thing> thingsOf(const Environment& environment);
    [[nodiscard]] static std::string thingTitle(const Thing& thing);
    [[nodiscard]] bool isOverhead(const Thing& thing) const;
    void drawThing(const Thing& thing);
    void drawNeutralThing(const Thing& thing);
    void drawZoneName(const Element& element, std::size_t index);
    void drawWall(const Element& element);
    void drawOpening(const Element& element, const ElementLines& lines);
    void drawPlacedNames();

    /// A pen so many sizes of text wide.
    [[nodiscard]] Stroke pen(Color color, double width, std::vector<double> dashes = {}) const;
    [[nodiscard]] double metres(double ems) const { return ems * style_.em / style_.view.scale; }

    Picture& picture_;
    const Scene& scene_;
    PlanStyle style_;
    std::vector<Thing> things_;  ///< the lowest first
    double wall_pen_ = 0;        ///< of walls that are lines, in sizes of text
};

/// A layer of the plan while it lives: in metres, cut at the plan's box or at these curves.
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

/// The area a plan shows: the limits with walls' thickness, and what stands near them.
Box2 planBox(const Scene& scene);

/// Holes of the indoor region that are not rooms, as curves by the even-odd rule.
std::vector<Polygon> outsideOf(const Regions& indoor);

/// A room's own walls count as walls, not as things in it.
bool isWall(const Element& element);
bool standsAt(double bottom, double top, double height);

}  // namespace ispace
