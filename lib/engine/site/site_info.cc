// SPDX-License-Identifier: GPL-3.0-or-later
// Measures and pictures of a building.
#include <algorithm>
#include <map>
#include <string>

#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"
#include "drawing/plan/plan.h"
#include "env/environment.h"
#include "env/room_info.h"
#include "scene/placement_schemas.h"
#include "site/site_scene.h"
#include "site/site_sight.h"

namespace ispace {

namespace {

/// Measures of the storeys, each room once, and their sums.
struct BuildingInfo {
    std::vector<EnvironmentInfo> storeys;
    EnvironmentInfo sum;  // limits: in the building; height: from the lowest floor
};

EnvironmentInfo infoOfRoom(const SiteScene& alone) {
    const Scene& scene = *alone.scenes.front();
    return describe(scene.environment, scene.records, scene.digest());
}

BuildingInfo describe(const SiteScene& building) {
    BuildingInfo info;
    std::map<const Scene*, EnvironmentInfo> known;
    const auto floors = Coupling(building).floors();
    for (std::size_t i = 0; i < building.scenes.size(); ++i) {
        const Scene& scene = *building.scenes[i];
        const auto [room, is_new] = known.try_emplace(floors[i].get());
        if (is_new) {
            room->second = describe(scene.environment, scene.records, scene.digest());
            if (floors[i] != building.scenes[i]) {
                const EnvironmentInfo floor =
                    describe(floors[i]->environment, scene.records, scene.digest());
                room->second.indoor_area = floor.indoor_area;
                room->second.free_area = floor.free_area;
                room->second.perimeter = floor.perimeter;
            }
        }
        info.storeys.push_back(room->second);
        info.sum.indoor_area += room->second.indoor_area;
        info.sum.free_area += room->second.free_area;
        info.sum.perimeter += room->second.perimeter;
        const Storey& storey = building.document.storeys[i];
        const Box2& box = room->second.limits;
        for (const Point2 corner :
             {box.low, Point2{box.high.x, box.low.y}, box.high, Point2{box.low.x, box.high.y}})
            info.sum.limits.add(storey.building_from_storey * corner);
        info.sum.height =
            std::max(info.sum.height,
                     storey.floor - building.document.storeys.front().floor + room->second.height);
        info.sum.triangles += room->second.triangles;
        for (const auto& [keyword, count] : room->second.counts) info.sum.counts[keyword] += count;
    }
    info.sum.counts["storey"] = static_cast<int>(building.scenes.size());
    for (const StoreyPassage& passage : building.document.passages)
        ++info.sum.counts[passage.record.keyword()];
    return info;
}

}  // namespace

std::string siteInfoJson(const SiteScene& building) {
    if (building.isRoomAlone()) return infoJson(infoOfRoom(building));
    const BuildingInfo info = describe(building);
    std::vector<RoomInfo> rooms;
    for (std::size_t i = 0; i < info.storeys.size(); ++i) {
        const Storey& storey = building.document.storeys[i];
        rooms.push_back({storey.id, storey.floor, building.height(i), &info.storeys[i]});
    }
    JsonWriter json;
    beginReport(json, "ispace-info/1", "envc");
    json.key("digest").value(building.document.digest());
    writeRooms(json, rooms);
    json.key("storeys").beginArray();
    std::string text;
    for (const auto& [id, z, height, room] : rooms) {
        json.beginObject().key("id").value(id).key("z").value(roundSignificant(z));
        json.key("height").value(roundSignificant(height)).key("room");
        text += json.take() + storeyInfoJson(*room);
        text.pop_back();  // its newline
        json.endObject();
    }
    json.endArray().key("passages").beginArray();
    for (const StoreyPassage& passage : building.document.passages) {
        json.beginObject().key("id").value(passage.id);
        json.key("keyword").value(passage.record.keyword()).key("storeys").beginArray();
        for (const std::size_t i : passage.storeys) json.value(building.document.storeys[i].id);
        json.endArray().endObject();
    }
    json.endArray();
    writeMeasures(json, info.sum);
    json.endObject();
    return text + json.take() + '\n';
}

std::string siteInfoText(const SiteScene& building) {
    if (building.isRoomAlone()) return infoText(infoOfRoom(building));
    const BuildingInfo info = describe(building);
    std::string text;
    for (std::size_t i = 0; i < building.scenes.size(); ++i) {
        const Storey& storey = building.document.storeys[i];
        text += "storey " + storey.id + " from " + formatFixed(storey.floor, 3) + " m to " +
                formatFixed(storey.floor + building.height(i), 3) + " m\n" +
                infoText(info.storeys[i]) + '\n';
    }
    text += "building of " + std::to_string(building.scenes.size()) +
            (building.scenes.size() == 1 ? " storey\n" : " storeys\n");
    text += "digest       " + building.document.digest() + '\n';
    text += "indoor area  " + formatFixed(info.sum.indoor_area, 3) + " m2\n";
    text += "free area    " + formatFixed(info.sum.free_area, 3) + " m2 at " +
            formatDouble(kScanHeight) + " m\n";
    text += "records     ";
    for (const auto& [keyword, count] : info.sum.counts)
        text += ' ' + keyword + ' ' + std::to_string(count) + ',';
    text.back() = '\n';
    for (const StoreyPassage& passage : building.document.passages) {
        text += passage.record.keyword() + ' ' + passage.id + ' ';
        for (const std::size_t i : passage.storeys)
            text += (i == passage.storeys.front() ? " " : ", ") + building.document.storeys[i].id;
        text += '\n';
    }
    return text;
}

Picture panelsOf(const std::vector<Picture>& pictures) {
    double width = 0, height = 0;
    for (const Picture& picture : pictures) {
        width = std::max(width, picture.width());
        height += picture.height();
    }
    // Many storeys on one page: all panels become smaller.
    const double scale = std::min(1.0, Picture::kMaxSide / std::max(width, height));
    Picture page(std::max(1.0, scale * width), std::max(1.0, scale * height),
                 pictures.front().unit());
    double top = 0;
    for (auto picture = pictures.rbegin(); picture != pictures.rend(); ++picture) {
        page.inset(*picture, {0, top}, scale);
        top += scale * picture->height();
    }
    return page;
}

namespace {

/// Returns the footprint of a passage on a storey as a zone, which plans draw with its id.
Record footprintOn(const Storey& storey, const StoreyPassage& passage) {
    Record zone(*sceneSchemas().find("zone"));
    zone.set("id", passage.id);
    TupleList path;
    for (const Point2 corner : footprintOf(passage, storey)) path.push_back({corner.x, corner.y});
    zone.set("path", path);
    return zone;
}

/// Returns the scene of a storey with the footprints of what joins it to others.
Scene withPassages(const SiteScene& building, std::size_t i) {
    const Scene& scene = *building.scenes[i];
    std::vector<Record> records = scene.records;
    for (const StoreyPassage& passage : building.document.passages)
        if (std::find(passage.storeys.begin(), passage.storeys.end(), i) != passage.storeys.end() &&
            std::find(scene.ids.begin(), scene.ids.end(), passage.id) == scene.ids.end())
            records.push_back(footprintOn(building.document.storeys[i], passage));
    return makeScene(std::move(records), scene, building.devices);
}

}  // namespace

std::string drawSite(const SiteScene& building, PictureFormat format, int width,
                     const std::string& title) {
    std::vector<Picture> panels;
    for (std::size_t i = 0; i < building.scenes.size(); ++i)
        panels.push_back(
            planPicture(withPassages(building, i),
                        {format,
                         {},
                         width,
                         (title.empty() ? "" : title + ", ") + building.document.storeys[i].id,
                         nullptr}));
    Picture page = panelsOf(panels);
    page.describe(
        title.empty() ? "building" : title,
        "The plans of its storeys, the lowest at the bottom: " + building.document.storeyList());
    return page.write(format);
}

}  // namespace ispace
