// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/module/node_graph.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "io/mesh_parts.h"

namespace ispace {

NodeGraph::Node NodeGraph::add() {
    if (children_.size() >= kMaxMeshNodes)
        throw std::runtime_error("bad mesh file: more than " + std::to_string(kMaxMeshNodes) +
                                 " nodes");
    children_.emplace_back();
    return static_cast<Node>(children_.size() - 1);
}

void NodeGraph::check() const {
    struct Below {
        std::size_t count = 0, depth = 0;  // with the node itself; 0: not known yet
        bool open = false;
    };
    struct Step {
        Node node;
        std::size_t next;  // child to look at
    };
    std::vector<Below> below(children_.size());
    for (Node root = 0; root < children_.size(); ++root) {
        std::vector<Step> path;
        const auto enter = [&](Node node) {
            if (below[node].open)
                throw std::runtime_error("bad mesh file: a node that contains itself");
            if (below[node].count > 0) return;
            below[node] = {0, 1, true};
            path.push_back({node, 0});
        };
        enter(root);
        while (!path.empty()) {
            Step& step = path.back();
            const Node node = step.node;
            const std::vector<Node>& children = children_[node];
            if (step.next < children.size()) {
                enter(children[step.next++]);
                continue;
            }
            path.pop_back();
            Below sum{1, 1, false};
            for (const Node child : children) {
                sum.count += below[child].count;
                sum.depth = std::max(sum.depth, below[child].depth + 1);
            }
            if (sum.depth > kMaxMeshNodeDepth)
                throw std::runtime_error("bad mesh file: nodes nested more than " +
                                         std::to_string(kMaxMeshNodeDepth) + " deep");
            if (sum.count > kMaxMeshNodes)
                throw std::runtime_error("bad mesh file: more than " +
                                         std::to_string(kMaxMeshNodes) +
                                         " nodes, each instance counted");
            below[node] = sum;
        }
    }
}

}  // namespace ispace
