// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor/field_of_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "scene/sensor/camera.h"
#include "scene/sensor/lens_resolution.h"

namespace ispace {

FieldOfView FieldOfView::pyramid(const Pose3& pose, const Tangents& sides, double max_range,
                                 bool is_by_depth) {
    FieldOfView view;
    view.frame = Frame3(pose);
    view.max_range = max_range;
    view.is_by_depth = is_by_depth;
    view.sides = sides;
    return view;
}

FieldOfView FieldOfView::pyramid(const Pose3& pose, Angle half_x, Angle half_y, double max_range,
                                 bool is_by_depth) {
    const double across = tan(half_x), upright = tan(half_y);
    return pyramid(pose, {across, across, upright, upright}, max_range, is_by_depth);
}

FieldOfView FieldOfView::window(const Pose3& pose, Angle half_x, Angle half_y, double max_range) {
    return {Shape::Window,
            Frame3(pose),
            max_range,
            false,
            half_x,
            half_y,
            cos(std::min(half_x, Angle::degrees(180))),
            sin(std::min(half_y, Angle::degrees(90))),
            {},
            nullptr};
}

FieldOfView FieldOfView::cone(const Pose3& pose, Angle half, double max_range) {
    return {Shape::Cone,
            Frame3(pose),
            max_range,
            false,
            half,
            half,
            cos(std::min(half, Angle::degrees(180))),
            0,
            {},
            nullptr};
}

FieldOfView FieldOfView::picture(const Pose3& pose, const Camera& camera) {
    FieldOfView view;
    view.shape = Shape::Picture;
    view.frame = Frame3(pose);
    view.max_range = camera.max_range;
    view.is_by_depth = camera.lens == Lens::Pinhole;
    view.camera = std::make_shared<const Camera>(camera);
    if (camera.least_density > 0) {
        view.resolution = std::make_shared<const LensResolution>(camera);
        view.least_density = camera.least_density;
    }
    return view;
}

bool FieldOfView::isInPicture(Vec3 local) const {
    const auto place = camera->project(local);
    return place && camera->holds(*place);
}

bool FieldOfView::hasDensity(Vec3 local) const {
    return resolution->densityAt(local) >= least_density;
}

double FieldOfView::farthest() const {
    if (!is_by_depth) return max_range;
    if (shape == Shape::Picture) return max_range / cos(camera->widestInPicture());
    const double across = std::max(std::fabs(sides.left), std::fabs(sides.right));
    const double upright = std::max(std::fabs(sides.up), std::fabs(sides.down));
    return max_range * std::sqrt(1 + across * across + upright * upright);
}

namespace {

using Index = std::uint32_t;

Point2 onCircle(double radius, Index i) {
    const Angle t = Angle::degrees(360.0 * i / kAround);
    return {radius * cos(t), radius * sin(t)};
}

}  // namespace

void addBox(Mesh& mesh, Point3 low, Point3 high) {
    const auto first = static_cast<Index>(mesh.vertices.size());
    for (const double z : {low.z, high.z})
        for (const Point2 p :
             {Point2{low.x, low.y}, {high.x, low.y}, {high.x, high.y}, {low.x, high.y}})
            mesh.vertices.push_back({p.x, p.y, z});
    using Triangle = std::array<Index, 3>;
    for (const auto& [i, j, k] : {Triangle{0, 2, 1},
                                  {0, 3, 2},
                                  {4, 5, 6},
                                  {4, 6, 7},
                                  {0, 1, 5},
                                  {0, 5, 4},
                                  {1, 2, 6},
                                  {1, 6, 5},
                                  {2, 3, 7},
                                  {2, 7, 6},
                                  {3, 0, 4},
                                  {3, 4, 7}})
        mesh.triangles.push_back({first + i, first + j, first + k});
}

void addDisc(Mesh& mesh, Point3 back, double radius, double length) {
    const auto first = static_cast<Index>(mesh.vertices.size());
    for (const double x : {back.x, back.x + length})
        for (Index i = 0; i < kAround; ++i) {
            const Point2 p = onCircle(radius, i);
            mesh.vertices.push_back({x, back.y + p.x, back.z + p.y});
        }
    for (Index i = 0; i < kAround; ++i) {
        const Index next = (i + 1) % kAround;
        mesh.triangles.push_back({first + i, first + next, first + kAround + next});
        mesh.triangles.push_back({first + i, first + kAround + next, first + kAround + i});
    }
    for (Index i = 2; i < kAround; ++i) {
        mesh.triangles.push_back({first, first + i, first + i - 1});
        mesh.triangles.push_back({first + kAround, first + kAround + i - 1, first + kAround + i});
    }
}

void addBall(Mesh& mesh, Point3 center, double radius) {
    constexpr Index kRings = 11;  // between the poles
    const auto first = static_cast<Index>(mesh.vertices.size());
    for (Index ring = 1; ring <= kRings; ++ring) {
        const Angle up = Angle::degrees(180.0 * ring / (kRings + 1) - 90);
        for (Index i = 0; i < kAround; ++i) {
            const Point2 p = onCircle(radius * cos(up), i);
            mesh.vertices.push_back({center.x + p.x, center.y + p.y, center.z + radius * sin(up)});
        }
    }
    const auto low = static_cast<Index>(mesh.vertices.size()), high = low + 1;
    mesh.vertices.push_back({center.x, center.y, center.z - radius});
    mesh.vertices.push_back({center.x, center.y, center.z + radius});
    for (Index i = 0; i < kAround; ++i) {
        const Index next = (i + 1) % kAround;
        for (Index ring = 0; ring + 1 < kRings; ++ring) {
            const Index a = first + ring * kAround, b = a + kAround;
            mesh.triangles.push_back({a + i, a + next, b + next});
            mesh.triangles.push_back({a + i, b + next, b + i});
        }
        const Index top = first + (kRings - 1) * kAround;
        mesh.triangles.push_back({first + next, first + i, low});
        mesh.triangles.push_back({top + i, top + next, high});
    }
}

Mesh noseBox() {
    constexpr double kHalf = 0.025, kHalfHeight = 0.035, kNose = 0.05;
    Mesh mesh{Material::Sensor, {}, {}};
    for (const double z : {-kHalfHeight, kHalfHeight})
        for (const auto& [x, y] :
             {Point2{-kHalf, -kHalf}, {kHalf, -kHalf}, {kHalf, kHalf}, {-kHalf, kHalf}})
            mesh.vertices.push_back({x, y, z});
    mesh.vertices.push_back({kNose, 0, 0});
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4}, {2, 3, 7},
                      {2, 7, 6}, {3, 0, 4}, {3, 4, 7}, {1, 2, 8}, {2, 6, 8}, {6, 5, 8}, {5, 1, 8}};
    return mesh;
}

