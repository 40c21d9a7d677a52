// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/placed_meshes.h"

#include <algorithm>
#include <array>
#include <utility>

#include "env/body.h"

namespace ispace {

namespace {

/// A pyramid that points forward from a rectangle across x, closed.
void addNose(Mesh& mesh, double from, double to, double half_width, double low, double high) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const double z : {low, high})
        for (const double y : {-half_width, half_width}) mesh.vertices.push_back({from, y, z});
    mesh.vertices.push_back({to, 0, low + (high - low) / 2});
    using Triangle = std::array<std::uint32_t, 3>;
    for (const Triangle& corners : {Triangle{0, 2, 3}, Triangle{0, 3, 1}, Triangle{0, 1, 4},
                                    Triangle{1, 3, 4}, Triangle{3, 2, 4}, Triangle{2, 0, 4}})
        mesh.triangles.push_back({first + corners[0], first + corners[1], first + corners[2]});
}

}  // namespace

Mesh sensorMesh() {
    constexpr double kHalf = 0.025, kHalfHeight = 0.035, kNose = 0.05;
    Mesh mesh;
    for (const double z : {-kHalfHeight, kHalfHeight})
        for (const auto& [x, y] :
             {Point2{-kHalf, -kHalf}, {kHalf, -kHalf}, {kHalf, kHalf}, {-kHalf, kHalf}})
            mesh.vertices.push_back({x, y, z});
    mesh.vertices.push_back({kNose, 0, 0});
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4}, {2, 3, 7},
                      {2, 7, 6}, {3, 0, 4}, {3, 4, 7}, {1, 2, 8}, {2, 6, 8}, {6, 5, 8}, {5, 1, 8}};
    return mesh;
}

Mesh robotMesh(const RobotModel& model) {
    const bool is_box = model.length > 0;
    const double length = is_box ? model.length : 2 * model.radius;
    const double width = is_box ? model.width : 2 * model.radius;
    const Point2 middle{model.center, 0};
    Prism prism;
    prism.footprint =
        is_box ? rectangle(middle, length, width, {}) : ellipse(middle, length, width, {});
    prism.top = model.height;
    Body body;
    body.prisms.push_back(std::move(prism));
    Mesh mesh = meshesOf(body, true).front();
    // It begins within the body, round or not, and stands out by as much.
    const double nose = std::min(length, width) / 8, front = model.center + length / 2;
    addNose(mesh, front - nose, front + nose, nose, 0.5 * model.height, 0.75 * model.height);
    return mesh;
}

}  // namespace ispace
