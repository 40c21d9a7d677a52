// SPDX-License-Identifier: GPL-3.0-or-later
// A recorded run as poses at any time, for pictures of it. Seconds and metres; apply() looks at all
// moments up to the time.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "geom/pose.h"
#include "scene/run/run_reader.h"
#include "scene/scene.h"

namespace ispace::views {

/// Holds the poses of robots and people in a recorded run in memory.
class RunRecord {
  public:
    /// Reads all moments. \throws as the reader, and FormatError if there is no moment
    explicit RunRecord(RunReader reader);

    /// Returns the first and last time, seconds.
    [[nodiscard]] double begin() const { return steps_.front().time; }
    [[nodiscard]] double end() const { return steps_.back().time; }
    /// Checks the movers at the start. \throws FormatError for one that the scene does not have
    void checkStart(const Scene& scene) const;
    /// Moves robots and people, and the sensors mounted on them, to their poses at the last step at
    /// or before this time. Skips movers that the scene does not have.
    void apply(Scene& scene, double time) const;
    /// Returns the swing of the limbs of Scene::people at that step, as humanParts() takes it; 0
    /// for absent people.
    [[nodiscard]] std::vector<Angle> swingsAt(const Scene& scene, double time) const;
    /// Returns the ways of all movers until this time, on the floor, without turns on the spot.
    [[nodiscard]] std::vector<std::vector<Point2>> waysUntil(double time) const;

  private:
    struct Step {
        double time = 0;
        std::size_t member = 0;
        Pose2 pose;
        Angle swing = {};  // of a person's limbs
    };

    /// Returns the last step of each mover at or before this time, by `member`.
    [[nodiscard]] std::map<std::size_t, const Step*> lastSteps(double time) const;

    std::string name_;
    std::vector<RunMember> members_;
    std::vector<Step> steps_;  // sorted by time, not empty
};

}  // namespace ispace::views
