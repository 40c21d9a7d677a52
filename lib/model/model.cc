// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/model.h"

#include <optional>
#include <utility>
#include <vector>

#include "env/mesh.h"
#include "layout/bodies.h"

namespace ispace {

namespace {

/// Adds the node if it has anything to show.
void addNode(std::vector<ModelNode>& nodes, ModelNode node) {
    std::erase_if(node.meshes, [](const Mesh& mesh) { return mesh.triangles.empty(); });
    if (!node.meshes.empty()) nodes.push_back(std::move(node));
}

void addPlaced(std::vector<ModelNode>& nodes, const Scene& scene, bool with_views) {
    addNode(nodes, {"floor", "", {}, {scene.environment.floor()}});
    for (const Placed& placed : scene.placed) {
        std::vector<Mesh> meshes = bodyOf(scene, placed);
        if (auto view = with_views ? viewOf(scene, placed) : std::nullopt)
            meshes.push_back(std::move(*view));
        addNode(nodes, {scene.ids[placed.record], scene.records[placed.record].keyword(),
                        placed.pose, std::move(meshes)});
    }
}

}  // namespace

ModelNode nodeOf(const Element& element) {
    return {element.id,
            element.record.keyword(),
            {},
            meshesOf(element.body, Surfaces::Drawn),
            &element};
}

std::vector<ModelNode> modelOf(const Scene& scene) {
    std::vector<ModelNode> nodes;
    for (const Element& element : scene.environment.elements()) addNode(nodes, nodeOf(element));
    addPlaced(nodes, scene, false);
    return nodes;
}

std::vector<ModelNode> placedNodes(const Scene& scene, bool with_views) {
    std::vector<ModelNode> nodes;
    addPlaced(nodes, scene, with_views);
    return nodes;
}

}  // namespace ispace
