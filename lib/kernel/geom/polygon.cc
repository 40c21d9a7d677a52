// SPDX-License-Identifier: GPL-3.0-or-later
// Triangulates and simplifies polygons with CGAL.
#include "geom/polygon.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polyline_simplification_2/Squared_distance_cost.h>
#include <CGAL/Polyline_simplification_2/Stop_above_cost_threshold.h>
#include <CGAL/Polyline_simplification_2/simplify.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "geom/planar_map.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

/// How an edge meets the ray that leaves p towards +x, end points by the half-open rule.
enum class Meeting { None, Crossing, Touches };

Meeting meetRay(const Segment2& edge, Point2 p) {
    const auto& [a, b] = edge;
    if (p == a || p == b) return Meeting::Touches;
    const double low_x = std::min(a.x, b.x), high_x = std::max(a.x, b.x);
    if ((a.y > p.y) == (b.y > p.y)) {
        const bool along = a.y == p.y && b.y == p.y && low_x <= p.x && p.x <= high_x;
        return along ? Meeting::Touches : Meeting::None;
    }
    if (p.x > high_x) return Meeting::None;
    if (p.x < low_x) return Meeting::Crossing;
    const Turn turn = a.y < b.y ? orientation(a, b, p) : orientation(b, a, p);
    if (turn == Turn::Straight) return Meeting::Touches;
    return turn == Turn::Left ? Meeting::Crossing : Meeting::None;
}

/// True if `test` holds of the turn at every corner.
template <typename Test>
bool everyTurn(const Polygon& polygon, Test test) {
    const std::size_t n = polygon.size();
    for (std::size_t i = 0; i < n; ++i)
        if (!test(orientation(polygon[i], polygon[(i + 1) % n], polygon[(i + 2) % n])))
            return false;
    return true;
}

void addCurves(std::vector<Polygon>& curves, const Region& region) {
    curves.push_back(region.outline);
    curves.insert(curves.end(), region.holes.begin(), region.holes.end());
}

}  // namespace

double signedArea(const Polygon& polygon) {
    double twice = 0;
    // Relative to the first vertex, so that a small polygon far from the origin keeps its digits.
    for (std::size_t i = 2; i < polygon.size(); ++i)
        twice += cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
    return twice / 2;
}

double perimeter(const Polygon& polygon) {
    double sum = 0;
    forEachEdge(polygon, [&](const Segment2& edge) { sum += distance(edge.a, edge.b); });
    return sum;
}

Box2 bounds(const Polygon& polygon) {
    Box2 box;
    for (const Point2 p : polygon) box.add(p);
    return box;
}

Box2 bounds(const Segment2& segment) {
    Box2 box;
    box.add(segment.a);
    box.add(segment.b);
    return box;
}

bool isConvex(const Polygon& polygon) {
    bool turns = false;
    const auto is_allowed = [&turns](Turn turn) {
        turns = turns || turn == Turn::Left;
        return turn != Turn::Right;
    };
    return everyTurn(polygon, is_allowed) && turns;
}

bool isStrictlyConvex(const Polygon& polygon) {
    return !polygon.empty() && everyTurn(polygon, [](Turn turn) { return turn == Turn::Left; });
}

Side locate(const Polygon& polygon, Point2 p) {
    bool inside = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point2 next = polygon[i + 1 == polygon.size() ? 0 : i + 1];
        const Meeting meeting = meetRay({polygon[i], next}, p);
        if (meeting == Meeting::Touches) return Side::Boundary;
        if (meeting == Meeting::Crossing) inside = !inside;
    }
    return inside ? Side::Inside : Side::Outside;
}

std::vector<Polygon> curvesOf(const Region& region) {
    std::vector<Polygon> curves;
    addCurves(curves, region);
    return curves;
}

std::vector<Polygon> curvesOf(const std::vector<Region>& regions) {
    std::vector<Polygon> curves;
    for (const Region& region : regions) addCurves(curves, region);
    return curves;
}

std::vector<Polygon> curvesOf(const Regions& regions) { return curvesOf(regions.parts); }

Box2 bounds(const Regions& regions) { return bounds(std::span(regions.parts)); }

Box2 bounds(std::span<const Region> regions) {
    Box2 box;
    for (const Region& region : regions)
        for (const Point2 p : region.outline) box.add(p);
    return box;
}

Box2 bounds(std::span<const Polygon> curves) {
    Box2 box;
    for (const Polygon& curve : curves)
        for (const Point2 p : curve) box.add(p);
    return box;
}

double Region::area() const {
    double sum = std::abs(signedArea(outline));
    for (const Polygon& hole : holes) sum -= std::abs(signedArea(hole));
    return sum;
}

double Region::boundaryLength() const {
    double sum = perimeter(outline);
    for (const Polygon& hole : holes) sum += perimeter(hole);
    return sum;
}

Side Region::locate(Point2 p) const {
    const Side side = ispace::locate(outline, p);
    if (side != Side::Inside) return side;
    for (const Polygon& hole : holes) {
        const Side in_hole = ispace::locate(hole, p);
        if (in_hole == Side::Boundary) return Side::Boundary;
        if (in_hole == Side::Inside) return Side::Outside;
    }
    return Side::Inside;
}

double Regions::area() const {
    double sum = 0;
    for (const Region& part : parts) sum += part.area();
    return sum;
}

double Regions::boundaryLength() const {
    double sum = 0;
    for (const Region& part : parts) sum += part.boundaryLength();
    return sum;
}

