// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/triangulate.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace ispace {

namespace {

constexpr auto kNew = std::numeric_limits<std::uint32_t>::max();

struct VertexInfo {
    std::uint32_t index = kNew;  // vertices made where constraints cross have none yet
};

enum class Nesting { Unknown, Inside, Outside };
struct FaceInfo {
    Nesting nesting = Nesting::Unknown;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Tds = CGAL::Triangulation_data_structure_2<
    CGAL::Triangulation_vertex_base_with_info_2<VertexInfo, Kernel>,
    CGAL::Constrained_triangulation_face_base_2<
        Kernel, CGAL::Triangulation_face_base_with_info_2<FaceInfo, Kernel>>>;
// Regions rounded to doubles may cross themselves by a rounding error: that must not throw.
using Delaunay =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Tds, CGAL::Exact_predicates_tag>;

using Edge = std::pair<std::uint32_t, std::uint32_t>;

std::vector<Point2> distinctVertices(const Region& region) {
    std::vector<Point2> vertices;
    region.forEachEdge([&](const Segment2& e) { vertices.push_back(e.a); });
    std::sort(vertices.begin(), vertices.end(), [](Point2 a, Point2 b) { return lexLess(a, b); });
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

/// The edges that separate: one that comes twice has the same on both sides.
std::vector<Edge> separatingEdges(const Region& region, const std::vector<Point2>& vertices) {
    const auto index_of = [&](Point2 p) {
        const auto it = std::lower_bound(vertices.begin(), vertices.end(), p,
                                         [](Point2 a, Point2 b) { return lexLess(a, b); });
        return static_cast<std::uint32_t>(it - vertices.begin());
    };
    std::vector<Edge> edges;
    region.forEachEdge([&](const Segment2& e) {
        edges.push_back(std::minmax({index_of(e.a), index_of(e.b)}));
    });
    std::sort(edges.begin(), edges.end());
    std::vector<Edge> separating;
    for (const Edge& edge : edges) {
        if (!separating.empty() && separating.back() == edge)
            separating.pop_back();
        else if (edge.first != edge.second)
            separating.push_back(edge);
    }
    return separating;
}

Delaunay build(const std::vector<Point2>& vertices, const std::vector<Edge>& edges) {
    std::vector<std::pair<Kernel::Point_2, VertexInfo>> points;
    for (std::size_t i = 0; i < vertices.size(); ++i)
        points.push_back({Kernel::Point_2(vertices[i].x, vertices[i].y),
                          VertexInfo{static_cast<std::uint32_t>(i)}});
    Delaunay net;
    net.insert(points.begin(), points.end());
    std::vector<Delaunay::Vertex_handle> handles(vertices.size());
    for (auto v = net.finite_vertices_begin(); v != net.finite_vertices_end(); ++v)
        handles[v->info().index] = v;
    for (const auto& [a, b] : edges) net.insert_constraint(handles[a], handles[b]);
    return net;
}

/// Floods from outside; each constraint crossed leads in or out.
void markInside(Delaunay& net) {
    std::vector<Delaunay::Face_handle> open{net.infinite_face()};
    open[0]->info().nesting = Nesting::Outside;
    while (!open.empty()) {
        const auto face = open.back();
        open.pop_back();
        for (int i = 0; i < 3; ++i) {
            const auto next = face->neighbor(i);
            if (next->info().nesting != Nesting::Unknown) continue;
            const bool inside = face->info().nesting == Nesting::Inside;
            next->info().nesting =
                inside != face->is_constrained(i) ? Nesting::Inside : Nesting::Outside;
            open.push_back(next);
        }
    }
}

}  // namespace

Triangulation triangulate(const Region& region) {
    Triangulation result;
    result.vertices = distinctVertices(region);
    Delaunay net = build(result.vertices, separatingEdges(region, result.vertices));
    if (net.dimension() < 2) return result;
    markInside(net);

    for (auto f = net.finite_faces_begin(); f != net.finite_faces_end(); ++f) {
        if (f->info().nesting != Nesting::Inside) continue;
        std::array<std::uint32_t, 3> triangle{};
        for (int i = 0; i < 3; ++i) {
            const auto v = f->vertex(i);
            if (v->info().index == kNew) {
                v->info().index = static_cast<std::uint32_t>(result.vertices.size());
                result.vertices.push_back({v->point().x(), v->point().y()});
            }
            triangle[static_cast<std::size_t>(i)] = v->info().index;
        }
        std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                    triangle.end());
        result.triangles.push_back(triangle);
    }
    std::sort(result.triangles.begin(), result.triangles.end());
    return result;
}

}  // namespace ispace
