// SPDX-License-Identifier: GPL-3.0-or-later
// Moves the sensors of a layout off their candidates, by the area that they see exactly.
//
// Coverage on a grid has no slope; the area of a union of views has. Regions are in closed form and
// their union is an overlay (geom/overlay/overlay.h): areas err by its rounding. The result is
// never worse than the start. Unless stopped it is a local optimum for steps of a millimetre,
// without a bound of its distance from the best layout.
//
//     const VisibleArea sight(scene.environment, 0);
//     const Refined better = refine(scene, sight, sensors, {}, {}, progress);
//     // better.after >= better.before, m2
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "arrange/sensor_group.h"
#include "base/error.h"
#include "coverage/target.h"
#include "coverage/visible_area.h"
#include "scene/scene.h"

namespace ispace {

class CoverageModel;

/// Steps and rules of a refinement.
struct RefineOptions {
    int multiplicity = 1;                ///< a point is covered if this many sensors see it
    double step = 0.25;                  ///< first step, metres; steps are halved down to 1 mm
    Angle turn = Angle::degrees(11.25);  ///< first turn; likewise down to 0.05 degrees
    /// Returns false for rejected positions of a sensor, given by its index; null: accepts all.
    std::function<bool(std::size_t, Point2)> is_valid = {};
    /// Returns false for rejected steps, given the poses of all sensors after the step; null:
    /// accepts all.
    std::function<bool(const std::vector<Pose3>&)> accepts = {};
};

/// A refined layout.
struct Refined {
    std::vector<Pose3> poses;      ///< in the order of the sensors
    double before = 0, after = 0;  ///< exact weighted area covered, m2; after >= before
    std::size_t evaluations = 0;   ///< poses of which the gain was computed
};

/// Validates before a search that refine() can follow it.
/// \throws UsageError for sweeping lasers without a known exact region (among `devices` and the
///         scene's) and for too many weights
void mustBeRefinable(const Scene& scene, std::span<const SensorModel> devices,
                     const FloorWeights& weights);

/// Improves a layout in continuous x, y and heading: sensor after sensor, by pattern search
/// (R. Hooke, T. A. Jeeves, Direct search solution of numerical and statistical problems, 1961):
/// steps along the axes and their pattern, halved when no step gains. The objective is the exact
/// weighted area that at least `multiplicity` sensors see, in closed form (Overlay), including the
/// standing sensors of the scene. z, tilt and roll stay, and so does the heading of a sensor with
/// the same view at every heading. Steps lead to whole multiples of 0.1 mm and 0.001 degrees and
/// count if they gain more than 1e-9 of the total; a sensor without such a step keeps its pose to
/// the bit. Ends when no step of the smallest length, 1 mm and 0.05 degrees, gains.
///
/// The result does not depend on the number of threads. Returns early, with the best poses so far,
/// if progress says stop.
/// \param sight visible areas in the scene's environment
/// \throws UsageError for sensors, standing ones included, without a known exact region (lasers
///         that nod or roll), and for more than 60 weighted zones
Refined refine(const Scene& scene, const VisibleArea& sight, std::span<const Sensor> sensors,
               const FloorWeights& weights, const RefineOptions& options, Progress& progress);

/// Runs refine() on sensors that a search arranged, room by room, by the rules of the search: sites
/// stay valid, the value on its grid ends no lower than `least`, and connected coverage stays
/// connected. Sensors that were apart stay 5 cm apart: two housings need their space.
Refined refine(CoverageModel& model, const std::vector<Placement>& placements, std::uint64_t least,
               Progress& progress);

/// Computes the exact gain of poses: the area that at least `multiplicity` sensors see, in closed
/// form (Overlay), times its weight. Lasers and rangers count one by one, all ultrasonic receivers
/// together as one, where enough of them hear.
///
/// Standing sensors of the scene do not move: their regions, and the floor by its weights, are
/// computed once.
///
///     ExactGain gain(scene, sight, sensors, {}, 1);
///     gain.take(0);
///     const std::vector<double> of = gain.gains(poses);    // of sensor 0, each pose alone
///     gain.put(poses[1]);                                  // value() grows by of[1] - of[0], if
///                                                          // poses[0] was its pose
///
/// Not thread-safe; gains() uses all cores.
class ExactGain {
  public:
    /// All sensors stand at their poses. Stores the references.
    /// \throws UsageError for sensors without an exact region and for more than kMaxZones weights
    ExactGain(const Scene& scene, const VisibleArea& sight, std::span<const Sensor> sensors,
              const FloorWeights& weights, int multiplicity);
    ~ExactGain();
    ExactGain(const ExactGain&) = delete;
    ExactGain& operator=(const ExactGain&) = delete;

    static constexpr std::size_t kMaxZones = 60;

    /// Returns the weight of all floor that counts, m2 times weight.
    [[nodiscard]] double total() const;
    /// Returns the weight covered at the current poses, at most total(). O(n log n) in all regions
    /// and walls.
    [[nodiscard]] double value() const;

    /// Computes at once, for all sensors, the floor that lacks exactly the one of them, until put()
    /// moves one: take() and gains() then read the neighbourhood of views alone, without an overlay
    /// of the other sensors'. Returns false, without effect, for receivers and several sensors a
    /// point. O(n log n) in all regions, their crossings and walls.
    bool prepareAll();
    /// Computes the unseen floor alone, for mostMore(): also of receivers and several sensors a
    /// point. O(n log n) as prepareAll()
    void prepareBounds();
    /// Returns a bound of what the selected sensor gains at a pose over its present one, by the
    /// unseen floor in a box about its field of view; +infinity unless prepareAll() returned true
    /// or prepareBounds() was called, and no sensor was moved since. Thread-safe.
    [[nodiscard]] double mostMore(const Pose3& pose) const;
    /// Selects the sensor that moves from here on; all others stay.
    void take(std::size_t sensor);
    /// Computes the gain of the selected sensor over the others at each of these poses, on all
    /// cores. Reads only its neighbourhood: O(n log n) in its region and those it meets.
    /// \pre take() was called
    [[nodiscard]] std::vector<double> gains(std::span<const Pose3> poses);
    /// Moves the selected sensor to this pose. Undoes prepareAll() and prepareBounds().
    void put(const Pose3& pose);

    /// Returns false for a sensor with the same view at every heading.
    [[nodiscard]] bool turns(std::size_t sensor) const;

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
