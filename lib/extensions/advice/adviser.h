// SPDX-License-Identifier: GPL-3.0-or-later
// The search behind suggestChanges().
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "arrange/arrange.h"
#include "coverage/exact_shares.h"
#include "coverage/requirement.h"
#include "coverage/visible_area.h"
#include "extensions/advice/coarse_sight.h"
#include "extensions/advice/suggestion.h"
#include "extensions/camerarules/facing_meter.h"
#include "extensions/camerarules/private_floor.h"
#include "scene/placement_schemas.h"
#include "trace/ray_world.h"

namespace ispace::advice {

/// Share of the indoor floor that a change may lose if it saves a sensor or its cost.
constexpr double kNegligible = 0.01;

/// Share of the indoor floor that a suggestion gains, at least.
constexpr double kWorthwhile = 1e-3;

/// Rounds square metres to those that overlays of regions resolve.
inline double withoutNoise(double area) { return std::round(1e6 * area) / 1e6; }

/// A scene with its coverage.
struct MeasuredState {
    Scene scene;
    Coverage coverage;
    double missing = 0;  ///< missingFloor()
};

inline double coveredShare(const Coverage& coverage) {
    const Metric& metric = coverage.report.coverage;
    return metric.exact.value_or(metric.grid.value_or(0));
}

/// Returns the indoor floor that no sensor covers, m2.
inline double uncoveredFloor(const Coverage& coverage) {
    return (1 - coveredShare(coverage)) * coverage.report.indoor_area;
}

/// Tries single cameras of a scene at other poses by the rules of SuggestOptions.
class RuleTrials {
  public:
    /// Stores the references. \param private_floor of the scene's environment
    RuleTrials(const MeasuredState& now, const SuggestOptions& options,
               camerarules::PrivateFloor& private_floor);

    /// Returns a bound of gain() that holds for all poses of the sensor.
    [[nodiscard]] double mostGain(const Sensor& sensor) const;
    /// Returns by how much less floor the rules miss with the sensor at this pose, m2; 0 for
    /// sensors that are no cameras.
    [[nodiscard]] double gain(const Sensor& sensor, const Pose3& pose);

  private:
    const SuggestOptions& options_;
    const Scene& scene_;
    camerarules::PrivateFloor& private_floor_;
    std::vector<SensorView> views_;  // of all cameras
    std::optional<camerarules::FacingMeter> facing_;
    double faces_ = 0;  // that are missing, m2
};

/// Returns the same as missingFloor(). \param private_floor of the scene's environment
double missingFloor(const Scene& scene, const Coverage& coverage, const SuggestOptions& options,
                    camerarules::PrivateFloor& private_floor);

/// Returns the rules of facing that a scene does not meet.
std::vector<camerarules::FacingRule> unmetFacing(const MeasuredState& now,
                                                 const SuggestOptions& options);

/// Searches changes of measured scenes, see suggestChanges().
class Adviser {
  public:
    Adviser(const SuggestOptions& options, const DeviceCatalogue& devices, Progress& progress)
        : options_(options), devices_(devices), progress_(progress) {}

    [[nodiscard]] bool isStopped() const { return progress_.stopped(); }
    /// Returns the number of steps that moves() reports.
    [[nodiscard]] std::int64_t stepsOfMoves(const Scene& scene) const;

    /// Returns the additions, turns and shifts with the largest gain of each kind, as they apply to
    /// this state.
    std::vector<Suggestion> moves(const MeasuredState& now) {
        std::vector<Suggestion> found = turnAndShift(now);
        if (!is_repeating_ || mayAddingMend(now))
            for (Suggestion& suggestion : additions(now)) found.push_back(std::move(suggestion));
        if (auto removal = withoutIntruder(now)) found.push_back(*std::move(removal));
        return found;
    }

    /// Returns the private floor of an environment; valid until that of two others is requested.
    camerarules::PrivateFloor& privateFloorOf(const Environment& environment);
    /// Returns the move of one piece of furniture, by 0.5, 1 or 2 m in steps of 45 degrees, that
    /// mends most, then gains most. Tries the six pieces that may hide most floor; moves that add
    /// findings are left out.
    std::optional<Suggestion> furniture(const MeasuredState& now);
    /// Returns the replacement of a device by the cheapest one of its kind in the scene that saves
    /// most, at a loss of kNegligible of the floor or less. A sensor without `cost` counts as 1.
    std::optional<Suggestion> replacement(const MeasuredState& now);
    /// Returns the removal of the sensor that adds least floor of its own, if that is kNegligible
    /// or less and the rules miss no more without it.
    std::optional<Suggestion> removal(const MeasuredState& now);
    /// Returns changes that meet all together, at most eight; empty if the greedy choice finds no
    /// such list. \param first moves() of this state
    std::optional<Suggestion> together(const MeasuredState& now, std::vector<Suggestion> first);

