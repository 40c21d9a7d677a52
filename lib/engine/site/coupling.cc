// SPDX-License-Identifier: GPL-3.0-or-later
// Builds the surroundings of storeys: records of the own room, and one mesh of all that is around
// it.
//
// RoomBuilder collects the openings, slabs and neighbours that the extent of a room asks for, and
// writes them in the frame of the own storey: openings become faces without floor, other rooms
// become triangles, slabs become closed bodies that end a millimetre (kSkin) within their faces, so
// that a sensor at a ceiling is not in it. Storeys of one scene with equal key() share a floor.
//
// Sheets of a mesh are a few float steps longer than their lines: vertices at one point would be
// welded, and sheets around an area would count as a solid.
#include "site/coupling.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "base/message.h"
#include "base/number.h"
#include "env/body.h"
#include "env/level.h"
#include "env/mesh.h"
#include "env/point_location.h"
#include "env/walls.h"
#include "geom/overlay/overlay.h"
#include "record/text.h"
#include "scene/bodies.h"
#include "scene/element_device.h"
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
    /// Adds a closed body with these outlines between two heights: what lies in it is inside a
    /// solid.
    void addSolid(const std::vector<Region>& regions, double bottom, double top) {
        for (const Region& region : regions) {
            const Triangulation parts = triangulate(region);
            const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
            const auto count = static_cast<std::uint32_t>(parts.vertices.size());
            for (const double z : {bottom, top})
                for (const Point2 p : parts.vertices)
                    mesh_.vertices.push_back(
                        {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(z)});
            std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
            for (const auto& [a, b, c] : parts.triangles) {
                mesh_.triangles.push_back({first + a, first + c, first + b});
                mesh_.triangles.push_back(
                    {first + count + a, first + count + b, first + count + c});
                edges.insert({{a, b}, {b, c}, {c, a}});
            }
            for (const auto& [a, b] : edges) {
                if (edges.contains({b, a})) continue;  // within the region
                mesh_.triangles.push_back({first + a, first + b, first + count + b});
                mesh_.triangles.push_back({first + a, first + count + b, first + count + a});
            }
        }
    }
    /// Adds an upright sheet, a little longer than its line: vertices at one point are welded, and
    /// sheets around an area would count as the sides of a solid.
    void addSheet(const Segment2& line, double bottom, double top) {
        constexpr double kFloatSteps = 4 * 1.2e-7, kLeast = 1e-6;  // of coordinates; metres
        const Vec2 way = line.b - line.a;
        if (!(length(way) > 0)) return;
        const double size = std::max(
            {std::fabs(line.a.x), std::fabs(line.a.y), std::fabs(line.b.x), std::fabs(line.b.y)});
        const Vec2 more = (kFloatSteps * size + kLeast) / length(way) * way;
        const Segment2 longer{line.a - more, line.b + more};
        addQuad(longer, bottom, longer, top);
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

/// A slab is solid this far within its faces, metres: sensors at a ceiling are not in it.
constexpr double kSkin = 1e-3;
/// Bodies that overlap in height by less do not, metres.
constexpr double kTouching = 1e-6;
/// Steps are this deep, downwards from their plane: about a rise, metres.
constexpr double kStepDepth = 0.17;

/// Returns the outlines of a storey's indoor region, holes included, in the building.
std::vector<Polygon> outlinesOf(const SiteScene& building, std::size_t storey) {
    std::vector<Polygon> outlines = curvesOf(building.scenes[storey]->environment.indoor());
    for (Polygon& outline : outlines)
        for (Point2& p : outline) p = building.document.storeys[storey].building_from_storey * p;
    return outlines;
}

std::vector<Curve> asCurves(const std::vector<Polygon>& outlines) {
    std::vector<Curve> curves;
    curves.reserve(outlines.size());
    for (const Polygon& outline : outlines) curves.push_back(curveOf(outline));
    return curves;
}

/// Returns the common part of two plans.
std::vector<Region> commonPart(const std::vector<Polygon>& a, const std::vector<Polygon>& b) {
    constexpr std::uint64_t kBoth = 3;
    return Overlay(std::vector<Layer>{{.curves = asCurves(a), .counts = false, .marks = 1},
                                      {.curves = asCurves(b), .counts = false, .marks = 2}})
        .regions([](const LayerLabel& label) { return label.marks == kBoth; });
}

/// Returns the number of a scene in a building: that of the first storey that has it.
std::size_t sceneNumber(const SiteScene& building, std::size_t storey) {
    const auto& scenes = building.scenes;
    return static_cast<std::size_t>(std::find(scenes.begin(), scenes.end(), scenes[storey]) -
                                    scenes.begin());
}

/// Returns the highest sensor of a scene, at least 0, or the lowest one, at most 0.
std::pair<double, double> heightsOfSensors(const Scene& scene) {
    double low = 0, high = 0;
    for (const Sensor& sensor : scene.sensors) {
        low = std::min(low, sensor.pose.position.z);
        high = std::max(high, sensor.pose.position.z);
    }
    return {low, high};
}

}  // namespace

