// SPDX-License-Identifier: GPL-3.0-or-later
// Sites of Open-RMF (building.yaml of its traffic editor): levels with vertices, walls, doors and
// measurements, and lifts.
//
// Levels are laid over each other by fiducials of equal names: the rigid motion of least squares
// (S. Umeyama, Least-squares estimation of transformation parameters between two point patterns,
// 1991; in the plane the angle is the direction of summed products). Walls and doors then go
// through the importer of plans, which joins their ends.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/budget.h"
#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "io/import_records.h"
#include "io/plan/line_plan.h"
#include "record/yaml/yaml.h"
#include "scene/placement_schemas.h"
#include "site/building_imports.h"
#include "site/building_schemas.h"

namespace ispace {

namespace {

/// Metres a pixel of a level without measurements, as the traffic editor takes it.
constexpr double kDefaultScale = 0.05;
/// Ends of walls closer than this are joined, metres: they are drawn by hand.
constexpr double kSnap = 0.05;
/// Units of Budget for a wall or door, which becomes part of a room.
constexpr std::uint64_t kEdgeWork = 16;
/// Of a fiducial, which is looked up by name.
constexpr std::uint64_t kFiducialWork = 4;
constexpr const char* kWalls = "walls";
constexpr const char* kDoors = "doors";
constexpr const char* kFiducials = "fiducials";

/// Finds the value of a key; null if the node is no map or has no such key.
const YamlNode* member(const YamlNode& map, std::string_view key) {
    if (map.kind != YamlNode::Kind::Map) return nullptr;
    for (std::size_t i = 0; i + 1 < map.items.size(); i += 2)
        if (map.items[i]->scalar == key) return map.items[i + 1];
    return nullptr;
}

/// A level in metres, in a frame of its own, y up.
struct RmfLevel {
    std::string name;
    double elevation = 0;
    double scale = kDefaultScale;  ///< metres a unit of its coordinates
    bool is_measured = false;
    std::vector<Point2> vertices;  ///< in units of the file, y up
    std::vector<std::pair<std::size_t, std::size_t>> walls, doors;
    std::map<std::string, Point2> fiducials;  ///< in units of the file, y up
    std::size_t models = 0;
    Pose2 building_from_level;
};

/// Reads the nodes of a site.
class RmfReader {
  public:
    RmfReader(const std::string& name, const YamlNode& top, Budget& work)
        : name_(name), work_(work) {
        const YamlNode* const system = member(top, "coordinate_system");
        const std::string word = system == nullptr ? "reference_image" : system->scalar;
        if (word != "reference_image" && word != "cartesian_meters")
            fail(*system, "the coordinate system " + excerpt(word) +
                              " is not read, wanted reference_image or cartesian_meters");
        is_image_ = word == "reference_image";
    }

    [[nodiscard]] RmfLevel level(const std::string& name, const YamlNode& node) const {
        RmfLevel level;
        level.name = name;
        if (const YamlNode* const z = member(node, "elevation")) level.elevation = number(*z);
        forEachItem(node, "vertices", 2,
                    [&](const YamlNode& item) { level.vertices.push_back(point(item)); });
        level.walls = edges(node, kWalls, level);
        level.doors = edges(node, kDoors, level);
        forEachItem(node, kFiducials, 3, [&](const YamlNode& item) {
            level.fiducials.emplace(item.items[2]->scalar, point(item));
        });
        if (const YamlNode* const models = member(node, "models"))
            level.models = models->items.size();
        measure(node, level);
        return level;
    }

    [[nodiscard]] double number(const YamlNode& node) const {
        const auto value =
            node.kind == YamlNode::Kind::Scalar ? parseDouble(node.scalar) : std::nullopt;
        if (!value || !(std::abs(*value) <= kMaxPlanCoordinate))
            fail(node,
                 (node.kind == YamlNode::Kind::Scalar ? excerpt(node.scalar) : "a list or map") +
                     " is no coordinate or length");
        return *value;
    }
    [[nodiscard]] double number(const YamlNode& map, const char* key) const {
        const YamlNode* const node = member(map, key);
        if (node == nullptr) fail(map, "`" + std::string(key) + "` is missing");
        return number(*node);
    }
    /// A point x,y in units of the file, y up.
    [[nodiscard]] Point2 upright(double x, double y) const { return {x, is_image_ ? -y : y}; }

