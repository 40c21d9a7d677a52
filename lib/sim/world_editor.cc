// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/world_editor.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "base/error.h"
#include "layout/scene_edit.h"

namespace ispace {

WorldEditor::WorldEditor(Simulation& simulation, std::shared_ptr<const SceneSource> source)
    : simulation_(&simulation), source_(std::move(source)), start_(simulation.world().scene()) {}

bool WorldEditor::finds(const Edit& edit) const {
    const auto& ids = simulation_->world().scene().ids;
    return std::any_of(ids.begin(), ids.end(),
                       [&](const std::string& id) { return isAbout(edit, id); });
}

std::vector<std::string> WorldEditor::moversOf(const Edit& edit) const {
    std::vector<std::string> ids;
    for (const Mover& mover : simulation_->world().movers())
        if (isAbout(edit, mover.id)) ids.push_back(mover.id);
    return ids;
}

std::vector<Record> WorldEditor::edited(const std::vector<Edit>& edits) const {
    const World& world = simulation_->world();
    const Scene& scene = world.scene();
    std::unordered_map<std::string, Record> with_files;
    for (std::size_t i = 0; i < scene.records.size(); ++i)
        if (fileKeyOf(scene.records[i]) != nullptr)
            with_files.emplace(scene.ids[i], scene.records[i]);
    std::vector<Record> records = editedRecords(scene, edits, [&world](const std::string& id) {
        const auto mover = world.moverNamed(id);
        return mover ? std::optional(world.status(*mover).pose) : std::nullopt;
    });
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
    const std::vector<std::string> placed = placedBy(edits, world.scene());
    world.change(makeScene(std::move(records), world.scene(), source_->devices()), placed);
}

void WorldEditor::load(const std::string& environment, const std::string& layout) {
    Scene scene = source_->load(environment, layout);
    simulation_->world().restart(scene);
    start_ = std::move(scene);
}

void WorldEditor::reset() { simulation_->world().restart(start_); }

}  // namespace ispace
