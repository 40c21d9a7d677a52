// SPDX-License-Identifier: GPL-3.0-or-later
// Storeys of an IFC building: which of them is a room, which are a site. A confined program parses
// the file and cuts its geometry (module/building.h); here are boxes, sections and names alone.
#include "extensions/ifc/ifc_import.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "env/environment.h"
#include "extensions/ifc/ifc.h"
#include "extensions/ifc/ifc_zip.h"
#include "extensions/ifc/reader/building.h"
#include "extensions/ifc/reader/step_file.h"
#include "extensions/ifc/storey_import.h"
#include "extensions/ifc/storey_plan.h"
#include "geom/arrangement.h"
#include "geom/predicates.h"
#include "io/import_records.h"
#include "io/importers.h"
#include "io/plan/plan_rooms.h"
#include "io/unread.h"

namespace ispace::ifc {

namespace {

constexpr std::size_t kMaxListed = 40;
/// The id of an unnamed storey in a site.
constexpr const char* kStoreyId = "storey";

bool severalBuildings(const Building& building) {
    std::set<std::string> names;
    for (const BuildingStorey& storey : building.storeys) names.insert(storey.building);
    return names.size() > 1;
}

std::string nameOf(const BuildingStorey& storey, bool several_buildings) {
    const std::string name = storey.name.empty() ? "unnamed" : storey.name;
    return several_buildings ? storey.building + '/' + name : name;
}

/// The spaces of a storey; a part of another one has no area of its own.
std::vector<double> spaceAreas(const Building& building, std::size_t storey) {
    std::vector<double> areas;
    for (const BuildingSpace& space : building.spaces)
        if (space.storey == storey)
            areas.push_back(space.is_part ? 0 : areaOfSection(space.outline));
    return areas;
}

/// `2 "Level 1" at 0.00 m, 126.3 m2 in 10 spaces`
std::string describe(const Building& building, std::size_t i) {
    const std::vector<double> areas = spaceAreas(building, i);
    double sum = 0;
    for (const double area : areas) sum += area;
    return std::to_string(i + 1) + " \"" + nameOf(building.storeys[i], severalBuildings(building)) +
           "\" at " + formatFixed(building.storeys[i].elevation, 2) + " m, " +
           (areas.empty() ? "no spaces"
                          : areaText(sum) + " in " + countText(areas.size(), "space"));
}

std::string listOf(const Building& building, std::span<const std::size_t> storeys) {
    std::string list;
    for (const std::size_t i : storeys.first(std::min(storeys.size(), kMaxListed)))
        list.append(list.empty() ? "" : "; ").append(describe(building, i));
    if (storeys.size() > kMaxListed)
        list += "; and " + std::to_string(storeys.size() - kMaxListed) + " more";
    return list;
}

/// Lists all storeys, or all but one.
std::string listOf(const Building& building, std::optional<std::size_t> but = std::nullopt) {
    std::vector<std::size_t> storeys;
    for (std::size_t i = 0; i < building.storeys.size(); ++i)
        if (i != but) storeys.push_back(i);
    return listOf(building, storeys);
}

[[noreturn]] void refuse(const std::string& message) {
    throw FormatError(Diagnostic{"", 0, 0, message});
}

std::string lowerCase(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

/// Returns the storeys that become rooms of a site, from the lowest on: those with doors or spaces,
/// or all in a building without any, but for those that are level with a lower one.
std::vector<std::size_t> roomStoreys(const Building& building) {
    const bool any_rooms =
        std::any_of(building.storeys.begin(), building.storeys.end(),
                    [](const BuildingStorey& storey) { return storey.doors > 0; }) ||
        !building.spaces.empty();
    std::vector<bool> has_space(building.storeys.size(), false);
    for (const BuildingSpace& space : building.spaces)
        if (space.storey < has_space.size()) has_space[space.storey] = true;
    std::vector<std::size_t> rooms;
    for (std::size_t i = 0; i < building.storeys.size(); ++i) {
        const BuildingStorey& storey = building.storeys[i];
        const bool is_level =
            !rooms.empty() && !(storey.elevation > building.storeys[rooms.back()].elevation);
        if (!is_level && (!any_rooms || storey.doors > 0 || has_space[i])) rooms.push_back(i);
    }
    return rooms;
}

/// Finds the storey of an id in the site of the building, in any case.
std::optional<std::size_t> storeyOfId(const Building& building, const std::string& wanted) {
    std::map<std::string, int> numbers;
    std::set<std::string> ids;
    for (const std::size_t storey : roomStoreys(building)) {  // numbered as by freeId()
        std::string word = ImportRecords::idWord(building.storeys[storey].name);
        if (word.empty()) word = kStoreyId;
        std::string id = word;
        for (int& last = numbers.try_emplace(word, 1).first->second; !ids.insert(id).second;)
            id = word + '-' + std::to_string(++last);
        if (id == lowerCase(wanted)) return storey;
    }
    return std::nullopt;
}

std::size_t storeyCalled(const Building& building, const std::string& wanted) {
    std::vector<std::size_t> found;
    std::vector<std::string> known;
    const bool several = severalBuildings(building);
    for (std::size_t i = 0; i < building.storeys.size(); ++i) {
        const std::string whole = nameOf(building.storeys[i], several);
        known.push_back(whole);
        if (lowerCase(whole) == lowerCase(wanted) ||
            lowerCase(building.storeys[i].name) == lowerCase(wanted))
            found.push_back(i);
    }
    if (found.size() == 1) return found.front();
    if (const auto storey = storeyOfId(building, wanted)) return *storey;
    const auto number = parseInteger(wanted);
    if (found.empty() && number && *number >= 1 &&
        static_cast<std::size_t>(*number) <= building.storeys.size())
        return static_cast<std::size_t>(*number) - 1;
    refuse((found.empty()
                ? "the building has no storey " + excerpt(wanted) + didYouMean(wanted, known)
                : "several storeys are called " + excerpt(wanted) + ": choose one by its number") +
           "; its storeys: " + listOf(building));
}

/// Returns true if a line from the point crosses no wall of the storey.
bool seesOutside(const Building& building, std::uint64_t sections, Point2 from, Vec2 way) {
    constexpr double kFar = 1000;  // metres, longer than buildings
    const Segment2 ray{from, from + kFar * way};
    return std::none_of(building.walls.begin(), building.walls.end(),
                        [&](const BuildingWall& wall) {
                            if (wall.storey != sections) return false;
                            const Vec2 u = wall.box.length / 2 * wall.box.along;
                            const Vec2 v = wall.box.width / 2 * perpendicular(wall.box.along);
                            const Point2 c = wall.box.center;
                            return intersects(ray, {c - u - v, c + u + v}) ||
                                   intersects(ray, {c - u + v, c + u - v});
                        });
}

/// Computes for each storey whether one of its doors has a room on one side alone: a space, or in a
/// storey without spaces anything between walls.
std::vector<bool> storeysWithOuterDoors(const Building& building) {
    constexpr double kBeside = 0.3;  // metres from the door's box
    std::vector<bool> outer(building.storeys.size(), false);
    std::vector<std::vector<Region>> spaces(building.storeys.size());
    for (const BuildingSpace& space : building.spaces)
        for (Region& part : areaOf(space.outline)) spaces[space.storey].push_back(std::move(part));
    // Each door is compared with all walls or corners: of very many none decides.
    std::size_t tests = 200'000'000, each = 1 + building.walls.size();
    for (const std::vector<Region>& regions : spaces)
        for (const Region& region : regions) each += region.outline.size();
    for (const BuildingOpening& door : building.openings) {
        if (door.kind != BuildingOpening::Kind::Door || outer[door.storey]) continue;
        if (tests < each) return std::vector<bool>(building.storeys.size(), false);
        tests -= each;
        const BuildingBox& box = door.box;
        const Vec2 across = box.length >= box.width ? perpendicular(box.along) : box.along;
        const double off = std::min(box.length, box.width) / 2 + kBeside;
        const auto is_outside = [&](Vec2 way) {
            const Point2 beside = box.center + off * way;
            if (spaces[door.storey].empty())
                return seesOutside(building, storeyOfSections(building, door.storey), beside, way);
            return std::none_of(
                spaces[door.storey].begin(), spaces[door.storey].end(),
                [beside](const Region& space) { return space.locate(beside) != Side::Outside; });
        };
        outer[door.storey] = is_outside(across) != is_outside(-across);
    }
    return outer;
}

}  // namespace

double areaOfSection(const BuildingSection& section) { return totalArea(areaOf(section)); }

std::size_t chosenStorey(const Building& building, const ImportOptions& options) {
    const std::size_t count = building.storeys.size();
    if (lowerCase(options.storey) == "all" && count > 1)
        refuse("one storey is read here: choose it with --storey; the storeys: " +
               listOf(building));
    if (!options.storey.empty() && lowerCase(options.storey) != "all")
        return storeyCalled(building, options.storey);
    if (options.slice_walls)
        for (std::size_t i = count; i-- > 0;)
            if (building.storeys[i].elevation <= *options.slice_walls) return i;
    // The ground floor, and not the cellar: a storey with a door to the outside whose floor is near
    // to 0, else with any door.
    const std::vector<bool> outer = storeysWithOuterDoors(building);
    std::optional<std::size_t> ground;
    const auto off = [&](std::size_t i) {
        return std::pair(!outer[i], std::abs(building.storeys[i].elevation));
    };
    for (std::size_t i = 0; i < count; ++i)
        if (building.storeys[i].doors > 0 && (!ground || off(i) < off(*ground))) ground = i;
    if (ground) return *ground;
    for (std::size_t i = 0; i < count; ++i)
        if (!spaceAreas(building, i).empty()) return i;
    for (std::size_t i = 0; i < count; ++i)
        for (const BuildingWall& wall : building.walls)
            if (wall.storey == i) return i;
    return 0;
}

std::string storeyWord(const Building& building, std::size_t storey) {
    const bool several = severalBuildings(building);
    const std::string word = nameOf(building.storeys[storey], several);
    const auto is_called_so = [&](const BuildingStorey& other) {
        return lowerCase(nameOf(other, several)) == lowerCase(word);
    };
    const bool is_alone =
        std::count_if(building.storeys.begin(), building.storeys.end(), is_called_so) == 1;
    return is_alone && !building.storeys[storey].name.empty() ? word : std::to_string(storey + 1);
}

std::string storeysText(const Building& building, std::size_t chosen) {
    const BuildingStorey& storey = building.storeys[chosen];
    std::string text = "read storey " + describe(building, chosen) + ", " +
                       countText(storey.walls, "wall") + ", " + countText(storey.doors, "door") +
                       ", " + countText(storey.windows, "window");
    if (building.storeys.size() == 1) return text;
    return text + "; others: " + listOf(building, chosen) + "; --storey NAME chooses";
}

std::string unreadText(const Building& building) {
    std::string text;
    std::size_t all = 0;
    for (const auto& [type, count] : unreadKinds(building)) {
        text += (text.empty() ? "" : ", ") + type + " (" + std::to_string(count) + ')';
        all += count;
    }
    return countText(all, "part") + " of its geometry cannot be read: " + text;
}

namespace {

/// Moves a building in surveyors' coordinates to the origin, by whole metres.
std::optional<Vec2> movedHome(Building& building) {
    Box2 box;
    const auto each_point = [&](auto visit) {
        const auto section = [&](BuildingSection& cut) {
            for (BuildingSection::Part& part : cut.parts)
                for (auto* curves : {&part.curves, &part.removed})
                    for (Polygon& curve : *curves)
                        for (Point2& p : curve) visit(p);
            for (Polygon& sheet : cut.sheets)
                for (Point2& p : sheet) visit(p);
        };
        for (BuildingWall& wall : building.walls) {
            section(wall.section);
            visit(wall.box.center);
        }
        for (BuildingSpace& space : building.spaces) section(space.outline);
        for (BuildingOpening& opening : building.openings) visit(opening.box.center);
        for (BuildingThing& thing : building.things)
            for (BuildingBox& one : thing.boxes) visit(one.center);
    };
    each_point([&](const Point2& p) { box.add(p); });
    if (box.empty()) return std::nullopt;
    const auto way = wayFromSurvey(box.low);
    if (way) each_point([&](Point2& p) { p = p - *way; });
    return way;
}

/// Lists the rooms of the storeys that are not imported.
void listRooms(const Building& building, std::size_t first, std::size_t end,
               const std::string& operand, ImportOptions options, Budget& work,
               const Schemas& schemas) {
    if (options.found == nullptr || !options.found->all_storeys) return;
    std::vector<FoundRoom>& listed = options.found->rooms;
    for (std::size_t storey = first; storey < end; ++storey) {
        FoundRooms found;
        options.found = &found;
        options.report = nullptr;
        options.inside.clear();
        ImportRecords out(schemas, operand, options);
        out.setStorey(storeyWord(building, storey));
        try {
            writeStorey(building, storey, options, work, out);
        } catch (const FormatError&) {
            continue;  // neither walls nor spaces: it has no rooms
        }
        for (FoundRoom& room : found.rooms) {
            room.is_kept = false;
            room.floor.clear();
            listed.push_back(std::move(room));
        }
    }
}

}  // namespace

bool isIfc(std::string_view bytes) {
    if (isIfcZip(bytes)) return true;
    bytes = bytes.substr(0, 1 << 16);
    const std::size_t schema = bytes.find("FILE_SCHEMA");
    return beginsAsStep(bytes) && schema != std::string_view::npos &&
           bytes.substr(schema, bytes.find(';', schema) - schema).find("IFC") !=
               std::string_view::npos;
}

namespace {

Building wholeBuilding(std::string_view bytes, const std::string& operand,
                       const ImportOptions& options, Budget& work) {
    std::string unpacked;
    if (isIfcZip(bytes)) {
        unpacked = unzippedIfc(bytes, operand, work);
        work.grant(unpacked.size());
        bytes = unpacked;
        if (!beginsAsStep(bytes))
            failFile(operand, "a zip archive whose .ifc is no STEP file: export it as IFC-SPF");
    }
    if (bytes.find("END-ISO-10303-21") == std::string_view::npos)
        failFile(operand, "truncated: the building ends without `END-ISO-10303-21;`");
    return readBuildingInChild(bytes, operand, options.slice_walls, work);
}

/// Warns of geometry of this storey that was not read, see io/unread.h. \param is_first it has that
/// of products without a storey, too
void warnOfUnread(const Building& building, std::size_t storey, bool is_first,
                  std::span<const PlanRegion> rooms, ImportRecords& out) {
    std::vector<UnreadThing> things;
    for (const BuildingUnread& part : building.unread) {
        if (part.storey == BuildingUnread::kNoStorey ? !is_first : part.storey != storey) continue;
        UnreadThing& thing = things.emplace_back(UnreadThing{part.kind});
        thing.owner = printable(part.owner);
        if (part.has_place) thing.at = part.at;
    }
    warnOfUnread(
        things, rooms,
        "export it with solids that are extruded, or with meshes (IFC4 Reference View), or "
        "draw what is missing with --add",
        out);
}

/// Returns the boxes of all things of these types.
std::vector<BuildingBox> boxesOf(const Building& building,
                                 std::initializer_list<std::string_view> types) {
    std::vector<BuildingBox> boxes;
    for (const BuildingThing& thing : building.things)
        if (std::find(types.begin(), types.end(), thing.type) != types.end())
            boxes.insert(boxes.end(), thing.boxes.begin(), thing.boxes.end());
    return boxes;
}

}  // namespace

IfcStoreys readIfcStoreys(std::string_view bytes, const std::string& operand,
                          const ImportOptions& options, const Schemas& schemas) {
    Budget work(bytes.size(), options.max_work);
    Building building = wholeBuilding(bytes, operand, options, work);
    IfcStoreys all;
    std::vector<std::size_t> left_out;
    if (const auto moved = movedHome(building)) all.notes.push_back(surveyText(*moved, "building"));
    if (options.report != nullptr) options.report->has_storeys = true;
    const std::vector<std::size_t> rooms = roomStoreys(building);
    for (std::size_t i = 0; i < building.storeys.size(); ++i) {
        const BuildingStorey& storey = building.storeys[i];
        if (!std::binary_search(rooms.begin(), rooms.end(), i)) {
            left_out.push_back(i);
            continue;
        }
        ImportRecords out(schemas, operand, options);
        out.setStorey(storeyWord(building, i));
        const bool is_first = all.storeys.empty();
        withFileName(operand, [&] {
            warnOfUnread(building, i, is_first, writeStorey(building, i, options, work, out), out);
        });
        all.storeys.push_back({storey.name, storey.elevation, out.take()});
    }
    if (all.storeys.empty()) failFile(operand, "no storey has walls or spaces");
    std::string sentence =
        "read " + countText(rooms.size(), "storey") + ": " + listOf(building, rooms);
    if (!left_out.empty()) sentence += "; left out: " + listOf(building, left_out);
    sentence += "; --storey NAME chooses";
    if (options.report != nullptr)
        options.report->addChoice(operand, sentence);
    else
        all.notes.push_back(std::move(sentence));
    all.flights = boxesOf(building, {"IFCSTAIR", "IFCSTAIRFLIGHT"});
    all.lifts = boxesOf(building, {"IFCTRANSPORTELEMENT"});
    return all;
}

Document readIfc(std::string_view bytes, const std::string& operand, const ImportOptions& options,
                 const Schemas& schemas) {
    Budget work(bytes.size(), options.max_work);
    Building building = wholeBuilding(bytes, operand, options, work);
    ImportRecords out(schemas, operand, options);
    withFileName(operand, [&] {
        const auto moved = movedHome(building);
        const std::size_t storey = chosenStorey(building, options);
        out.report(storeysText(building, storey));
        if (options.report != nullptr) options.report->has_storeys = true;
        if (moved) out.report(surveyText(*moved, "building"));
        listRooms(building, 0, storey, operand, options, work, schemas);
        out.setStorey(storeyWord(building, storey));
        warnOfUnread(building, storey, true, writeStorey(building, storey, options, work, out),
                     out);
        listRooms(building, storey + 1, building.storeys.size(), operand, options, work, schemas);
    });
    return out.take();
}

}  // namespace ispace::ifc
