// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arr_walk_along_line_point_location.h>
#include <CGAL/Arrangement_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangular_expansion_visibility_2.h>

#include <boost/variant/get.hpp>
#include <variant>
#include <vector>

#include "geom/point.h"
#include "support/test_plans.h"

namespace ispace::test {

namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Arrangement = CGAL::Arrangement_2<CGAL::Arr_segment_traits_2<Kernel>>;
using Face = Arrangement::Face_const_handle;
using Halfedge = Arrangement::Halfedge_const_handle;
using Vertex = Arrangement::Vertex_const_handle;

Kernel::Point_2 exact(Point2 p) { return {p.x, p.y}; }

/// The alternative of a variant of Boost (CGAL 5) or of the standard library (CGAL 6), or null.
template <typename T, typename Variant>
const T* as(const Variant& found) {
    if constexpr (requires { std::get_if<T>(&found); }) {
        return std::get_if<T>(&found);
    } else {
        return boost::get<T>(&found);
    }
}

}  // namespace

struct VisibilityOracle::Data {
    Arrangement arrangement;
    Arrangement out;
    CGAL::Triangular_expansion_visibility_2<Arrangement, CGAL::Tag_true> visibility;
    CGAL::Arr_walk_along_line_point_location<Arrangement> locator;
    std::vector<Face> faces;

    double area(const Kernel::Point_2& p) {
        const auto found = locator.locate(p);
        if (const auto* const face = as<Face>(found)) return areaIn(p, *face);
        if (const auto* const edge = as<Halfedge>(found))
            return areaIn(p, *edge) + areaIn(p, (*edge)->twin());
        const Vertex vertex = *as<Vertex>(found);
        double sum = 0;
        Arrangement::Halfedge_around_vertex_const_circulator edge = vertex->incident_halfedges();
        const auto first = edge;
        do sum += areaIn(p, Halfedge(edge));
        while (++edge != first);
        return sum;
    }

    template <typename From>
    double areaIn(const Kernel::Point_2& p, From from) {
        out.clear();
        visibility.compute_visibility(p, from, out);
        Kernel::FT twice = 0;
        for (auto face = out.faces_begin(); face != out.faces_end(); ++face) {
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
};

VisibilityOracle::VisibilityOracle(std::span<const Segment2> lines)
    : data_(std::make_unique<Data>()) {
    std::vector<Arrangement::X_monotone_curve_2> curves;
    Box2 box;
    for (const auto& [a, b] : lines) {
        box.add(a);
        box.add(b);
        curves.emplace_back(exact(a), exact(b));
    }
    const Point2 low = box.low - Vec2{10, 10}, high = box.high + Vec2{10, 10};
    const Point2 corners[] = {low, {high.x, low.y}, high, {low.x, high.y}};
    for (int i = 0; i < 4; ++i) curves.emplace_back(exact(corners[i]), exact(corners[(i + 1) % 4]));
    CGAL::insert(data_->arrangement, curves.begin(), curves.end());
    data_->visibility.attach(data_->arrangement);
    data_->locator.attach(data_->arrangement);
}

VisibilityOracle::~VisibilityOracle() = default;

double VisibilityOracle::areaFrom(Point2 p) const { return data_->area(exact(p)); }

double VisibilityOracle::areaFrom(const Segment2& line, int eighths, Point2& rounded) const {
    const auto a = exact(line.a), b = exact(line.b);
    const auto place = a + (b - a) * Kernel::FT(eighths) / Kernel::FT(8);
    rounded = {CGAL::to_double(place.x()), CGAL::to_double(place.y())};
    return data_->area(place);
}

std::optional<std::size_t> VisibilityOracle::faceOf(Point2 p) {
    const auto found = data_->locator.locate(exact(p));
    const auto* const face = as<Face>(found);
    if (face == nullptr) return std::nullopt;
    data_->faces.push_back(*face);
    return data_->faces.size() - 1;
}

Vec2 VisibilityOracle::query(Point2 p, std::size_t face) const {
    data_->out.clear();
    data_->visibility.compute_visibility(exact(p), data_->faces[face], data_->out);
    Vec2 sum;
    for (auto v = data_->out.vertices_begin(); v != data_->out.vertices_end(); ++v)
        sum = sum + Vec2{CGAL::to_double(v->point().x()), CGAL::to_double(v->point().y())};
    return sum;
}

}  // namespace ispace::test