    [[noreturn]] void fail(const YamlNode& node, const std::string& message) const {
        throw FormatError({displayName(name_), node.line, node.column, message});
    }

  private:
    template <typename Visit>
    void forEachItem(const YamlNode& level, const char* key, std::size_t least, Visit visit) const {
        const YamlNode* const list = member(level, key);
        if (list == nullptr) return;
        // An alias lists the same items again.
        const std::string_view name(key);
        const std::uint64_t each = name == kWalls || name == kDoors ? kEdgeWork
                                   : name == kFiducials             ? kFiducialWork
                                                                    : 1;
        if (!work_.take(each * list->items.size()))
            fail(*list, "`" + std::string(key) + "` of the levels make " + work_.excess());
        for (const YamlNode* const item : list->items) {
            if (item->kind != YamlNode::Kind::List || item->items.size() < least)
                fail(*item, "`" + std::string(key) + "`: wanted lists of " + std::to_string(least) +
                                " values or more");
            visit(*item);
        }
    }

    [[nodiscard]] Point2 point(const YamlNode& item) const {
        return upright(number(*item.items[0]), number(*item.items[1]));
    }

    [[nodiscard]] std::pair<std::size_t, std::size_t> edge(const YamlNode& item,
                                                           const RmfLevel& level) const {
        const auto index = [&](const YamlNode& node) {
            const auto value = parseInteger(node.scalar);
            if (!value || *value < 0 || static_cast<std::size_t>(*value) >= level.vertices.size())
                fail(node, excerpt(node.scalar) + " is none of the " +
                               std::to_string(level.vertices.size()) + " vertices of level " +
                               level.name);
            return static_cast<std::size_t>(*value);
        };
        return {index(*item.items[0]), index(*item.items[1])};
    }

