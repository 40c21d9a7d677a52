// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/sdf_frames.h"

#include <cmath>
#include <string>
#include <utility>

#include "base/message.h"
#include "io/import_records.h"

namespace ispace {

namespace {

constexpr int kLongestChain = 200;  // frames relative to frames

using Transform = Eigen::Isometry3d;

bool isInclude(pugi::xml_node node) { return std::string_view(node.name()) == "include"; }

/// Radians as files have them: 1.5708 and its kin are meant to be quarter turns.
Angle snappedAngle(double radians) {
    constexpr double kClose = 1e-3;  // degrees
    const double degrees = Angle::radians(radians).degrees();
    const double quarter = std::round(degrees / 90) * 90;
    return Angle::degrees(std::abs(degrees - quarter) < kClose ? quarter : degrees);
}

}  // namespace

pugi::xml_node SdfFrames::modelOf(pugi::xml_node node) const {
    return isInclude(node) ? files_.included(node) : node;
}

std::string_view SdfFrames::nameOf(pugi::xml_node node) const {
    const std::string_view own =
        isInclude(node) ? trimmed(node.child_value("name")) : std::string_view();
    return own.empty() ? modelOf(node).attribute("name").value() : own;
}

/// An include without a pose leaves the model's own.
pugi::xml_node SdfFrames::poseNode(pugi::xml_node node) const {
    const pugi::xml_node own = node.child("pose");
    return own ? own : modelOf(node).child("pose");
}

Transform SdfFrames::poseIn(pugi::xml_node node) const {
    const pugi::xml_node pose_node = poseNode(node);
    const std::string_view text = pose_node.child_value();
    if (trimmed(text).empty()) return Transform::Identity();
    Transform pose = Transform::Identity();
    if (std::string_view(pose_node.attribute("rotation_format").value()) == "quat_xyzw") {
        const std::vector<double> n = files_.numbersOf(pose_node, text, 7);
        const Eigen::Quaterniond turn(n[6], n[3], n[4], n[5]);
        if (!(turn.norm() > 0)) files_.fail(pose_node, "`pose`: a quaternion of length 0");
        pose.linear() = turn.normalized().toRotationMatrix();
        pose.translation() = Eigen::Vector3d(n[0], n[1], n[2]);
        return pose;
    }
    const std::vector<double> n = files_.numbersOf(pose_node, text, 6);
    const bool in_degrees = pose_node.attribute("degrees").as_bool();
    const auto turn = [&](int axis, double angle) {
        return turnAbout(axis, in_degrees ? Angle::degrees(angle) : snappedAngle(angle));
    };
    pose.linear() = (turn(2, n[5]) * turn(1, n[4]) * turn(0, n[3])).toRotationMatrix();
    pose.translation() = Eigen::Vector3d(n[0], n[1], n[2]);
    return pose;
}

const SdfScope& SdfFrames::scopeOf(pugi::xml_node node) {
    if (const auto known = scopes_.find(node.hash_value()); known != scopes_.end())
        return *known->second;
    SdfScope scope{modelOf(node)};
    files_.loadIncludes(scope.node);
    for (const pugi::xml_node child : scope.node.children()) {
        const std::string_view kind = child.name();
        const bool is_include = kind == "include" && files_.included(child);
        if (is_include && child.attribute("merge").as_bool())
            scope.merged.push_back(child);
        else if (is_include || kind == "model" || kind == "link" || kind == "frame" ||
                 kind == "joint")
            scope.children.emplace(nameOf(child), child);
    }
    auto& made = scopes_[node.hash_value()];
    made = std::make_unique<SdfScope>(std::move(scope));
    return *made;
}

Transform SdfFrames::frameCalled(std::string_view name, const SdfScope& scope, pugi::xml_node user,
                                 int length) {
    const bool is_world = std::string_view(scope.node.name()) == "world";
    if (name.empty() || name == "__model__" || (is_world && name == "world"))
        return Transform::Identity();
    const std::size_t colons = name.find("::");
    const std::string_view first = name.substr(0, colons);
    const auto child = scope.children.find(first);
    if (child != scope.children.end()) {
        const Transform& frame = frameOf(child->second, scope, length + 1);
        if (colons == std::string_view::npos) return frame;
        return frame *
               frameCalled(name.substr(colons + 2), scopeOf(child->second), user, length + 1);
    }
    for (const pugi::xml_node include : scope.merged)
        if (const SdfScope& inner = scopeOf(include); inner.children.contains(first))
            return frameOf(include, scope, length + 1) * frameCalled(name, inner, user, length + 1);
    files_.fail(user, "no frame called " + excerpt(name) + " beside it");
}

const Transform& SdfFrames::frameOf(pugi::xml_node node, const SdfScope& scope, int length) {
    if (const auto known = frames_.find(node.hash_value()); known != frames_.end())
        return *known->second;
    if (length > kLongestChain)
        files_.fail(node, "its pose is relative to itself, by more than " +
                              std::to_string(kLongestChain) + " frames");
    const std::string_view kind = node.name();
    std::string_view base = poseNode(node).attribute("relative_to").value();
    if (base.empty() && kind == "frame") base = node.attribute("attached_to").value();
    if (base.empty() && kind == "joint") base = trimmed(node.child_value("child"));
    Transform frame = frameCalled(base, scope, node, length) * poseIn(node);
    // Where a model's own frame is: its pose may be that of a frame in it.
    std::string_view placed = trimmed(node.child_value("placement_frame"));
    if (placed.empty()) placed = modelOf(node).attribute("placement_frame").value();
    if (!placed.empty()) frame = frame * frameCalled(placed, scopeOf(node), node, length).inverse();
    auto& made = frames_[node.hash_value()];
    made = std::make_unique<Transform>(frame);
    return *made;
}

}  // namespace ispace
