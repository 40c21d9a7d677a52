// SPDX-License-Identifier: GPL-3.0-or-later
// Edits by whole ids: all records are gathered with their ids across the building, edited as one
// list, and split by storeys again. Ids that were automatic are left out again as far as the order
// still gives them.
#include "site/site_edit.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "record/text.h"
#include "scene/placement_schemas.h"
#include "site/building_schemas.h"

namespace ispace {

namespace {

/// The records of all rooms and the passages, with their ids across the building.
struct WholeRecords {
    std::vector<Record> records;
    std::set<std::string> automatic;  ///< ids of rooms' records that are not written
};

WholeRecords wholeRecords(const StoreyedDocument& building) {
    WholeRecords whole;
    for (const Storey& storey : building.storeys) {
        const std::vector<Record>& records = storey.room->records;
        const std::vector<std::string> ids = assignIds(records);
        for (std::size_t i = 0; i < records.size(); ++i) {
            if (records[i].schema().type == RecordType::Meta) continue;
            whole.records.push_back(inBuilding(storey, records[i], ids[i]));
            if (records[i].writtenId().empty()) whole.automatic.insert(wholeId(storey, ids[i]));
        }
    }
    for (const StoreyPassage& passage : building.passages) {
        whole.records.push_back(passage.record);
        whole.records.back().set("id", passage.id);
    }
    return whole;
}

/// Removes the ids that were automatic, as far as they follow from the order of the records.
void leaveOutIds(std::vector<Record>& records, const Storey& storey,
                 const std::set<std::string>& automatic) {
    const std::vector<std::string> ids = assignIds(records);
    for (std::size_t i = 0; i < records.size(); ++i)
        if (automatic.contains(wholeId(storey, ids[i]))) records[i].erase("id");
    constexpr int kPasses = 8;  // an id that is written shifts others
    for (int pass = 0; pass < kPasses; ++pass) {
        const std::vector<std::string> now = assignIds(records);
        if (now == ids) return;
        for (std::size_t i = 0; i < records.size(); ++i)
            if (now[i] != ids[i]) records[i].set("id", ids[i]);
    }
    for (std::size_t i = 0; i < records.size(); ++i) records[i].set("id", ids[i]);
}

/// Returns true if the edits of an only storey are about its room alone, by plain ids.
bool arePlain(const Storey& storey, std::span<const Edit> edits) {
    const std::vector<std::string> ids = assignIds(storey.room->records);
    return std::all_of(edits.begin(), edits.end(), [&](const Edit& edit) {
        if (edit.kind == Edit::Kind::Add || edit.kind == Edit::Kind::Fence)
            return edit.text.find("id=" + storey.id + '/') == std::string::npos;
        return std::any_of(ids.begin(), ids.end(),
                           [&](const std::string& id) { return edit.ids.matches(id); });
    });
}

}  // namespace

std::shared_ptr<const Scene> sceneOfSite(const SiteScene& building, std::size_t storey) {
    if (building.isRoomAlone()) return building.scenes[storey];
    const Scene& scene = *building.scenes[storey];
    std::vector<Record> records;
    for (std::size_t i = 0; i < scene.records.size(); ++i)
        records.push_back(
            inBuilding(building.document.storeys[storey], scene.records[i], scene.ids[i]));
    return std::make_shared<const Scene>(makeScene(std::move(records), scene, building.devices));
}

void editSite(StoreyedDocument& building, std::span<const Edit> edits) {
    if (edits.empty()) return;
    if (building.storeys.size() == 1 && arePlain(building.storeys.front(), edits)) {
        Document room = *building.storeys.front().room;
        room.records = edited(std::move(room.records), edits, sceneSchemas());
        building.storeys.front().room = std::make_shared<const Document>(std::move(room));
        return;
    }
    WholeRecords whole = wholeRecords(building);
    std::vector<Record> passages;
    Document rooms;
    for (Record& record : edited(std::move(whole.records), edits, sceneSchemas())) {
        const bool is_passage = buildingSchemas().find(record.keyword()) == &record.schema();
        (is_passage ? passages : rooms.records).push_back(std::move(record));
    }
    const std::vector<Document> changed = layoutsOf(rooms, building);
    std::vector<StoreyInput> storeys;
    for (std::size_t i = 0; i < building.storeys.size(); ++i) {
        Storey& storey = building.storeys[i];
        std::vector<Record> records = changed[i].records;
        leaveOutIds(records, storey, whole.automatic);
        if (records != storey.room->records) {
            Document room = *storey.room;
            room.records = std::move(records);
            storey.room = std::make_shared<const Document>(std::move(room));
        }
        storey.record.set("id", storey.id);
        storeys.push_back({storey.record, storey.room});
    }
    StoreyedDocument made = makeBuilding(std::move(storeys), std::move(passages), "");
    building.storeys = std::move(made.storeys);
    building.passages = std::move(made.passages);
}

}  // namespace ispace
