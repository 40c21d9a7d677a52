// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "env/mesh.h"
#include "layout/scene.h"

namespace ispace {

/// One named thing of a model, as triangles: what the writers of GLB, OBJ and STL have in common.
struct ModelNode {
    std::string id;
    std::string keyword;        ///< "" for the floor of the indoor region, whose id is "floor"
    std::optional<Pose3> pose;  ///< frame of the meshes; none: they are in the world's
    std::vector<Mesh> meshes;   ///< one a material; never empty, each with triangles
    const Element* element = nullptr;  ///< of the scene; none: the floor, or what is placed
};

/// Elements in the order of their records, the floor behind them, then what is placed: sensors,
/// robots, people. Elements without a body (zones, inside points) are left out.
/// The nodes point into the scene. `with_views`: sensors with what they look at.
std::vector<ModelNode> modelOf(const Scene& scene, bool with_views = false);

}  // namespace ispace
