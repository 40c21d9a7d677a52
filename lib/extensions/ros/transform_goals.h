// SPDX-License-Identifier: GPL-3.0-or-later
// Poses of frames in a chosen one, for browsers without a library of tf.
#pragma once

#include <Eigen/Geometry>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "extensions/ros/ros_feed.h"

namespace ispace::ros {

/// The frames of messages of /tf and /tf_static.
class TransformTree {
  public:
    /// Takes the transforms of a message in CDR. \throws FormatError
    void add(std::string_view message);
    /// Returns the pose of a frame in another; empty if no transforms lead between them.
    [[nodiscard]] std::optional<Eigen::Isometry3d> pose(const std::string& frame,
                                                        const std::string& in) const;

  private:
    struct Link {
        std::string parent;
        Eigen::Isometry3d pose;  ///< in the parent
    };
    /// Returns the pose in the root, whose name replaces the frame's.
    [[nodiscard]] Eigen::Isometry3d poseInRoot(std::string& frame) const;

    std::map<std::string, Link> links_;  // by child
};

/// Goals of the action tf2_web_republisher, by which roslib's TF clients get the poses of frames in
/// one that they choose: those that have moved further than a threshold, at most at a rate of wall
/// time. Frames have no leading slash.
class TransformGoals {
  public:
    static constexpr std::size_t kMostGoals = 16, kMostFrames = 256;

    explicit TransformGoals(RosFeed& feed) : feed_(&feed) {}
    TransformGoals(const TransformGoals&) = delete;
    TransformGoals& operator=(const TransformGoals&) = delete;
    ~TransformGoals();

    /// \param goal source_frames, target_frame, angular_thres, trans_thres, rate; it replaces an
    /// earlier one of this id \returns why there is none, or ""
    std::string begin(const std::string& id, const nlohmann::json& goal);
    /// \returns false if there is no such goal
    bool end(const std::string& id);
    /// Calls send(id, feedback) for each goal of which frames have moved, with the JSON of its
    /// feedback. Call after each step.
    void stepped(const std::function<void(const std::string& id, std::string feedback)>& send);

  private:
    struct Goal {
        std::string target;
        std::map<std::string, std::optional<Eigen::Isometry3d>> frames;  // poses that were sent
        double angle = 0, distance = 0;  ///< thresholds, radians and metres
        std::chrono::nanoseconds period{};
        WallTime last{};
    };
    void follow(bool is_wanted);
    void update();
    std::string feedback(Goal& goal) const;

    RosFeed* feed_;
    std::map<std::string, Goal> goals_;
    std::vector<std::uint32_t> topics_;            // subscribed
    std::map<std::uint32_t, std::int64_t> taken_;  // numbers of messages in the tree, by topic
    std::uint64_t time_ = 0;                       // of the newest, nanoseconds
    TransformTree tree_;
};

}  // namespace ispace::ros
