// SPDX-License-Identifier: GPL-3.0-or-later
#include "drawing/plan/plan_json.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "drawing/drawing.h"
#include "drawing/plan/elements.h"
#include "drawing/plan/plan.h"
#include "env/body.h"
#include "env/level.h"
#include "scene/bodies.h"
#include "scene/sensor/sensor.h"

namespace ispace {

namespace {

using Kind = DisplayList::Kind;

/// Size of the picture for which pens are chosen, in pixels.
constexpr double kWidth = 1000, kText = 12;

double toMillimetre(double metres) { return std::round(metres * 1000) / 1000; }
double toHundredth(double pixels) { return std::round(pixels * 100) / 100; }

/// Converts a picture's shapes back to metres.
class ShapeWriter {
  public:
    ShapeWriter(JsonWriter& json, const DisplayList& list, const PageView& view)
        : json_(json), list_(list), view_(view) {}

    void write() {
        json_.beginArray();
        for (const DisplayList::Shape& shape : list_.shapes) add(shape);
        json_.endArray();
    }

  private:
    void add(const DisplayList::Shape& shape) {
        switch (shape.kind) {
            case Kind::Layer:
                json_.beginObject().key("name").value(list_.names[names_++].title);
                json_.key("groups").beginArray();
                break;
            case Kind::Group:
                json_.beginObject().key("id").value(list_.names[names_].id);
                json_.key("title").value(list_.names[names_++].title).key("shapes").beginArray();
                break;
            case Kind::End:
                json_.endArray().endObject();
                break;
            case Kind::Area:
            case Kind::Lines:
                json_.beginObject().key(shape.kind == Kind::Area ? "area" : "lines").beginArray();
                for (std::uint32_t i = shape.first; i < shape.last; ++i) addCurve(i);
                json_.endArray();
                addInks(shape);
                break;
            case Kind::Arc:
                addArc(shape);
                break;
            case Kind::Text:
            case Kind::Image:
                break;  // absent from the plan's fixed part
        }
    }

    void addPoint(Point2 page) {
        json_.value(
            toMillimetre(view_.world_anchor.x + (page.x - view_.page_anchor.x) / view_.scale));
        json_.value(
            toMillimetre(view_.world_anchor.y - (page.y - view_.page_anchor.y) / view_.scale));
    }

    void addCurve(std::uint32_t index) {
        json_.beginArray();
        for (const Point2 p : list_.curve(index)) addPoint(p);
        json_.endArray();
    }

    void addArc(const DisplayList::Shape& shape) {
        const DisplayList::Arc& arc = list_.arcs[shape.first];
        json_.beginObject().key("arc").beginArray();
        addPoint(arc.center);
        json_.value(toMillimetre(arc.radius / view_.scale));
        json_.value(toHundredth(arc.from.degrees())).value(toHundredth(arc.to.degrees()));
        json_.endArray();
        addInks(shape);
    }

    /// Writes the inks, and ends the shape.
    void addInks(const DisplayList::Shape& shape) {
        json_.key("inks").beginArray();
        for (const Ink& ink : list_.inksOf(shape)) {
            if (const auto* fill = std::get_if<Color>(&ink)) {
                json_.beginObject().key("fill").value(cssColor(*fill)).endObject();
            } else if (const auto* stroke = std::get_if<Stroke>(&ink)) {
                json_.beginObject().key("line").value(cssColor(stroke->color));
                json_.key("width").value(toHundredth(stroke->width));
                if (!stroke->dashes.empty()) {
                    json_.key("dash").beginArray();
                    for (const double dash : stroke->dashes) json_.value(toHundredth(dash));
                    json_.endArray();
                }
                json_.endObject();
            }
        }
        json_.endArray().endObject();
    }