/// Builds the room of a storey with all that stands around it.
class RoomBuilder {
  public:
    struct Extent {
        /// Bodies wholly below or above these heights over the floor are left out, metres.
        double low = -std::numeric_limits<double>::infinity();
        double high = std::numeric_limits<double>::infinity();
        bool with_own_slab = false;  ///< even if the room holds no storey below
        bool with_slabs = true;
        bool with_movers = false;
        /// The openings to storeys that the room does not hold are open, too.
        bool with_all_openings = true;
    };

    /// \param storeys ascending, with `own`, in whose frame the room is
    RoomBuilder(const Coupling& coupling, std::vector<std::size_t> storeys, std::size_t own,
                const Extent& extent)
        : coupling_(coupling),
          building_(coupling.building()),
          storeys_(std::move(storeys)),
          own_(own),
          extent_(extent),
          base_(building_.document.storeys[own]) {
        findOpenings();
        if (extent.with_slabs) findSlabs();
    }

    /// Returns true if the room of the storey is the same alone.
    [[nodiscard]] bool isAlone() const {
        return storeys_.size() == 1 && floor_.empty() && ceiling_.empty() && steps_.empty() &&
               sides_.empty() && slabs_.empty() && raised_.empty();
    }

    /// Returns numbers that are equal for storeys of one scene with equal things around them.
    [[nodiscard]] std::vector<std::int64_t> key() const {
        constexpr double kEqualWithin = 1e-9;  // metres
        std::vector<std::int64_t> numbers;
        const auto add = [&](double value) {
            numbers.push_back(std::llround(value / kEqualWithin));
        };
        const auto add_outline = [&](const Polygon& outline) {
            add(static_cast<double>(outline.size()));
            for (const Point2 p : inBase(outline)) {
                add(p.x);
                add(p.y);
            }
        };
        const auto add_storey = [&](std::size_t storey) {
            numbers.push_back(static_cast<std::int64_t>(sceneNumber(building_, storey)));
            add(floorOf(storey));
            const Point2 origin = placeOf(storey, {0, 0}), ahead = placeOf(storey, {1, 0});
            for (const double value : {origin.x, origin.y, ahead.x, ahead.y}) add(value);
        };
        std::vector<const FloorOpening*> beside;  // that cut the other storeys of the room
        for (const FloorOpening* const opening : open_)
            if ((opening->above != own_ && isHere(opening->above)) ||
                (opening->below != own_ && isHere(opening->below)))
                beside.push_back(opening);
        for (const auto* openings :
             {&floor_, &ceiling_, &sides_, &steps_, &std::as_const(beside)}) {
            add(static_cast<double>(openings->size()));
            for (const FloorOpening* const opening : *openings) {
                add_outline(opening->outline);
                add(floorOf(opening->below));
                add(building_.height(opening->below));
                add(floorOf(opening->above));
            }
        }
        add(static_cast<double>(slabs_.size()));
        for (const std::size_t i : slabs_) {
            add_storey(i);
            add(bottomOf(i));
            for (const std::size_t at : coupling_.openings_at_[i])
                if (const FloorOpening& opening = coupling_.openings_[at]; opening.above == i)
                    add_outline(opening.outline);
        }
        add(static_cast<double>(raised_.size()));
        for (const auto& [storey, above] : raised_) {
            add_storey(storey);
            add_storey(above);
            add(bottomOf(above));
        }
        for (const std::size_t i : storeys_) add_storey(i);
        return numbers;
    }

