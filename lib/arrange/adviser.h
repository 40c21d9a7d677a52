// SPDX-License-Identifier: GPL-3.0-or-later
// The search behind suggestChanges().
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "arrange/arrange.h"
#include "arrange/suggestion.h"
#include "coverage/visible_area.h"
#include "scene/placement_schemas.h"
#include "trace/ray_world.h"

namespace ispace {

/// Share of the indoor floor that a change may lose if it saves a sensor or its cost.
constexpr double kNegligible = 0.01;

/// A scene with its coverage.
struct MeasuredState {
    Scene scene;
    Coverage coverage;
};

inline double coveredShare(const Coverage& coverage) {
    const Metric& metric = coverage.report.coverage;
    return metric.exact.value_or(metric.grid.value_or(0));
}

/// Searches changes of measured scenes, see suggestChanges().
class Adviser {
  public:
    Adviser(const SuggestOptions& options, const DeviceCatalogue& devices, Progress& progress)
        : options_(options), devices_(devices), progress_(progress) {}

    [[nodiscard]] bool isStopped() const { return progress_.stopped(); }

    /// Returns the additions, turns and shifts with the largest gain of each kind, as they apply to
    /// this state.
    std::vector<Suggestion> moves(const MeasuredState& now) {
        std::vector<Suggestion> found = turnAndShift(now);
        for (Suggestion& suggestion : additions(now)) found.push_back(std::move(suggestion));
        return found;
    }

    std::optional<Suggestion> furniture(const MeasuredState& now);
    std::optional<Suggestion> replacement(const MeasuredState& now);
    std::optional<Suggestion> removal(const MeasuredState& now);
    std::optional<Suggestion> together(const MeasuredState& now, std::vector<Suggestion> first);

    /// Returns the floor that the requirements still miss, m2.
    [[nodiscard]] double missing(const Coverage& coverage) const {
        double sum = 0;
        for (const Requirement& requirement : options_.requirements)
            sum += checkRequirement(requirement, coverage).missing;
        return sum;
    }

  private:
    /// Applies the edits and measures the scene.
    [[nodiscard]] MeasuredState after(const Scene& scene, std::span<const Edit> edits) const {
        Scene changed = makeScene(edited(scene.records, edits, sceneSchemas()), scene, devices_);
        Worlds worlds(changed.environment);
        Coverage coverage = measureCoverage(changed, worlds, options_.measure);
        return {std::move(changed), std::move(coverage)};
    }
    /// Completes a suggestion by measuring it.
    Suggestion measured(const MeasuredState& now, Suggestion::Kind kind, std::string text,
                        std::vector<Edit> edits) {
        const MeasuredState then = after(now.scene, edits);
        const double share = coveredShare(then.coverage);
        // Furniture changes no indoor area.
        const double gained =
            (share - coveredShare(now.coverage)) * now.coverage.report.indoor_area;
        rank_ = missing(now.coverage) - missing(then.coverage);
        progress_.advance(1);
        return {kind, std::move(text), std::move(edits), gained, share};
    }
    /// Keeps the better of two suggestions, by requirements, then by floor.
    void offer(std::optional<Suggestion>& best, double& best_rank, Suggestion suggestion) {
        if (best && std::pair(best_rank, best->gained) >= std::pair(rank_, suggestion.gained))
            return;
        best_rank = rank_;
        best = std::move(suggestion);
    }

    std::vector<Suggestion> turnAndShift(const MeasuredState& now);
    std::vector<Suggestion> additions(const MeasuredState& now);
    [[nodiscard]] FloorWeights weightsFor(const MeasuredState& now) const;
    /// Returns the options of a search for one more sensor like one of the scene `home`.
    [[nodiscard]] ArrangeOptions optionsFor(const MeasuredState& now, const Scene& home,
                                            const Sensor& like) const;

    const SuggestOptions& options_;
    const DeviceCatalogue& devices_;
    Progress& progress_;
    double rank_ = 0;  ///< of the suggestion measured last: required floor that it adds
};

/// Returns the sensors whose pose a person can change: not those of robots and people.
std::vector<Sensor> standingSensors(const Scene& scene);

/// Returns the displacements of these lengths, in steps of 45 degrees.
std::vector<Vec2> displacements(std::span<const double> lengths);

/// Returns the edit that moves a record.
Edit moveOf(const std::string& id, Vec2 by);

}  // namespace ispace