    JsonWriter& json_;
    const DisplayList& list_;
    PageView view_;
    std::size_t names_ = 0;
};

}  // namespace

void writePlan(JsonWriter& json, const Scene& scene) {
    const Box2 box = planBox(scene);
    const double scale = kWidth / std::max(box.width(), box.depth());
    PlanStyle style;
    style.view = {scale, {box.low.x, box.high.y}, {}};
    style.em = kText;
    style.box = box;
    Picture picture(kWidth, kWidth);
    PlanDrawing plan(picture, scene, style);
    plan.drawFloor();
    plan.drawZones();
    plan.drawThings();
    plan.drawWalls();
    plan.drawOpenings();
    plan.drawOverhead();
    json.beginObject().key("box").beginArray();
    for (const double side : {box.low.x, box.low.y, box.high.x, box.high.y})
        json.value(toMillimetre(side));
    json.endArray().key("layers");
    ShapeWriter(json, picture.list(), style.view).write();
    json.endObject();
}

namespace {

using namespace palette;

/// Sizes of marks and names, metres.
constexpr double kDxfMark = 0.06, kArrow = 0.3, kDxfText = 0.15;

/// Width of the line of a shut door, metres; an open one is a line of width 0.
constexpr double kLeaf = 0.04;

/// The last point of a closed chain repeats the first.
void addChain(DxfWriter& out, const char* layer, std::vector<Point2> chain, double width,
              DxfExtrusion upright, double depth = 0) {
    const bool closed = chain.size() > 2 && chain.front() == chain.back();
    if (closed) chain.pop_back();
    out.path(layer, chain, closed, width, upright, depth);
}

/// Returns the depth of an opening that states one, else 0.
double depthOf(const Record& opening) {
    const Tuple& size = opening.tuple("size");
    return size.size() > 1 ? size[1] : 0;
}

/// Writes the outline of each prism and mesh, including hidden ones.
void addObject(DxfWriter& out, const Body& body) {
    for (const Prism& prism : body.prisms) {
        const DxfExtrusion upright{prism.bottom, prism.top - prism.bottom};
        const Ellipse* round = prism.curve.get();
        if (round == nullptr)
            out.path("objects", prism.footprint, true, 0, upright);
        else if (round->half_length == round->half_width)
            out.circle("objects", round->center, round->half_length, upright);
        else
            out.path("objects", outlineOf(*round), true, 0, upright);
    }
    Body meshes;
    meshes.meshes = body.meshes;
    for (const OverheadPart& part : partsFromAbove(meshes))
        for (const Polygon& ring : part.curves)
            out.path("objects", ring, true, 0, {part.bottom, part.top - part.bottom});
}

/// Writes a name in the middle of an area.
void addName(DxfWriter& out, const Polygon& outline, const std::string& id) {
    out.text("names", bounds(outline).center(), id, kDxfText);
}

/// Writes a sector about a sensor, or a circle if it sees all around, clamped to the plan's width.
void addView(DxfWriter& out, const Scene& scene, const PlacedRecord& placed) {
    const BearingSpan span = bearingsOf(scene, placed);
    const std::optional<Angle> heading = headingOf(placed.pose);
    const Box2& plan = scene.environment.limits();
    const double radius = std::min(span.range, std::max(plan.width(), plan.depth()));
    const Angle sweep = span.to - span.from;
    if (!heading || radius <= 0 || sweep <= Angle()) return;
    const Point2 center = placed.pose.position.onFloor();
    if (sweep >= Angle::degrees(360)) {
        out.circle("views", center, radius);
        return;
    }
    const auto rim = [&](double share) {
        return center + radius * unitVector(*heading + span.from + share * sweep);
    };
    // An edge of a curve is at most a half turn.
    out.curve("views", {{center, rim(0)},
                        {rim(0), rim(0.5), radius, center},
                        {rim(0.5), rim(1), radius, center},
                        {rim(1), center}});
}

void addRobot(DxfWriter& out, const Pose2& pose, const RobotModel& robot) {
    const Point2 middle = pose * Point2{robot.center, 0};
    if (robot.length > 0)
        out.path("robots", rectangle(middle, robot.length, robot.width, pose.heading), true);
    else
        out.circle("robots", middle, robot.radius);
}

void addPlaced(DxfWriter& out, const Scene& scene, const PlacedRecord& placed) {
    const Record& record = scene.records[placed.record];
    const std::string& id = scene.ids[placed.record];
    const Pose2 pose{placed.pose.position.onFloor(), placed.pose.heading};
    if (sensorKind(record.keyword()) != nullptr) {
        addView(out, scene, placed);
        addSensorToDxf(out, id, placed.pose);
        return;
    }
    const bool moves = record.keyword() == "robot" || record.keyword() == "human";
    const char* layer = moves ? "robots" : "sensors";
    if (record.keyword() == "robot")
        addRobot(out, pose, scene.robots[placed.index].model);
    else if (record.keyword() == "human")
        out.circle(layer, pose.position, humanRadius(scene.people[placed.index].height));
    else if (record.keyword() == "gate")
        out.line(layer, {pose * Point2{0, record.number("width") / 2},
                         pose * Point2{0, -record.number("width") / 2}});
    else if (record.keyword() == "mat")
        out.path(layer,
                 rectangle(pose.position, record.tuple("size")[0], record.tuple("size")[1],
                           pose.heading),
                 true);
    if (moves) out.line(layer, {pose.position, pose * Point2{kArrow, 0}});
    out.text(layer, pose.position + Vec2{kDxfMark, kDxfMark}, id, kDxfText);
}

void addAreas(DxfWriter& out, const Environment& environment) {
    for (const Element& element : environment.elements()) {
        const std::string& keyword = element.record.keyword();
        if (keyword == "zone") {
            const Polygon outline = zoneOutline(element.record);
            out.path("zones", outline, true);
            addName(out, outline, element.id);
        } else if (keyword == "floor") {
            out.path("floors", floorOutline(element.record), true);
        }
    }
}

std::string writeSlice(const Environment& environment, double height) {
    DxfWriter out({{"free", kGrid}, {"obstacles", kInk}});
    const auto level = environment.level(height);
    for (const Region& piece : level->freeFloor()) out.area("free", piece);
    const Slice& slice = level->slice();
    for (const Segment2& sheet : slice.sheets) out.line("obstacles", sheet);
    for (const Polygon& solid : inscribedSolids(slice)) out.path("obstacles", solid, true);
    return out.finish();
}

}  // namespace

std::vector<DxfLayer> dxfRoomLayers() {
    return {{"walls", kInk},
            {"doors", kDoor},
            {"windows", kGlass},
            {"objects", displayColor(Material::WoodDark)},
            {"inside", kFaintInk}};
}

std::vector<DxfLayer> dxfPlacedLayers() { return {{"sensors", kSensor}, {"robots", kRobot}}; }

void addRoomToDxf(DxfWriter& out, const Environment& environment) {
    const std::vector<Element>& elements = environment.elements();
    const std::vector<ElementLines> lines = elementLinesOf(environment);
    for (std::size_t i = 0; i < elements.size(); ++i) {
        const std::string& keyword = elements[i].record.keyword();
        const bool is_door = keyword == "door", is_window = keyword == "window";
        const bool is_shut = is_door && !elements[i].record.flag("open");
        for (const std::vector<Point2>& chain : lines[i].chains) {
            if (is_door || is_window)
                addChain(out, is_door ? "doors" : "windows", chain, is_shut ? kLeaf : 0,
                         {lines[i].bottom, lines[i].top - lines[i].bottom},
                         depthOf(elements[i].record));
            else
                addChain(out, "walls", chain, lines[i].thickness, {0, topOf(elements[i].body)});
        }
        if (keyword == "inside") {
            const Tuple& at = elements[i].record.tuple("at");
            out.circle("inside", {at[0], at[1]}, kDxfMark);
        }
        if (lines[i].chains.empty() && keyword != "floor") addObject(out, elements[i].body);
    }
}

void addSensorToDxf(DxfWriter& out, const std::string& id, const Pose3& pose) {
    const Point2 place = pose.position.onFloor();
    out.circle("sensors", place, kDxfMark);
    if (const auto heading = headingOf(pose))
        out.line("sensors", {place, place + kArrow * unitVector(*heading)});
    out.text("sensors", place + Vec2{kDxfMark, kDxfMark}, id, kDxfText);
}

std::string writeDxf(const Scene& scene, std::optional<double> slice_height) {
    if (slice_height) return writeSlice(scene.environment, *slice_height);
    std::vector<DxfLayer> layers = dxfRoomLayers();
    for (DxfLayer& layer : dxfPlacedLayers()) layers.push_back(std::move(layer));
    layers.insert(layers.end(),
                  {{"views", kMat}, {"zones", kZone}, {"floors", kGrid}, {"names", kFaintInk}});
    DxfWriter out(layers);
    addAreas(out, scene.environment);
    addRoomToDxf(out, scene.environment);
    for (const PlacedRecord& placed : scene.placed) addPlaced(out, scene, placed);
    return out.finish();
}

}  // namespace ispace