std::vector<Mesh> lensBox(Vec3 size, std::initializer_list<double> lenses, double radius) {
    constexpr double kLens = 0.02;
    Mesh box{Material::Sensor, {}, {}}, glass{Material::Metal, {}, {}};
    addBox(box, {-kLens - size.x, -size.y / 2, -size.z / 2}, {-kLens, size.y / 2, size.z / 2});
    for (const double y : lenses) addDisc(glass, {-kLens, y, 0}, radius, kLens);
    return {std::move(box), std::move(glass)};
}

ViewLimits viewLimits(double least, double greatest, double reach) {
    return {std::min(least, reach), std::min(greatest, reach)};
}

int piecesOf(Angle span) {
    constexpr double kBend = 5;  // degrees: patches are bent at least this finely
    return std::clamp(static_cast<int>(std::ceil(std::fabs(span.degrees()) / kBend)), 1, 72);
}

Vec3 directionOf(Angle bearing, Angle elevation) {
    const auto [cb, sb] = cosSin(bearing);
    const auto [ce, se] = cosSin(elevation);
    return {cb * ce, sb * ce, se};
}

Mesh windowView(Angle fov_x, Angle fov_y, ViewLimits limits) {
    return pictureView(fov_x, fov_y, limits, fov_x >= Angle::degrees(360),
                       [&](double across, double upright, double range) {
                           return range * directionOf(-0.5 * across * fov_x, 0.5 * upright * fov_y);
                       });
}

}  // namespace ispace
