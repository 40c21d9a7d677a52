// SPDX-License-Identifier: GPL-3.0-or-later
// The syntax of Webots' worlds, a dialect of VRML97: nodes with fields, and nodes used again.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/budget.h"

namespace ispace::webots {

struct VrmlNode;

/// The value of a field; which of the members are filled depends on the field.
struct VrmlValue {
    std::vector<double> numbers = {};
    std::vector<std::string> texts = {};
    std::vector<const VrmlNode*> nodes = {};
    std::string_view word = {};  ///< TRUE, FALSE or NULL
};

/// A node: `DEF name Type { field value … }`.
struct VrmlNode {
    std::string_view type, def = {};
    int line = 0;
    std::vector<std::pair<std::string_view, VrmlValue>> fields = {};

    /// Returns the value of a field; null if it is not given, so that its default holds.
    [[nodiscard]] const VrmlValue* field(std::string_view name) const;
};

/// A parsed world. Nodes that USE shares are stored once, so a walk must bound its work and depth.
/// Neither PROTOs nor other files are fetched. O(bytes). Not movable: nodes point into it.
class VrmlFile {
  public:
    /// \param bytes outlive this object \param work pays for nodes
    /// \throws FormatError with the line: bad syntax, nodes nested too deep, USE of an unknown
    /// name, more work than the budget has
    VrmlFile(std::string_view bytes, const std::string& name, Budget& work);
    VrmlFile(const VrmlFile&) = delete;
    VrmlFile& operator=(const VrmlFile&) = delete;

    /// The version in the first line: "R2023b".
    [[nodiscard]] std::string_view version() const { return version_; }
    [[nodiscard]] const std::vector<const VrmlNode*>& roots() const { return roots_; }

    static constexpr int kMaxDepth = 128;  ///< nodes within nodes

  private:
    class Parser;

    std::string_view version_;
    std::deque<VrmlNode> nodes_;
    std::vector<const VrmlNode*> roots_;
};

}  // namespace ispace::webots
