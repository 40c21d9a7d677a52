// SPDX-License-Identifier: GPL-3.0-or-later
// What tests and benchmarks compare visibility with: CGAL's triangular expansion, in exact numbers.
#pragma once

#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arr_walk_along_line_point_location.h>
#include <CGAL/Arrangement_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangular_expansion_visibility_2.h>

#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "geom/box.h"
#include "geom/polygon.h"

namespace ispace::test {

class VisibilityOracle {
  public:
    using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
    using Arrangement = CGAL::Arrangement_2<CGAL::Arr_segment_traits_2<Kernel>>;
    using Face = Arrangement::Face_const_handle;

    /// Of the lines and a box around them, 10 m away.
    explicit VisibilityOracle(std::span<const Segment2> lines) {
        std::vector<Arrangement::X_monotone_curve_2> curves;
        Box2 box;
        for (const auto& [a, b] : lines) {
            box.add(a);
            box.add(b);
            curves.emplace_back(exact(a), exact(b));
        }
        const Point2 low = box.low - Vec2{10, 10}, high = box.high + Vec2{10, 10};
        const Point2 corners[] = {low, {high.x, low.y}, high, {low.x, high.y}};
        for (int i = 0; i < 4; ++i)
            curves.emplace_back(exact(corners[i]), exact(corners[(i + 1) % 4]));
        CGAL::insert(arrangement_, curves.begin(), curves.end());
        visibility_.attach(arrangement_);
        locator_.attach(arrangement_);
    }
    VisibilityOracle(const VisibilityOracle&) = delete;
    VisibilityOracle& operator=(const VisibilityOracle&) = delete;

    static Kernel::Point_2 exact(Point2 p) { return {p.x, p.y}; }
    static Kernel::Point_2 middleOf(const Segment2& line, int of_8) {
        const auto a = exact(line.a), b = exact(line.b);
        return a + (b - a) * Kernel::FT(of_8) / Kernel::FT(8);
    }

    /// The face that a point lies strictly in; a null handle for none.
    [[nodiscard]] Face faceOf(Point2 p) const {
        const auto found = locator_.locate(exact(p));
        const auto* const face = boost::get<Face>(&found);
        return face == nullptr ? Face() : *face;
    }

    /// Seen from a point, on both sides of all lines on which it lies.
    [[nodiscard]] double area(const Kernel::Point_2& p) const {
        const auto found = locator_.locate(p);
        if (const auto* const face = boost::get<Face>(&found)) return areaFrom(p, *face);
        if (const auto* const edge = boost::get<Arrangement::Halfedge_const_handle>(&found))
            return areaFrom(p, *edge) + areaFrom(p, (*edge)->twin());
        const auto vertex = boost::get<Arrangement::Vertex_const_handle>(found);
        double sum = 0;
        Arrangement::Halfedge_around_vertex_const_circulator edge = vertex->incident_halfedges();
        const auto first = edge;
        do sum += areaFrom(p, Arrangement::Halfedge_const_handle(edge));
        while (++edge != first);
        return sum;
    }

    /// \return number of vertices
    std::size_t look(Point2 p, Face face) const {
        out_.clear();
        visibility_.compute_visibility(exact(p), face, out_);
        return out_.number_of_vertices();
    }

  private:
    template <typename From>
    [[nodiscard]] double areaFrom(const Kernel::Point_2& p, From from) const {
        out_.clear();
        visibility_.compute_visibility(p, from, out_);
        Kernel::FT twice = 0;
        for (auto face = out_.faces_begin(); face != out_.faces_end(); ++face) {
            if (face->is_unbounded() || !face->has_outer_ccb()) continue;
            auto edge = face->outer_ccb();
            const auto first = edge;
            do {
                const auto a = edge->source()->point() - p, b = edge->target()->point() - p;
                twice += a.x() * b.y() - a.y() * b.x();
            } while (++edge != first);
        }
        return CGAL::to_double(twice) / 2;
    }

    Arrangement arrangement_;
    mutable Arrangement out_;
    CGAL::Triangular_expansion_visibility_2<Arrangement, CGAL::Tag_true> visibility_;
    CGAL::Arr_walk_along_line_point_location<Arrangement> locator_;
};

}  // namespace ispace::test
