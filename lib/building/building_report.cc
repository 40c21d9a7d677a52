// SPDX-License-Identifier: GPL-3.0-or-later
// Measures and pictures of a building.
#include <algorithm>
#include <map>
#include <string>

#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"
#include "building/building_scene.h"
#include "building/building_sight.h"
#include "drawing/plan/plan.h"
#include "env/environment.h"
#include "scene/placement_schemas.h"

namespace ispace {

namespace {

/// Measures of the storeys, each room once, and their sums.
struct BuildingInfo {
    std::vector<EnvironmentInfo> storeys;
    Box2 limits;        // in the building
    double height = 0;  // from the lowest floor to the highest wall
    double indoor_area = 0, free_area = 0, perimeter = 0;
    std::size_t triangles = 0;
    std::map<std::string, int> counts;
};

BuildingInfo describe(const BuildingScene& building) {
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
        info.indoor_area += room->second.indoor_area;
        info.free_area += room->second.free_area;
        info.perimeter += room->second.perimeter;
        const Storey& storey = building.document.storeys[i];
        const Box2& box = room->second.limits;
        for (const Point2 corner :
             {box.low, Point2{box.high.x, box.low.y}, box.high, Point2{box.low.x, box.high.y}})
            info.limits.add(storey.building_from_storey * corner);
        info.height = std::max(info.height, storey.floor - building.document.storeys.front().floor +
                                                room->second.height);
        info.triangles += room->second.triangles;
        for (const auto& [keyword, count] : room->second.counts) info.counts[keyword] += count;
    }
    info.counts["storey"] = static_cast<int>(building.scenes.size());
    for (const StoreyPassage& passage : building.document.passages)
        ++info.counts[passage.record.keyword()];
    return info;
}

}  // namespace

std::string buildingInfoJson(const BuildingScene& building) {
    const BuildingInfo info = describe(building);
    JsonWriter json;
    beginReport(json, "ispace-building-info/1", "envc");
    json.key("digest").value(building.document.digest());
    json.key("storeys").beginArray();
    std::string text;
    for (std::size_t i = 0; i < building.scenes.size(); ++i) {
        const Storey& storey = building.document.storeys[i];
        json.beginObject().key("id").value(storey.id);
        json.key("z").value(roundSignificant(storey.floor));
        json.key("height").value(roundSignificant(building.height(i))).key("room");
        text += json.take() + infoJson(info.storeys[i]);
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
    json.endArray().key("limits").beginArray();
    for (const double limit :
         {info.limits.low.x, info.limits.low.y, info.limits.high.x, info.limits.high.y})
        json.value(roundSignificant(limit));
    json.endArray().key("indoor_area").value(roundSignificant(info.indoor_area));
    json.key("free_area").value(roundSignificant(info.free_area));
    json.key("height").value(roundSignificant(info.height));
    json.key("perimeter").value(roundSignificant(info.perimeter));
    json.key("counts").beginObject();
    for (const auto& [keyword, count] : info.counts) json.key(keyword).value(count);
    json.endObject().key("triangles").value(info.triangles).endObject();
    return text + json.take() + '\n';
}

std::string buildingInfoText(const BuildingScene& building) {
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
    text += "indoor area  " + formatFixed(info.indoor_area, 3) + " m2\n";
    text += "free area    " + formatFixed(info.free_area, 3) + " m2 at " +
            formatDouble(kScanHeight) + " m\n";
    text += "records     ";
    for (const auto& [keyword, count] : info.counts)
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
Scene withPassages(const BuildingScene& building, std::size_t i) {
    const Scene& scene = *building.scenes[i];
    std::vector<Record> records = scene.records;
    for (const StoreyPassage& passage : building.document.passages)
        if (std::find(passage.storeys.begin(), passage.storeys.end(), i) != passage.storeys.end() &&
            std::find(scene.ids.begin(), scene.ids.end(), passage.id) == scene.ids.end())
            records.push_back(footprintOn(building.document.storeys[i], passage));
    return makeScene(std::move(records), scene, building.devices);
}

}  // namespace

std::string drawBuilding(const BuildingScene& building, PictureFormat format, int width,
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
