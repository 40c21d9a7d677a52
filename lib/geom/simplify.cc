// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/simplify.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polyline_simplification_2/Squared_distance_cost.h>
#include <CGAL/Polyline_simplification_2/Stop_above_cost_threshold.h>
#include <CGAL/Polyline_simplification_2/simplify.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "geom/planar_map.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

namespace ps = CGAL::Polyline_simplification_2;

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Tds =
    CGAL::Triangulation_data_structure_2<ps::Vertex_base_2<Kernel>,
                                         CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Delaunay =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Tds, CGAL::Exact_predicates_tag>;
using Curves = CGAL::Constrained_triangulation_plus_2<Delaunay>;

Point2 placeOf(Curves::Vertex_handle vertex) { return {vertex->point().x(), vertex->point().y()}; }

/// What removing a vertex costs: the squared distance of the original points, which stay in the
/// net until the end, from the edge that would replace them. That is the displacement itself, not
/// the one since the last step. None where it is beyond the tolerance or where that edge would
/// pass so near to another vertex that welding joined them.
///
/// CGAL takes vertices of equal cost in the order of their curves' addresses. Pixel maps have
/// thousands of them, so each vertex gets a cost of its own, by its place among all vertices.
class Cost {
  public:
    Cost(const std::vector<Polygon>& curves, double tolerance, std::vector<Point2> kept)
        : most_(tolerance * tolerance), kept_(std::move(kept)) {
        for (const Polygon& curve : curves) order_.insert(order_.end(), curve.begin(), curve.end());
        std::sort(order_.begin(), order_.end(), lexLess);
        std::sort(kept_.begin(), kept_.end(), lexLess);
    }

    boost::optional<double> operator()(
        const Curves& net, const Curves::Vertices_in_constraint_iterator& vertex) const {
        if (std::binary_search(kept_.begin(), kept_.end(), placeOf(*vertex), lexLess))
            return boost::none;
        const auto cost = ps::Squared_distance_cost()(net, vertex);
        if (!cost || *cost > most_ || isTight(net, vertex)) return boost::none;
        const auto place =
            std::lower_bound(order_.begin(), order_.end(), placeOf(*vertex), lexLess);
        const double share =
            static_cast<double>(place - order_.begin()) / static_cast<double>(order_.size());
        return *cost + (most_ > 0 ? 1e-6 * most_ : 1) * share;
    }

  private:
    /// The net is Delaunay: what lies close behind the new edge is a neighbour of the vertex.
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
    // The cost decides alone.
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
