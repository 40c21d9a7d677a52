// SPDX-License-Identifier: GPL-3.0-or-later
// All storeys of an IFC building.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/message.h"
#include "env/walls.h"
#include "extensions/ifc/ifc.h"
#include "extensions/ifc/ifc_import.h"
#include "io/import_records.h"
#include "scene/placement_schemas.h"
#include "site/building_schemas.h"
#include "site/site_scene.h"

namespace ispace::ifc {

namespace {

/// A flight may begin and end this far above or below the floors, metres: by a step or a slab; its
/// box may hold a handrail as high as this.
constexpr double kStep = 0.6, kHandrail = 1.5;
/// Boxes narrower or lower than this are railings and landings, metres.
constexpr double kNarrowestFlight = 0.5, kLowestFlight = 1.0;
/// Doors of a lift lie this far before its cabin, behind the wall of its shaft, or within it.
constexpr double kBeforeCabin = 0.8, kIntoCabin = 0.3;
/// Least cosine of the angle between a door and the front of its cabin.
constexpr double kFacing = 0.7;
constexpr std::size_t kSides = 4;  // of a cabin
/// Cabins drawn on several storeys that are nearer to each other are one lift.
constexpr double kSameShaft = 0.5;

/// Finds the highest storey whose floor lies at a height, or below it by a distance.
std::optional<std::size_t> floorAt(const StoreyedDocument& building, double height, double below) {
    for (std::size_t i = building.storeys.size(); i-- > 0;) {
        const double floor = building.storeys[i].floor;
        if (floor <= height + kStep && floor >= height - below) return i;
    }
    return std::nullopt;
}

/// Writes the stairs in a box, rising along a heading.
Record stairsOf(const StoreyedDocument& building, const BuildingBox& box, std::size_t below,
                std::size_t above, const std::string& id, bool turned) {
    const Vec2 up = turned ? -1 * box.along : box.along;
    const Point2 foot = box.center - box.length / 2 * up;
    Record record(*buildingSchemas().find("stairs"));
    record.set("id", id);
    record.set("storeys", building.storeys[below].id + ',' + building.storeys[above].id);
    record.set("at", Tuple{wholeMicrometres(foot.x), wholeMicrometres(foot.y)});
    record.set("heading", nineDecimals(directionOf(up.x, up.y).degrees()));
    record.set("size", Tuple{wholeMicrometres(box.width), wholeMicrometres(box.length)});
    return record;
}

/// Returns the number of findings about these stairs alone.
std::size_t faultsOf(SiteScene& building, const Record& stairs,
                     const std::vector<std::size_t>& storeys) {
    building.document.passages = {{stairs, "", storeys}};
    return checkBuilding(building).size();
}

/// Finds the flights between the storeys. The better of the two directions is that with fewer
/// findings.
std::vector<Record> flightsOf(const StoreyedDocument& building, const IfcStoreys& all,
                              ImportRecords& names) {
    std::vector<Record> flights;
    std::optional<SiteScene> scene;
    for (BuildingBox box : all.flights) {
        if (box.width > box.length) {
            std::swap(box.width, box.length);
            box.along = {-box.along.y, box.along.x};
        }
        const auto below = floorAt(building, box.bottom, kStep);
        const auto above = floorAt(building, box.top, kHandrail);
        if (box.width < kNarrowestFlight || box.top - box.bottom < kLowestFlight || !below ||
            !above || *below >= *above)
            continue;
        if (!scene) scene = makeSiteScene(building, {}, {});
        const std::string id = names.freeId("stairs", "stairs");
        const Record ahead = stairsOf(building, box, *below, *above, id, false);
        const Record back = stairsOf(building, box, *below, *above, id, true);
        const std::vector<std::size_t> storeys = {*below, *above};
        flights.push_back(
            faultsOf(*scene, back, storeys) < faultsOf(*scene, ahead, storeys) ? back : ahead);
    }
    return flights;
}

/// A door of a storey, between the points of its opening, in the building.
struct StoreyDoor {
    std::size_t storey = 0;
    Point2 from, to;
};

std::vector<StoreyDoor> doorsOf(const StoreyedDocument& building) {
    std::vector<StoreyDoor> doors;
    for (std::size_t i = 0; i < building.storeys.size(); ++i)
        for (const Record& record : building.storeys[i].room->records)
            if (record.keyword() == "door" && record.has("from") && record.has("to"))
                doors.push_back({i, pointOf(record.tuple("from")), pointOf(record.tuple("to"))});
    return doors;
}

/// The doors of a lift on one side of its cabin.
struct LiftSide {
    Vec2 out;                          // direction in which one leaves
    double across = 0, along = 0;      // size of the cabin
    double door = 0;                   // the narrowest of its doors
    std::vector<std::size_t> storeys;  // ascending
};

/// Returns the side of a cabin with the most doors before it; the first of equal ones.
LiftSide sideOf(const BuildingBox& cabin, const std::vector<StoreyDoor>& doors) {
    LiftSide best;
    for (std::size_t quarter = 0; quarter < kSides; ++quarter) {
        LiftSide side;
        side.out = quarter % 2 == 0 ? cabin.along : Vec2{-cabin.along.y, cabin.along.x};
        if (quarter >= 2) side.out = -1 * side.out;
        side.along = quarter % 2 == 0 ? cabin.length : cabin.width;
        side.across = quarter % 2 == 0 ? cabin.width : cabin.length;
        side.door = side.across;
        for (const StoreyDoor& door : doors) {
            const Vec2 way = door.from + 0.5 * (door.to - door.from) - cabin.center;
            const double gap = dot(way, side.out) - side.along / 2;
            if (gap < -kIntoCabin || gap > kBeforeCabin ||
                std::abs(cross(side.out, way)) > side.across / 2)
                continue;
            // Doors at right angles are those of the lobby.
            const double width = std::abs(cross(side.out, door.to - door.from));
            if (width < kFacing * length(door.to - door.from)) continue;
            side.door = std::min(side.door, width);
            if (side.storeys.empty() || side.storeys.back() != door.storey)
                side.storeys.push_back(door.storey);
        }
        if (side.storeys.size() > best.storeys.size() && side.door > 0) best = side;
    }
    return best;
}

/// Finds the lifts: transport elements, one above the other or as high as a shaft, that have doors
/// on two storeys or more. \param left_out counts the others
/// \throws FormatError if comparing them with all doors takes more than the budget
std::vector<Record> liftsOf(const StoreyedDocument& building, const IfcStoreys& all,
                            const std::string& operand, Budget& work, ImportRecords& names,
                            std::size_t& left_out) {
    const std::vector<StoreyDoor> doors = doorsOf(building);
    std::vector<Record> lifts;
    std::vector<Point2> known;
    for (const BuildingBox& box : all.lifts) {
        if (!work.take(kSides * (1 + doors.size()) + known.size()))
            throw FormatError({displayName(operand), 0, 0,
                               "lifts and doors of the building make " + work.excess()});
        if (std::any_of(known.begin(), known.end(),
                        [&](Point2 center) { return distance(center, box.center) < kSameShaft; }))
            continue;
        const LiftSide side = sideOf(box, doors);
        if (side.storeys.size() < 2) {
            ++left_out;
            continue;
        }
        known.push_back(box.center);
        std::string storeys;
        for (const std::size_t storey : side.storeys)
            storeys += (storeys.empty() ? "" : ",") + building.storeys[storey].id;
        Record record(*buildingSchemas().find("lift"));
        record.set("id", names.freeId("lift", "lift"));
        record.set("storeys", storeys);
        record.set("at", Tuple{wholeMicrometres(box.center.x), wholeMicrometres(box.center.y)});
        record.set("heading", nineDecimals(directionOf(side.out.x, side.out.y).degrees()));
        record.set("size", Tuple{wholeMicrometres(side.across), wholeMicrometres(side.along)});
        record.set("door", wholeMicrometres(side.door));
        lifts.push_back(std::move(record));
    }
    return lifts;
}

}  // namespace

StoreyedDocument readIfcBuilding(std::string_view bytes, const std::string& operand,
                                 const ImportOptions& options) {
    ImportOptions each = options;
    each.storey.clear();
    IfcStoreys all = readIfcStoreys(bytes, operand, each, sceneSchemas());
    ImportRecords names(sceneSchemas(), operand, options);
    std::vector<StoreyInput> storeys;
    for (std::size_t i = 0; i < all.storeys.size(); ++i) {
        IfcStorey& storey = all.storeys[i];
        Record record(*buildingSchemas().find("storey"));
        record.set("id", names.freeId(storey.name, "storey"));
        if (!storey.name.empty()) record.set("name", storey.name);
        record.set("z", wholeMicrometres(storey.elevation));
        if (i + 1 < all.storeys.size())
            record.set("height", wholeMicrometres(all.storeys[i + 1].elevation - storey.elevation));
        storeys.push_back(
            {std::move(record), std::make_shared<const Document>(std::move(storey.room))});
    }
    StoreyedDocument building = makeBuilding(std::move(storeys), {}, operand);
    std::vector<Record> passages = flightsOf(building, all, names);
    Budget work(bytes.size(), options.max_work);
    std::size_t left_out = 0;
    for (Record& lift : liftsOf(building, all, operand, work, names, left_out))
        passages.push_back(std::move(lift));
    if (!passages.empty()) {
        std::vector<StoreyInput> inputs;
        for (const Storey& storey : building.storeys)
            inputs.push_back({storey.record, storey.room});
        building = makeBuilding(std::move(inputs), std::move(passages), operand);
    }
    if (left_out > 0)
        all.notes.push_back(countText(left_out, "transport element") +
                            " left out: lifts have doors on two storeys or more");
    building.notes.insert(building.notes.begin(), all.notes.begin(), all.notes.end());
    return building;
}

}  // namespace ispace::ifc
