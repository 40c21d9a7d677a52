// SPDX-License-Identifier: GPL-3.0-or-later
// Source: tf2_web_republisher. Frames are looked up in the newest transforms; feedback holds those
// that moved by more than a threshold since they were sent.
#include "extensions/ros/transform_goals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/json_writer.h"
#include "sense/formats/cdr.h"

namespace ispace::ros {

namespace {

constexpr double kDefaultRate = 10, kHighestRate = 100;

std::string withoutSlash(const std::string& frame) {
    return frame.starts_with('/') ? frame.substr(1) : frame;
}

}  // namespace

void TransformTree::add(std::string_view message) {
    CdrReader in(message);
    for (std::size_t left = in.count(); left > 0; --left) {
        in.number<std::int32_t>();
        in.number<std::uint32_t>();
        Link link;
        link.parent = in.text();
        const std::string child(in.text());
        std::array<double, 7> values{};  // the place, and a quaternion with w last
        for (double& value : values) value = in.number<double>();
        link.pose = Eigen::Translation3d(values[0], values[1], values[2]) *
                    Eigen::Quaterniond(values[6], values[3], values[4], values[5]);
        links_.insert_or_assign(child, std::move(link));
    }
}

Eigen::Isometry3d TransformTree::poseInRoot(std::string& frame) const {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    // A chain is no longer than there are links.
    for (std::size_t left = links_.size(); left > 0; --left) {
        const auto link = links_.find(frame);
        if (link == links_.end()) break;
        pose = link->second.pose * pose;
        frame = link->second.parent;
    }
    return pose;
}

std::optional<Eigen::Isometry3d> TransformTree::pose(const std::string& frame,
                                                     const std::string& in) const {
    std::string root = frame, other_root = in;
    const Eigen::Isometry3d pose = poseInRoot(root), other = poseInRoot(other_root);
    if (root != other_root) return std::nullopt;
    return other.inverse() * pose;
}

TransformGoals::~TransformGoals() { follow(false); }

std::string TransformGoals::begin(const std::string& id, const nlohmann::json& goal) {
    if (!goal.is_object()) return "the goal has no frames";
    if (goals_.size() >= kMostGoals && !goals_.contains(id)) return "too many goals";
    const auto number = [&](const char* name, double otherwise) {
        const auto found = goal.find(name);
        return found != goal.end() && found->is_number() ? found->get<double>() : otherwise;
    };
    Goal out;
    out.target = withoutSlash(goal.value("target_frame", ""));
    const auto sources = goal.find("source_frames");
    if (sources != goal.end())
        for (const auto& source : *sources)
            if (source.is_string() && out.frames.size() < kMostFrames)
                out.frames.try_emplace(withoutSlash(source.get<std::string>()));
    out.angle = number("angular_thres", 0);
    out.distance = number("trans_thres", 0);
    const double rate = number("rate", kDefaultRate);
    out.period = std::chrono::nanoseconds(
        std::llround(1e9 / (rate > 0 ? std::min(rate, kHighestRate) : kDefaultRate)));
    goals_.insert_or_assign(id, std::move(out));
    follow(true);
    return "";
}

bool TransformGoals::end(const std::string& id) {
    if (goals_.erase(id) == 0) return false;
    follow(!goals_.empty());
    return true;
}

/// Subscribes to the topics, or cancels that.
void TransformGoals::follow(bool is_wanted) {
    if (is_wanted == !topics_.empty()) return;
    if (is_wanted) {
        for (const char* topic : {"/tf", "/tf_static"})
            for (const std::uint32_t number : feed_->numbersOf(topic)) topics_.push_back(number);
        for (const std::uint32_t number : topics_) feed_->want(number);
        return;
    }
    for (const std::uint32_t number : topics_) feed_->unwant(number);
    topics_.clear();
    taken_.clear();
    tree_ = {};
}

void TransformGoals::update() {
    const bool has_changed = std::ranges::any_of(topics_, [&](std::uint32_t number) {
        const auto entry = feed_->entries().find(number);
        return entry != feed_->entries().end() && entry->second.newest &&
               entry->second.newest->number() != taken_[number];
    });
    if (!has_changed) return;
    tree_ = {};  // frames may have gone
    for (const std::uint32_t number : topics_) {
        const auto entry = feed_->entries().find(number);
        if (entry == feed_->entries().end() || !entry->second.newest) continue;
        const RosMessage& message = *entry->second.newest;
        taken_[number] = message.number();
        time_ = std::max(time_, message.time());
        tree_.add(*message.cdr());
    }
}

/// Returns the JSON of the poses that have changed; "" for none.
std::string TransformGoals::feedback(Goal& goal) const {
    JsonWriter json;
    json.beginObject().key("transforms").beginArray();
    bool is_empty = true;
    for (auto& [frame, sent] : goal.frames) {
        const auto pose = tree_.pose(frame, goal.target);
        if (!pose) continue;
        const Eigen::Quaterniond turn(pose->rotation());
        if (sent && (pose->translation() - sent->translation()).norm() <= goal.distance &&
            turn.angularDistance(Eigen::Quaterniond(sent->rotation())) <= goal.angle)
            continue;
        sent = pose;
        is_empty = false;
        constexpr std::uint64_t kSecond = 1'000'000'000;
        json.beginObject().key("header").beginObject().key("stamp").beginObject();
        json.key("sec").value(static_cast<std::int64_t>(time_ / kSecond));
        json.key("nanosec").value(static_cast<std::int64_t>(time_ % kSecond)).endObject();
        json.key("frame_id").value(goal.target).endObject().key("child_frame_id").value(frame);
        json.key("transform").beginObject().key("translation").beginObject();
        json.key("x").value(pose->translation().x()).key("y").value(pose->translation().y());
        json.key("z").value(pose->translation().z()).endObject().key("rotation").beginObject();
        json.key("x").value(turn.x()).key("y").value(turn.y()).key("z").value(turn.z());
        json.key("w").value(turn.w()).endObject().endObject().endObject();
    }
    return is_empty ? "" : json.endArray().endObject().take();
}

void TransformGoals::stepped(
    const std::function<void(const std::string& id, std::string feedback)>& send) {
    const WallTime now = std::chrono::steady_clock::now();
    for (auto& [id, goal] : goals_) {
        if (now - goal.last < goal.period) continue;
        update();
        std::string text = feedback(goal);
        if (text.empty()) continue;
        goal.last = now;
        send(id, std::move(text));
    }
}

}  // namespace ispace::ros
