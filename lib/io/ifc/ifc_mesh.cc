// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/ifc/ifc_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "io/ifc/ifc_shapes.h"
#include "io/mesh_parts.h"

namespace ispace {

namespace {

using Loop = std::span<const Point3>;

/// Twice the area of a loop, along its normal (Newell).
Vec3 areaVector(Loop loop) {
    Vec3 sum;
    for (std::size_t i = 2; i < loop.size(); ++i)
        sum = sum + cross(loop[i - 1] - loop[0], loop[i] - loop[0]);
    return sum;
}

/// Appends triangles of doubles to floats, corner by corner.
class TriangleList {
  public:
    void add(Point3 a, Point3 b, Point3 c) {
        if (mesh_.triangles.size() >= kMaxMeshTriangles)
            throw std::runtime_error("more than " + std::to_string(kMaxMeshTriangles) +
                                     " triangles");
        mesh_.triangles.push_back({corner(a), corner(b), corner(c)});
    }

    /// A plane face: the largest loop without the others.
    void addFace(const std::vector<Loop>& loops) {
        std::vector<std::pair<double, std::size_t>> sizes;
        for (std::size_t i = 0; i < loops.size(); ++i)
            sizes.emplace_back(-length(areaVector(loops[i])), i);
        if (sizes.empty()) return;
        std::sort(sizes.begin(), sizes.end());
        const Loop outer = loops[sizes.front().second];
        const Vec3 normal = unitOf(areaVector(outer));
        if (normal == Vec3{}) return;
        if (loops.size() == 1 && outer.size() == 3) return add(outer[0], outer[1], outer[2]);
        // Seen along the axis that the normal is nearest to, mirrored where it points away.
        const Vec3 size{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
        const int axis = size.z >= std::max(size.x, size.y) ? 2 : size.y >= size.x ? 1 : 0;
        const double sign = (axis == 0 ? normal.x : axis == 1 ? normal.y : normal.z) > 0 ? 1 : -1;
        const auto flat = [&](const Point3& p) {
            if (axis == 2) return Point2{p.x, sign * p.y};
            return axis == 1 ? Point2{p.z, sign * p.x} : Point2{p.y, sign * p.z};
        };
        std::map<std::pair<double, double>, Point3> back;
        Region face;
        for (const auto& [area, i] : sizes) {
            Polygon polygon;
            for (const Point3& p : loops[i]) {
                polygon.push_back(flat(p));
                back.try_emplace({polygon.back().x, polygon.back().y}, p);
            }
            const bool is_outer = i == sizes.front().second;
            if ((signedArea(polygon) > 0) != is_outer) std::reverse(polygon.begin(), polygon.end());
            if (is_outer)
                face.outline = std::move(polygon);
            else
                face.holes.push_back(std::move(polygon));
        }
        const Triangulation flat_triangles = triangulate(face);
        for (const auto& t : flat_triangles.triangles) {
            std::array<Point3, 3> corners;
            for (std::size_t k = 0; k < 3; ++k) {
                const Point2 p = flat_triangles.vertices[t[k]];
                const auto found = back.find({p.x, p.y});
                if (found == back.end()) return;
                corners[k] = found->second;
            }
            add(corners[0], corners[1], corners[2]);
        }
    }

    [[nodiscard]] TriangleMesh take() { return std::move(mesh_); }

  private:
    std::uint32_t corner(Point3 p) {
        const std::array<float, 3> place{static_cast<float>(p.x + 0), static_cast<float>(p.y + 0),
                                         static_cast<float>(p.z + 0)};
        if (!std::isfinite(place[0]) || !std::isfinite(place[1]) || !std::isfinite(place[2]))
            throw std::runtime_error("a vertex that is no place (NaN or infinity)");
        const auto [known, is_new] =
            index_.try_emplace(place, static_cast<std::uint32_t>(mesh_.vertices.size()));
        if (is_new) mesh_.vertices.push_back(place);
        return known->second;
    }

    std::map<std::array<float, 3>, std::uint32_t> index_;
    TriangleMesh mesh_;
};

bool isBody(std::string_view type) {
    return type != "IFCSPACE" && !type.starts_with("IFCOPENING") && type != "IFCANNOTATION" &&
           type != "IFCSPATIALZONE" && type != "IFCGRID";
}

}  // namespace

TriangleMesh ifcMesh(std::string_view bytes) {
    const StepFile file(bytes);
    IfcFrames frames(file);
    IfcShapes shapes(frames);
    TriangleList triangles;
    const auto add_product = [&](StepId id) {
        const StepInstance product = file.read(id);
        if (file.typeOf(product[5].reference()) != "IFCLOCALPLACEMENT") return;
        IfcShape shape = shapes.shapeOf(product[6].reference());
        const IfcFrame frame = frames.placement(product[5].reference());
        for (IfcSolid& solid : shape) {
            solid.body.move(frame);
            std::size_t loop = 0, corner = 0;
            for (const std::uint32_t face_end : solid.body.face_ends) {
                std::vector<Loop> loops;
                for (; loop < face_end; corner = solid.body.loop_ends[loop++])
                    loops.push_back(Loop(solid.body.corners)
                                        .subspan(corner, solid.body.loop_ends[loop] - corner));
                triangles.addFace(loops);
            }
        }
    };
    for (const auto& [type, ids] : file.types()) {
        if (!isBody(type)) continue;
        for (const StepId id : ids) {
            try {
                add_product(id);
            } catch (const UnreadGeometry&) {
                // As parts of its shapes that are not read.
            }
        }
    }
    return triangles.take();
}

}  // namespace ispace
