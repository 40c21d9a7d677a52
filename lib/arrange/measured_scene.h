// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/arrange only: sensors that add nothing to the value of the others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "arrange/arrange.h"
#include "arrange/candidate_generator.h"
#include "arrange/search/problem.h"
#include "arrange/sensor_group.h"
#include "arrange/tried_pose.h"
#include "base/cell_set.h"
#include "base/error.h"
#include "coverage/coverage.h"
#include "coverage/visible_area.h"
#include "geom/point.h"
#include "raster/grid.h"
#include "scene/scene.h"
#include "trace/ray_world.h"

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
class MeasuredScene {
  public:
    /// Makes all candidates. Keeps references.
    /// \throws UnmetError if a kind has no valid place, nothing may be bought or nothing counts,
    ///         UsageError if the candidates do not fit in memory or cannot be refined as asked
    MeasuredScene(const Scene& scene, const std::vector<SensorGroup>& groups,
                  const ArrangeOptions& options, Progress& progress);

    [[nodiscard]] const Scene& scene() const { return scene_; }
    [[nodiscard]] const std::vector<SensorGroup>& groups() const { return groups_; }
    [[nodiscard]] const ArrangeOptions& options() const { return options_; }
    [[nodiscard]] const Problem& problem() const { return problem_; }
    [[nodiscard]] const std::vector<SensorClass>& kinds() const { return kinds_; }
    [[nodiscard]] const Target& target() const { return target_; }
    Worlds& worlds() { return worlds_; }
    /// What sensors see of the room.
    [[nodiscard]] const VisibleArea& sight() const { return sight_; }
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
    void spreadRedundant(std::vector<Choice>& chosen) const;
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
    VisibleArea sight_;
    std::vector<SensorClass> kinds_;
    int unit_ = 1;  ///< multiplicity of sensors other than receivers
    Target target_;
    Problem problem_;
    std::uint64_t total_ = 0;
    std::unique_ptr<CandidatePool> pool_;
    std::vector<std::unique_ptr<PosedCandidates>> sets_;
    bool is_complete_ = true;
};

/// Upper bound of the cells of the grid that one such sensor sees of a level plane, wherever it
/// stands and whichever way it faces: the area within d, half a cell's diagonal, of what may be in
/// view, over the area of a cell. For a connected part of the plane with area A and outline L that
/// is at most A + L d + pi d^2 (Steiner's formula). A and L are at most those
/// - of its sector for a laser that does not sweep; a tilted or rolled one covers no more, as its
///   sector is seen from above, where nothing is longer or larger;
/// - of the disc of its range for swept lasers, receivers and spherical rangers: nothing they see
/// of
///   a plane is farther away;
/// - for pinholes of any plane section of the view pyramid down to the depth of the range, and of
///   the disc through the farthest point in view, which for those that measure depth is a corner of
///   the picture, beyond the range. The area of a section is the root of the sum of squares of the
///   areas of its three projections, here at most the rectangle and two triangles of the pyramid;
///   its outline, as of any convex figure, is at most pi times its diameter.
std::uint64_t maxCellsInView(const SensorModel& device, const Grid& grid);

/// Upper bound of the value of sensors at any places, on the grid of the problem's weights: what
/// stands already covers, and the heaviest other cells, as many as these sensors can see together.
/// `devices` are those of the problem's kinds, `most` the maximum number of each; with a budget
/// those that see most per cost count, the last one in part.
std::uint64_t maxFromAnyPlace(const Problem& problem, const Grid& grid,
                              std::span<const SensorModel> devices, std::span<const int> most);

class MeasuredScene;
struct CountedView;

/// Choices that can all be left out without loss of value or of connection, ascending; later ones
/// are preferred. O(choices * cells / 64 + runs)
std::vector<std::size_t> idleChoices(const Problem& problem, std::span<const Choice> chosen);

/// The same for the views of placed sensors, by their indices.
std::vector<std::size_t> idleViews(const MeasuredScene& model, std::span<const CountedView> views);

/// Spreads idle choices: moves each in turn to the site farthest from all other sensors, among
/// those that see anything of weight, with the heading that sees most of what few others see.
/// Connected coverage stays connected. `standing`: positions of sensors that stand already.
void spreadRedundant(const Problem& problem, std::span<const Point3> standing,
                     const std::function<Point3(const Choice&)>& position_of,
                     std::vector<Choice>& chosen);

}  // namespace ispace
