// SPDX-License-Identifier: GPL-3.0-or-later
// Faces and differences against an arrangement of CGAL in exact numbers.

#include <CGAL/Arr_consolidated_curve_data_traits_2.h>
#include <CGAL/Arr_extended_dcel.h>
#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arrangement_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "geom/arrangement.h"
#include "support/test_curves.h"

namespace ispace {

namespace {

constexpr int kDropped = -1;

struct HalfedgeMark {
    bool walked = false;
};

struct FaceMark {
    bool reached = false;
    int added = 0, removed = 0;  // winding numbers
    int piece = kDropped;        // faces of one piece are one region
};

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
// Each edge carries the indices of the lines it is part of.
using Traits =
    CGAL::Arr_consolidated_curve_data_traits_2<CGAL::Arr_segment_traits_2<Kernel>, std::uint32_t>;
using Dcel = CGAL::Arr_extended_dcel<Traits, char, HalfedgeMark, FaceMark>;
using Arrangement = CGAL::Arrangement_2<Traits, Dcel>;
using Halfedge = Arrangement::Halfedge_handle;
using Face = Arrangement::Face_handle;
using Vertex = Arrangement::Vertex_handle;
using ExactPoint = Arrangement::Point_2;

/// A line from its lower end to its upper, with what it adds to the winding numbers on its left.
struct Line {
    Point2 a, b;
    int added = 0, removed = 0;
    bool passage = false;  ///< does not keep faces apart
};

Line turned(const Segment2& s, int added, int removed, bool passage = false) {
    if (lexLess(s.a, s.b)) return {s.a, s.b, added, removed, passage};
    return {s.b, s.a, -added, -removed, passage};
}

/// Equal lines as one, those without length left out: thousands on one place would make the lists
/// of indices long.
std::vector<Line> joined(std::vector<Line> lines) {
    std::erase_if(lines, [](const Line& line) { return line.a == line.b; });
    std::sort(lines.begin(), lines.end(), [](const Line& l, const Line& m) {
        return l.a == m.a ? lexLess(l.b, m.b) : lexLess(l.a, m.a);
    });
    std::vector<Line> all;
    for (const Line& line : lines) {
        if (all.empty() || all.back().a != line.a || all.back().b != line.b) {
            all.push_back(line);
        } else {
            all.back().added += line.added;
            all.back().removed += line.removed;
            all.back().passage = all.back().passage && line.passage;
        }
    }
    return all;
}

Arrangement arrange(const std::vector<Line>& lines) {
    std::vector<Traits::Curve_2> curves;
    curves.reserve(lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const auto& [a, b, added, removed, passage] = lines[i];
        curves.emplace_back(
            Traits::Base_curve_2(Kernel::Point_2(a.x, a.y), Kernel::Point_2(b.x, b.y)),
            static_cast<std::uint32_t>(i));
    }
    Arrangement arrangement;
    CGAL::insert(arrangement, curves.begin(), curves.end());
    return arrangement;
}

template <typename Visit>
void forEachHalfedge(Face face, Visit visit) {
    const auto around = [&](Arrangement::Ccb_halfedge_circulator start) {
        auto edge = start;
        do visit(Halfedge(edge));
        while (++edge != start);
    };
    for (auto c = face->outer_ccbs_begin(); c != face->outer_ccbs_end(); ++c) around(*c);
    for (auto c = face->inner_ccbs_begin(); c != face->inner_ccbs_end(); ++c) around(*c);
}

/// True where the piece on the left of the edge ends.
bool isBoundary(Halfedge edge) {
    const int left = edge->face()->data().piece;
    return left != kDropped && left != edge->twin()->face()->data().piece;
}

/// How the winding numbers grow from the right of an edge to its left.
void addLines(Halfedge edge, const std::vector<Line>& lines, FaceMark& mark) {
    const int step = edge->direction() == CGAL::ARR_LEFT_TO_RIGHT ? 1 : -1;
    const auto& sources = edge->curve().data();
    for (auto i = sources.begin(); i != sources.end(); ++i) {
        mark.added += step * lines[*i].added;
        mark.removed += step * lines[*i].removed;
    }
}

void windFaces(Arrangement& arrangement, const std::vector<Line>& lines) {
    std::vector<Face> reached{arrangement.unbounded_face()};
    reached[0]->data().reached = true;
    while (!reached.empty()) {
        const Face face = reached.back();
        reached.pop_back();
        forEachHalfedge(face, [&](Halfedge edge) {
            const Face next = edge->twin()->face();
            if (next->data().reached) return;
            FaceMark mark = face->data();
            addLines(edge->twin(), lines, mark);
            next->set_data(mark);
            reached.push_back(next);
        });
    }
}

/// Numbers the pieces: faces that are kept(face) and share an edge that is open(edge) are one.
template <typename Kept, typename Open>
int joinFaces(Arrangement& arrangement, Kept kept, Open is_open) {
    int pieces = 0;
    std::vector<Face> open;
    for (auto f = arrangement.faces_begin(); f != arrangement.faces_end(); ++f) {
        if (!kept(f) || f->data().piece != kDropped) continue;
        f->data().piece = pieces;
        open.assign(1, f);
        while (!open.empty()) {
            const Face face = open.back();
            open.pop_back();
            forEachHalfedge(face, [&](Halfedge edge) {
                const Face next = edge->twin()->face();
                if (next->data().piece != kDropped || !kept(next) || !is_open(edge)) return;
                next->data().piece = pieces;
                open.push_back(next);
            });
        }
        ++pieces;
    }
    return pieces;
}

/// A closed walk along the boundary of a piece, the piece on the left.
using Loop = std::vector<Halfedge>;

Loop walk(Halfedge start) {
    Loop loop;
    Halfedge edge = start;
    do {
        edge->data().walked = true;
        loop.push_back(edge);
        edge = edge->next();
        // Lines with the same piece on both sides are no boundary: turn past them.
        while (!isBoundary(edge)) edge = edge->twin()->next();
    } while (edge != start);
    return loop;
}

/// Whether the piece lies outside the loop, decided at its leftmost vertex: at one of the loop's
/// visits there the direction to the left is within the piece.
bool isHole(const Loop& loop) {
    const Kernel kernel;
    const auto less = kernel.less_xy_2_object();
    const auto turn = kernel.orientation_2_object();
    std::size_t leftmost = 0;
    for (std::size_t i = 1; i < loop.size(); ++i) {
        if (less(loop[i]->source()->point(), loop[leftmost]->source()->point())) leftmost = i;
    }
    const Vertex vertex = loop[leftmost]->source();
    for (std::size_t i = 0; i < loop.size(); ++i) {
        if (loop[i]->source() != vertex) continue;
        const Halfedge before = loop[i == 0 ? loop.size() - 1 : i - 1];
        if (turn(vertex->point(), before->source()->point(), loop[i]->target()->point()) ==
            CGAL::LEFT_TURN)
            return true;
    }
    return false;
}

/// The nearest double of a coordinate, also where its interval is wide.
double rounded(const Kernel::FT& value) {
    if (!value.approx().is_point()) value.exact();
    return CGAL::to_double(value);
}

/// A vertex that only lines of no account made, on a straight line of the boundary.
bool isIdle(const ExactPoint& before, Vertex vertex, const ExactPoint& after) {
    if (vertex->degree() == 2) return false;  // the input's own
    std::size_t boundaries = 0;
    auto edge = vertex->incident_halfedges();
    const auto start = edge;
    do {
        if (isBoundary(edge) || isBoundary(edge->twin())) ++boundaries;
    } while (++edge != start);
    return boundaries == 2 && CGAL::orientation(before, vertex->point(), after) == CGAL::COLLINEAR;
}

/// Vertices in doubles, without the repetitions and spikes that rounding makes, from the lowest.
Polygon roundedCurve(const Loop& loop) {
    Polygon curve;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Halfedge before = loop[i == 0 ? loop.size() - 1 : i - 1];
        const Vertex vertex = loop[i]->source();
        if (isIdle(before->source()->point(), vertex, loop[i]->target()->point())) continue;
        const Point2 p{rounded(vertex->point().x()) + 0.0, rounded(vertex->point().y()) + 0.0};
        if (!curve.empty() && curve.back() == p) continue;
        curve.push_back(p);
        while (curve.size() >= 3 && curve.end()[-3] == p) curve.resize(curve.size() - 2);
    }
    const auto is_spike = [&] {
        const std::size_t n = curve.size();
        return n >= 2 && (curve[0] == curve[n - 1] || curve[0] == curve[n - 2] ||
                          (n >= 3 && curve[1] == curve[n - 1]));
    };
    while (is_spike()) {
        if (curve.size() >= 3 && curve[1] == curve.back()) curve.erase(curve.begin());
        curve.pop_back();
    }
    if (curve.size() < 3) return {};
    rotateToLowest(curve);
    return curve;
}

std::vector<Region> collect(Arrangement& arrangement, int pieces) {
    std::vector<Region> regions(static_cast<std::size_t>(pieces));
    for (auto e = arrangement.halfedges_begin(); e != arrangement.halfedges_end(); ++e) {
        if (e->data().walked || !isBoundary(e)) continue;
        const Loop loop = walk(e);
        Polygon curve = roundedCurve(loop);
        Region& region = regions[static_cast<std::size_t>(e->face()->data().piece)];
        // What rounding has turned inside out is thinner than a double can tell.
        if (isHole(loop)) {
            if (signedArea(curve) < 0) region.holes.push_back(std::move(curve));
        } else if (signedArea(curve) > 0) {
            region.outline = std::move(curve);
        }
    }
    putInOrder(regions);
    return regions;
}

}  // namespace