Side Regions::locate(Point2 p) const {
    Side side = Side::Outside;
    for (const Region& part : parts) {
        const Side in_part = part.locate(p);
        if (in_part == Side::Inside) return Side::Inside;
        if (in_part == Side::Boundary) side = Side::Boundary;
    }
    return side;
}

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

namespace {

namespace ps = CGAL::Polyline_simplification_2;

using CurveTds =
    CGAL::Triangulation_data_structure_2<ps::Vertex_base_2<Kernel>,
                                         CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Curves = CGAL::Constrained_triangulation_plus_2<
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CurveTds, CGAL::Exact_predicates_tag>>;

Point2 placeOf(Curves::Vertex_handle vertex) { return {vertex->point().x(), vertex->point().y()}; }

/// Cost of removing a vertex: the squared distance of the original points, which the net stores
/// until the end, from the edge that would replace them. That is the displacement itself, not the
/// one since the last step. nullopt if it exceeds the tolerance or if that edge would pass so near
/// to another vertex that welding joined them.
///
/// CGAL sorts vertices of equal cost by their curves' addresses. Pixel maps have thousands of them,
/// so each vertex gets a unique cost, by its index among all vertices.
class Cost {
  public:
    Cost(const std::vector<Polygon>& curves, double tolerance, std::vector<Point2> kept)
        : most_(tolerance * tolerance), kept_(std::move(kept)) {
        for (const Polygon& curve : curves) order_.insert(order_.end(), curve.begin(), curve.end());
        std::sort(order_.begin(), order_.end(), lexLess);
        std::sort(kept_.begin(), kept_.end(), lexLess);
    }

    /// An optional of Boost in CGAL 5, of the standard library in CGAL 6.
    using Optional = std::invoke_result_t<ps::Squared_distance_cost, const Curves&,
                                          Curves::Vertices_in_constraint_iterator>;

    Optional operator()(const Curves& net,
                        const Curves::Vertices_in_constraint_iterator& vertex) const {
        if (std::binary_search(kept_.begin(), kept_.end(), placeOf(*vertex), lexLess)) return {};
        const auto cost = ps::Squared_distance_cost()(net, vertex);
        if (!cost || *cost > most_ || isTight(net, vertex)) return {};
        const auto place =
            std::lower_bound(order_.begin(), order_.end(), placeOf(*vertex), lexLess);
        const double share =
            static_cast<double>(place - order_.begin()) / static_cast<double>(order_.size());
        return *cost + (most_ > 0 ? 1e-6 * most_ : 1) * share;
    }

  private:
    /// The net is Delaunay, so vertices close behind the new edge are neighbours of the vertex.
    static bool isTight(const Curves& net, const Curves::Vertices_in_constraint_iterator& vertex) {
        const auto before = *boost::prior(vertex), after = *boost::next(vertex);
        const Segment2 edge{placeOf(before), placeOf(after)};
        auto neighbour = net.incident_vertices(*vertex);
        const auto start = neighbour;
        do {
            const Curves::Vertex_handle other = neighbour;
            if (other == before || other == after || net.is_infinite(other)) continue;
            if (distance(placeOf(other), edge) <= 2 * kWeldDistance) return true;
        } while (++neighbour != start);
        return false;
    }

    double most_;
    std::vector<Point2> order_, kept_;
};

/// The curve from its lowest vertex on: CGAL keeps the first vertex, and that one is a corner.
std::vector<Kernel::Point_2> pointsOf(const Polygon& curve) {
    const auto lowest = std::min_element(curve.begin(), curve.end(),
                                         [](Point2 a, Point2 b) { return lexLess(a, b); });
    std::vector<Kernel::Point_2> points;
    for (auto it = lowest; it != curve.end(); ++it) points.emplace_back(it->x, it->y);
    for (auto it = curve.begin(); it != lowest; ++it) points.emplace_back(it->x, it->y);
    return points;
}

bool isCurve(const Polygon& polygon) {
    return polygon.size() >= 3 &&
           std::any_of(polygon.begin(), polygon.end(), [&](Point2 p) { return p != polygon[0]; });
}

}  // namespace

std::vector<Polygon> simplified(const std::vector<Polygon>& curves, double tolerance,
                                std::vector<Point2> kept) {
    Curves net;
    std::vector<Curves::Constraint_id> ids(curves.size(), Curves::Constraint_id(nullptr));
    for (std::size_t i = 0; i < curves.size(); ++i) {
        if (!isCurve(curves[i])) continue;
        const auto points = pointsOf(curves[i]);
        ids[i] = net.insert_constraint(points.begin(), points.end(), true);
    }
    // Only the cost stops the simplification.
    constexpr double kNever = std::numeric_limits<double>::infinity();
    ps::simplify(net, Cost(curves, tolerance, std::move(kept)),
                 ps::Stop_above_cost_threshold(kNever));

    std::vector<Polygon> result(curves);
    for (std::size_t i = 0; i < curves.size(); ++i) {
        if (ids[i] == Curves::Constraint_id(nullptr)) continue;
        Polygon curve;
        for (auto v = net.vertices_in_constraint_begin(ids[i]);
             v != net.vertices_in_constraint_end(ids[i]); ++v)
            curve.push_back({(*v)->point().x(), (*v)->point().y()});
        curve.pop_back();  // the first vertex again
        if (curve.size() >= 3) result[i] = std::move(curve);
    }
    return result;
}

}  // namespace ispace
