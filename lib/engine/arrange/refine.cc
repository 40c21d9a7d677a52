// SPDX-License-Identifier: GPL-3.0-or-later
// Pattern search (R. Hooke, T. A. Jeeves, Direct search solution of numerical and statistical
// problems, 1961) over x, y and heading of one sensor after another.
//
// For each length of steps, from 0.25 m and 11.25 degrees down by halves to 1 mm and 0.05 degrees,
// sensors take turns until all in a row keep their poses. A sensor tries its 6 axial steps, then
// those along two and three axes, and repeats a step that gains. Steps lead to a lattice of 0.1 mm
// and 0.001 degrees. Invariant: the gain of the moving sensor over all others only grows; the joint
// value is measured at both ends, and decides.
#include "arrange/refine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <optional>

#include "arrange/coverage_model.h"
#include "base/error.h"
#include "base/number.h"

namespace ispace {

namespace {

constexpr double kMinStep = 0.001, kMinTurn = 0.05;  // metres, degrees
/// Steps lead to whole multiples of these: layouts are read by people.
constexpr double kPerMetre = 1e4, kPerDegree = 1e3;
/// Share of the total: a smaller gain is rounding.
constexpr double kMinGain = 1e-9;
/// Limit for one length of steps, in case rounding keeps yielding gains.
constexpr std::size_t kMaxRounds = 200;

/// A step of one length along some of the axes.
struct Direction {
    int x = 0, y = 0, turn = 0;

