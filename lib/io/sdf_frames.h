// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <pugixml.hpp>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "geom/rotation.h"
#include "io/sdf_files.h"

namespace ispace {

/// A world or model of SDF: what its children's poses may be relative to.
struct SdfScope {
    pugi::xml_node node;  ///< of a model included, in its own file
    /// With a pose, by name; models that are included by their `include`.
    std::unordered_map<std::string_view, pugi::xml_node> children = {};
    std::vector<pugi::xml_node> merged = {};  ///< includes whose children count as its own
};

/// Poses of SDF 1.0 to 1.11, each in the scope's own frame: nested models, frames, `relative_to`,
/// `attached_to`, `placement_frame`, and includes with their own pose. O(1) for each pose, as none
/// is resolved twice.
///
/// All throw FormatError with the line: numbers that are none, frames that are not there or depend
/// on each other, and what SdfFiles throws.
class SdfFrames {
  public:
    using Transform = Eigen::Isometry3d;

    explicit SdfFrames(SdfFiles& files) : files_(files) {}

    /// Of a world, a `model`, or an `include` with one.
    const SdfScope& scopeOf(pugi::xml_node node);
    /// The frame of a link, joint, frame, model or include in the scope. \param length of the chain
    /// of frames that led to it
    const Transform& frameOf(pugi::xml_node node, const SdfScope& scope, int length = 0);
    /// The frame that an attribute of `user` names; "": the scope's own.
    Transform frameCalled(std::string_view name, const SdfScope& scope, pugi::xml_node user,
                          int length = 0);
    /// What a `pose` in the node says, in whatever frame.
    [[nodiscard]] Transform poseIn(pugi::xml_node node) const;
    [[nodiscard]] std::string_view nameOf(pugi::xml_node node) const;

  private:
    [[nodiscard]] pugi::xml_node modelOf(pugi::xml_node node) const;
    [[nodiscard]] pugi::xml_node poseNode(pugi::xml_node node) const;

    SdfFiles& files_;
    std::unordered_map<std::size_t, std::unique_ptr<SdfScope>> scopes_;  // by node
    std::unordered_map<std::size_t, std::unique_ptr<Transform>> frames_;
};

}  // namespace ispace
