// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/world_editor.h"

#include <fnmatch.h>

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "base/error.h"
#include "layout/schemas.h"

namespace ispace {

namespace {

bool matches(const Edit& edit, const std::string& id) {
    return edit.ids == id || ::fnmatch(edit.ids.c_str(), id.c_str(), 0) == 0;
}

/// True if the edit says anew where what it names is.
bool places(const Edit& edit, const Record& record) {
    if (edit.kind != Edit::Kind::Set) return false;
    const KeySpec* const key = record.schema().find(edit.key);
    return key != nullptr && (key->role == Role::Place || key->role == Role::Heading);
}

const char* fileKeyOf(const Record& record) {
    for (const KeySpec& key : record.schema().keys)
        if (key.role == Role::File && record.has(key.name)) return key.name.c_str();
    return nullptr;
}

}  // namespace

WorldEditor::WorldEditor(Simulation& simulation, std::shared_ptr<const SceneSource> source)
    : simulation_(&simulation), source_(std::move(source)), start_(simulation.world().scene()) {}

bool WorldEditor::finds(const Edit& edit) const {
    const auto& ids = simulation_->world().scene().ids;
    return std::any_of(ids.begin(), ids.end(),
                       [&](const std::string& id) { return matches(edit, id); });
}

std::vector<std::string> WorldEditor::moversOf(const Edit& edit) const {
    std::vector<std::string> ids;
    for (const Mover& mover : simulation_->world().movers())
        if (matches(edit, mover.id)) ids.push_back(mover.id);
    return ids;
}

std::vector<Record> WorldEditor::edited(const std::vector<Edit>& edits) const {
    const World& world = simulation_->world();
    const Scene& scene = world.scene();
    std::vector<Record> records = scene.records;
    std::unordered_map<std::string, Record> with_files;
    for (std::size_t i = 0; i < records.size(); ++i) {
        if (fileKeyOf(records[i]) != nullptr) with_files.emplace(scene.ids[i], records[i]);
        const auto mover = world.moverNamed(scene.ids[i]);
        if (!mover) continue;
        const auto moves = [&](const Edit& edit) {
            return places(edit, records[i]) && matches(edit, scene.ids[i]);
        };
        if (std::none_of(edits.begin(), edits.end(), moves)) continue;
        const Pose2 pose = world.status(*mover).pose;
        records[i].set("at", Tuple{pose.position.x, pose.position.y});
        records[i].set("heading", pose.heading.degrees());
    }
    records = ispace::edited(std::move(records), edits, sceneSchemas());
    if (records.size() > kMaxRecords)
        throw FormatError(Diagnostic{
            "", 0, 0, "a world has at most " + std::to_string(kMaxRecords) + " records"});
    const std::vector<std::string> ids = assignIds(records);
    for (std::size_t i = 0; i < records.size(); ++i) {
        if (fileKeyOf(records[i]) == nullptr) continue;
        const auto before = with_files.find(ids[i]);
        if (before == with_files.end() || !(before->second == records[i]))
            source_->loadFilesOf(records[i]);
    }
    return records;
}

void WorldEditor::adopt(std::vector<Record> records, const std::vector<Edit>& edits) {
    World& world = simulation_->world();
    std::vector<std::string> placed;
    for (const Edit& edit : edits) {
        if (edit.kind != Edit::Kind::Set) continue;
        const Scene& scene = world.scene();
        for (std::size_t i = 0; i < scene.ids.size(); ++i)
            if (matches(edit, scene.ids[i]) && places(edit, scene.records[i]))
                placed.push_back(scene.ids[i]);
    }
    world.change(makeScene(std::move(records), world.scene(), source_->devices()), placed);
}

void WorldEditor::load(const std::string& environment, const std::string& layout) {
    Scene scene = source_->load(environment, layout);
    simulation_->world().restart(scene);
    start_ = std::move(scene);
}

void WorldEditor::reset() { simulation_->world().restart(start_); }

}  // namespace ispace
