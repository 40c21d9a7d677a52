// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geom/pose.h"
#include "layout/scene.h"

namespace ispace {

/// Where robots were in a run that simrun recorded.
class RunRecord {
  public:
    /// \param bytes of robots.csv \param name for messages \throws FormatError
    RunRecord(std::string_view bytes, const std::string& name);

    /// The first and last time, seconds.
    [[nodiscard]] double begin() const { return steps_.front().time; }
    [[nodiscard]] double end() const { return steps_.back().time; }
    /// Puts robots where they were at the last step at or before this time, with what they carry.
    /// \throws FormatError for a robot that the scene does not have
    void apply(Scene& scene, double time) const;
    /// The ways of all robots from the beginning up to this time, on the floor, without turns on
    /// the spot.
    [[nodiscard]] std::vector<std::vector<Point2>> waysUntil(double time) const;

  private:
    struct Step {
        double time = 0;
        std::string id;
        Pose2 pose;
    };
    std::string name_;
    std::vector<Step> steps_;  // by ascending time, never empty
};

}  // namespace ispace
