// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a scene as IFC4 (ISO 16739-1:2018), Reference View: products with placements, swept solids
// and faceted bodies, openings that void walls, doors and windows that fill openings, spaces with
// areas. GUIDs are hashes, so that a room written twice has the same ones, and programs recognise
// its parts.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "drawing/plan/elements.h"
#include "extensions/ifc/ifc.h"
#include "extensions/ifc/ifc_walls.h"
#include "extensions/ifc/ifc_write_model.h"
#include "geom/arrangement.h"
#include "geom/planar_map.h"
#include "io/plan/line_plan.h"
#include "scene/bodies.h"
#include "scene/sensor/sensor.h"

namespace ispace::ifc {

namespace {

using Id = IfcModel::Id;

/// Openings reach this far beyond the faces of their wall, in metres, so that no skin is left.
constexpr double kOpeningRim = 0.01;
/// Thickness of the slabs below floors, metres.
constexpr double kSlab = 0.2;
/// Coverings of the floor are this thick, in metres.
constexpr double kCovering = 0.001;

/// The IFC classes of furniture and fixtures; other records are proxies.
struct IfcClass {
    std::string_view keyword, type, kind;
};
constexpr std::string_view kProxy = "IFCBUILDINGELEMENTPROXY";
constexpr IfcClass kClasses[] = {
    {"table", "IFCFURNITURE", ".TABLE."},
    {"desk", "IFCFURNITURE", ".DESK."},
    {"chair", "IFCFURNITURE", ".CHAIR."},
    {"screen", "IFCFURNITURE", ".USERDEFINED."},
    {"pillar", "IFCCOLUMN", ".COLUMN."},
    {"floor", "IFCCOVERING", ".FLOORING."},
    {"camera", "IFCAUDIOVISUALAPPLIANCE", ".CAMERA."},
    {"lamp", "IFCLIGHTFIXTURE", ".NOTDEFINED."},
    {"projector", "IFCAUDIOVISUALAPPLIANCE", ".PROJECTOR."},
    {"speaker", "IFCAUDIOVISUALAPPLIANCE", ".SPEAKER."},
    {"heater", "IFCSPACEHEATER", ".NOTDEFINED."},
    {"panel", "IFCELECTRICDISTRIBUTIONBOARD", ".NOTDEFINED."},
    {"switch", "IFCSWITCHINGDEVICE", ".TOGGLESWITCH."},
};

IfcClass classOf(std::string_view keyword, std::string_view otherwise) {
    for (const IfcClass& row : kClasses)
        if (row.keyword == keyword) return row;
    return {keyword, otherwise, ".USERDEFINED."};
}

std::string measure(std::string_view type, double value) {
    return std::string(type) + '(' + stepReal(value) + ')';
}
std::string lengthMeasure(double metres) { return measure("IFCPOSITIVELENGTHMEASURE", metres); }
std::string angleMeasure(Angle angle) { return measure("IFCPLANEANGLEMEASURE", angle.degrees()); }

/// The angle between the upper and the lower edge of a field of view.
Angle uprightSpan(const FieldOfView& view) {
    switch (view.shape) {
        case FieldOfView::Shape::Pyramid:
            return Angle::radians(std::atan(view.sides.up) + std::atan(view.sides.down));
        case FieldOfView::Shape::Window:
            return 2 * view.half_y;
        case FieldOfView::Shape::Cone:
            return 2 * view.half_x;
        case FieldOfView::Shape::Picture:
            return view.camera->fovY();
    }
    return {};
}

std::vector<IfcProperty> propertiesOf(const Sensor& sensor) {
    const SensorKind& kind = kindOf(sensor.model);
    std::vector<IfcProperty> properties{
        {"Kind", "IFCLABEL(" + stepText(kind.keyword) + ')'},
        {"Height", measure("IFCLENGTHMEASURE", sensor.pose.position.z)},
        {"Heading", angleMeasure(wrapped(sensor.pose.heading))},
        {"Tilt", angleMeasure(sensor.pose.tilt)},
        {"Roll", angleMeasure(sensor.pose.roll)}};
    if (const std::string& model = deviceName(sensor.model); !model.empty())
        properties.insert(properties.begin() + 1, {"Model", "IFCLABEL(" + stepText(model) + ')'});
    if (kind.bearings != nullptr) {
        const BearingSpan span = kind.bearings(sensor.model);
        properties.emplace_back("FieldOfView", angleMeasure(span.to - span.from));
    }
    if (const auto view = fieldOfView(sensor))
        properties.emplace_back("FieldOfViewVertical", angleMeasure(uprightSpan(*view)));
    if (const double range = maxRange(sensor.model); std::isfinite(range))
        properties.emplace_back("Range", lengthMeasure(range));
    return properties;
}

/// One line of walls with its frame: along the line from its beginning, on the wall's foot.
struct WallFrame {
    Pose2 pose;
    double bottom = 0;