    [[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> edges(
        const YamlNode& node, const char* key, const RmfLevel& level) const {
        std::vector<std::pair<std::size_t, std::size_t>> edges;
        forEachItem(node, key, 2,
                    [&](const YamlNode& item) { edges.push_back(edge(item, level)); });
        return edges;
    }

    /// The scale is the mean over all measurements.
    void measure(const YamlNode& node, RmfLevel& level) const {
        if (!is_image_) {
            level.scale = 1;
            level.is_measured = true;
            return;
        }
        double sum = 0;
        std::size_t count = 0;
        forEachItem(node, "measurements", 3, [&](const YamlNode& item) {
            const auto [a, b] = edge(item, level);
            const YamlNode* const stated = member(*item.items[2], "distance");
            if (stated == nullptr || stated->kind != YamlNode::Kind::List ||
                stated->items.size() < 2)
                fail(item, "a measurement without `distance`");
            const double drawn = distance(level.vertices[a], level.vertices[b]);
            if (!(drawn > 0)) fail(item, "a measurement between equal points");
            sum += number(*stated->items[1]) / drawn;
            ++count;
        });
        if (count == 0) return;
        level.scale = sum / static_cast<double>(count);
        level.is_measured = true;
        if (!(level.scale > 0)) fail(node, "the measurements give no scale above 0");
    }

    const std::string& name_;
    Budget& work_;
    bool is_image_ = true;
};

Point2 inMetres(const RmfLevel& level, Point2 p) { return {level.scale * p.x, level.scale * p.y}; }

/// Lays a level on another by the fiducials of both: the rigid motion of least squares. A level
/// without measurements gets the scale at which they fit. \return false without common ones
bool align(RmfLevel& level, const RmfLevel& reference) {
    std::vector<std::pair<Point2, Point2>> pairs;
    for (const auto& [name, p] : level.fiducials)
        if (const auto other = reference.fiducials.find(name); other != reference.fiducials.end())
            pairs.emplace_back(p, inMetres(reference, other->second));
    if (pairs.empty()) return false;
    const auto count = static_cast<double>(pairs.size());
    Vec2 from, to;
    for (const auto& [a, b] : pairs) {
        from = from + 1 / count * (a - Point2());
        to = to + 1 / count * (b - Point2());
    }
    double along = 0, aside = 0, spread = 0, wanted = 0;
    for (const auto& [a, b] : pairs) {
        const Vec2 u = a - (Point2() + from), v = b - (Point2() + to);
        along += dot(u, v);
        aside += cross(u, v);
        spread += dot(u, u);
        wanted += dot(v, v);
    }
    if (!level.is_measured && spread > 0 && wanted > 0) {
        level.scale = std::sqrt(wanted / spread);
        level.is_measured = true;
    }
    const Angle heading = pairs.size() > 1 ? directionOf(along, aside) : Angle();
    const Vec2 turned = Pose2{{}, heading} * (level.scale * from);
    level.building_from_level = {Point2() + (to - turned), heading};
    return true;
}

/// Writes the room of a level: walls, with doors in the gaps between them.
std::shared_ptr<const Document> roomOf(const RmfLevel& level, const std::string& operand,
                                       ImportOptions options) {
    options.wall_layers = {kWalls};
    options.door_layers = {kDoors};
    options.window_layers.clear();
    options.snap = options.snap.value_or(kSnap);
    if (options.inside.empty()) options.rooms = RoomChoice::All;
    std::vector<PlanShape> shapes;
    const auto add = [&](const auto& edges, const char* layer) {
        for (const auto& [a, b] : edges) {
            const Segment2 line{inMetres(level, level.vertices[a]),
                                inMetres(level, level.vertices[b])};
            if (line.a == line.b) continue;
            shapes.push_back({{{line.a, line.b}, false, 0}, {{line, {}}}, layer});
        }
    };
    add(level.walls, kWalls);
    add(level.doors, kDoors);
    ImportRecords out(sceneSchemas(), operand, options);
    try {
        writeLinePlan(std::move(shapes), operand, options, out);
    } catch (const FormatError& error) {
        std::vector<Diagnostic> findings = error.diagnostics();
        for (Diagnostic& finding : findings)
            finding.message = "level " + level.name + ": " + finding.message;
        throw FormatError(std::move(findings));
    }
    if (level.models > 0)
        out.note(countText(level.models, "model") + " of level " + level.name + " left out");
    return std::make_shared<const Document>(out.take());
}

/// Writes a lift. \param ids of the storeys by level \return nullopt if it stops at one or none
std::optional<Record> liftOf(const RmfReader& reader, const YamlNode& lift, const std::string& id,
                             const std::vector<RmfLevel>& levels,
                             const std::map<std::string, std::string>& ids, const std::string& file,
                             std::vector<std::string>& notes) {
    std::string storeys;
    std::size_t stops = 0;
    std::string first_door;
    if (const YamlNode* const doors = member(lift, "level_doors"))
        for (std::size_t i = 0; i + 1 < doors->items.size(); i += 2) {
            const auto storey = ids.find(doors->items[i]->scalar);
            if (storey == ids.end() || doors->items[i + 1]->items.empty()) continue;
            storeys += (stops++ == 0 ? "" : ",") + storey->second;
            if (first_door.empty()) first_door = doors->items[i + 1]->items.front()->scalar;
        }
    if (stops < 2) {
        notes.push_back("lift " + id + " stops at fewer than two storeys and is left out");
        return std::nullopt;
    }
    const YamlNode* const reference = member(lift, "reference_floor_name");
    const auto level = std::find_if(levels.begin(), levels.end(), [&](const RmfLevel& one) {
        return reference != nullptr && one.name == reference->scalar;
    });
    const RmfLevel& on = level == levels.end() ? levels.front() : *level;
    const Point2 at =
        on.building_from_level *
        inMetres(on, reader.upright(reader.number(lift, "x"), reader.number(lift, "y")));
    const YamlNode* const yaw = member(lift, "yaw");
    Angle heading = on.building_from_level.heading +
                    (yaw == nullptr ? Angle() : Angle::radians(reader.number(*yaw)));
    double across = reader.number(lift, "width"), along = reader.number(lift, "depth");
    Record record(*buildingSchemas().find("lift"),
                  {std::make_shared<const std::string>(file), lift.line, lift.column});
    const YamlNode* const doors = member(lift, "doors");
    if (const YamlNode* const door = doors == nullptr ? nullptr : member(*doors, first_door)) {
        const double x = reader.number(*door, "x"), y = reader.number(*door, "y");
        record.set("door", reader.number(*door, "width"));
        if (doors->items.size() > 2)
            notes.push_back("lift " + id + " has several doors: it opens at " + first_door +
                            " alone");
        // Its width lies along x of the cabin.
        if (std::abs(x) > std::abs(y)) std::swap(across, along);
        heading = heading + directionOf(x, y);
    }
    record.set("id", id);
    record.set("storeys", storeys);
    record.set("at", Tuple{wholeMicrometres(at.x), wholeMicrometres(at.y)});
    record.set("heading", nineDecimals(heading.degrees()));
    record.set("size", Tuple{across, along});
    return record;
}

}  // namespace

bool isRmfSite(const YamlNode& top) {
    const YamlNode* const levels = member(top, "levels");
    if (levels == nullptr || levels->kind != YamlNode::Kind::Map) return false;
    for (std::size_t i = 0; i + 1 < levels->items.size(); i += 2)
        if (member(*levels->items[i + 1], "vertices") != nullptr) return true;
    return false;
}

StoreyedDocument readRmfSite(const YamlNode& top, const std::string& operand,
                             const ImportOptions& import, Budget& work) {
    ImportOptions options = import;
    options.max_work.whole = &work;
    const RmfReader reader(operand, top, work);
    const YamlNode& nodes = *member(top, "levels");
    std::vector<RmfLevel> levels;
    std::vector<std::string> notes;
    std::vector<Diagnostic> warnings;
    if (nodes.items.size() / 2 > kMaxStoreys)
        reader.fail(nodes, "more than " + std::to_string(kMaxStoreys) + " levels");
    for (std::size_t i = 0; i + 1 < nodes.items.size(); i += 2) {
        RmfLevel level = reader.level(nodes.items[i]->scalar, *nodes.items[i + 1]);
        if (level.walls.empty())
            notes.push_back("level " + level.name + " has no walls and is left out");
        else
            levels.push_back(std::move(level));
    }
    if (levels.empty()) reader.fail(nodes, "no level has walls");
    const YamlNode* const named = member(top, "reference_level_name");
    const auto found = std::find_if(levels.begin(), levels.end(), [&](const RmfLevel& level) {
        return named != nullptr && level.name == named->scalar;
    });
    const std::size_t first =
        found == levels.end() ? 0 : static_cast<std::size_t>(found - levels.begin());
    const auto warn = [&](const std::string& message) {
        warnings.push_back({displayName(operand), 0, 0, message, Severity::Warning});
    };
    for (std::size_t i = 0; i < levels.size(); ++i) {
        if (i != first && !align(levels[i], levels[first]))
            warn("levels " + levels[first].name + " and " + levels[i].name +
                 " have no fiducial in common: their origins are laid on each other");
        if (!levels[i].is_measured)
            warn("level " + levels[i].name + " has no measurement: a pixel is taken as " +
                 formatDouble(kDefaultScale) + " m");
    }
    ImportRecords names(sceneSchemas(), operand, options);
    std::map<std::string, std::string> ids;
    std::vector<StoreyInput> storeys;
    for (const RmfLevel& level : levels) {
        const std::string id = names.freeId(level.name, "storey");
        ids.emplace(level.name, id);
        Record record(*buildingSchemas().find("storey"));
        record.set("id", id);
        if (id != level.name) record.set("name", level.name);
        record.set("z", level.elevation);
        std::optional<double> above;
        for (const RmfLevel& other : levels)
            if (other.elevation > level.elevation && (!above || other.elevation < *above))
                above = other.elevation;
        if (above) record.set("height", wholeMicrometres(*above - level.elevation));
        const Pose2& frame = level.building_from_level;
        record.set("at",
                   Tuple{wholeMicrometres(frame.position.x), wholeMicrometres(frame.position.y)});
        record.set("heading", nineDecimals(frame.heading.degrees()));
        storeys.push_back({std::move(record), roomOf(level, operand, options)});
    }
    std::vector<Record> passages;
    if (const YamlNode* const lifts = member(top, "lifts"))
        for (std::size_t i = 0; i + 1 < lifts->items.size(); i += 2)
            if (auto lift = liftOf(reader, *lifts->items[i + 1],
                                   names.freeId(lifts->items[i]->scalar, "lift"), levels, ids,
                                   operand, notes))
                passages.push_back(*std::move(lift));
    StoreyedDocument building = makeBuilding(std::move(storeys), std::move(passages), operand);
    building.notes.insert(building.notes.begin(), notes.begin(), notes.end());
    building.warnings.insert(building.warnings.begin(), warnings.begin(), warnings.end());
    return building;
}

}  // namespace ispace
