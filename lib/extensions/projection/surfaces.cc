// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles are joined by their plane, rounded to 1e-5 of the normal and 0.1 mm of the offset from
// the middle of the room; two planes that differ by less are one surface, and one that falls on the
// edge of rounding may become two. Cells are marked by their centres. The order is that of the
// normals, from those that face down to those that face up.
#include "extensions/projection/surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "env/body.h"
#include "env/mesh.h"

namespace ispace::projection {

namespace {

/// Faces of less extent are reported together: no picture fits on them.
constexpr double kNarrow = 0.2;

using Corners = std::array<Point3, 3>;

/// A plane seen from one side, rounded: parts of one face have equal keys.
using PlaneKey = std::array<std::int64_t, 4>;

struct Plane {
    Vec3 normal;
    std::vector<Corners> triangles = {};
};

/// The planes of an element in the order of their keys.
using Planes = std::map<PlaneKey, Plane>;

Vec3 unit(Vec3 v) {
    const double size = length(v);
    return size > 0 ? (1 / size) * v : Vec3{0, 0, 0};
}

void addTriangle(const Corners& corners, Point3 middle, Planes& planes) {
    constexpr double kNormalSteps = 1e5, kOffsetSteps = 1e4, kLeastArea = 1e-10;
    const Vec3 across = cross(corners[1] - corners[0], corners[2] - corners[0]);
    if (length(across) < kLeastArea) return;
    const Vec3 normal = unit(across);
    const auto rounded = [](double value, double steps) {
        return static_cast<std::int64_t>(std::llround(value * steps));
    };
    const double offset = dot(normal, corners[0] - middle);
    const PlaneKey key = {rounded(normal.z, kNormalSteps), rounded(normal.x, kNormalSteps),
                          rounded(normal.y, kNormalSteps), rounded(offset, kOffsetSteps)};
    planes.try_emplace(key, Plane{normal}).first->second.triangles.push_back(corners);
}

void addMesh(const Mesh& mesh, Point3 middle, Planes& planes) {
    for (const auto& [a, b, c] : mesh.triangles) {
        const Corners corners = {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
        addTriangle(corners, middle, planes);
        if (mesh.open) addTriangle({corners[0], corners[2], corners[1]}, middle, planes);
    }
}

/// Marks the cells with their centres in a triangle, sides included.
void markCells(const std::array<Point2, 3>& t, const FlatFace& facet, std::vector<char>& marks) {
    Box2 box;
    for (const Point2 corner : t) box.add(corner);
    const double wide = facet.cellWidth(), high = facet.cellHeight();
    const auto first = [](double low, double size) {
        return static_cast<std::size_t>(std::max(0.0, std::floor(low / size - 0.5)));
    };
    const auto end = [](double top, double size, std::size_t count) {
        return std::min(count,
                        static_cast<std::size_t>(std::max(0.0, std::ceil(top / size + 0.5))));
    };
    constexpr double kSlack = 1e-9;
    const auto is_left_of = [&](Point2 a, Point2 b, Point2 p) {
        return cross(b - a, p - a) >= -kSlack * length(b - a);
    };
    for (std::size_t row = first(box.low.y, high); row < end(box.high.y, high, facet.rows); ++row)
        for (std::size_t column = first(box.low.x, wide);
             column < end(box.high.x, wide, facet.columns); ++column) {
            const Point2 p{(static_cast<double>(column) + 0.5) * wide,
                           (static_cast<double>(row) + 0.5) * high};
            if (is_left_of(t[0], t[1], p) && is_left_of(t[1], t[2], p) && is_left_of(t[2], t[0], p))
                marks[row * facet.columns + column] = 1;
        }
}

FlatFace facetOf(const Plane& plane, double cell) {
    FlatFace facet;
    const Vec3 normal = plane.normal;
    const bool is_level = std::abs(normal.x) < 1e-9 && std::abs(normal.y) < 1e-9;
    const Vec3 up =
        is_level ? Vec3{0, 1, 0}
                 : unit({-normal.z * normal.x, -normal.z * normal.y, 1 - normal.z * normal.z});
    const Vec3 right = cross(up, normal);
    const Point3 base = plane.triangles.front().front();
    constexpr double kFar = std::numeric_limits<double>::infinity();
    double left = kFar, low = kFar, most_right = -kFar, top = -kFar;
    for (const Corners& corners : plane.triangles) {
        facet.area += length(cross(corners[1] - corners[0], corners[2] - corners[0])) / 2;
        for (const Point3 corner : corners) {
            const double x = dot(corner - base, right), y = dot(corner - base, up);
            left = std::min(left, x);
            most_right = std::max(most_right, x);
            low = std::min(low, y);
            top = std::max(top, y);
        }
    }
    facet.frame.origin = base + left * right + low * up;
    facet.frame.forward = normal;
    facet.frame.left = -1.0 * right;
    facet.frame.up = up;
    facet.width = most_right - left;
    facet.height = top - low;
    if (facet.width / cell * (facet.height / cell) > kMostProjectionCells)
        throw UsageError("a surface of " + formatFixed(facet.width, 1) + " x " +
                         formatFixed(facet.height, 1) + " m has too many cells of " +
                         formatDouble(cell) + " m: give a larger --cell");
    const auto count = [cell](double size) {
        return static_cast<std::size_t>(std::max(1.0, std::ceil(size / cell - 1e-9)));
    };
    facet.columns = count(facet.width);
    facet.rows = count(facet.height);
    std::vector<char> marks(facet.columns * facet.rows, 0);
    for (const Corners& corners : plane.triangles) {
        std::array<Point2, 3> flat;
        for (std::size_t i = 0; i < flat.size(); ++i) {
            const Vec3 way = corners[i] - facet.frame.origin;
            flat[i] = {dot(way, right), dot(way, up)};
        }
        markCells(flat, facet, marks);
    }
    for (std::size_t i = 0; i < marks.size(); ++i)
        if (marks[i] != 0) facet.cells.push_back(i);
    return facet;
}

std::string sideName(Vec3 normal) {
    constexpr double kUpright = 1 - 1e-9;
    if (normal.z > kUpright) return "top";
    if (normal.z < -kUpright) return "underside";
    const double heading = std::atan2(normal.y, normal.x) * 180 / std::numbers::pi;
    const double tilt = std::asin(std::clamp(normal.z, -1.0, 1.0)) * 180 / std::numbers::pi;
    const auto whole = [](double degrees) { return formatDouble(std::round(degrees) + 0.0); };
    const double rounded = std::round(heading) <= -180 ? 180 : heading;
    std::string name = "facing " + whole(rounded);
    if (std::abs(tilt) >= 0.5) name += " tilted " + whole(tilt);
    return name;
}

/// Appends the surfaces of an element.
void addSurfaces(const std::string& id, const std::string& name, const Planes& planes, double cell,
                 std::vector<ProjectionSurface>& surfaces) {
    ProjectionSurface narrow{id, name + ", narrow faces", {}};
    for (const auto& [key, plane] : planes) {
        FlatFace facet = facetOf(plane, cell);
        if (facet.width < kNarrow || facet.height < kNarrow) {
            narrow.facets.push_back(std::move(facet));
            continue;
        }
        surfaces.push_back({id, name + ", " + sideName(plane.normal), {}});
        surfaces.back().facets.push_back(std::move(facet));
    }
    if (!narrow.facets.empty()) surfaces.push_back(std::move(narrow));
}

}  // namespace

double ProjectionSurface::area() const {
    double sum = 0;
    for (const FlatFace& facet : facets) sum += facet.area;
    return sum;
}

std::vector<ProjectionSurface> projectionSurfaces(const Environment& environment, double cell) {
    const Point2 center = environment.limits().center();
    const Point3 middle{center.x, center.y, 0};
    std::vector<ProjectionSurface> surfaces;
    Planes floor;
    Mesh ground = environment.floor();
    ground.open = false;
    addMesh(ground, middle, floor);
    for (const auto& [key, plane] : floor) {
        surfaces.push_back({"floor", "floor", {}});
        surfaces.back().facets.push_back(facetOf(plane, cell));
    }
    for (const Element& element : environment.elements()) {
        Planes planes;
        for (const Mesh& mesh : meshesOf(element.body, Surfaces::Opaque))
            addMesh(mesh, middle, planes);
        addSurfaces(element.id, nameOf(element), planes, cell, surfaces);
    }
    std::map<std::string, int> same;
    for (ProjectionSurface& surface : surfaces)
        if (const int number = ++same[surface.name]; number > 1)
            surface.name += " (" + std::to_string(number) + ')';
    return surfaces;
}

}  // namespace ispace::projection
