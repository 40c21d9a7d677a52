// SPDX-License-Identifier: GPL-3.0-or-later
// The openings between storeys, and several storeys as one room.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "building/building_sight.h"
#include "env/body.h"
#include "env/mesh.h"
#include "env/walls.h"
#include "geom/overlay/overlay.h"
#include "record/text.h"
#include "scene/bodies.h"
#include "scene/placement_schemas.h"
#include "trace/ray_world.h"

namespace ispace {

namespace {

double shortestEdge(const Polygon& outline) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < outline.size(); ++i)
        least = std::min(least, distance(outline[i], outline[(i + 1) % outline.size()]));
    return least;
}

Polygon counterClockwise(Polygon outline) {
    if (signedArea(outline) < 0) std::reverse(outline.begin(), outline.end());
    return outline;
}

/// Returns the area less the openings.
std::vector<Region> cutOut(const std::vector<Curve>& area, const std::vector<Polygon>& openings) {
    std::vector<Layer> layers = {{.curves = area, .counts = false, .marks = 1}};
    for (const Polygon& opening : openings) layers.push_back({.curves = {curveOf(opening)}});
    return Overlay(layers).regions(
        [](const LayerLabel& label) { return label.marks == 1 && label.count == 0; });
}

/// Returns a triangle of a millimetre in a convex corner of the outline.
Polygon cornerOf(const Polygon& outline) {
    constexpr double kEdge = 1e-3;
    const auto lowest = static_cast<std::size_t>(std::min_element(outline.begin(), outline.end(),
                                                                  [](Point2 a, Point2 b) {
                                                                      return std::pair(a.y, a.x) <
                                                                             std::pair(b.y, b.x);
                                                                  }) -
                                                 outline.begin());
    const Point2 corner = outline[lowest];
    const auto toward = [&](Point2 next) {
        const Vec2 way = next - corner;
        return corner + std::min(kEdge, length(way) / 2) / length(way) * way;
    };
    const std::size_t count = outline.size();
    return counterClockwise({corner, toward(outline[(lowest + 1) % count]),
                             toward(outline[(lowest + count - 1) % count])});
}

/// Takes the openings out of the floor: faces of their own, without a point known to be inside. An
/// environment has a floor: of one that is all open a corner remains.
void openFloor(const Environment& room, const std::vector<Polygon>& openings,
               std::vector<Record>& records) {
    constexpr std::uint64_t kIndoor = 1, kKept = 2;
    std::vector<Layer> layers = {
        {.curves = curvesWithArcs(room.indoor()), .counts = false, .marks = kIndoor}};
    for (const Polygon& opening : openings) layers.push_back({.curves = {curveOf(opening)}});
    const auto is_floor = [](const LayerLabel& label) {
        return label.marks == (kIndoor | kKept) || (label.marks == kIndoor && label.count == 0);
    };
    const auto is_open = [](const LayerLabel& label) {
        return label.marks == kIndoor && label.count > 0;
    };
    std::optional<Overlay> overlay(std::in_place, layers);
    std::vector<Region> floor = overlay->regions(is_floor);
    if (floor.empty()) {
        const std::vector<Region> open = overlay->regions(is_open);
        if (open.empty()) return;
        layers.push_back(
            {.curves = {curveOf(cornerOf(open.front().outline))}, .counts = false, .marks = kKept});
        floor = overlay.emplace(layers).regions(is_floor);
    }
    std::erase_if(records, [](const Record& record) { return record.keyword() == "inside"; });
    for (const Region& part : floor) {
        const Point2 place = interiorPoint(part);
        Record inside(*sceneSchemas().find("inside"));
        inside.set("at", Tuple{place.x, place.y});
        records.push_back(std::move(inside));
    }
    constexpr double kFlat = 1e-6;  // a rim that is hardly a body
    for (const Region& part : overlay->regions(is_open)) {
        if (shortestEdge(part.outline) < 2 * kFlat) continue;  // no ray passes it
        TupleList path;
        for (const Point2 corner : part.outline) path.push_back({corner.x, corner.y});
        Record rim(*sceneSchemas().find("fence"));
        rim.set("path", path);
        rim.set("closed", true);
        rim.set("height", kFlat);
        records.push_back(std::move(rim));
    }
}

