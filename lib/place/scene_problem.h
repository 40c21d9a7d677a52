// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/place only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/progress.h"
#include "cover/coverage.h"
#include "place/arrange_options.h"
#include "place/arranged_sensor.h"
#include "place/candidate_pool.h"
#include "solve/problem.h"
#include "trace/worlds.h"

namespace ispace {

/// A scene with sensors to be placed as a problem in whole numbers, and the ways back from it.
///
/// Sensors that are alike are one kind of the problem, with the candidates of the options'
/// strategy; the target's cells weigh what options.worth says; what stands meets its share of the
/// demand.
class SceneProblem {
  public:
    /// Makes all candidates. Keeps references.
    /// \throws UnmetError if a kind has no valid place, nothing may be bought or nothing counts,
    ///         UsageError if the candidates do not fit in memory or cannot be refined as asked
    SceneProblem(const Scene& scene, const std::vector<SensorGroup>& groups,
                 const ArrangeOptions& options, Progress& progress);

    [[nodiscard]] const Scene& scene() const { return scene_; }
    [[nodiscard]] const std::vector<SensorGroup>& groups() const { return groups_; }
    [[nodiscard]] const ArrangeOptions& options() const { return options_; }
    [[nodiscard]] const Problem& problem() const { return problem_; }
    [[nodiscard]] const std::vector<SensorClass>& kinds() const { return kinds_; }
    [[nodiscard]] const Target& target() const { return target_; }
    Worlds& worlds() { return worlds_; }
    /// False if progress said to stop before all candidates were made.
    [[nodiscard]] bool isComplete() const { return is_complete_; }
    /// Of all kinds.
    [[nodiscard]] std::size_t candidates() const;
    [[nodiscard]] std::size_t bytes() const;
    /// As the options have it, with the memory that candidates leave.
    [[nodiscard]] SearchOptions searchOptions() const;
    /// The judge of the places that a sensor of this height may take.
    const SiteJudge& judgeAt(double height) { return pool_->judgeAt(height); }

    /// A value of the problem as a share of all that counts.
    [[nodiscard]] double share(std::uint64_t value) const;
    /// The least value that is this share, but for rounding.
    [[nodiscard]] std::uint64_t valueFor(double share) const;
    /// Weights of cells whose demand is not met by what stands; 0 for the others.
    [[nodiscard]] std::vector<std::uint32_t> weightsLeft() const;

    [[nodiscard]] Pose3 poseOf(const Choice& choice) const {
        return sets_[choice.kind]->pose(choice.candidate);
    }
    /// The sensors at the places that were chosen.
    [[nodiscard]] std::vector<ArrangedSensor> sensorsOf(const std::vector<Choice>& chosen) const;
    /// On the grid of the search.
    [[nodiscard]] Coverage coverageOf(const std::vector<ArrangedSensor>& sensors);
    [[nodiscard]] std::uint64_t valueOf(const Coverage& coverage) const;
    [[nodiscard]] bool isConnected(const Coverage& coverage) const;
    /// Ids of the arranged sensors that add nothing, see idleSensors().
    [[nodiscard]] std::vector<std::string> idleIn(const Coverage& coverage) const;
    /// Moves choices that add nothing apart. Not for what is worth nothing at all: those choices
    /// may be some of the many that a demand takes.
    void spreadIdle(std::vector<Choice>& chosen) const;
    /// No sensors of these numbers, at whatever places, are worth more; `most` by kind.
    [[nodiscard]] std::uint64_t mostFromAnyPlace(const std::vector<int>& most) const;

  private:
    void mustBeAffordable() const;
    void setDemand(const Coverage& standing);
    void addKinds();

    const Scene& scene_;
    const std::vector<SensorGroup>& groups_;
    const ArrangeOptions& options_;
    Worlds worlds_;
    std::vector<SensorClass> kinds_;
    int unit_ = 1;  ///< share of the demand of a sensor that sees on its own
    Target target_;
    Problem problem_;
    std::uint64_t total_ = 0;
    std::unique_ptr<CandidatePool> pool_;
    std::vector<std::unique_ptr<PosedCandidates>> sets_;
    bool is_complete_ = true;
};

}  // namespace ispace