    struct Records {
        std::vector<Record> records;
        std::vector<std::string> ids;
    };

    /// Records of the storey come first, but a floor with openings is replaced, and automatic
    /// ids are made anew. What other storeys add comes last, as meshes of triangles.
    Records build() {
        const Scene& base = *building_.scenes[own_];
        Records room{base.records, base.ids};
        if (!ceiling_.empty()) {
            const std::vector<Polygon> above = outlines(ceiling_);
            for (Record& record : room.records) {
                if (record.keyword() != "ispace" || !record.flag("ceiling")) continue;
                for (const Plate& plate : bodyOf(record).plates) addCeiling(plate, own_, above);
                record.set("ceiling", false);
            }
        }
        if (!floor_.empty()) {
            openFloor(base.environment, outlines(floor_), room.records);
            room.ids = assignIds(room.records);
        }
        for (const std::size_t storey : storeys_)
            if (storey != own_) addStorey(storey);
        addSides();
        addSlabs();
        for (const FloorOpening* const opening : steps_)
            triangles_.addSteps(*opening, base_, floorOf(opening->below), floorOf(opening->above));
        if (!triangles_.empty()) {
            room.records.push_back(meshRecord(triangles_));
            room.ids.emplace_back("storeys");
        }
        for (Triangles& solid : solids_) {  // apart: their faces may touch
            if (solid.empty()) continue;
            room.records.push_back(meshRecord(solid));
            room.ids.push_back("storeys" + std::to_string(room.records.size()));
        }
        return room;
    }

    Environment environment() {
        const Records room = build();
        const auto filled = withDevices(room.records, building_.devices);
        return Environment(filled ? *filled : room.records, room.ids,
                           building_.scenes[own_]->environment);
    }

  private:
    [[nodiscard]] bool isHere(std::size_t storey) const {
        return std::find(storeys_.begin(), storeys_.end(), storey) != storeys_.end();
    }
    [[nodiscard]] double floorOf(std::size_t storey) const {
        return building_.document.storeys[storey].floor - base_.floor;
    }
    /// Returns the underside of a storey's slab.
    [[nodiscard]] double bottomOf(std::size_t storey) const {
        return coupling_.slab(storey).bottom - base_.floor;
    }
    /// True if bodies between two heights may stand in the way.
    [[nodiscard]] bool counts(double bottom, double top) const {
        return bottom < extent_.high && top > extent_.low + kTouching;
    }
    /// Converts a point of a storey to the frame of the room.
    [[nodiscard]] Point2 placeOf(std::size_t storey, Point2 p) const {
        return inStorey(base_, building_.document.storeys[storey].building_from_storey * p);
    }
    [[nodiscard]] Polygon inBase(Polygon outline) const {
        for (Point2& p : outline) p = inStorey(base_, p);
        return outline;
    }
    [[nodiscard]] std::vector<Region> inBase(std::vector<Region> regions) const {
        for (Region& region : regions) {
            region.outline = inBase(std::move(region.outline));
            for (Polygon& hole : region.holes) hole = inBase(std::move(hole));
        }
        return regions;
    }
    [[nodiscard]] std::vector<Polygon> outlines(
        const std::vector<const FloorOpening*>& openings) const {
        std::vector<Polygon> found;
        found.reserve(openings.size());
        for (const FloorOpening* const opening : openings)
            found.push_back(inBase(opening->outline));
        return found;
    }
    /// Returns the outlines of the openings in the floor of a storey, or of those above it.
    [[nodiscard]] std::vector<Polygon> outlinesIn(std::size_t storey, bool in_floor) const {
        std::vector<const FloorOpening*> found;
        for (const FloorOpening* const opening : open_)
            if ((in_floor ? opening->above : opening->below) == storey) found.push_back(opening);
        return outlines(found);
    }
    /// Returns the height of the lowest ceiling of the storey's own room.
    [[nodiscard]] double lowestCeiling() const {
        double lowest = std::numeric_limits<double>::infinity();
        for (const Element& element : building_.scenes[own_]->environment.elements())
            for (const Plate& plate : element.body.plates)
                if (plate.material == Material::Ceiling) lowest = std::min(lowest, plate.z);
        return lowest;
    }

