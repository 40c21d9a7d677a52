// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/ifc/ifc_write.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "drawing/plan/elements.h"
#include "geom/arrangement.h"
#include "geom/planar_map.h"
#include "io/exporters.h"
#include "io/ifc/ifc_write_model.h"
#include "io/plan/line_plan.h"
#include "scene/bodies.h"
#include "scene/sensor/sensor.h"

namespace ispace {

namespace {

/// Returns the parts without those inside another one on the same line.
std::vector<WallPart> withoutDoubles(const std::vector<WallPart>& parts) {
    const auto ends = [&](std::size_t i) {
        const auto& [a, b] = parts[i].piece.line;
        return lexLess(b, a) ? std::tuple(b.x, b.y, a.x, a.y) : std::tuple(a.x, a.y, b.x, b.y);
    };
    const auto holds = [&](std::size_t i, std::size_t k) {
        const WallLine &outer = parts[i].piece, &inner = parts[k].piece;
        return outer.thickness >= inner.thickness && outer.bottom <= inner.bottom &&
               outer.top >= inner.top;
    };
    std::vector<std::size_t> order(parts.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) {
        return std::tuple(ends(i), -parts[i].piece.thickness, i) <
               std::tuple(ends(k), -parts[k].piece.thickness, k);
    });
    std::vector<bool> dropped(parts.size());
    std::size_t last = 0;  // the last one that is kept
    for (std::size_t i = 1; i < order.size(); ++i) {
        dropped[order[i]] = ends(order[last]) == ends(order[i]) && holds(order[last], order[i]);
        if (!dropped[order[i]]) last = i;
    }
    std::vector<WallPart> kept;
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (!dropped[i]) kept.push_back(parts[i]);
    return kept;
}

}  // namespace

WholeWalls::WholeWalls(const std::vector<Element>& elements) {
    Diagnostics findings;  // the environment has had them
    for (std::size_t i = 0; i < elements.size(); ++i)
        if (isWall(elements[i].record))
            for (const WallLine& wall : wallLinesOf(elements[i].record, findings))
                plan.add(wall, i);
    openings = placeOpenings(elements, plan, findings);
    std::vector<WallLine> thick = plan.walls;
    for (WallLine& wall : thick)
        if (wall.thickness <= kThinnest) wall.thickness = kThinWall;
    const std::vector<WallPart> parts = withoutDoubles(wallParts(thick, weld(plan.lines)));
    bodies = wallBodies(parts, thick.size());
    lengths.resize(thick.size());
    for (const WallPart& part : parts)
        lengths[part.source] += distance(part.piece.line.a, part.piece.line.b);
}

bool WholeWalls::stands(const OpeningCut& cut) const {
    const Point2 middle = cut.jambs.a + 0.5 * (cut.jambs.b - cut.jambs.a);
    const Opening& opening = openings[cut.opening];
    const auto& prisms = bodies[cut.line].prisms;
    return std::any_of(prisms.begin(), prisms.end(), [&](const Prism& prism) {
        return prism.bottom < opening.top && prism.top > opening.bottom &&
               locate(prism.footprint, middle) != Side::Outside;
    });
}

std::vector<Polygon> WholeWalls::footprints() const {
    std::vector<Polygon> footprints;
    for (std::size_t i = 0; i < bodies.size(); ++i)
        if (plan.walls[i].thickness > kThinnest)
            for (const Prism& prism : bodies[i].prisms)
                if (prism.bottom <= 0) footprints.push_back(prism.footprint);
    return footprints;
}

namespace {

using Id = IfcModel::Id;

/// Openings reach this far beyond the faces of their wall, in metres, so that no skin is left.
constexpr double kOpeningRim = 0.01;
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
        const WholeWalls walls(elements_);
        addWalls(walls);
        addOpenings(walls);
        addSpaces(walls);
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

