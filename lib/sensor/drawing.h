// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes that the bodies and fields of view of sensors are drawn with.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

#include "env/mesh.h"
#include "geom/point.h"

namespace ispace {

/// Corners of what is drawn round; these bodies stop nothing, so coarse is good enough.
constexpr std::uint32_t kAround = 24;

void addBox(Mesh& mesh, Point3 low, Point3 high);
/// A cylinder about an axis along x.
void addDisc(Mesh& mesh, Point3 back, double radius, double length);
void addBall(Mesh& mesh, Point3 center, double radius);

/// A small box with a nose where it faces, the size of a URG-04LX.
Mesh noseBox();
/// A box behind the optical centre with lenses at these places beside it.
std::vector<Mesh> lensBox(Vec3 size, std::initializer_list<double> lenses, double radius);

/// Between which distances a field of view is drawn.
struct ViewLimits {
    double near, far;
};
ViewLimits viewLimits(double least, double greatest, double reach);
/// Pieces into which a span of angles is bent.
int piecesOf(Angle span);
Vec3 directionOf(Angle bearing, Angle elevation);

/// A surface of columns x rows patches; place(u, v) is where it is, u and v from 0 to 1.
template <typename Place>
void addSheet(Mesh& mesh, int columns, int rows, Place place) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int v = 0; v <= rows; ++v)
        for (int u = 0; u <= columns; ++u)
            mesh.vertices.push_back(
                Point3{} + place(static_cast<double>(u) / columns, static_cast<double>(v) / rows));
    const auto stride = static_cast<std::uint32_t>(columns) + 1;
    for (std::uint32_t v = 0; v < static_cast<std::uint32_t>(rows); ++v)
        for (std::uint32_t u = 0; u + 1 < stride; ++u) {
            const std::uint32_t a = first + v * stride + u, b = a + stride;
            mesh.triangles.push_back({a, a + 1, b + 1});
            mesh.triangles.push_back({a, b + 1, b});
        }
}

}  // namespace ispace