    /// Openings between storeys of the room are open; others of the storey only
    /// with_all_openings. Steps stand on each storey of the room from which a flight leads up.
    void findOpenings() {
        std::vector<std::size_t> found;
        for (const std::size_t storey : storeys_) {
            const std::vector<std::size_t>& at = coupling_.openings_at_[storey];
            found.insert(found.end(), at.begin(), at.end());
        }
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        for (const std::size_t i : found) {
            const FloorOpening& opening = coupling_.openings_[i];
            const bool is_own = opening.below == own_ || opening.above == own_;
            const bool is_within = isHere(opening.below) && isHere(opening.above);
            if (isHere(opening.below) && opening.flight.size() == 2) steps_.push_back(&opening);
            if (!is_within && !(is_own && extent_.with_all_openings)) continue;
            open_.push_back(&opening);
            if (opening.above == own_) floor_.push_back(&opening);
            const double bottom = floorOf(opening.below) + building_.height(opening.below);
            if (bottom < floorOf(opening.above) && counts(bottom, floorOf(opening.above)))
                sides_.push_back(&opening);
            if (opening.below == own_) ceiling_.push_back(&opening);
        }
        if (!ceiling_.empty() && !(lowestCeiling() < extent_.high)) ceiling_.clear();
    }

    /// Finds the slabs over the floor of the lowest storey, and the outer walls that reach up to
    /// them. Storeys that the room does not hold hide it as well.
    void findSlabs() {
        for (std::size_t i = 0; i < building_.scenes.size(); ++i) {
            const bool is_over = floorOf(i) > floorOf(storeys_.front());
            const bool is_wanted = i == own_
                                       ? is_over || extent_.with_own_slab
                                       : is_over && counts(bottomOf(i), floorOf(i)) &&
                                             (isHere(i) || floorOf(i) <= kSightBetweenStoreys);
            if (!is_wanted) continue;
            if (isHere(i) && !(bottomOf(i) < floorOf(i))) continue;  // its floor
            slabs_.push_back(i);
        }
        for (const std::size_t i : storeys_) {
            const double walls = wallsOf(i);
            if (!(walls < extent_.high)) continue;
            for (const std::size_t above : coupling_.slabsAbove(i))
                if (bottomOf(above) > walls + kRayEpsilon) raised_.emplace_back(i, above);
        }
    }
    [[nodiscard]] double wallsOf(std::size_t storey) const {
        return floorOf(storey) + building_.scenes[storey]->environment.height();
    }

    void addCeiling(const Plate& plate, std::size_t storey, const std::vector<Polygon>& above) {
        Polygon outline = plate.outline;
        for (Point2& p : outline) p = placeOf(storey, p);
        triangles_.addLevel(cutOut({curveOf(outline)}, above), floorOf(storey) + plate.z);
    }

