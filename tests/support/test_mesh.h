// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of lib/kernel/env and the libraries above it: builds meshes.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "env/body.h"
#include "env/element_schemas.h"
#include "env/mesh.h"
#include "env/slice.h"
#include "geom/arrangement.h"
#include "record/record.h"
#include "record/text.h"

namespace ispace::testing {

using Corner = std::array<float, 3>;

/// Builds a closed box between two corners.
inline TriangleMesh boxMesh(Corner low, Corner high) {
    TriangleMesh mesh;
    for (const float z : {low[2], high[2]})
        for (const auto& [x, y] :
             {std::pair{low[0], low[1]}, {high[0], low[1]}, {high[0], high[1]}, {low[0], high[1]}})
            mesh.vertices.push_back({x, y, z});
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                      {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
    return mesh;
}

/// Merges both, side by side; the second with its faces inward if `hollow`.
inline TriangleMesh joined(TriangleMesh a, const TriangleMesh& b, bool hollow = false) {
    const auto first = static_cast<std::uint32_t>(a.vertices.size());
    a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
    for (auto [i, j, k] : b.triangles) {
        if (hollow) std::swap(j, k);
        a.triangles.push_back({first + i, first + j, first + k});
    }
    return a;
}

/// Builds a torus about the z axis from a grid of `rows` by `columns` vertices, `radius` from the
/// axis, with a tube of radius `tube`; the grid closes on both sides.
inline TriangleMesh torusMesh(double radius, double tube, std::uint32_t columns,
                              std::uint32_t rows) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < columns; ++i)
        for (std::uint32_t k = 0; k < rows; ++k) {
            const double u = 2 * std::numbers::pi * i / columns,
                         v = 2 * std::numbers::pi * k / rows;
            const double r = radius + tube * std::cos(v);
            mesh.vertices.push_back({static_cast<float>(r * std::cos(u)),
                                     static_cast<float>(r * std::sin(u)),
                                     static_cast<float>(tube * std::sin(v))});
        }
    for (std::uint32_t i = 0; i < columns; ++i)
        for (std::uint32_t k = 0; k < rows; ++k) {
            const std::uint32_t next = (i + 1) % columns, above = (k + 1) % rows;
            const std::uint32_t a = i * rows + k, b = next * rows + k, c = next * rows + above,
                                d = i * rows + above;
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
        }
    return mesh;
}

inline Record withMesh(const std::string& line, TriangleMesh mesh) {
    static const Schemas kSchemas(environmentSchemas());
    Record record = readRecord(line, "line", kSchemas);
    record.setMesh(std::make_shared<const TriangleMesh>(std::move(mesh)));
    return record;
}

/// Returns the body of a mesh record with these contents.
inline Body meshed(const TriangleMesh& mesh, const std::string& keys = "") {
    return bodyOf(withMesh("mesh file=a.stl " + keys, mesh));
}

inline Slice cut(const Body& body, double height) {
    Slice slice;
    cutMeshes(body, height, slice);
    return slice;
}

/// Computes the area of the union of solids, within 100 m of the origin.
inline double unionArea(const std::vector<Polygon>& solids) {
    const Polygon all = rectangle({0, 0}, 200, 200, {});
    return 40000 - totalArea(difference({all, {}}, solids));
}

/// Computes the volume of a closed mesh by the divergence theorem, positive if it is wound outward.
inline double volume(const Mesh& mesh) {
    double sum = 0;
    for (const auto& [i, j, k] : mesh.triangles) {
        const Point3 o{};
        sum += dot(mesh.vertices[i] - o, cross(mesh.vertices[j] - o, mesh.vertices[k] - o)) / 6;
    }
    return sum;
}

}  // namespace ispace::testing