    /// Cuts openings into all walls that they go through, and fills each once.
    void addOpenings(const WholeWalls& walls) {
        std::vector<OpeningCut> cuts = openingCuts(walls.plan, walls.openings);
        std::erase_if(cuts, [&](const OpeningCut& cut) { return !walls.stands(cut); });
        // The opening's own line first.
        std::stable_sort(cuts.begin(), cuts.end(), [&](const OpeningCut& c, const OpeningCut& d) {
            const auto other = [&](const OpeningCut& cut) {
                return std::pair(cut.opening, cut.line != walls.openings[cut.opening].line);
            };
            return other(c) < other(d);
        });
        for (std::size_t i = 0; i < cuts.size(); ++i) {
            const bool is_first = i == 0 || cuts[i - 1].opening != cuts[i].opening;
            addOpening(walls, cuts[i], is_first);
        }
    }

    void addOpening(const WholeWalls& walls, const OpeningCut& cut, bool is_filled) {
        const Opening& opening = walls.openings[cut.opening];
        const Element& element = elements_[opening.element];
        const WallFrame& frame = frames_[cut.line];
        const auto [from, to] = std::minmax({frame.along(cut.jambs.a), frame.along(cut.jambs.b)});
        const Id place = model_.addPlacement(
            places_[cut.line], {{from, 0, opening.bottom - frame.bottom}, {}, {}, {}});
        SdfPart hole;
        hole.length = to - from;
        hole.width = std::max(walls.plan.walls[cut.line].thickness, kThinWall) + 2 * kOpeningRim;
        hole.height = opening.top - opening.bottom;
        hole.place = {hole.length / 2, 0, hole.height / 2};
        const std::string wall = lineId(walls.plan, cut.line);
        const std::string key = is_filled ? element.id : element.id + ' ' + wall;
        const Id void_id = addProduct("IFCOPENINGELEMENT", key, "", place,
                                      model_.addShape({&hole, 1}, {}), ".OPENING.");
        model_.addRooted("IFCRELVOIDSELEMENT", key, "",
                         {IfcModel::ref(products_[cut.line]), IfcModel::ref(void_id)});
        if (!is_filled) return;
        const Pose2 origin{frame.pose * Point2{from, 0}, frame.pose.heading};
        const bool is_door = element.record.keyword() == "door";
        const Id filling = model_.addRooted(
            is_door ? "IFCDOOR" : "IFCWINDOW", element.id, element.id,
            {stepText(fillingName(opening.filling)), IfcModel::ref(model_.addPlacement(place, {})),
             model_.addShape(sdfParts(element.body, origin, opening.bottom, true, ""), {}),
             stepText(element.id), stepReal(hole.height), stepReal(hole.length),
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

    /// Adds the rooms, minus the walls in them, and the zones.
    void addSpaces(const WholeWalls& walls) {
        const std::vector<Region> rooms =
            difference(scene_.environment.indoor(), walls.footprints());
        for (std::size_t i = 0; i < rooms.size(); ++i) {
            const std::string number = rooms.size() == 1 ? "" : ' ' + std::to_string(i + 1);
            addSpace("indoor" + number, "room", ".INTERNAL.", rooms[i]);
        }
        for (const Element& element : elements_)
            if (element.record.keyword() == "zone")
                addSpace(element.id, "zone", ".USERDEFINED.", {zoneOutline(element.record), {}});
    }

    void addSpace(const std::string& name, const std::string& what, std::string kind,
                  const Region& region) {
        const std::string key = what + ' ' + name;
        const Id place = model_.addPlacement(place_, {});
        const Id space =
            model_.addRooted("IFCSPACE", key, name,
                             {stepText(what), IfcModel::ref(place),
                              model_.addShape(region, scene_.environment.height()), "$",
                              what == "zone" ? ".PARTIAL." : ".ELEMENT.", std::move(kind), "0."});
        spaces_.push_back(IfcModel::ref(space));
        model_.addQuantities(space, key, "Qto_SpaceBaseQuantities",
                             {{"AREA", "NetFloorArea", region.area()},
                              {"LENGTH", "NetPerimeter", region.boundaryLength()},
                              {"LENGTH", "Height", scene_.environment.height()}});
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
        if (shape == "$") return;
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
    std::vector<std::string> contained_, spaces_;
    std::map<std::string, std::size_t> left_out_;
};

}  // namespace

ExportedFiles writeIfc(const Scene& scene, const std::string& title) {
    return RoomWriter(scene).write(title);
}

}  // namespace ispace
