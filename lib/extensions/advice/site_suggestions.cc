// SPDX-License-Identifier: GPL-3.0-or-later
// Storeys that share a scene and openings count once, on the lowest. Each storey is searched as a
// room with the examples of all others, and each change is measured once in the whole building: a
// sensor that looks through an opening gains there, too.
#include "extensions/advice/site_suggestions.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "record/text.h"
#include "scene/placement_schemas.h"
#include "site/site_edit.h"
#include "site/site_sight.h"
#include "trace/ray_world.h"

namespace ispace::advice {

namespace {

/// Least gain of a suggestion, and greatest loss of one that saves a sensor, as shares of the
/// storey's indoor floor, as in suggestChanges().
constexpr double kMinGain = 1e-3, kMaxLoss = 0.01;
constexpr std::size_t kKinds = 7;  // of suggestions, but for Together one of each a storey

double seenShare(const SiteCoverage& coverage) {
    return coverage.coverage.exact.value_or(coverage.coverage.grid.value_or(0));
}

void replaceAll(std::string& text, const std::string& old, const std::string& by) {
    for (std::size_t at = text.find(old); at != std::string::npos;
         at = text.find(old, at + by.size()))
        text.replace(at, old.size(), by);
}

/// Gives the sensors that a suggestion adds ids of the storey, in its later edits, too.
void nameAdded(Suggestion& suggestion, const Storey& storey, std::vector<std::string> ids) {
    for (std::size_t i = 0; i < suggestion.edits.size(); ++i) {
        if (suggestion.edits[i].kind != Edit::Kind::Add) continue;
        Record added = readRecord(suggestion.edits[i].text, "", sceneSchemas());
        const std::string before = added.has("id") ? added.text("id") : "";
        std::string id;
        for (std::size_t n = 1; id.empty() || std::find(ids.begin(), ids.end(), id) != ids.end();
             ++n)
            id = wholeId(storey, added.keyword() + std::to_string(n));
        added.set("id", id);
        ids.push_back(id);
        suggestion.edits[i] = parseEdit(Edit::Kind::Add, formatRecord(added));
        if (before.empty()) continue;
        for (std::size_t k = i + 1; k < suggestion.edits.size(); ++k) {
            const Edit& edit = suggestion.edits[k];
            const std::string& text = edit.text;
            if (text == before || text.starts_with(before + ':') || text.starts_with(before + '.'))
                suggestion.edits[k] = parseEdit(edit.kind, id + text.substr(before.size()));
        }
        for (const char* const verb : {"turn ", "move ", "remove "}) {
            std::string old = verb, by = verb;
            replaceAll(suggestion.text, old.append(before).append(" "), by.append(id).append(" "));
        }
    }
    if (suggestion.kind == Suggestion::Kind::Add)
        suggestion.text += " on " + storey.id;
    else
        replaceAll(suggestion.text, "add a ", "add on " + storey.id + " a ");
}

}  // namespace

std::vector<std::shared_ptr<const Scene>> wholeScenes(const SiteScene& building) {
    const auto floors = Coupling(building).floors();
    const auto is_first = [&floors](std::size_t i) {
        return std::find(floors.begin(), floors.end(), floors[i]) - floors.begin() ==
               static_cast<std::ptrdiff_t>(i);
    };
    std::vector<std::shared_ptr<const Scene>> whole;
    for (std::size_t i = 0; i < floors.size(); ++i)
        whole.push_back(is_first(i) ? sceneOfSite(building, i) : nullptr);
    return whole;
}

std::vector<Suggestion> suggestForStorey(const SiteScene& building, std::size_t storey,
                                         std::span<const std::shared_ptr<const Scene>> whole,
                                         const SuggestOptions& options, Progress& progress) {
    SiteScene named = building;
    named.scenes[storey] = whole[storey];
    const std::shared_ptr<const Scene> opened = Coupling(named).recordedFloor(storey);
    const Scene& scene = *opened;
    SuggestOptions own = options;
    own.most = kKinds;
    own.requirements.clear();
    for (const auto& other : whole)
        if (other != nullptr && other != whole[storey]) own.others.push_back(other.get());
    RayScenes worlds(scene.environment);
    const Coverage measured = measureCoverage(scene, worlds, own.measure);
    std::vector<Suggestion> found =
        suggestChanges(scene, measured, own, building.devices, progress);
    if (building.isRoomAlone()) return found;
    for (Suggestion& one : found) nameAdded(one, building.document.storeys[storey], scene.ids);
    return found;
}

SiteScene editedStorey(const SiteScene& building, std::size_t storey, const Scene& whole,
                       std::span<const Edit> edits) {
    Document records;
    records.records = edited(whole.records, edits, sceneSchemas());
    SiteScene changed = building;
    if (building.isRoomAlone()) {
        changed.scenes[storey] = std::make_shared<const Scene>(
            makeScene(std::move(records.records), *building.scenes[storey], building.devices));
        return changed;
    }
    changed.scenes[storey] = std::make_shared<const Scene>(
        makeScene(std::move(layoutsOf(records, building.document)[storey].records),
                  *building.scenes[storey], building.devices));
    return changed;
}

std::vector<Suggestion> suggestForSite(const SiteScene& building, const SiteCoverage& coverage,
                                       const SuggestOptions& options, Progress& progress) {
    const auto whole = wholeScenes(building);
    const auto missing_of = [&](const SiteScene& of, const SiteCoverage& by) {
        if (options.facing.empty() && options.privacy.empty()) return 0.0;
        return missingFloor(camerarules::measureSiteRules(of, by, options.measure, options.facing,
                                                          options.privacy));
    };
    const auto uncovered_of = [&](const SiteCoverage& by) {
        double sum = 0;
        for (const Requirement& requirement : options.requirements)
            sum += checkRequirement(requirement, building, by).missing;
        return sum;
    };
    const double before = seenShare(coverage), missing = missing_of(building, coverage);
    const double uncovered = uncovered_of(coverage);
    constexpr double kRounding = 1e-6;  // m2
    std::vector<Suggestion> gains, savings;
    std::optional<Suggestion> whole_change;
    SiteScene after_all = building;
    progress.begin("storeys", static_cast<std::int64_t>(whole.size()));
    for (std::size_t i = 0; i < whole.size() && !progress.stopped(); ++i) {
        progress.advance(1);
        if (whole[i] == nullptr) continue;
        const double floor = coverage.storeys[i].report.indoor_area;
        StopsWith stops(progress);
        camerarules::StoreyRules rules =
            camerarules::rulesOfStorey(building, coverage, i, options.facing, options.privacy);
        SuggestOptions own = options;
        own.facing = std::move(rules.facing);
        own.privacy = std::move(rules.privacy);
        for (Suggestion& one : suggestForStorey(building, i, whole, own, stops)) {
            const bool saves =
                one.kind == Suggestion::Kind::Replace || one.kind == Suggestion::Kind::Remove;
            const SiteScene changed = editedStorey(building, i, *whole[i], one.edits);
            if (one.kind == Suggestion::Kind::Together) {
                after_all.scenes[i] = changed.scenes[i];
                if (!whole_change) {
                    whole_change = std::move(one);
                    continue;
                }
                whole_change->text.append(", ").append(one.text);
                whole_change->edits.insert(whole_change->edits.end(), one.edits.begin(),
                                           one.edits.end());
                continue;
            }
            const SiteCoverage measured = measureSite(changed, options.measure);
            const double left = uncovered_of(measured);
            if (missing_of(changed, measured) + left > missing + uncovered + kRounding) continue;
            one.required += uncovered - left;
            one.share = seenShare(measured);
            one.gained = (one.share - before) * coverage.indoor_area;
            const double most = saves ? one.gained : std::max(one.gained, one.required);
            if (most < (saves ? -kMaxLoss : kMinGain) * floor) continue;
            (saves ? savings : gains).push_back(std::move(one));
        }
    }
    progress.end();
    std::stable_sort(gains.begin(), gains.end(), [](const Suggestion& a, const Suggestion& b) {
        return std::pair(a.required, a.gained) > std::pair(b.required, b.gained);
    });
    if (whole_change && !progress.stopped()) {
        const SiteCoverage measured = measureSite(after_all, options.measure);
        if (missing_of(after_all, measured) == 0) {
            whole_change->unmet = uncovered_of(measured);
            whole_change->required = missing + uncovered - whole_change->unmet;
            whole_change->share = seenShare(measured);
            whole_change->gained = (whole_change->share - before) * coverage.indoor_area;
            // Told once if it is a single change.
            std::erase_if(gains,
                          [&](const Suggestion& one) { return one.text == whole_change->text; });
            gains.insert(gains.begin(), *std::move(whole_change));
        }
    }
    std::move(savings.begin(), savings.end(), std::back_inserter(gains));
    if (gains.size() > options.most) gains.resize(options.most);
    return gains;
}

Advice adviceFor(const SiteScene& building, const SiteCoverage& coverage,
                 const SuggestOptions& options, const DeviceCatalogue& devices,
                 Progress& progress) {
    Advice advice;
    double missing = 0;
    if (building.isRoomAlone()) {
        const Scene& room = *building.scenes.front();
        const Coverage& measured = coverage.storeys.front();
        advice.suggestions = suggestChanges(room, measured, options, devices, progress);
        missing = missingFloor(room, measured, options);
    } else {
        SiteScene equipped = building;
        equipped.devices = devices;
        advice.suggestions = suggestForSite(equipped, coverage, options, progress);
        if (!options.facing.empty() || !options.privacy.empty())
            missing = missingFloor(camerarules::measureSiteRules(
                building, coverage, options.measure, options.facing, options.privacy));
    }
    advice.is_short =
        missing > 0 && (advice.suggestions.empty() ||
                        advice.suggestions.front().kind != Suggestion::Kind::Together ||
                        advice.suggestions.front().unmet > 0);
    return advice;
}

}  // namespace ispace::advice
