// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "env/info.h"
#include "io/ifc/building_process.h"
#include "io/ifc/storey_choice.h"
#include "io/ifc/storey_import.h"
#include "io/importers.h"

namespace ispace {

namespace {

constexpr double kFarOut = 100'000;  // metres: surveyors' coordinates
/// Moves a building that stands in surveyors' coordinates to the origin, by whole metres.
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
    const Point2 low{std::floor(box.low.x), std::floor(box.low.y)};
    if (std::max(std::abs(low.x), std::abs(low.y)) < kFarOut) return std::nullopt;
    each_point([&](Point2& p) { p = p - (low - Point2{}); });
    return low - Point2{};
}

std::string unreadText(const Building& building) {
    std::string text;
    std::size_t all = 0;
    for (const auto& [type, count] : building.unread) {
        text += (text.empty() ? "" : ", ") + type + " (" + std::to_string(count) + ')';
        all += count;
    }
    return countText(all, "part") + " of its geometry cannot be read: " + text;
}

/// Lists the rooms of storeys that are not read.
void listRooms(const Building& building, std::size_t first, std::size_t end,
               const std::string& operand, ImportOptions options, const Schemas& schemas) {
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
            writeStorey(building, storey, options, out);
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
    bytes = bytes.substr(0, 1 << 16);
    const std::size_t schema = bytes.find("FILE_SCHEMA");
    return bytes.starts_with("ISO-10303-21") && schema != std::string_view::npos &&
           bytes.substr(schema, bytes.find(';', schema) - schema).find("IFC") !=
               std::string_view::npos;
}

Document readIfc(std::string_view bytes, const std::string& operand, const ImportOptions& options,
                 const Schemas& schemas) {
    if (bytes.find("END-ISO-10303-21") == std::string_view::npos)
        failFile(operand, "truncated: the building ends without `END-ISO-10303-21;`");
    Building building = readBuildingInChild(bytes, operand, options.slice_walls);
    ImportRecords out(schemas, operand, options);
    withFileName(operand, [&] {
        const auto moved = movedHome(building);
        const std::size_t storey = chosenStorey(building, options);
        out.tell(storeysText(building, storey));
        if (options.report != nullptr) options.report->has_storeys = true;
        if (moved)
            out.tell("moved by " + placeText(Point2{} - *moved) +
                     " m: the building stands in surveyors' coordinates");
        if (!building.unread.empty()) out.warn(unreadText(building));
        listRooms(building, 0, storey, operand, options, schemas);
        out.setStorey(storeyWord(building, storey));
        writeStorey(building, storey, options, out);
        listRooms(building, storey + 1, building.storeys.size(), operand, options, schemas);
    });
    return out.take();
}

}  // namespace ispace
