// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "geom/pose.h"
#include "layout/run_reader.h"
#include "layout/scene.h"

namespace ispace {

/// Where robots and people were in a run that simrun recorded, held in memory.
class RunRecord {
  public:
    /// Reads all moments. \throws as the reader, and FormatError if there is none
    explicit RunRecord(RunReader reader);

    /// The first and last time, seconds.
    [[nodiscard]] double begin() const { return steps_.front().time; }
    [[nodiscard]] double end() const { return steps_.back().time; }
    /// \throws FormatError for one of the start that the scene does not have
    void checkStart(const Scene& scene) const;
    /// Puts robots and people where they were at the last step at or before this time, with what
    /// they carry. Who is not in the scene is passed over.
    void apply(Scene& scene, double time) const;
    /// How far the limbs of Scene::people swung at that step, as humanParts() takes it; 0 of those
    /// who were not there.
    [[nodiscard]] std::vector<Angle> swingsAt(const Scene& scene, double time) const;
    /// The ways of all from the beginning up to this time, on the floor, without turns on
    /// the spot.
    [[nodiscard]] std::vector<std::vector<Point2>> waysUntil(double time) const;

  private:
    struct Step {
        double time = 0;
        std::size_t who = 0;
        Pose2 pose;
        Angle swing = {};  // of a person's limbs
    };

    /// The last step of each at or before this time, by `who`.
    [[nodiscard]] std::map<std::size_t, const Step*> lastSteps(double time) const;

    std::string name_;
    std::vector<RunMember> who_;
    std::vector<Step> steps_;  // by ascending time, never empty
};

}  // namespace ispace