    [[nodiscard]] double along(Point2 p) const {
        return dot(p - pose.position, unitVector(pose.heading));
    }
};

class RoomWriter {
  public:
    explicit RoomWriter(const Scene& scene)
        : scene_(scene), elements_(scene.environment.elements()), model_(scene.digest()) {}

    ExportedFiles write(const std::string& title) {
        addStorey(title);
        const WholeWalls walls(scene_.environment);
        addWalls(walls);
        addSolids(walls);
        addOpenings(walls);
        addSpaces(walls);
        addFloors();
        for (const Element& element : elements_)
            if (isThing(element.record)) addThing(element);
        for (const PlacedRecord& placed : scene_.placed) addPlaced(placed);
        relate("IFCRELAGGREGATES", "storey", IfcModel::ref(storey_), stepList(spaces_), spaces_);
        relate("IFCRELCONTAINEDINSPATIALSTRUCTURE", "storey", stepList(contained_),
               IfcModel::ref(storey_), contained_);
        ExportedFiles files{model_.finish(title), ""};
        if (!left_out_.empty())
            files.left_out =
                "IFC is written of what stays where it is, without " + listText(left_out_);
        return files;
    }

  private:
    static bool isThing(const Record& record) {
        const RecordType type = record.schema().type;
        return type == RecordType::Other || type == RecordType::Infra || type == RecordType::Floor;
    }

    void relate(std::string_view type, std::string_view key, std::string first, std::string second,
                const std::vector<std::string>& members) {
        if (!members.empty())
            model_.addRooted(type, key, "", {std::move(first), std::move(second)});
    }

    /// Project, site, building and storey, each with the next as its part.
    void addStorey(const std::string& title) {
        const std::string name = title.empty() ? "room" : title;
        const Id project = model_.addRooted("IFCPROJECT", "", name,
                                            {"$", "$", "$", model_.contexts(), model_.units()});
        const Id site_place = model_.addPlacement({}, {});
        const Id site = model_.addRooted(
            "IFCSITE", "", "site",
            {"$", IfcModel::ref(site_place), "$", "$", ".ELEMENT.", "$", "$", "$", "$", "$"});
        const Id building_place = model_.addPlacement(site_place, {});
        const Id building = model_.addRooted(
            "IFCBUILDING", "", name,
            {"$", IfcModel::ref(building_place), "$", "$", ".ELEMENT.", "$", "$", "$"});
        place_ = model_.addPlacement(building_place, {});
        storey_ = model_.addRooted("IFCBUILDINGSTOREY", "", "floor",
                                   {"$", IfcModel::ref(place_), "$", "$", ".ELEMENT.", "0."});
        for (const auto& [key, whole, part] :
             {std::tuple("project", project, site), std::tuple("site", site, building),
              std::tuple("building", building, storey_)})
            model_.addRooted("IFCRELAGGREGATES", key, "",
                             {IfcModel::ref(whole), stepList({{IfcModel::ref(part)}})});
    }

    /// A product of the eight arguments that all elements have, and others.
    Id addProduct(std::string_view type, const std::string& id, std::string_view object_type,
                  Id placement, std::string shape, std::string_view kind) {
        return model_.addRooted(
            type, id, id,
            {object_type.empty() ? "$" : stepText(object_type), IfcModel::ref(placement),
             std::move(shape), stepText(id), std::string(kind)});
    }

    void contain(Id product) { contained_.push_back(IfcModel::ref(product)); }

