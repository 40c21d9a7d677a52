// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/place only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/cell_set.h"
#include "base/progress.h"
#include "cover/coverage.h"
#include "cover/sight.h"
#include "cover/tried_pose.h"
#include "place/arrange_options.h"
#include "place/candidate_pool.h"
#include "place/sensor_group.h"
#include "solve/problem.h"
#include "trace/worlds.h"

namespace ispace {

/// What one sensor sees of the grid of the search, and the multiplicity that it adds there.
struct CountedView {
    CellSet cells;
    int multiplicity = 1;
};

/// A scene with sensors to place as a weighted coverage problem, and the way back from its
/// solutions.
///
/// Sensors that are alike are one kind of the problem, with candidates by the options' strategy.
/// The target's cells have the weights of options.weights; sensors that stand already add to the
/// multiplicity.
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
    /// What sensors see of the room.
    [[nodiscard]] const Sight& sight() const { return sight_; }
    /// False if progress said to stop before all candidates were made.
    [[nodiscard]] bool isComplete() const { return is_complete_; }
    /// Of all kinds.
    [[nodiscard]] std::size_t candidates() const;
    [[nodiscard]] std::size_t bytes() const;
    /// Those of the options, with the memory that the candidates leave.
    [[nodiscard]] SearchOptions searchOptions() const;
    /// The validity test for places at this height.
    const SiteValidity& validityAt(double height) { return pool_->validityAt(height); }

    /// A value of the problem as a share of the total weight.
    [[nodiscard]] double share(std::uint64_t value) const;
    /// The smallest value that is at least this share, up to rounding.
    [[nodiscard]] std::uint64_t valueFor(double share) const;
    /// Weights of the cells not covered by what stands; 0 for the others.
    [[nodiscard]] std::vector<std::uint32_t> weightsLeft() const;

    [[nodiscard]] Pose3 poseOf(const Choice& choice) const {
        return sets_[choice.kind]->pose(choice.candidate);
    }
    /// The sensors at the places that were chosen.
    [[nodiscard]] std::vector<Placement> placementsOf(const std::vector<Choice>& chosen) const;
    /// What these sensors see of the grid of the search. The same for any number of threads.
    [[nodiscard]] std::vector<CountedView> viewsOf(std::span<const Sensor> sensors) const;
    /// As valueOf() of the sensors with these views.
    [[nodiscard]] std::uint64_t valueOf(std::span<const CountedView> views) const;
    /// True if these views hang together with what stands, which is one part, see
    /// Problem::is_connected. O(views^2 * cells / 64)
    [[nodiscard]] bool isConnected(std::span<const CountedView> views) const;
    /// Spreads choices that add nothing. \pre the choices have a value: else they may be some of
    /// the many that the required multiplicity takes
    void spreadIdle(std::vector<Choice>& chosen) const;
    /// Every candidate with the share of the total weight that it would add to what stands and, for
    /// a laser, its slice area (eq. 4.4) by the thesis' scan of the pose.
    [[nodiscard]] std::vector<TriedPose> triedPoses(const std::vector<Choice>& chosen);
    /// Upper bound of the value of these numbers of sensors at any places; `most` by kind.
    [[nodiscard]] std::uint64_t maxFromAnyPlace(const std::vector<int>& most) const;

  private:
    void mustBeAffordable() const;
    void setMultiplicities(const Coverage& standing);
    void addKinds();

    const Scene& scene_;
    const std::vector<SensorGroup>& groups_;
    const ArrangeOptions& options_;
    Worlds worlds_;
    Sight sight_;
    std::vector<SensorClass> kinds_;
    int unit_ = 1;  ///< multiplicity of sensors other than receivers
    Target target_;
    Problem problem_;
    std::uint64_t total_ = 0;
    std::unique_ptr<CandidatePool> pool_;
    std::vector<std::unique_ptr<PosedCandidates>> sets_;
    bool is_complete_ = true;
};

}  // namespace ispace