    /// Adds what hides: floor, ceilings, opaque surfaces. Glass and what is only drawn is left out.
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
            for (const Sheet& sheet : body.sheets)
                if (!sheet.clear)
                    triangles_.addSheet(
                        {placeOf(storey, sheet.line.a), placeOf(storey, sheet.line.b)},
                        floor + sheet.bottom, floor + sheet.top);
            body.sheets.clear();
            for (const Mesh& mesh : meshesOf(body, Surfaces::Opaque)) addMesh(storey, mesh);
        }
        if (extent_.with_movers) addMovers(storey);
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
        for (const FloorOpening* const opening : sides_)
            joints[{opening->below, opening->above}].push_back(
                {.curves = {curveOf(inBase(opening->outline))}});
        for (const auto& [joint, layers] : joints) {
            const double bottom = floorOf(joint.first) + building_.height(joint.first);
            const double top = floorOf(joint.second);
            const Overlay overlay(layers);
            for (const Region& region :
                 overlay.regions([](const LayerLabel& label) { return label.count > 0; }))
                region.forEachEdge(
                    [&](const Segment2& side) { triangles_.addSheet(side, bottom, top); });
        }
    }

    void addSlabs() {
        for (const std::size_t i : slabs_) {
            const std::vector<Region> plan = inBase(coupling_.slabPlan(i));
            const double bottom = bottomOf(i), top = floorOf(i);
            const bool is_thick = top - bottom > 4 * kSkin;
            // A ceiling of the room itself keeps its material.
            if (!is_thick || std::fabs(lowestCeiling() - bottom) > kTouching)
                triangles_.addLevel(plan, bottom);
            if (is_thick) solids_.emplace_back().addSolid(plan, bottom + kSkin, top - kSkin);
        }
        for (const auto& [storey, above] : raised_) raiseWalls(storey, above);
    }

    /// Continues the outer walls of a storey up to the slab above it, where it lies over them.
    void raiseWalls(std::size_t storey, std::size_t above) {
        const std::vector<Polygon> outlines = outlinesOf(building_, storey);
        const auto& indoor = building_.scenes[storey]->environment.indoorIndex();
        const Storey& own = building_.document.storeys[storey];
        const auto is_outside = [&](Point2 p) {
            return indoor.locate(inStorey(own, p)) == Side::Outside;
        };
        for (const Region& region : commonPart(outlines, outlinesOf(building_, above)))
            region.forEachEdge([&](const Segment2& side) {
                constexpr double kBeside = 1e-5;
                const Vec2 way = side.b - side.a;
                if (!(length(way) > kBeside)) return;
                const Point2 middle = side.a + 0.5 * way;
                const Vec2 left = kBeside / length(way) * perpendicular(way);
                if (!is_outside(middle - left) && !is_outside(middle + left)) return;
                triangles_.addSheet({inStorey(base_, side.a), inStorey(base_, side.b)},
                                    wallsOf(storey), bottomOf(above));
            });
    }

    const Coupling& coupling_;
    const SiteScene& building_;
    std::vector<std::size_t> storeys_;
    std::size_t own_;
    Extent extent_;
    const Storey& base_;
    std::vector<const FloorOpening*> open_;                    // of the room
    std::vector<const FloorOpening*> floor_, ceiling_;         // of the storey itself
    std::vector<const FloorOpening*> sides_, steps_;           // that are seen
    std::vector<std::size_t> slabs_;                           // storeys
    std::vector<std::pair<std::size_t, std::size_t>> raised_;  // storey, and that of the slab
    Triangles triangles_;
    std::vector<Triangles> solids_;
};

namespace {

/// Returns the ordinals of the openings below or above each storey, ascending.
std::vector<std::vector<std::size_t>> byStorey(std::size_t storeys,
                                               const std::vector<FloorOpening>& openings) {
    std::vector<std::vector<std::size_t>> at(storeys);
    for (std::size_t i = 0; i < openings.size(); ++i) {
        at[openings[i].below].push_back(i);
        if (openings[i].above != openings[i].below) at[openings[i].above].push_back(i);
    }
    return at;
}

}  // namespace

/// Scenes of floors by the storey's scene and what stands around it.
struct Coupling::Floors {
    std::mutex mutex;
    std::map<std::pair<const Scene*, std::vector<std::int64_t>>, std::shared_ptr<const Scene>> made;
};

Coupling::Coupling(const SiteScene& building)
    : building_(building),
      openings_(floorOpenings(building)),
      openings_at_(byStorey(building.scenes.size(), openings_)),
      above_(storeysAbove(building.scenes.size(), openings_)),
      slab_plans_(building.scenes.size()),
      surroundings_(building.scenes.size()),
      with_movers_(building.scenes.size()),
      floors_(std::make_unique<Floors>()) {}

Coupling::~Coupling() = default;

/// True if two storeys have floor area in common, as seen from above.
bool Coupling::areStacked(std::size_t a, std::size_t b) const {
    const auto& stacked = stacked_.get([this] {
        const std::vector<Storey>& storeys = building_.document.storeys;
        const std::size_t count = storeys.size();
        std::vector<Box2> boxes(count);
        std::vector<Point2> inside;
        for (std::size_t i = 0; i < count; ++i) {
            const Environment& room = building_.scenes[i]->environment;
            const Box2& own = room.limits();
            for (const Point2 corner :
                 {own.low, own.high, Point2{own.low.x, own.high.y}, Point2{own.high.x, own.low.y}})
                boxes[i].add(storeys[i].building_from_storey * corner);
            inside.push_back(storeys[i].building_from_storey * room.inside());
        }
        const auto holds = [&](std::size_t i, Point2 p) {
            return building_.scenes[i]->environment.indoorIndex().locate(inStorey(storeys[i], p)) ==
                   Side::Inside;
        };
        const auto meet = [&](std::size_t i, std::size_t k) {
            const Box2 both = common(boxes[i], boxes[k]);
            if (both.empty() || !(both.low.x < both.high.x && both.low.y < both.high.y))
                return false;
            if (holds(i, inside[k]) || holds(k, inside[i])) return true;
            constexpr double kArea = 1e-6;  // square metres that rounding may make
            double area = 0;
            for (const Region& part :
                 commonPart(outlinesOf(building_, i), outlinesOf(building_, k)))
                area += part.area();
            return area > kArea;
        };
        std::vector<std::vector<bool>> found(count, std::vector<bool>(count));
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t k = 0; k < i; ++k) found[i][k] = found[k][i] = meet(i, k);
        return found;
    });
    return stacked[a][b];
}