/// Collects triangles in the frame of a room.
class Triangles {
  public:
    void add(Point3 a, Point3 b, Point3 c) {
        const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
        for (const Point3 p : {a, b, c})
            mesh_.vertices.push_back(
                {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
        mesh_.triangles.push_back({first, first + 1, first + 2});
    }
    void addLevel(const std::vector<Region>& regions, double z) {
        for (const Region& region : regions) {
            const Triangulation parts = triangulate(region);
            const auto at = [&](std::uint32_t i) {
                return Point3{parts.vertices[i].x, parts.vertices[i].y, z};
            };
            for (const auto& [a, b, c] : parts.triangles) add(at(a), at(b), at(c));
        }
    }
    void addSheet(const Segment2& line, double bottom, double top) {
        addQuad(line, bottom, line, top);
    }
    /// Adds a plane strip between two parallel edges, each at a height.
    void addQuad(const Segment2& low, double bottom, const Segment2& high, double top) {
        const Point3 a{low.a.x, low.a.y, bottom}, b{low.b.x, low.b.y, bottom};
        const Point3 c{high.b.x, high.b.y, top}, d{high.a.x, high.a.y, top};
        add(a, b, c);
        add(a, c, d);
    }
    /// Adds the steps of straight stairs, as a plane. \param frame of the triangles
    void addSteps(const FloorOpening& stairs, const Storey& frame, double bottom, double top) {
        if (stairs.flight.size() != 2) return;
        const auto edge = [&](const Segment2& step) {
            return Segment2{inStorey(frame, step.a), inStorey(frame, step.b)};
        };
        addQuad(edge(stairs.flight[0]), bottom, edge(stairs.flight[1]), top);
    }
    [[nodiscard]] bool empty() const { return mesh_.triangles.empty(); }
    TriangleMesh take() {
        const auto* const bytes = reinterpret_cast<const char*>(mesh_.vertices.data());
        mesh_.digest = sha256({bytes, mesh_.vertices.size() * sizeof(mesh_.vertices[0])});
        return std::move(mesh_);
    }

  private:
    TriangleMesh mesh_;
};

/// Returns the record of a mesh that stops light.
Record meshRecord(Triangles& triangles) {
    Record mesh(*sceneSchemas().find("mesh"));
    mesh.set("file", std::string("storeys"));
    mesh.set("up", std::string("z"));
    mesh.setMesh(std::make_shared<const TriangleMesh>(triangles.take()));
    return mesh;
}

/// Returns the bounds of the wall lines of each storey, in the building.
std::vector<Box2> boxesOf(const BuildingScene& building) {
    std::vector<Box2> boxes(building.scenes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Box2& own = building.scenes[i]->environment.limits();
        for (const Point2 corner :
             {own.low, own.high, Point2{own.low.x, own.high.y}, Point2{own.high.x, own.low.y}})
            boxes[i].add(building.document.storeys[i].building_from_storey * corner);
    }
    return boxes;
}

/// True if storeys lie above each other, by bounds that have area in common.
bool areStacked(const Box2& a, const Box2& b) {
    const Box2 both = common(a, b);
    return !both.empty() && both.low.x < both.high.x && both.low.y < both.high.y;
}

/// Returns the height of the underside of a storey's floor: the top of the storeys below it. A
/// floor above no storey has no thickness.
double undersideOf(const BuildingScene& building, const std::vector<Box2>& boxes,
                   std::size_t storey) {
    const std::vector<Storey>& storeys = building.document.storeys;
    const double floor = storeys[storey].floor;
    std::optional<double> top;
    for (std::size_t i = 0; i < storeys.size(); ++i)
        if (storeys[i].floor < floor && areStacked(boxes[i], boxes[storey]))
            top = std::max(top.value_or(storeys[i].floor), storeys[i].floor + building.height(i));
    return std::min(floor, top.value_or(floor));
}

/// Returns the height of the lowest underside above a storey; empty under the roof.
std::optional<double> slabAbove(const BuildingScene& building, const std::vector<Box2>& boxes,
                                std::size_t storey) {
    const std::vector<Storey>& storeys = building.document.storeys;
    std::optional<double> lowest;
    for (std::size_t i = 0; i < storeys.size(); ++i) {
        if (storeys[i].floor <= storeys[storey].floor || !areStacked(boxes[i], boxes[storey]))
            continue;
        const double underside = undersideOf(building, boxes, i);
        lowest = std::min(lowest.value_or(underside), underside);
    }
    return lowest;
}

/// Builds what stands above and below a storey: other storeys, and its own floor and ceiling with
/// their openings.
class Surroundings {
  public:
    /// \param storeys a single one has its openings to others, too
    /// \param own the storey in whose frame the room is
    Surroundings(const BuildingScene& building, std::span<const FloorOpening> openings,
                 std::span<const std::size_t> storeys, std::size_t own, bool with_movers)
        : building_(building),
          all_(openings),
          storeys_(storeys),
          own_(own),
          with_movers_(with_movers),
          base_(building.document.storeys[own]) {
        for (const FloorOpening& opening : openings)
            if (storeys.size() == 1 ? isHere(opening.below) || isHere(opening.above)
                                    : isHere(opening.below) && isHere(opening.above))
                openings_.push_back(&opening);
    }

    /// \param with_slabs adds the undersides of the floors above, and closes the gaps between
    /// these and the walls
    Environment room(bool with_slabs) {
        const Scene& base = *building_.scenes[own_];
        std::vector<Record> records = base.records;
        std::vector<std::string> ids = base.ids;
        if (const auto above = outlinesIn(own_, false); !above.empty())
            for (Record& record : records) {
                if (record.keyword() != "ispace" || !record.flag("ceiling")) continue;
                for (const Plate& plate : bodyOf(record).plates) addCeiling(plate, own_, above);
                record.set("ceiling", false);
            }
        if (const auto below = outlinesIn(own_, true); !below.empty()) {
            openFloor(base.environment, below, records);
            ids = assignIds(records);
        }
        for (const std::size_t storey : storeys_)
            if (storey != own_) addStorey(storey);
        addSides();
        if (with_slabs) addSlabs();
        // Steps hide what lies beyond them, wherever they lead.
        for (const FloorOpening& opening : all_)
            if (isHere(opening.below))
                triangles_.addSteps(opening, base_, floorOf(opening.below), floorOf(opening.above));
        if (!triangles_.empty()) {
            records.push_back(meshRecord(triangles_));
            ids.emplace_back("storeys");
        }
        return Environment(records, ids, base.environment);
    }

  private:
    [[nodiscard]] bool isHere(std::size_t storey) const {
        return std::find(storeys_.begin(), storeys_.end(), storey) != storeys_.end();
    }
    [[nodiscard]] double floorOf(std::size_t storey) const {
        return building_.document.storeys[storey].floor - base_.floor;
    }
    /// Converts a point of a storey to the frame of the lowest one.
    [[nodiscard]] Point2 placeOf(std::size_t storey, Point2 p) const {
        return inStorey(base_, building_.document.storeys[storey].building_from_storey * p);
    }
    [[nodiscard]] Polygon inBase(Polygon outline) const {
        for (Point2& p : outline) p = inStorey(base_, p);
        return outline;
    }
    /// Returns the openings in the floor of a storey, or those above it.
    [[nodiscard]] std::vector<Polygon> outlinesIn(std::size_t storey, bool in_floor) const {
        std::vector<Polygon> outlines;
        for (const FloorOpening* const opening : openings_)
            if ((in_floor ? opening->above : opening->below) == storey)
                outlines.push_back(inBase(opening->outline));
        return outlines;
    }

    void addCeiling(const Plate& plate, std::size_t storey, const std::vector<Polygon>& above) {
        Polygon outline = plate.outline;
        for (Point2& p : outline) p = placeOf(storey, p);
        triangles_.addLevel(cutOut({curveOf(outline)}, above), floorOf(storey) + plate.z);
    }

    void addStorey(std::size_t storey) {
        const Environment& room = building_.scenes[storey]->environment;
        const double floor = floorOf(storey);
        std::vector<Curve> indoor;
        for (Polygon outline : curvesOf(room.indoor())) {
            for (Point2& p : outline) p = placeOf(storey, p);
            indoor.push_back(curveOf(outline));
        }
        triangles_.addLevel(cutOut(indoor, outlinesIn(storey, true)), floor);
        const std::vector<Polygon> above = outlinesIn(storey, false);
        for (const Element& element : room.elements()) {
            Body body = element.body;
            for (const Plate& plate : body.plates)
                if (plate.material == Material::Ceiling) addCeiling(plate, storey, above);
            std::erase_if(body.plates, [](const Plate& plate) {
                return plate.visual_only || plate.material == Material::Ceiling;
            });
            for (const Mesh& mesh : meshesOf(body, Surfaces::Opaque)) addMesh(storey, mesh);
        }
        if (with_movers_) addMovers(storey);
    }

    /// Adds robots and people of a storey, as they stand at the start.
    void addMovers(std::size_t storey) {
        const Scene& scene = *building_.scenes[storey];
        for (const PlacedRecord& placed : scene.placed) {
            const std::string& keyword = scene.records[placed.record].keyword();
            if (keyword != "robot" && keyword != "human") continue;
            const Frame3 frame(placed.pose);
            for (Mesh& mesh : bodyOf(scene, placed)) {
                for (Point3& p : mesh.vertices) p = frame.origin + frame * Vec3{p.x, p.y, p.z};
                addMesh(storey, mesh);
            }
        }
    }

    void addMesh(std::size_t storey, const Mesh& mesh) {
        const double floor = floorOf(storey);
        const auto at = [&](std::uint32_t i) {
            const Point3& p = mesh.vertices[i];
            const Point2 place = placeOf(storey, p.onFloor());
            return Point3{place.x, place.y, floor + p.z};
        };
        for (const auto& [a, b, c] : mesh.triangles) triangles_.add(at(a), at(b), at(c));
    }

    /// Closes the openings at their sides, between a storey and the floor above it. Openings that
    /// overlap have common sides.
    void addSides() {
        std::map<std::pair<std::size_t, std::size_t>, std::vector<Layer>> joints;
        for (const FloorOpening* const opening : openings_)
            joints[{opening->below, opening->above}].push_back(
                {.curves = {curveOf(inBase(opening->outline))}});
        for (const auto& [joint, layers] : joints) {
            const double bottom = floorOf(joint.first) + building_.height(joint.first);
            const double top = floorOf(joint.second);
            if (!(bottom < top)) continue;
            const Overlay overlay(layers);
            for (const Region& region :
                 overlay.regions([](const LayerLabel& label) { return label.count > 0; }))
                region.forEachEdge(
                    [&](const Segment2& side) { triangles_.addSheet(side, bottom, top); });
        }
    }

    /// Returns the indoor region of a storey, without the holes in it, in the frame of the room.
    [[nodiscard]] std::vector<Curve> planOf(std::size_t storey) const {
        std::vector<Curve> plan;
        for (Polygon outline : curvesOf(building_.scenes[storey]->environment.indoor())) {
            for (Point2& p : outline) p = placeOf(storey, p);
            plan.push_back(curveOf(outline));
        }
        return plan;
    }

    /// Adds the undersides of the floors above, less their openings, and continues the outer walls
    /// of storeys up to them. Storeys that the room does not hold hide it as well.
    void addSlabs() {
        const auto boxes = boxesOf(building_);
        const auto is_seen = [&](std::size_t i) {
            return isHere(i) || floorOf(i) <= kSightBetweenStoreys;
        };
        for (std::size_t i = 0; i < building_.scenes.size(); ++i) {
            if (floorOf(i) <= floorOf(storeys_.front()) || !is_seen(i)) continue;
            const double bottom = undersideOf(building_, boxes, i) - base_.floor;
            if (isHere(i) && bottom >= floorOf(i)) continue;  // its floor
            std::vector<Polygon> open;
            for (const FloorOpening& opening : all_)
                if (opening.above == i) open.push_back(inBase(opening.outline));
            triangles_.addLevel(cutOut(planOf(i), open), bottom);
        }
        for (const std::size_t i : storeys_) {
            const double walls = floorOf(i) + building_.scenes[i]->environment.height();
            const auto slab = slabAbove(building_, boxes, i);
            if (!slab || *slab - base_.floor <= walls + kRayEpsilon) continue;
            const Overlay overlay(std::vector<Layer>{{.curves = planOf(i)}});
            for (const Region& region :
                 overlay.regions([](const LayerLabel& label) { return label.count > 0; }))
                region.forEachEdge([&](const Segment2& side) {
                    triangles_.addSheet(side, walls, *slab - base_.floor);
                });
        }
    }

    const BuildingScene& building_;
    std::span<const FloorOpening> all_;
    std::span<const std::size_t> storeys_;
    std::size_t own_;
    bool with_movers_;
    const Storey& base_;
    std::vector<const FloorOpening*> openings_;
    Triangles triangles_;
};

/// What joins a storey to others, in its frame: openings in its floor, and steps that begin on it.
struct StoreyJoints {
    std::vector<Polygon> open;
    Triangles steps;
    std::vector<double> numbers;  ///< equal for equal joints
};

std::vector<StoreyJoints> jointsOf(const BuildingScene& building) {
    std::vector<StoreyJoints> joints(building.scenes.size());
    const std::vector<Storey>& storeys = building.document.storeys;
    const auto add_points = [](const Storey& storey, const Polygon& outline, StoreyJoints& of) {
        for (const Point2 p : outline) {
            const Point2 local = inStorey(storey, p);
            of.numbers.insert(of.numbers.end(), {local.x, local.y});
        }
    };
    for (const FloorOpening& opening : floorOpenings(building)) {
        StoreyJoints& above = joints[opening.above];
        Polygon& outline = above.open.emplace_back(opening.outline);
        for (Point2& p : outline) p = inStorey(storeys[opening.above], p);
        add_points(storeys[opening.above], opening.outline, above);
        above.numbers.push_back(0);  // no rise
        if (opening.flight.size() != 2) continue;
        const Storey& below = storeys[opening.below];
        const double rise = storeys[opening.above].floor - below.floor;
        joints[opening.below].steps.addSteps(opening, below, 0, rise);
        add_points(below, opening.outline, joints[opening.below]);
        joints[opening.below].numbers.push_back(rise);
    }
    return joints;
}

/// Opens the floor and adds the steps. Returns false if there are neither.
bool join(const Environment& room, StoreyJoints& joints, std::vector<Record>& records) {
    if (joints.open.empty() && joints.steps.empty()) return false;
    if (!joints.open.empty()) openFloor(room, joints.open, records);
    if (!joints.steps.empty()) records.push_back(meshRecord(joints.steps));
    return true;
}

}  // namespace

std::vector<std::shared_ptr<const Scene>> scenesOfFloors(const BuildingScene& building) {
    constexpr double kEqualWithin = 1e-9;  // metres
    std::vector<StoreyJoints> joints = jointsOf(building);
    std::map<std::pair<const Scene*, std::vector<std::int64_t>>, std::shared_ptr<const Scene>> made;
    std::vector<std::shared_ptr<const Scene>> scenes = building.scenes;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        std::vector<std::int64_t> numbers;
        for (const double value : joints[i].numbers)
            numbers.push_back(std::llround(value / kEqualWithin));
        auto& known = made[{scenes[i].get(), std::move(numbers)}];
        if (known == nullptr) {
            std::vector<Record> records = scenes[i]->records;
            if (!join(scenes[i]->environment, joints[i], records)) continue;
            Scene scene = *scenes[i];
            scene.environment = Environment(records, assignIds(records), scene.environment);
            known = std::make_shared<const Scene>(std::move(scene));
        }
        scenes[i] = known;
    }
    return scenes;
}

