// SPDX-License-Identifier: GPL-3.0-or-later
// Shared by the writers of SDF and URDF: poses, boxes and cylinders in XML.
#pragma once

#include <array>
#include <initializer_list>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "env/mesh.h"
#include "geom/pose.h"
#include "scene/scene.h"

namespace ispace {

/// Creates names from ids. Both formats require unique names other than `world`; SDF also reserves
/// `::` and names within double underscores.
class XmlNames {
  public:
    /// \param reserved names already in the file
    explicit XmlNames(std::set<std::string> reserved = {"world"}) : taken_(std::move(reserved)) {}
    /// Returns the id, changed as little as possible.
    std::string take(std::string_view id);

  private:
    std::set<std::string> taken_;
};

/// Writes lengths to a nanometre and angles to a thousandth of a nanoradian, separated by blanks:
/// further digits of computed values are rounding.
std::string lengthsText(std::initializer_list<double> metres);
std::string radiansText(Angle angle);
/// Writes roll, pitch and yaw as both formats define them: Rz(yaw) Ry(pitch) Rx(roll), pitch down.
std::string anglesText(const Pose3& pose);

/// Adds an element with text in it.
pugi::xml_node addText(pugi::xml_node parent, const char* name, const std::string& text);

/// Returns the file's text, indented.
std::string xmlText(const pugi::xml_document& document);

/// An upright box around meshes, in their frame.
struct MeshBox {
    Point3 center;
    std::array<double, 3> size{};  ///< along x, y and z
};
/// \pre the meshes have vertices
MeshBox boxAround(const std::vector<Mesh>& meshes);

}  // namespace ispace