/// A slab reaches from the top of the highest room below, of those under its outline, up to the
/// floor; it is empty without such a room, or if that is as high. O(storeys^2) tests of outlines,
/// once.
const std::vector<Coupling::Slab>& Coupling::slabs() const {
    return slabs_.get([this] {
        const std::vector<Storey>& storeys = building_.document.storeys;
        std::vector<Slab> slabs;
        for (std::size_t i = 0; i < storeys.size(); ++i) {
            const double floor = storeys[i].floor;
            std::optional<double> top;
            for (std::size_t k = 0; k < i; ++k) {
                // Walls above the height of a storey stand in its rooms, not in the slab.
                const double reached =
                    storeys[k].floor +
                    std::max(building_.height(k), building_.scenes[k]->environment.height());
                if (storeys[k].floor < floor && (!top || reached > *top) && areStacked(k, i))
                    top = reached;
            }
            slabs.push_back({std::min(floor, top.value_or(floor)), floor});
        }
        return slabs;
    });
}

const Coupling::Slab& Coupling::slab(std::size_t storey) const { return slabs()[storey]; }

const std::vector<Region>& Coupling::slabPlan(std::size_t storey) const {
    return slab_plans_[storey].get([&] {
        std::vector<Polygon> open;
        for (const std::size_t i : openings_at_[storey])
            if (openings_[i].above == storey) open.push_back(openings_[i].outline);
        return cutOut(asCurves(outlinesOf(building_, storey)), open);
    });
}

std::vector<std::size_t> Coupling::slabsAbove(std::size_t storey) const {
    const std::vector<Storey>& storeys = building_.document.storeys;
    std::vector<std::size_t> found;
    for (std::size_t i = storey + 1; i < storeys.size(); ++i) {  // the lowest is the first
        if (storeys[i].floor <= storeys[storey].floor || !areStacked(storey, i)) continue;
        if (std::none_of(found.begin(), found.end(),
                         [&](std::size_t under) { return areStacked(under, i); }))
            found.push_back(i);
    }
    return found;
}

std::vector<std::size_t> Coupling::neighbours(std::size_t storey) const {
    const auto floor_of = [&](std::size_t i) { return building_.document.storeys[i].floor; };
    std::vector<std::size_t> near;
    std::set<double> up, down;  // heights of floors on the way
    const auto is_near = [&](std::size_t i) {
        return std::fabs(floor_of(i) - floor_of(storey)) <= kSightBetweenStoreys;
    };
    for (std::size_t i = storey + 1; i < building_.scenes.size(); ++i)
        if (above_[storey][i] && is_near(i)) {
            up.insert(floor_of(i));
            if (up.size() <= kSightThroughFloors) near.push_back(i);
        }
    near.push_back(storey);
    for (std::size_t i = storey; i-- > 0;)
        if (above_[i][storey] && is_near(i)) {
            down.insert(floor_of(i));
            if (down.size() <= kSightThroughFloors) near.push_back(i);
        }
    std::sort(near.begin(), near.end());
    return near;
}

bool Coupling::isAlone(std::size_t storey) const {
    if (neighbours(storey).size() > 1 || !slabsAbove(storey).empty()) return false;
    return !(heightsOfSensors(*building_.scenes[storey]).first < -kSkin) ||
           !(slab(storey).bottom < slab(storey).top);
}