  private:
    /// Applies the edits and measures the scene. Exact figures only if those of `now` are known:
    /// crowds of views have figures of cells.
    [[nodiscard]] MeasuredState after(const MeasuredState& now, std::span<const Edit> edits) {
        Scene changed =
            makeScene(edited(now.scene.records, edits, sceneSchemas()), now.scene, devices_);
        RayScenes worlds(changed.environment);
        CoverageOptions options = options_.measure;
        options.exact = options.exact && now.coverage.report.exact_missing.empty();
        const bool is_by_density =
            std::any_of(options_.requirements.begin(), options_.requirements.end(),
                        [](const Requirement& one) { return one.density.has_value(); });
        auto shares = is_by_density
                          ? std::nullopt
                          : exactShares(changed, worlds, options, knownSight(changed.environment));
        Coverage coverage =
            shares ? *std::move(shares)
                   : measureChanged(changed, worlds, options, {&now.scene, &now.coverage});
        const double missing =
            missingFloor(changed, coverage, options_, privateFloorOf(changed.environment));
        return {std::move(changed), std::move(coverage), missing};
    }
    /// Completes a suggestion by measuring it.
    Suggestion measured(const MeasuredState& now, Suggestion::Kind kind, std::string text,
                        std::vector<Edit> edits) {
        const MeasuredState then = after(now, edits);
        const double share = coveredShare(then.coverage);
        // Furniture changes no indoor area.
        const double gained =
            (share - coveredShare(now.coverage)) * now.coverage.report.indoor_area;
        return {.kind = kind,
                .text = std::move(text),
                .edits = std::move(edits),
                .gained = gained,
                .share = share,
                .required = withoutNoise(now.missing - then.missing)};
    }
    /// Keeps the better of two suggestions, by requirements, then by floor.
    static void offer(std::optional<Suggestion>& best, Suggestion suggestion) {
        if (best && std::pair(best->required, best->gained) >=
                        std::pair(suggestion.required, suggestion.gained))
            return;
        best = std::move(suggestion);
    }

    /// Returns the sight in the first environment that keeps regions; null in others.
    const VisibleArea* sightIn(const Environment& environment);
    /// Returns the same if it exists.
    [[nodiscard]] const VisibleArea* knownSight(const Environment& environment) const {
        const bool is_first =
            first_sight_ && first_sight_->environment.digest() == environment.digest();
        return is_first ? &first_sight_->sight : nullptr;
    }
    /// Returns the floor that suggestions of this state gain, at least, m2: smaller gains are not
    /// told unless requirements fall short.
    [[nodiscard]] static double leastGain(const MeasuredState& now) {
        return now.missing > 0 ? 0 : kWorthwhile * now.coverage.report.indoor_area;
    }
    [[nodiscard]] static double mostAdded(const MeasuredState& now, const Sensor& like);
    /// A displacement of a piece of furniture.
    struct Move {
        std::string id;
        Vec2 by;
    };
    [[nodiscard]] std::vector<Move> movesOf(const std::vector<std::string>& pieces) const;
    /// Returns the number of findings about furniture and sensors.
    [[nodiscard]] static std::size_t findingsOf(const Scene& scene);
    [[nodiscard]] Scene sceneAfter(const MeasuredState& now, const Move& move) const;
    std::vector<Move> promisingMoves(const MeasuredState& now,
                                     const std::vector<std::string>& pieces);
    void keepPromising(const MeasuredState& now, std::vector<Move>& moves);
    std::vector<Suggestion> turnAndShift(const MeasuredState& now);
    void leaveOutNeedless(const MeasuredState& now, std::vector<Suggestion>& steps);
    std::vector<Suggestion> additions(const MeasuredState& now);
    /// Returns false if one more sensor leaves no less floor missing: with privacy alone, unless
    /// just small pieces of several cameras add up.
    bool mayAddingMend(const MeasuredState& now);
    std::optional<Suggestion> addition(const MeasuredState& now,
                                       const std::vector<SensorGroup>& groups,
                                       const ArrangeOptions& options);
    /// Returns the removal of the camera that sees private zones and mends most, if any. Measures
    /// only cameras that see more of them than the best one mends.
    std::optional<Suggestion> withoutIntruder(const MeasuredState& now);
    /// Returns the number of cameras that see private zones.
    std::size_t intruders(const Scene& scene);
    [[nodiscard]] FloorWeights weightsFor(const MeasuredState& now) const;
    /// Returns the options of a search for one more sensor like one of the scene `home`.
    [[nodiscard]] ArrangeOptions optionsFor(const MeasuredState& now, const Scene& home,
                                            const Sensor& like) const;
    /// Returns these options for each rule of facing that is not met, or as they are.
    [[nodiscard]] std::vector<ArrangeOptions> goalsOf(const MeasuredState& now,
                                                      ArrangeOptions options) const;

    /// Reports steps of moves(), unless Together repeats them.
    void advance(std::size_t steps) {
        if (!is_repeating_) progress_.advance(static_cast<std::int64_t>(steps));
    }

    const SuggestOptions& options_;
    const DeviceCatalogue& devices_;
    Progress& progress_;
    bool is_repeating_ = false;
    /// Of the first environment.
    struct FirstSight {
        Environment environment;  // shares its data
        VisibleArea sight;
        FirstSight(const Environment& first, double plane)
            : environment(first), sight(environment, plane) {
            sight.keepRegions();
        }
    };
    std::unique_ptr<FirstSight> first_sight_;
    std::unique_ptr<CoarseSight> first_coarse_;  // of its environment
    /// Of the first environment, and of the last other one.
    std::array<std::unique_ptr<camerarules::PrivateFloor>, 2> private_floors_;
};

/// Returns the sensors whose pose a person can change: not those of robots and people.
std::vector<Sensor> standingSensors(const Scene& scene);

/// Returns the displacements of these lengths, in steps of 45 degrees.
std::vector<Vec2> displacements(std::span<const double> lengths);

/// Returns the edit that moves a record.
Edit moveOf(const std::string& id, Vec2 by);

}  // namespace ispace::advice