std::shared_ptr<const Scene> openedScene(const BuildingScene& building, std::size_t storey) {
    const auto& scene = building.scenes[storey];
    StoreyJoints joints = std::move(jointsOf(building)[storey]);
    std::vector<Record> records = scene->records;
    if (!join(scene->environment, joints, records)) return scene;
    return std::make_shared<const Scene>(makeScene(std::move(records), *scene, building.devices));
}

Environment joinedRoom(const BuildingScene& building, std::span<const FloorOpening> openings,
                       std::span<const std::size_t> storeys) {
    return Surroundings(building, openings, storeys, storeys.front(), false).room(true);
}

std::optional<Environment> roomWithOpenings(const BuildingScene& building,
                                            std::span<const FloorOpening> openings,
                                            std::size_t storey) {
    const bool is_open =
        std::any_of(openings.begin(), openings.end(), [&](const FloorOpening& opening) {
            return opening.below == storey || opening.above == storey;
        });
    if (!is_open) return std::nullopt;
    return Surroundings(building, openings, {&storey, 1}, storey, false).room(false);
}

std::optional<Environment> roomWithSurroundings(const BuildingScene& building,
                                                std::span<const FloorOpening> openings,
                                                std::size_t storey, bool with_movers) {
    const auto above = storeysAbove(building.scenes.size(), openings);
    const auto floor_of = [&](std::size_t i) { return building.document.storeys[i].floor; };
    std::vector<std::size_t> near;
    std::set<double> up, down;  // heights of floors on the way
    const auto is_near = [&](std::size_t i) {
        return std::fabs(floor_of(i) - floor_of(storey)) <= kSightBetweenStoreys;
    };
    for (std::size_t i = storey + 1; i < building.scenes.size(); ++i)
        if (above[storey][i] && is_near(i)) {
            up.insert(floor_of(i));
            if (up.size() <= kSightThroughFloors) near.push_back(i);
        }
    near.push_back(storey);
    for (std::size_t i = storey; i-- > 0;)
        if (above[i][storey] && is_near(i)) {
            down.insert(floor_of(i));
            if (down.size() <= kSightThroughFloors) near.push_back(i);
        }
    if (near.size() == 1 && !slabAbove(building, boxesOf(building), storey)) return std::nullopt;
    std::sort(near.begin(), near.end());
    return Surroundings(building, openings, near, storey, with_movers).room(true);
}

}  // namespace ispace
