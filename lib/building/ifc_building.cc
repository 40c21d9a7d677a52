// SPDX-License-Identifier: GPL-3.0-or-later
// All storeys of an IFC building.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "building/building_imports.h"
#include "building/building_scene.h"
#include "building/building_schemas.h"
#include "io/ifc/ifc_import.h"
#include "io/import_records.h"
#include "scene/placement_schemas.h"

namespace ispace {

namespace {

/// A flight may begin and end this far above or below the floors, metres: by a step or a slab; its
/// box may hold a handrail as high as this.
constexpr double kStep = 0.6, kHandrail = 1.5;
/// Boxes narrower or lower than this are railings and landings, metres.
constexpr double kNarrowest = 0.5, kLowest = 1.0;

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
std::size_t faultsOf(BuildingScene& building, const Record& stairs,
                     const std::vector<std::size_t>& storeys) {
    building.document.passages = {{stairs, "", storeys}};
    return checkBuilding(building).size();
}

/// Finds the flights between the storeys. The better of the two directions is that with fewer
/// findings.
std::vector<Record> flightsOf(const StoreyedDocument& building, const IfcStoreys& all,
                              ImportRecords& names) {
    std::vector<Record> flights;
    std::optional<BuildingScene> scene;
    for (BuildingBox box : all.flights) {
        if (box.width > box.length) {
            std::swap(box.width, box.length);
            box.along = {-box.along.y, box.along.x};
        }
        const auto below = floorAt(building, box.bottom, kStep);
        const auto above = floorAt(building, box.top, kHandrail);
        if (box.width < kNarrowest || box.top - box.bottom < kLowest || !below || !above ||
            *below >= *above)
            continue;
        if (!scene) scene = makeBuildingScene(building, {}, {});
        const std::string id = names.freeId("stairs", "stairs");
        const Record ahead = stairsOf(building, box, *below, *above, id, false);
        const Record back = stairsOf(building, box, *below, *above, id, true);
        const std::vector<std::size_t> storeys = {*below, *above};
        flights.push_back(
            faultsOf(*scene, back, storeys) < faultsOf(*scene, ahead, storeys) ? back : ahead);
    }
    return flights;
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
    std::vector<Record> flights = flightsOf(building, all, names);
    if (!flights.empty()) {
        std::vector<StoreyInput> inputs;
        for (const Storey& storey : building.storeys)
            inputs.push_back({storey.record, storey.room});
        building = makeBuilding(std::move(inputs), std::move(flights), operand);
    }
    if (!all.lifts.empty())
        all.notes.push_back(countText(all.lifts.size(), "transport element") +
                            " left out: the file does not tell the doors of lifts");
    building.notes.insert(building.notes.begin(), all.notes.begin(), all.notes.end());
    building.warnings.insert(building.warnings.begin(), all.warnings.begin(), all.warnings.end());
    return building;
}

}  // namespace ispace