    /// \param id of a wall's line: that of its record, with a number if it has several
    [[nodiscard]] std::string lineId(const WallPlan& plan, std::size_t line) const {
        const std::size_t owner = plan.owner[line];
        const auto [first, last] = std::equal_range(plan.owner.begin(), plan.owner.end(), owner);
        const std::string& id = elements_[owner].id;
        if (last - first == 1) return id;
        return id + ' ' +
               std::to_string(plan.owner.begin() + static_cast<std::ptrdiff_t>(line) - first + 1);
    }

    void addWalls(const WholeWalls& walls) {
        const WallPlan& plan = walls.plan;
        frames_.resize(plan.walls.size());
        places_.resize(plan.walls.size());
        products_.resize(plan.walls.size());
        for (std::size_t i = 0; i < plan.walls.size(); ++i) {
            const WallLine& wall = plan.walls[i];
            if (walls.bodies[i].prisms.empty()) continue;  // another one has the same line
            const Vec2 along = wall.line.b - wall.line.a;
            frames_[i] = {{wall.line.a, directionOf(along.x, along.y)}, wall.bottom};
            const auto& [pose, bottom] = frames_[i];
            places_[i] = model_.addPlacement(
                place_, {{pose.position.x, pose.position.y, bottom}, pose.heading, {}, {}});
            const std::string id = lineId(plan, i);
            products_[i] =
                addProduct("IFCWALL", id, elements_[plan.owner[i]].record.keyword(), places_[i],
                           model_.addShape(sdfParts(walls.bodies[i], pose, bottom, true, ""), {}),
                           ".NOTDEFINED.");
            contain(products_[i]);
            model_.addQuantities(products_[i], id, "Qto_WallBaseQuantities",
                                 {{"LENGTH", "Length", walls.lengths[i]},
                                  {"LENGTH", "Width", std::max(wall.thickness, kThinWall)},
                                  {"LENGTH", "Height", wall.top - wall.bottom}});
        }
    }

    /// Adds walls with two faces, each with the name of one of its faces.
    void addSolids(const WholeWalls& walls) {
        for (std::size_t i = 0; i < walls.solids.size(); ++i) {
            const SolidWall& solid = walls.solids[i];
            const std::string id = lineId(walls.plan, solid.line);
            const Id place = model_.addPlacement(place_, {{0, 0, solid.bottom}, {}, {}, {}});
            const Id product = addProduct(
                "IFCWALL", id, elements_[walls.plan.owner[solid.line]].record.keyword(), place,
                model_.addShape(solid.footprint, solid.top - solid.bottom), ".NOTDEFINED.");
            contain(product);
            solids_.push_back({product, place});
            model_.addQuantities(product, id, "Qto_WallBaseQuantities",
                                 {{"LENGTH", "Height", solid.top - solid.bottom},
                                  {"AREA", "GrossFootprintArea", solid.footprint.area()}});
        }
    }

    /// The part of a wall that an opening cuts out.
    struct Hole {
        Id wall = 0, wall_place = 0;
        WallFrame frame;    ///< of the wall
        Pose2 pose;         ///< of its beginning, in that frame
        double length = 0;  ///< along the wall
        double depth = 0;   ///< of the wall
        std::string of;     ///< id of the wall
    };

    /// Cuts openings into all walls that they go through, and fills each once.
    void addOpenings(const WholeWalls& walls) {
        std::set<std::size_t> filled;
        for (const SolidHole& hole : walls.holes) {
            const auto& [product, place] = solids_[hole.solid];
            const SolidWall& solid = walls.solids[hole.solid];
            const Vec2 along = hole.middle.b - hole.middle.a;
            addOpening(walls.openings[hole.opening],
                       {product,
                        place,
                        {{}, solid.bottom},
                        {hole.middle.a, directionOf(along.x, along.y)},
                        length(along),
                        hole.depth,
                        lineId(walls.plan, solid.line) + " solid"},
                       filled.insert(hole.opening).second);
        }
        for (const OpeningCut& cut : walls.cuts) {
            const WallFrame& frame = frames_[cut.line];
            const auto [from, to] =
                std::minmax({frame.along(cut.jambs.a), frame.along(cut.jambs.b)});
            addOpening(walls.openings[cut.opening],
                       {products_[cut.line],
                        places_[cut.line],
                        frame,
                        {{from, 0}, {}},
                        to - from,
                        std::max(walls.plan.walls[cut.line].thickness, kThinWall),
                        lineId(walls.plan, cut.line)},
                       filled.insert(cut.opening).second);
        }
    }

