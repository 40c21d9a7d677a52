// SPDX-License-Identifier: GPL-3.0-or-later
// Fields of view of sensors, and the shapes that draw sensors and their views.
//
// Tests of single points, in doubles, without trigonometry but for curved projections. Edges count
// as inside, with a slack of kUnitTolerance times the distance (of pictures as Camera::holds());
// ranges compare as float32. Const members are thread-safe; copies share their camera.
//
//     const FieldOfView view = FieldOfView::cone(pose, Angle::degrees(30), 8);
//     const bool is_in_view = view.holds({3, 1, 0.5});  // occlusion is tested elsewhere
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <vector>

#include "env/mesh.h"
#include "geom/point.h"
#include "geom/pose.h"
#include "geom/tolerance.h"

namespace ispace {

struct Camera;
class LensResolution;

/// The rule of all range tests: compare as float32, end included. Distances stored as floats then
/// give the same result for any shorter range.
inline bool withinRange(double distance, double max_range) {
    return static_cast<float>(distance) <= static_cast<float>(max_range);
}

/// Where the sides of a pyramid lie at depth 1, each counted outwards: left and right of the axis,
/// above and below it. One may be negative, if less than the opposite one is positive.
struct Tangents {
    double left = 0, right = 0, up = 0, down = 0;
};

/// The field of view of a sensor with an axis, without occlusion. It includes its edges, with a
/// margin for rounding.
struct FieldOfView {
    enum class Shape {
        Pyramid,  ///< of a pinhole, through the edges of its picture
        Window,   ///< an interval of bearings and one of elevations
        Cone,     ///< about the axis
        Picture,  ///< the image of a camera with a curved projection
    };
    Shape shape = Shape::Pyramid;
    Frame3 frame;
    double max_range = 0;
    bool is_by_depth = false;  ///< the range is measured along the axis
    /// Of windows and cones half of the fields of view; of a cone both the same.
    Angle half_x, half_y;
    /// Of the window the cosine of half_x and the sine of half_y; of the cone its cosine, once.
    double across = 0, upright = 0;
    Tangents sides;                        ///< of a pyramid
    std::shared_ptr<const Camera> camera;  ///< of a picture
    /// Of a picture whose points need `least_density` pixels a metre.
    std::shared_ptr<const LensResolution> resolution = nullptr;
    double least_density = 0;

    /// \pre the sides are not empty: left + right > 0, up + down > 0
    static FieldOfView pyramid(const Pose3& pose, const Tangents& sides, double max_range,
                               bool is_by_depth);
    /// Creates a pyramid from half the horizontal and vertical fields of view, less than 90 degrees
    /// each.
    static FieldOfView pyramid(const Pose3& pose, Angle half_x, Angle half_y, double max_range,
                               bool is_by_depth);
    static FieldOfView window(const Pose3& pose, Angle half_x, Angle half_y, double max_range);
    /// `half`: between the axis and the edge.
    static FieldOfView cone(const Pose3& pose, Angle half, double max_range);
    /// Uses the camera's range: of pinholes along the axis.
    static FieldOfView picture(const Pose3& pose, const Camera& camera);

    /// Returns true if a point is in view, in range, and dense enough.
    [[nodiscard]] bool holds(Point3 place) const;
    /// Returns true if the direction to a point (in its frame) is in view; the sensor's own
    /// position is.
    [[nodiscard]] bool points(Vec3 local) const;
    /// Returns true if the picture has enough pixels a metre at a point of its frame.
    [[nodiscard]] bool isDense(Vec3 local) const {
        return !(least_density > 0) || hasDensity(local);
    }
    /// Returns an upper bound of the distance of points in view.
    [[nodiscard]] double farthest() const;

  private:
    [[nodiscard]] bool isInPicture(Vec3 local) const;
    [[nodiscard]] bool hasDensity(Vec3 local) const;
};

inline bool FieldOfView::points(Vec3 local) const {
    const double plan = local.x * local.x + local.y * local.y;
    const double distance = std::sqrt(plan + local.z * local.z), slack = kUnitTolerance * distance;
    switch (shape) {
        case Shape::Pyramid:
            return local.y <= sides.left * local.x + slack &&
                   -local.y <= sides.right * local.x + slack &&
                   local.z <= sides.up * local.x + slack &&
                   -local.z <= sides.down * local.x + slack;
        case Shape::Window:
            return local.x >= across * std::sqrt(plan) - slack &&
                   std::fabs(local.z) <= upright * distance + slack;
        case Shape::Cone:
            return local.x >= across * distance - slack;
        case Shape::Picture:
            return isInPicture(local);
    }
    return false;
}

inline bool FieldOfView::holds(Point3 place) const {
    const Vec3 local = frame.toLocal(place);
    const double range = is_by_depth ? local.x : std::sqrt(dot(local, local));
    return withinRange(range, max_range) && points(local) && isDense(local);
}

/// Corners of drawn circles; these bodies occlude no rays, so coarse suffices.
constexpr std::uint32_t kAround = 24;

void addBox(Mesh& mesh, Point3 low, Point3 high);
/// Adds a cylinder about an axis along x.
void addDisc(Mesh& mesh, Point3 back, double radius, double length);
void addBall(Mesh& mesh, Point3 center, double radius);

/// Builds a small box with a nose at its front, the size of a URG-04LX.
Mesh noseBox();
/// Builds a box behind the optical centre with lenses at these offsets beside it.
std::vector<Mesh> lensBox(Vec3 size, std::initializer_list<double> lenses, double radius);

/// The distances between which a field of view is drawn.
struct ViewLimits {
    double near, far;
};
ViewLimits viewLimits(double least, double greatest, double reach);
/// Returns the number of segments that approximate a span of angles.
int piecesOf(Angle span);
Vec3 directionOf(Angle bearing, Angle elevation);

/// Builds a surface of columns x rows patches; place(u, v) returns its points, u and v from 0 to 1.
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

/// Builds the view of a sensor with a picture: the picture at its range as a curved surface, and
/// the sides. place(across, upright, range) returns the point at this range on the ray through
/// picture coordinates -1 to 1. `fov_x` and `fov_y` determine the number of segments; a full
/// panorama has no left and right side.
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

/// The view of a sensor that sees intervals of bearings and elevations, see pictureView().
Mesh windowView(Angle fov_x, Angle fov_y, ViewLimits limits);

}  // namespace ispace