std::shared_ptr<const Environment> Coupling::surroundings(std::size_t storey, Movers movers) const {
    const bool with_movers = movers == Movers::OfNeighbours;
    return (with_movers ? with_movers_ : surroundings_)[storey].get([&] {
        const auto& scene = building_.scenes[storey];
        if (isAlone(storey)) return std::shared_ptr<const Environment>(scene, &scene->environment);
        RoomBuilder::Extent extent{.with_movers = with_movers};
        extent.with_own_slab = heightsOfSensors(*scene).first < -kSkin;
        return std::make_shared<const Environment>(
            RoomBuilder(*this, neighbours(storey), storey, extent).environment());
    });
}

std::shared_ptr<const Scene> Coupling::floor(std::size_t storey, double highest) const {
    const auto& scene = building_.scenes[storey];
    if (building_.isRoomAlone()) return scene;
    const auto [low, high] = heightsOfSensors(*scene);
    RoomBuilder::Extent extent{.low = 0, .high = std::max(high, highest) + kRayEpsilon};
    extent.with_own_slab = low < -kSkin;
    std::vector<std::size_t> beside = neighbours(storey);
    std::erase_if(beside, [&](std::size_t i) {
        const double floor =
            building_.document.storeys[i].floor - building_.document.storeys[storey].floor;
        const double top = std::max(building_.height(i), building_.scenes[i]->environment.height());
        return i != storey && !(floor < extent.high && floor + top > kTouching);
    });
    RoomBuilder builder(*this, std::move(beside), storey, extent);
    if (builder.isAlone()) return scene;
    std::pair<const Scene*, std::vector<std::int64_t>> key{scene.get(), builder.key()};
    {
        const std::lock_guard lock(floors_->mutex);
        if (const auto known = floors_->made.find(key); known != floors_->made.end())
            return known->second;
    }
    auto made = std::make_shared<Scene>(*scene);
    made->environment = builder.environment();
    const std::lock_guard lock(floors_->mutex);
    return floors_->made.try_emplace(std::move(key), std::move(made)).first->second;
}

std::vector<std::shared_ptr<const Scene>> Coupling::floors(double highest) const {
    std::vector<std::shared_ptr<const Scene>> scenes;
    for (std::size_t i = 0; i < building_.scenes.size(); ++i) scenes.push_back(floor(i, highest));
    return scenes;
}

std::shared_ptr<const Scene> Coupling::recordedFloor(std::size_t storey) const {
    const auto& scene = building_.scenes[storey];
    if (building_.isRoomAlone()) return scene;
    RoomBuilder::Extent extent{.low = 0};
    extent.with_own_slab = heightsOfSensors(*scene).first < -kSkin;
    RoomBuilder builder(*this, {storey}, storey, extent);
    if (builder.isAlone()) return scene;
    return std::make_shared<const Scene>(
        makeScene(builder.build().records, *scene, building_.devices));
}

Environment Coupling::joined(std::span<const std::size_t> storeys) const {
    return RoomBuilder(*this, {storeys.begin(), storeys.end()}, storeys.front(),
                       {.with_all_openings = false})
        .environment();
}

std::optional<Environment> Coupling::opened(std::size_t storey) const {
    if (openings_at_[storey].empty()) return std::nullopt;
    return RoomBuilder(*this, {storey}, storey, {.with_slabs = false}).environment();
}

std::optional<std::size_t> Coupling::slabAround(std::size_t storey, Point3 point) const {
    const Storey& own = building_.document.storeys[storey];
    const double height = own.floor + point.z;
    const Point2 place = own.building_from_storey * point.onFloor();
    for (std::size_t i = 0; i < building_.scenes.size(); ++i) {
        const double floor = building_.document.storeys[i].floor;
        if (!(height < floor - kSkin) || floor - own.floor > kSightBetweenStoreys) continue;
        if (!(height > slab(i).bottom + kSkin)) continue;
        for (const Region& part : slabPlan(i))
            if (locate(part.outline, place) == Side::Inside &&
                std::none_of(part.holes.begin(), part.holes.end(), [&](const Polygon& hole) {
                    return locate(hole, place) != Side::Outside;
                }))
                return i;
    }
    return std::nullopt;
}

bool Coupling::isInsideSolid(std::size_t storey, Point3 point) const {
    const Environment& room = building_.scenes[storey]->environment;
    return room.level(point.z)->isInsideSolid(point.onFloor()) ||
           slabAround(storey, point).has_value();
}