    void addOpening(const Opening& opening, const Hole& hole, bool is_filled) {
        const Element& element = elements_[opening.element];
        const Point2 from = hole.pose.position;
        const Id place = model_.addPlacement(
            hole.wall_place,
            {{from.x, from.y, opening.bottom - hole.frame.bottom}, hole.pose.heading, {}, {}});
        SdfPart part;
        part.length = hole.length;
        part.width = hole.depth + 2 * kOpeningRim;
        part.height = opening.top - opening.bottom;
        part.place = {part.length / 2, 0, part.height / 2};
        const std::string key = is_filled ? element.id : element.id + ' ' + hole.of;
        const Id void_id = addProduct("IFCOPENINGELEMENT", key, "", place,
                                      model_.addShape({&part, 1}, {}), ".OPENING.");
        model_.addRooted("IFCRELVOIDSELEMENT", key, "",
                         {IfcModel::ref(hole.wall), IfcModel::ref(void_id)});
        if (!is_filled) return;
        const Pose2& wall = hole.frame.pose;
        const Pose2 origin{wall * from, wall.heading + hole.pose.heading};
        const bool is_door = element.record.keyword() == "door";
        const Id filling = model_.addRooted(
            is_door ? "IFCDOOR" : "IFCWINDOW", element.id, element.id,
            {stepText(fillingName(opening.filling)), IfcModel::ref(model_.addPlacement(place, {})),
             model_.addShape(sdfParts(element.body, origin, opening.bottom, true, ""), {}),
             stepText(element.id), stepReal(part.height), stepReal(part.length),
             is_door ? ".DOOR." : ".WINDOW.", ".NOTDEFINED.", "$"});
        contain(filling);
        model_.addRooted("IFCRELFILLSELEMENT", element.id, "",
                         {IfcModel::ref(void_id), IfcModel::ref(filling)});
    }

    static std::string_view fillingName(Filling filling) {
        constexpr std::array<std::string_view, 4> kNames{"open", "leaf", "clear pane",
                                                         "opaque pane"};
        return kNames[static_cast<std::size_t>(filling)];
    }

    /// Adds a slab below each indoor region.
    void addFloors() {
        const Id place = model_.addPlacement(place_, {{0, 0, -kSlab}, {}, {}, {}});
        const std::vector<Region>& floors = scene_.environment.indoor().parts;
        for (std::size_t i = 0; i < floors.size(); ++i) {
            const std::string id =
                floors.size() == 1 ? "floor slab" : "floor slab " + std::to_string(i + 1);
            const Id slab =
                addProduct("IFCSLAB", id, "", place, model_.addShape(floors[i], kSlab), ".FLOOR.");
            contain(slab);
            model_.addQuantities(
                slab, id, "Qto_SlabBaseQuantities",
                {{"LENGTH", "Depth", kSlab}, {"AREA", "GrossArea", floors[i].area()}});
        }
    }

    /// Adds the rooms, minus the walls in them, and the zones, as parts of the rooms around them.
    void addSpaces(const WholeWalls& walls) {
        const std::vector<Polygon> footprints = walls.footprints();
        const std::vector<Region> rooms = difference(scene_.environment.indoor(), footprints);
        std::vector<std::vector<std::string>> zones(rooms.size());
        for (const Element& element : elements_) {
            if (element.record.keyword() != "zone") continue;
            const Region zone{zoneOutline(element.record), {}};
            // The room around the zone's floor: its middle may lie in a wall.
            const std::vector<Region> floors = difference(zone, footprints);
            const auto largest = std::max_element(
                floors.begin(), floors.end(),
                [](const Region& a, const Region& b) { return a.area() < b.area(); });
            const Point2 inside = interiorPoint(largest == floors.end() ? zone : *largest);
            const auto room = std::find_if(
                rooms.begin(), rooms.end(),
                [inside](const Region& each) { return each.locate(inside) != Side::Outside; });
            auto& parts = room == rooms.end()
                              ? spaces_
                              : zones[static_cast<std::size_t>(room - rooms.begin())];
            const Record& record = element.record;
            parts.push_back(addSpace(
                {"zone", element.id, record.has("number") ? record.text("number") : element.id,
                 record.has("name") ? stepText(record.text("name")) : "$",
                 ".PARTIAL.,.USERDEFINED."},
                zone));
        }
        for (std::size_t i = 0; i < rooms.size(); ++i) {
            const std::string name =
                rooms.size() == 1 ? "indoor" : "indoor " + std::to_string(i + 1);
            spaces_.push_back(
                addSpace({"room", name, name, "$", ".ELEMENT.,.INTERNAL."}, rooms[i]));
            relate("IFCRELAGGREGATES", name, spaces_.back(), stepList(zones[i]), zones[i]);
        }
    }

