// SPDX-License-Identifier: GPL-3.0-or-later
// Draws rooms and coverage as DXF, layer by layer: readers draw in the order of the file, so
// fillings come first. Arcs are bulges of polylines, exact up to rounding; fillings (SOLID) have
// chords with the area of their arcs.
#include "extensions/cad/dxf_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "drawing/color.h"
#include "drawing/drawing.h"
#include "drawing/plan/elements.h"
#include "drawing/plan/plan.h"
#include "env/body.h"
#include "env/level.h"
#include "report/map/map_parts.h"
#include "scene/bodies.h"
#include "scene/sensor/sensor.h"

namespace ispace::cad {

namespace {

using namespace palette;

/// Sizes of marks and names, metres.
constexpr double kDxfMark = 0.06, kArrow = 0.3, kDxfText = 0.15;

/// Width of the line of a shut door, metres; an open one is a line of width 0.
constexpr double kLeaf = 0.04;

/// The last point of a closed chain repeats the first.
void addChain(DxfWriter& out, const char* layer, std::vector<Point2> chain, double width,
              DxfExtrusion upright, const DxfOpening& opening = {}) {
    const bool closed = chain.size() > 2 && chain.front() == chain.back();
    if (closed) chain.pop_back();
    out.path(layer, chain, closed, width, upright, opening);
}

/// Returns the depth of an opening that states one, and what differs from clear glass.
DxfOpening openingOf(const Record& record) {
    DxfOpening opening;
    const Tuple& size = record.tuple("size");
    if (size.size() > 1) opening.depth = size[1];
    if (record.keyword() != "window") return opening;
    if (const std::string& glass = record.text("glass"); glass != "clear")
        opening.pane.push_back(kDxfGlass + glass);
    if (record.flag("open")) opening.pane.emplace_back(kDxfOpen);
    if (record.flag("blind")) opening.pane.emplace_back(kDxfBlind);
    return opening;
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
            const DxfExtrusion upright{lines[i].bottom, lines[i].top - lines[i].bottom};
            if (is_door || is_window)
                addChain(out, is_door ? "doors" : "windows", chain, is_shut ? kLeaf : 0, upright,
                         openingOf(elements[i].record));
            else
                addChain(out, "walls", chain, lines[i].thickness, upright);
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

namespace {

std::string seenLayer(std::uint32_t times) { return "seen-" + std::to_string(times); }

}  // namespace

std::string coverageDxf(const Scene& scene, const Coverage& coverage) {
    const std::vector<std::uint32_t> times = timesSeen(coverage);
    const std::uint32_t most = maxMultiplicity(coverage, times);
    std::vector<DxfLayer> layers = {{"unseen", palette::kLost}};
    for (std::uint32_t k = 1; k <= most; ++k)
        layers.push_back(
            {seenLayer(k), sequentialColor(static_cast<int>(k), static_cast<int>(most))});
    for (DxfLayer& layer : dxfRoomLayers()) layers.push_back(std::move(layer));
    layers.insert(layers.end(), {{"views", palette::kGlass}, {"sensors", palette::kSensor}});
    DxfWriter out(layers);
    // Fillings first: readers draw in the order of the file.
    for (const Region& piece : seenBy(coverage, 0, times)) out.area("unseen", piece);
    for (std::uint32_t k = 1; k <= most; ++k)
        for (const Region& piece : seenBy(coverage, k, times)) out.area(seenLayer(k), piece);
    addRoomToDxf(out, scene.environment);
    for (const SensorView& view : coverage.sensors) {
        if (view.region)
            for (const auto* curves : {&*view.region, &view.beyond})
                for (const Curve& curve : *curves) out.curve("views", curve);
        else
            for (const Region& piece : viewRegions(view, coverage.target.grid))
                for (const Polygon& ring : curvesOf(piece)) out.path("views", ring, true);
        addSensorToDxf(out, view.id, view.pose);
    }
    return out.finish();
}

void addDxfFormats() {
    static constexpr ExportFormat kExporters[] = {
        {.name = "dxf",
         .suffix = "dxf",
         .help =
             "The plan in metres as ASCII DXF (AutoCAD 2000), on the layers walls, doors, windows, "
             "objects, sensors, views, robots, zones, floors and names. Walls are the mid-lines "
             "that enclose the room, drawn as wide as they are thick, shut doors 4 cm wide, open "
             "ones as lines; objects are the outlines of their solid parts, whose elevation and "
             "thickness hold base and height. envc reads the same room back from these layers: "
             "walls, openings, and the parts of objects as cubes and cylinders.",
         .takes_slice = true,
         .write = [](const Scene& scene, const Document& /*document*/,
                     const ExportOptions& options) -> ExportedFiles {
             return {writeDxf(scene, options.slice), ""};
         }},
    };
    static constexpr CoverageFormat kCoverageFormats[] = {
        {.name = "dxf",
         .write = [](const CoverageProduct& product) -> CoverageFiles {
             return {coverageDxf(product.scene, product.coverage), ""};
         }},
    };
    addExporters(kExporters);
    addCoverageFormats(kCoverageFormats);
}

}  // namespace ispace::cad
