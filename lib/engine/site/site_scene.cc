// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes of storeys, and ids across a building. Storeys that share a document share a scene, but
// for those to which a layout adds records.
#include "site/site_scene.h"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "base/message.h"
#include "env/body_shapes.h"
#include "env/walls.h"
#include "io/glb/glb_write.h"
#include "scene/placement_schemas.h"
#include "site/building_schemas.h"

namespace ispace {

namespace {

bool isMoverRecord(const Record& record) {
    return record.keyword() == "robot" || record.keyword() == "human";
}

bool refers(const KeySpec& key) { return key.role == Role::Carrier || key.role == Role::Reference; }

/// Returns the record with `change` applied to its id and to the ids that it refers to.
template <typename Change>
Record withIds(Record record, const std::string& id, Change change) {
    record.set("id", change(id));
    for (const KeySpec& key : record.schema().keys)
        if (refers(key) && record.has(key.name))
            record.set(key.name, change(record.text(key.name)), record.keyPlace(key.name));
    return record;
}

}  // namespace

double SiteScene::height(std::size_t storey) const {
    return document.storeys[storey].height.value_or(scenes[storey]->environment.height());
}

SiteScene roomAlone(Document room, std::shared_ptr<const Scene> scene,
                    const DeviceCatalogue& devices) {
    StoreyedDocument document;
    document.storeys.push_back(Storey{Record(*buildingSchemas().find("storey")),
                                      "",
                                      {},
                                      0,
                                      {},
                                      std::make_shared<const Document>(std::move(room))});
    return {std::move(document), {std::move(scene)}, devices};
}

Point2 inStorey(const Storey& storey, Point2 p) {
    const Pose2& frame = storey.building_from_storey;
    const Frame3 axes({{frame.position.x, frame.position.y, 0}, frame.heading, {}, {}});
    const Vec3 local = axes.toLocal({p.x, p.y, 0});
    return {local.x, local.y};
}

Polygon footprintOf(const StoreyPassage& passage, const Storey& storey) {
    const Record& record = passage.record;
    Polygon outline;
    if (record.keyword() == "shaft") {
        for (const Tuple& corner : record.list("path")) outline.push_back(pointOf(corner));
    } else {
        const Pose2 frame{pointOf(record.tuple("at")), record.angle("heading")};
        const double width = record.tuple("size")[0], length = record.tuple("size")[1];
        // Stairs begin at their place, lifts lie about it.
        const double back = record.keyword() == "stairs" ? 0 : -length / 2;
        outline = {frame * Point2{back, -width / 2}, frame * Point2{back + length, -width / 2},
                   frame * Point2{back + length, width / 2}, frame * Point2{back, width / 2}};
    }
    for (Point2& corner : outline) corner = inStorey(storey, corner);
    return outline;
}

std::vector<Document> layoutsOf(const Document& layout, const StoreyedDocument& building) {
    std::vector<Document> layouts(building.storeys.size());
    for (Document& one : layouts) one.kind = DocumentKind::Layout;
    Diagnostics findings;
    for (const Record& record : layout.records) {
        if (record.schema().type == RecordType::Meta) continue;
        const std::string id = record.writtenId();
        const auto storey =
            std::find_if(building.storeys.begin(), building.storeys.end(),
                         [&](const Storey& one) { return id.starts_with(one.id + '/'); });
        if (storey == building.storeys.end()) {
            findings.add(record.finding(
                "id", (id.empty() ? record.keyword() + " has no id" : excerpt(id)) +
                          ", wanted one that begins with its storey, such as `" +
                          building.storeys.front().id + '/' + (id.empty() ? "l1" : id) +
                          "`; storeys: " + building.storeyList()));
            continue;
        }
        const std::string prefix = storey->id + '/';
        const auto plain = [&](const std::string& whole) {
            return whole.starts_with(prefix) ? whole.substr(prefix.size()) : whole;
        };
        layouts[static_cast<std::size_t>(storey - building.storeys.begin())].records.push_back(
            withIds(record, id, plain));
    }
    findings.throwIfAny();
    return layouts;
}

Record inBuilding(const Storey& storey, Record record, const std::string& id) {
    return withIds(std::move(record), id,
                   [&](const std::string& plain) { return wholeId(storey, plain); });
}

std::shared_ptr<const Scene> sceneWithWholeIds(const SiteScene& building, std::size_t storey) {
    const std::shared_ptr<const Scene>& scene = building.scenes[storey];
    if (building.isRoomAlone()) return scene;
    return sceneWithWholeIds(scene, building.document.storeys[storey], building.devices);
}

std::shared_ptr<const Scene> sceneWithWholeIds(const std::shared_ptr<const Scene>& scene,
                                               const Storey& home, const DeviceCatalogue& devices) {
    if (scene->robots.empty() && scene->people.empty()) return scene;
    std::set<std::string_view> movers;
    for (std::size_t i = 0; i < scene->records.size(); ++i)
        if (isMoverRecord(scene->records[i])) movers.insert(scene->ids[i]);
    std::vector<Record> records = scene->records;
    for (std::size_t i = 0; i < records.size(); ++i) {
        const bool is_carried = records[i].schema().type == RecordType::Placement &&
                                movers.contains(carrierOf(records[i]));
        if (isMoverRecord(records[i]) || is_carried)
            records[i] = inBuilding(home, records[i], scene->ids[i]);
        // A thing in a hand stays one of its storey.
        else if (const std::string person = personWith(records[i]); movers.contains(person))
            records[i].set(carriedKey(), wholeId(home, person));
    }
    return std::make_shared<const Scene>(makeScene(std::move(records), *scene, devices));
}

SiteScene makeSiteScene(StoreyedDocument document, const std::vector<Document>& layouts,
                        const DeviceCatalogue& devices) {
    SiteScene building{std::move(document), {}, devices};
    std::map<const Document*, std::shared_ptr<const Scene>> bare;
    for (std::size_t i = 0; i < building.document.storeys.size(); ++i) {
        const Document& room = *building.document.storeys[i].room;
        const bool has_layout = !layouts.empty() && !layouts[i].records.empty();
        // A person of the layout may carry a thing of the room, which is no scene without it.
        if (has_layout && std::any_of(room.records.begin(), room.records.end(),
                                      [](const Record& one) { return !personWith(one).empty(); })) {
            building.scenes.push_back(
                std::make_shared<const Scene>(makeScene(room, &layouts[i], devices)));
            continue;
        }
        auto& plain = bare[&room];
        if (plain == nullptr)
            plain = std::make_shared<const Scene>(makeScene(room, nullptr, devices));
        building.scenes.push_back(has_layout ? std::make_shared<const Scene>(makeScene(
                                                   room, &layouts[i], devices, plain.get()))
                                             : plain);
    }
    return building;
}

void writeSiteGlb(const SiteScene& building, const ByteSink& sink) {
    std::vector<GlbPart> parts;
    for (std::size_t i = 0; i < building.scenes.size(); ++i) {
        const Storey& storey = building.document.storeys[i];
        const Point2 at = storey.building_from_storey.position;
        parts.push_back({storey.id,
                         "storey",
                         {{at.x, at.y, storey.floor}, storey.building_from_storey.heading, {}, {}},
                         building.scenes[i].get()});
    }
    writeGlb(parts, writeBuildingYaml(building.document, true), "building", sink);
}

}  // namespace ispace