    [[nodiscard]] int axes() const { return std::abs(x) + std::abs(y) + std::abs(turn); }
};

/// Returns all ways, first those along one axis, then along two and three.
std::vector<Direction> waysFor(bool turns) {
    std::vector<Direction> ways;
    ways.reserve(26);
    for (int axes = 1; axes <= 3; ++axes)
        for (const int turn : {0, 1, -1})
            for (const int y : {0, 1, -1})
                for (const int x : {0, 1, -1})
                    if (const Direction way{x, y, turn}; way.axes() == axes && (turns || turn == 0))
                        ways.push_back(way);
    return ways;
}

/// Length of a step.
struct Stride {
    double metres, degrees;
};

std::vector<Stride> stridesOf(const RefineOptions& options) {
    std::vector<Stride> strides;
    double step = options.step, turn = options.turn.degrees();
    for (;;) {
        strides.push_back({std::max(step, kMinStep), std::max(turn, kMinTurn)});
        if (step <= kMinStep && turn <= kMinTurn) return strides;
        step /= 2;
        turn /= 2;
    }
}

double onLattice(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

Pose3 stepped(const Pose3& pose, const Direction& way, const Stride& stride) {
    Pose3 next = pose;
    next.position.x = onLattice(pose.position.x + way.x * stride.metres, kPerMetre);
    next.position.y = onLattice(pose.position.y + way.y * stride.metres, kPerMetre);
    const double heading = pose.heading.degrees() + way.turn * stride.degrees;
    next.heading =
        Angle::degrees(onLattice(wrapped(Angle::degrees(heading)).degrees(), kPerDegree));
    return next;
}

class Search {
  public:
    Search(const Scene& scene, const VisibleArea& sight, std::span<const Sensor> sensors,
           const FloorWeights& weights, const RefineOptions& options, Progress& progress)
        : options_(options),
          progress_(progress),
          strides_(stridesOf(options)),
          gain_(scene, sight, sensors, weights, options.multiplicity),
          total_(gain_.total()) {
        poses_.reserve(sensors.size());
        for (const Sensor& sensor : sensors) poses_.push_back(sensor.pose);
    }

    Refined run() {
        const std::vector<Pose3> start = poses_;
        const double before = gain_.value();
        ++evaluations_;
        value_ = before;
        progress_.begin("refining", static_cast<std::int64_t>(strides_.size()));
        for (const Stride& stride : strides_) {
            settle(stride);
            progress_.advance(1);
        }
        progress_.end();
        const double after = gain_.value();
        ++evaluations_;
        // Gains were those of single sensors; the joint value decides.
        if (after < before) return {start, before, before, evaluations_};
        return {poses_, before, after, evaluations_};
    }

  private:
    /// Tries steps of this length, sensor after sensor, until no step gains.
    void settle(const Stride& stride) {
        const std::size_t count = poses_.size();
        std::size_t idle = 0;  // sensors in a row that keep their pose
        for (std::size_t turn = 0; idle < count && turn < kMaxRounds * count; ++turn)
            idle = improve(turn % count, stride) ? 1 : idle + 1;
    }

    /// Moves one sensor as long as steps gain; returns false if no step did.
    bool improve(std::size_t sensor, const Stride& stride) {
        if (progress_.stopped()) return false;
        gain_.take(sensor);
        const std::vector<Direction> ways = waysFor(gain_.turns(sensor));
        double gain = gain_.gains(std::span(&poses_[sensor], 1))[0];
        ++evaluations_;
        const double first = gain;
        while (const auto way = bestDirection(sensor, ways, stride, gain)) {
            // Goes on along it as long as that gains.
            while (bestDirection(sensor, std::span(&*way, 1), stride, gain)) continue;
        }
        if (gain == first) return false;
        gain_.put(poses_[sensor]);
        value_ += gain - first;
        if (total_ > 0)
            progress_.note("exact coverage " + formatFixed(100 * value_ / total_, 2) + " %");
        return true;
    }

    /// Finds the best step, along few axes if one of them gains; empty if no step gains.
    std::optional<Direction> bestDirection(std::size_t sensor, std::span<const Direction> ways,
                                           const Stride& stride, double& gain) {
        for (std::size_t begin = 0; begin < ways.size();) {
            std::size_t end = begin;
            while (end < ways.size() && ways[end].axes() == ways[begin].axes()) ++end;
            const auto group = ways.subspan(begin, end - begin);
            if (const auto way = bestOf(sensor, group, stride, gain)) return way;
            begin = end;
        }
        return std::nullopt;
    }

    std::optional<Direction> bestOf(std::size_t sensor, std::span<const Direction> ways,
                                    const Stride& stride, double& gain) {
        if (progress_.stopped()) return std::nullopt;
        std::vector<Pose3> trials;
        std::vector<Direction> taken;
        trials.reserve(ways.size());
        taken.reserve(ways.size());
        for (const Direction& way : ways) {
            const Pose3 trial = stepped(poses_[sensor], way, stride);
            const bool moves = trial.position != poses_[sensor].position;
            if (moves && options_.is_valid && !options_.is_valid(sensor, trial.position.onFloor()))
                continue;
            trials.push_back(trial);
            taken.push_back(way);
        }
        if (trials.empty()) return std::nullopt;
        const std::vector<double> gains = gain_.gains(trials);
        evaluations_ += gains.size();
        std::optional<std::size_t> best;
        double most = gain + kMinGain * total_;
        for (std::size_t i = 0; i < gains.size(); ++i) {
            if (!(gains[i] > most) || !isAccepted(sensor, trials[i])) continue;
            most = gains[i];
            best = i;
        }
        if (!best) return std::nullopt;
        gain = most;
        poses_[sensor] = trials[*best];
        return taken[*best];
    }

    bool isAccepted(std::size_t sensor, const Pose3& trial) {
        if (!options_.accepts) return true;
        std::vector<Pose3> poses = poses_;
        poses[sensor] = trial;
        return options_.accepts(poses);
    }

    const RefineOptions& options_;
    Progress& progress_;
    std::vector<Stride> strides_;
    ExactGain gain_;
    double total_;
    double value_ = 0;
    std::vector<Pose3> poses_;
    std::size_t evaluations_ = 0;
};

}  // namespace

void mustBeRefinable(const Scene& scene, std::span<const SensorModel> devices,
                     const FloorWeights& weights) {
    if (weights.weights.size() > ExactGain::kMaxZones)
        throw UsageError("--refine knows at most " + std::to_string(ExactGain::kMaxZones) +
                         " weights");
    const auto refuse = [](const std::string& whose) {
        throw UsageError("--refine: the exact region of " + whose +
                         " is not known: it sweeps, and not level about the vertical");
    };
    for (const Sensor& sensor : scene.sensors)
        if (sensor.is<Laser>() && sensor.as<Laser>().sweep != SweepAxis::None &&
            !scansSlice(sensor))
            refuse(sensor.id);
    for (const SensorModel& device : devices)
        if (const auto* laser = std::get_if<Laser>(&device))
            if (laser->sweep != SweepAxis::None && laser->sweep != SweepAxis::Heading)
                refuse(laser->model.empty() ? "a laser" : laser->model);
}

Refined refine(const Scene& scene, const VisibleArea& sight, std::span<const Sensor> sensors,
               const FloorWeights& weights, const RefineOptions& options, Progress& progress) {
    return Search(scene, sight, sensors, weights, options, progress).run();
}

namespace {

constexpr double kApart = 0.05;  // metres

bool areApart(const std::vector<Sensor>& before, const std::vector<Pose3>& poses) {
    for (std::size_t i = 0; i < poses.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) {
            const double least =
                std::min(kApart, length(before[i].pose.position - before[k].pose.position));
            if (length(poses[i].position - poses[k].position) < least) return false;
        }
    return true;
}

}  // namespace

namespace {

/// Refines the sensors of one room among the others; `placements` receive their poses.
Refined refineRoom(CoverageModel& model, std::size_t room, std::vector<Placement>& placements,
                   std::uint64_t least, Progress& progress) {
    if (!model.hasRoom(room) || !model.site().rooms[room].goals.counts) return {};
    RoomModel& own = model.room(room);
    std::vector<std::size_t> moving;
    std::vector<Sensor> sensors;
    std::vector<const SiteValidity*> validities;
    for (std::size_t i = 0; i < placements.size(); ++i) {
        if (placements[i].room != room) continue;
        moving.push_back(i);
        sensors.push_back(sensorOf(model.groups(), placements[i]));
        validities.push_back(&own.pool().validityAt(placements[i].pose.position.z));
    }
    if (moving.empty()) return {};
    RefineOptions refining{.multiplicity = model.options().redundancy};
    refining.is_valid = [&](std::size_t i, Point2 place) { return validities[i]->isValid(place); };
    refining.accepts = [&](const std::vector<Pose3>& poses) { return areApart(sensors, poses); };
    const auto refined = [&] {
        return refine(own.scene(), own.sight(), sensors, own.options().weights, refining, progress);
    };
    const auto with_poses = [&](const std::vector<Pose3>& poses) {
        std::vector<Placement> moved = placements;
        for (std::size_t i = 0; i < poses.size(); ++i) moved[moving[i]].pose = poses[i];
        return moved;
    };
    const auto is_kept = [&](const std::vector<Pose3>& poses) {
        const std::vector<Placement> moved = with_poses(poses);
        const std::vector<CountedView> views = model.viewsOf(std::span<const Placement>(moved));
        return model.valueOf(views) >= least &&
               (!model.options().is_connected || model.isConnected(views));
    };
    Refined best = refined();
    if (!is_kept(best.poses)) {
        // The exact optimum may lose a cell on the grid by which results are compared, or break the
        // connection: then each step is tested for that.
        refining.accepts = [&](const std::vector<Pose3>& poses) {
            return areApart(sensors, poses) && is_kept(poses);
        };
        best = refined();
    }
    placements = with_poses(best.poses);
    return best;
}

}  // namespace

Refined refine(CoverageModel& model, const std::vector<Placement>& placements, std::uint64_t least,
               Progress& progress) {
    std::vector<Placement> moved = placements;
    Refined all;
    for (std::size_t room = 0; room < model.site().rooms.size(); ++room) {
        const Refined own = refineRoom(model, room, moved, least, progress);
        all.before += own.before;
        all.after += own.after;
        all.evaluations += own.evaluations;
    }
    for (const Placement& placement : moved) all.poses.push_back(placement.pose);
    return all;
}

}  // namespace ispace
