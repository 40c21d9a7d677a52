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

/// What a sensor with a picture looks at: the picture far away as a bent surface, and the sides to
/// it. place(across, upright, range) is where the ray through a place of the picture, -1 to 1
/// either way, has come to at this range. `fov_x` and `fov_y` say how finely to bend it; a view all
/// around has no left and right side.
template <typename Place>
Mesh pictureView(Angle fov_x, Angle fov_y, ViewLimits limits, bool is_all_around, Place place) {
    Mesh mesh{Material::View, {}, {}, true};
    const int columns = piecesOf(fov_x), rows = piecesOf(fov_y);
    const double deep = limits.far - limits.near;
    addSheet(mesh, columns, rows,
             [&](double u, double v) { return place(2 * u - 1, 2 * v - 1, limits.far); });
    for (const double side : {-1.0, 1.0}) {
        addSheet(mesh, columns, 1, [&](double u, double v) {
            return place(2 * u - 1, side, limits.near + v * deep);
        });
        if (is_all_around) continue;
        addSheet(mesh, rows, 1, [&](double u, double v) {
            return place(side, 2 * u - 1, limits.near + v * deep);
        });
    }
    return mesh;
}

}  // namespace ispace