std::vector<Region> test::exactFaces(std::span<const Segment2> lines,
                                     std::span<const Segment2> passages) {
    std::vector<Line> all;
    all.reserve(lines.size() + passages.size());
    for (const Segment2& s : lines) all.push_back(turned(s, 0, 0));
    for (const Segment2& s : passages) all.push_back(turned(s, 0, 0, true));
    all = joined(std::move(all));
    Arrangement arrangement = arrange(all);
    const auto bounded = [](Face face) { return !face->is_unbounded(); };
    const auto open = [&all](Halfedge edge) {
        const auto& sources = edge->curve().data();
        return std::all_of(sources.begin(), sources.end(),
                           [&all](std::uint32_t i) { return all[i].passage; });
    };
    return collect(arrangement, joinFaces(arrangement, bounded, open));
}

std::vector<Region> test::exactDifference(std::span<const Segment2> added,
                                          std::span<const Segment2> removed) {
    std::vector<Line> lines;
    for (const Segment2& s : added) lines.push_back(turned(s, 1, 0));
    for (const Segment2& s : removed) lines.push_back(turned(s, 0, 1));
    lines = joined(std::move(lines));
    Arrangement arrangement = arrange(lines);
    windFaces(arrangement, lines);
    const auto kept = [](Face face) { return face->data().added > 0 && face->data().removed == 0; };
    return collect(arrangement, joinFaces(arrangement, kept, [](Halfedge) { return true; }));
}

}  // namespace ispace