std::optional<std::string> Coupling::stepsAround(std::size_t storey, Point3 point,
                                                 double& height) const {
    const std::vector<Storey>& storeys = building_.document.storeys;
    const Point2 place = storeys[storey].building_from_storey * point.onFloor();
    for (const std::size_t i : openings_at_[storey]) {
        const FloorOpening& opening = openings_[i];
        if (opening.below != storey || opening.flight.size() != 2 ||
            locate(opening.outline, place) != Side::Inside)
            continue;
        const Segment2 &foot = opening.flight[0], &top = opening.flight[1];
        const Vec2 way = top.a - foot.a;
        const double rise = storeys[opening.above].floor - storeys[storey].floor;
        height = rise * dot(place - foot.a, way) / dot(way, way);
        if (point.z < height - kRayEpsilon && point.z > height - kStepDepth) return opening.passage;
    }
    return std::nullopt;
}

std::vector<Finding> Coupling::findings(std::size_t storey, const FindingFilter& filter) const {
    const auto& checks = filter.checks;
    if (!checks.empty() && std::find(checks.begin(), checks.end(), "buried") == checks.end())
        return {};
    const Scene& scene = *building_.scenes[storey];
    const std::vector<Storey>& storeys = building_.document.storeys;
    std::vector<Finding> found;
    std::optional<CheckContext> context;
    for (const PlacedRecord& placed : scene.placed) {
        if (isFull(found)) break;
        if (!mayBeCarried(scene.records[placed.record].schema())) continue;
        if (filter.ids && !filter.ids(scene.ids[placed.record])) continue;
        const Point3 at = placed.pose.position;
        const auto report = [&](const std::string& message, std::string hint) {
            if (!context) context.emplace(scene);
            found.push_back(context->finding(placed.record, Severity::Error, at.onFloor(),
                                             message + " at " + placeText(at.onFloor()),
                                             std::move(hint)));
        };
        double height = 0;
        if (const auto slab = slabAround(storey, at); slab && *slab == storey) {
            report(" stands inside the floor of " + storeys[storey].id, "raise it above the floor");
        } else if (slab) {
            const double bottom = this->slab(*slab).bottom - storeys[storey].floor;
            report(" stands inside the floor of " + storeys[*slab].id + ", " +
                       formatFixed(bottom, 2) + " m to " +
                       formatFixed(storeys[*slab].floor - storeys[storey].floor, 2) + " m high,",
                   "lower it to " + formatFixed(bottom, 2) + " m");
        } else if (const auto steps = stepsAround(storey, at, height)) {
            report(" stands inside the steps of stairs " + *steps,
                   "move it, or raise it to " + formatFixed(height, 2) + " m");
        }
    }
    return found;
}

std::vector<Diagnostic> storeyFindings(const Coupling& coupling, std::size_t storey,
                                       const FindingFilter& filter, bool with_scene) {
    const SiteScene& building = coupling.building();
    std::vector<Finding> findings;
    if (with_scene) findings = checkScene(*building.scenes[storey], filter);
    for (Finding& finding : coupling.findings(storey, filter))
        findings.push_back(std::move(finding));
    std::vector<Diagnostic> found;
    for (const Finding& finding : findings) {
        Diagnostic& diagnostic = found.emplace_back(finding.diagnostic());
        diagnostic.message.insert(0, building.document.storeys[storey].prefix());
    }
    return found;
}

std::vector<Diagnostic> storeyWarnings(const Coupling& coupling, const FindingFilter& filter,
                                       const std::function<bool(const std::string&)>& chosen) {
    const SiteScene& building = coupling.building();
    std::vector<Diagnostic> warnings;
    for (std::size_t i = 0; i < building.scenes.size(); ++i) {
        FindingFilter own = filter;
        if (chosen)
            own.ids = [&, i](const std::string& id) {
                return chosen(wholeId(building.document.storeys[i], id));
            };
        std::vector<Diagnostic> found = storeyFindings(coupling, i, own);
        if (found.size() > Diagnostics::kMax) found.resize(Diagnostics::kMax);
        for (Diagnostic& finding : found) {
            finding.severity = Severity::Warning;
            warnings.push_back(std::move(finding));
        }
    }
    return warnings;
}

}  // namespace ispace