    struct Space {
        std::string object_type, id, name;
        std::string long_name;  ///< quoted, or $
        std::string kind;       ///< composition and predefined type
    };

    /// \returns a reference to it
    std::string addSpace(const Space& what, const Region& region) {
        const std::string key = what.object_type + ' ' + what.id;
        const Id place = model_.addPlacement(place_, {});
        const Id space = model_.addRooted("IFCSPACE", key, what.name,
                                          {stepText(what.object_type), IfcModel::ref(place),
                                           model_.addShape(region, scene_.environment.height()),
                                           what.long_name, what.kind, "0."});
        model_.addQuantities(space, key, "Qto_SpaceBaseQuantities",
                             {{"AREA", "NetFloorArea", region.area()},
                              {"LENGTH", "NetPerimeter", region.boundaryLength()},
                              {"LENGTH", "Height", scene_.environment.height()}});
        return IfcModel::ref(space);
    }

    void addThing(const Element& element) {
        const Record& record = element.record;
        Body covering;
        if (record.schema().type == RecordType::Floor)
            covering.prisms.push_back({floorOutline(record), 0, kCovering});
        const auto [pose, parts] = covering.prisms.empty()
                                       ? sdfParts(element)
                                       : FramedSdfParts{{}, sdfParts(covering, {}, 0, false, "")};
        std::string shape = model_.addShape(parts, element.body.meshes);
        // Heaters, speakers and panels have a position, but no body.
        if (shape == "$" && record.find("at") == nullptr) return;
        const IfcClass row = classOf(record.keyword(), kProxy);
        contain(addProduct(row.type, element.id, record.keyword(),
                           model_.addPlacement(place_, pose), std::move(shape), row.kind));
    }

    void addPlaced(const PlacedRecord& placed) {
        const Record& record = scene_.records[placed.record];
        const SensorKind* const kind = sensorKind(record.keyword());
        const Sensor* const sensor = kind == nullptr ? nullptr : &scene_.sensors[placed.index];
        if (record.keyword() == "robot" || record.keyword() == "human" ||
            (sensor != nullptr && (sensor->mount || sensor->person))) {
            ++left_out_[record.keyword()];
            return;
        }
        // Mats and gates are sensors, too; passive targets of other sensors, such as tags, are not.
        const bool perceives = kind == nullptr || kind->perceives;
        const std::string& id = scene_.ids[placed.record];
        const IfcClass row = classOf(record.keyword(), perceives ? "IFCSENSOR" : kProxy);
        const Id product =
            addProduct(row.type, id, record.keyword(), model_.addPlacement(place_, placed.pose),
                       model_.addShape({}, bodyOf(scene_, placed)), row.kind);
        contain(product);
        if (sensor != nullptr)
            model_.addProperties(product, id, "ispace_Sensor", propertiesOf(*sensor));
    }

    const Scene& scene_;
    const std::vector<Element>& elements_;
    IfcModel model_;
    Id storey_ = 0, place_ = 0;
    std::vector<WallFrame> frames_;  // of each line of walls
    std::vector<Id> places_, products_;
    std::vector<std::pair<Id, Id>> solids_;  // and their placements
    std::vector<std::string> contained_, spaces_;
    std::map<std::string, std::size_t> left_out_;
};

}  // namespace

ExportedFiles writeIfc(const Scene& scene, const std::string& title) {
    return RoomWriter(scene).write(title);
}

}  // namespace ispace::ifc
