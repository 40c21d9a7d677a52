// SPDX-License-Identifier: GPL-3.0-or-later
#include "building/building_suggestions.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>

#include "building/building_edit.h"
#include "building/building_sight.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "trace/ray_world.h"

namespace ispace {

namespace {

/// Least gain of a suggestion, and greatest loss of one that saves a sensor, as shares of the
/// storey's indoor floor, as in suggestChanges().
constexpr double kMinGain = 1e-3, kMaxLoss = 0.01;
constexpr std::size_t kKinds = 7;  // of suggestions, but for Together one of each a storey

double seenShare(const BuildingCoverage& coverage) {
    return coverage.coverage.exact.value_or(coverage.coverage.grid.value_or(0));
}

/// Gives the sensor that a suggestion adds an id.
void nameAdded(Suggestion& suggestion, const Storey& storey, const std::vector<std::string>& ids) {
    Record added = readRecord(suggestion.edits.front().text, "", sceneSchemas());
    std::string id;
    for (std::size_t n = 1; id.empty() || std::find(ids.begin(), ids.end(), id) != ids.end(); ++n)
        id = wholeId(storey, added.keyword() + std::to_string(n));
    added.set("id", id);
    suggestion.edits.front() = parseEdit(Edit::Kind::Add, formatRecord(added));
    suggestion.text += " on " + storey.id;
}

}  // namespace

std::vector<std::shared_ptr<const Scene>> wholeScenes(const BuildingScene& building) {
    const auto floors = Coupling(building).floors();
    const auto is_first = [&floors](std::size_t i) {
        return std::find(floors.begin(), floors.end(), floors[i]) - floors.begin() ==
               static_cast<std::ptrdiff_t>(i);
    };
    std::vector<std::shared_ptr<const Scene>> whole;
    for (std::size_t i = 0; i < floors.size(); ++i)
        whole.push_back(is_first(i) ? sceneOfBuilding(building, i) : nullptr);
    return whole;
}

std::vector<Suggestion> suggestForStorey(const BuildingScene& building, std::size_t storey,
                                         std::span<const std::shared_ptr<const Scene>> whole,
                                         const SuggestOptions& options, Progress& progress) {
    BuildingScene named = building;
    named.scenes[storey] = whole[storey];
    const std::shared_ptr<const Scene> opened = Coupling(named).recordedFloor(storey);
    const Scene& scene = *opened;
    SuggestOptions own = options;
    own.most = kKinds;
    own.requirements.clear();
    for (const auto& other : whole)
        if (other != nullptr && other != whole[storey]) own.others.push_back(other.get());
    Worlds worlds(scene.environment);
    const Coverage coverage = measureCoverage(scene, worlds, own.measure);
    std::vector<Suggestion> found =
        suggestChanges(scene, coverage, own, building.devices, progress);
    for (Suggestion& one : found)
        if (one.kind == Suggestion::Kind::Add)
            nameAdded(one, building.document.storeys[storey], scene.ids);
    return found;
}

BuildingScene editedStorey(const BuildingScene& building, std::size_t storey, const Scene& whole,
                           std::span<const Edit> edits) {
    Document records;
    records.records = edited(whole.records, edits, sceneSchemas());
    BuildingScene changed = building;
    changed.scenes[storey] = std::make_shared<const Scene>(
        makeScene(std::move(layoutsOf(records, building.document)[storey].records),
                  *building.scenes[storey], building.devices));
    return changed;
}

std::vector<Suggestion> suggestForBuilding(const BuildingScene& building,
                                           const BuildingCoverage& coverage,
                                           const SuggestOptions& options, Progress& progress) {
    const auto whole = wholeScenes(building);
    const double before = seenShare(coverage);
    std::vector<Suggestion> gains, savings;
    progress.begin("storeys", static_cast<std::int64_t>(whole.size()));
    for (std::size_t i = 0; i < whole.size() && !progress.stopped(); ++i) {
        progress.advance(1);
        if (whole[i] == nullptr) continue;
        const double floor = coverage.storeys[i].report.indoor_area;
        StopsWith stops(progress);
        for (Suggestion& one : suggestForStorey(building, i, whole, options, stops)) {
            const bool saves =
                one.kind == Suggestion::Kind::Replace || one.kind == Suggestion::Kind::Remove;
            one.share = seenShare(
                measureBuilding(editedStorey(building, i, *whole[i], one.edits), options.measure));
            one.gained = (one.share - before) * coverage.indoor_area;
            if (one.gained < (saves ? -kMaxLoss : kMinGain) * floor) continue;
            (saves ? savings : gains).push_back(std::move(one));
        }
    }
    progress.end();
    std::stable_sort(gains.begin(), gains.end(),
                     [](const Suggestion& a, const Suggestion& b) { return a.gained > b.gained; });
    std::move(savings.begin(), savings.end(), std::back_inserter(gains));
    if (gains.size() > options.most) gains.resize(options.most);
    return gains;
}

}  // namespace ispace
