// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/visibility/visibility_mesh.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"

namespace ispace {

namespace {

using Index = std::uint32_t;
/// Lines' ends, or triangles, that are worth another thread.
constexpr std::size_t kMany = 20'000;
using Doubles = CGAL::Exact_predicates_inexact_constructions_kernel;

/// Plans are full of rectangles; their corners lie on a circle or next to it. If doubles are not
/// sufficient, pairs of doubles mostly are, in a fraction of the time of exact numbers.
struct Kernel : Doubles {
    struct Side_of_oriented_circle_2 {            // NOLINT: CGAL's names
        using result_type = CGAL::Oriented_side;  // NOLINT
        CGAL::Oriented_side operator()(const Point_2& a, const Point_2& b, const Point_2& c,
                                       const Point_2& p) const {
            const int side =
                surelyInCircle({a.x(), a.y()}, {b.x(), b.y()}, {c.x(), c.y()}, {p.x(), p.y()});
            if (side != 0) return side > 0 ? CGAL::ON_POSITIVE_SIDE : CGAL::ON_NEGATIVE_SIDE;
            return Doubles().side_of_oriented_circle_2_object()(a, b, c, p);
        }
    };
    [[nodiscard]] Side_of_oriented_circle_2 side_of_oriented_circle_2_object() const { return {}; }
};

}  // namespace

}  // namespace ispace

/// Finds triangles as its base kernel does: first with rounded orientations.
template <>
struct CGAL::Triangulation_structural_filtering_traits<ispace::Kernel> {
    using Use_structural_filtering_tag = CGAL::Tag_true;  // NOLINT: CGAL looks for it
};

namespace ispace {

namespace {

using Tds = CGAL::Triangulation_data_structure_2<
    CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>,
    CGAL::Constrained_triangulation_face_base_2<
        Kernel, CGAL::Triangulation_face_base_with_info_2<Index, Kernel>>>;
// Pieces of lines may still cross by a rounding error: that must not throw.
using Delaunay =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Tds, CGAL::Exact_predicates_tag>;

Point2 pointOf(const Delaunay::Vertex_handle& v) { return {v->point().x(), v->point().y()}; }

/// Returns a box with a margin around that of the lines, wherever they lie.
Box2 boxAround(const Box2& box) {
    if (box.empty()) return {{-1, -1}, {1, 1}};
    const double farthest = std::max(
        {std::abs(box.low.x), std::abs(box.low.y), std::abs(box.high.x), std::abs(box.high.y)});
    return box.expanded(std::max({box.width(), box.depth(), 1.0, farthest / 1024}));
}

std::array<Point2, 4> cornersOf(const Box2& box) {
    return {box.low, {box.high.x, box.low.y}, box.high, {box.low.x, box.high.y}};
}

/// Sorts by a total order, in parallel if there are many elements.
template <typename T, typename Less>
void sortMany(std::vector<T>& items, Less less) {
    if (items.size() < kMany)
        std::sort(items.begin(), items.end(), less);
    else
        tbb::parallel_sort(items.begin(), items.end(), less);
}

/// Runs both functions, the second on this thread; in parallel if it pays.
template <typename F, typename G>
void runBoth(bool is_worth_it, F f, G g) {
    if (is_worth_it) return tbb::parallel_invoke(f, g);
    f();
    g();
}

/// \param net empty; filled in place, since a move copies it in another order
void triangulate(const std::vector<Segment2>& lines, const Box2& box, Delaunay& net) {
    // Ends of lines: first and last of each, as of a list of all.
    struct End {
        Point2 at;
        Index number;
    };
    std::vector<End> ends;
    ends.reserve(2 * lines.size());
    for (const auto& [a, b] : lines) {
        ends.push_back({a, static_cast<Index>(ends.size())});
        ends.push_back({b, static_cast<Index>(ends.size())});
    }
    const auto less = [](const End& e, const End& f) {
        return e.at != f.at ? lexLess(e.at, f.at) : e.number < f.number;
    };
    sortMany(ends, less);
    std::vector<std::pair<Kernel::Point_2, Index>> sites;
    sites.reserve(ends.size() + 4);
    std::vector<Index> site_of(ends.size());
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const Point2 p = ends[i].at;
        if (i == 0 || ends[i - 1].at != p)
            sites.push_back({Kernel::Point_2(p.x, p.y), static_cast<Index>(sites.size())});
        site_of[ends[i].number] = static_cast<Index>(sites.size() - 1);
    }
    for (const Point2 p : cornersOf(box))
        sites.push_back({Kernel::Point_2(p.x, p.y), static_cast<Index>(sites.size())});

    net.insert(sites.begin(), sites.end());
    std::vector<Delaunay::Vertex_handle> handles(sites.size());
    for (auto v = net.finite_vertices_begin(); v != net.finite_vertices_end(); ++v)
        handles[v->info()] = v;
    for (std::size_t i = 0; i < lines.size(); ++i)
        net.insert_constraint(handles[site_of[2 * i]], handles[site_of[2 * i + 1]]);
}

/// Triangles along a curve that fills the plane (Morton), so that neighbours lie near each other in
/// memory; numbered in that order.
std::vector<Delaunay::Face_handle> numberedFaces(const Delaunay& net, const Box2& box) {
    struct Place {
        std::uint64_t code;
        Index number;  // in the order of the net
        Delaunay::Face_handle face;
    };
    std::vector<Place> order;
    order.reserve(net.number_of_faces());
    const auto step = [](double offset, double extent) {
        const double share = offset / extent;  // of the extent, within [0, 1]
        return share > 0 ? static_cast<std::uint32_t>(std::min(share, 1.0) * 0x7FFFFFFF) : 0U;
    };
    for (auto f = net.finite_faces_begin(); f != net.finite_faces_end(); ++f) {
        const Vec2 a = pointOf(f->vertex(0)) - box.low, b = pointOf(f->vertex(1)) - box.low;
        const Vec2 c = pointOf(f->vertex(2)) - box.low;
        order.push_back({mortonCode(step((a.x + b.x + c.x) / 3, box.width()),
                                    step((a.y + b.y + c.y) / 3, box.depth())),
                         static_cast<Index>(order.size()), f});
    }
    sortMany(order, [](const Place& a, const Place& b) {
        return a.code != b.code ? a.code < b.code : a.number < b.number;
    });
    std::vector<Delaunay::Face_handle> faces;
    faces.reserve(order.size());
    for (const Place& place : order) {
        place.face->info() = static_cast<Index>(faces.size());
        faces.push_back(place.face);
    }
    return faces;
}

/// Finds the line piece that contains an edge.
class LineFinder {
  public:
    /// \param lines sorted by their ends
    LineFinder(const std::vector<Segment2>& lines, const std::vector<Index>& names)
        : lines_(lines), names_(names) {}

    /// Mostly the edge is a whole piece. If not, it is the piece nearest to both end points.
    [[nodiscard]] Index find(Point2 a, Point2 b) const {
        const Segment2 edge = ordered({a, b});
        const auto whole = std::lower_bound(
            lines_.begin(), lines_.end(), edge, [](const Segment2& line, const Segment2& wanted) {
                const Segment2 own = ordered(line);
                return own.a != wanted.a ? lexLess(own.a, wanted.a) : lexLess(own.b, wanted.b);
            });
        if (whole != lines_.end() && ordered(*whole) == edge)
            return names_[static_cast<std::size_t>(whole - lines_.begin())];
        const Point2 middle{a.x / 2 + b.x / 2, a.y / 2 + b.y / 2};
        double least = std::numeric_limits<double>::infinity();
        Index found = 0;
        const SegmentGrid& grid = grid_.get([this] { return SegmentGrid(lines_, 0); });
        for (const Index i : grid.near(middle)) {
            const double gap = gapTo(lines_[i], a, b);
            if (gap < least) least = gap, found = i;
        }
        if (!std::isfinite(least)) {
            for (Index i = 0; i < lines_.size(); ++i) {
                const double gap = gapTo(lines_[i], a, b);
                if (gap < least) least = gap, found = i;
            }
        }
        return names_[found];
    }

  private:
    static Segment2 ordered(const Segment2& s) {
        return lexLess(s.b, s.a) ? Segment2{s.b, s.a} : s;
    }
    static double gapTo(const Segment2& line, Point2 a, Point2 b) {
        return std::max(distance(a, line), distance(b, line));
    }

    const std::vector<Segment2>& lines_;
    const std::vector<Index>& names_;
    Lazy<SegmentGrid> grid_;
};

}  // namespace

std::vector<LinePiece> sightPieces(std::span<const Segment2> all_lines) {
    std::vector<Segment2> lines(all_lines.begin(), all_lines.end());
    for (auto& [a, b] : lines) a = withinSight(a), b = withinSight(b);
    return noded(linePieces(lines));
}

ExpansionMesh::ExpansionMesh(std::span<const LinePiece> pieces) : in() {
    std::vector<Segment2> lines;
    std::vector<Index> names;
    lines.reserve(pieces.size());
    names.reserve(pieces.size());
    for (const LinePiece& piece : pieces) {
        lines.push_back(piece.segment);
        names.push_back(piece.line);
        cells_box.add(piece.segment.a);
        cells_box.add(piece.segment.b);
    }
    box = boxAround(cells_box);
    // Isolated: the caller may hold a lock that other tasks request.
    tbb::this_task_arena::isolate([&] { makeTriangles(lines, names); });
}

void ExpansionMesh::makeTriangles(const std::vector<Segment2>& lines,
                                  const std::vector<Index>& names) {
    const bool are_many = lines.size() >= kMany;
    const LineFinder finder(lines, names);
    std::optional<Delaunay> net(std::in_place);
    triangulate(lines, box, *net);
    std::vector<Delaunay::Face_handle> faces;
    runBoth(
        are_many, [&] { portals.resize(3 * net->number_of_faces()); },
        [&] { faces = numberedFaces(*net, box); });
    const auto portal_of = [](const Delaunay::Face_handle& face, int i) {
        return 3 * face->info() + static_cast<Index>(i);
    };
    const auto add_portals = [&](const Delaunay::Face_handle& face) {
        for (int i = 0; i < 3; ++i) {
            const Index edge = portal_of(face, i);
            const auto next = face->neighbor(i);
            const Point2 from = pointOf(face->vertex(CGAL::Triangulation_cw_ccw_2::ccw(i)));
            const Point2 to = pointOf(face->vertex(CGAL::Triangulation_cw_ccw_2::cw(i)));
            Index target = Portal::kFree;
            if (net->is_infinite(next)) {
                // Counter-clockwise: along the lower side in x, along the right one in y.
                const bool level = from.y == to.y;
                in[level ? (to.x > from.x ? 0U : 2U) : (to.y > from.y ? 1U : 3U)] = edge;
            } else {
                target = portal_of(next, next->index(face));
            }
            portals[edge].corner = pointOf(face->vertex(i));
            portals[edge].behind = target;
            if (face->is_constrained(i)) {
                if (target > edge) portals[edge].line = finder.find(from, to);
                target = Portal::kBlocked | edge;
            }
            portals[beforeOf(edge)].right = target;
            portals[nextOf(edge)].left = target;
        }
    };
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, faces.size(), kMany),
                      [&](const auto& range) {
                          for (std::size_t i = range.begin(); i < range.end(); ++i)
                              add_portals(faces[i]);
                      });
    // Finds the line once for both sides.
    for (Index edge = 0; edge < portals.size(); ++edge)
        if (portals[edge].behind < edge && isLine(edge))
            portals[edge].line = portals[portals[edge].behind].line;
    runBoth(
        are_many, [&] { net.reset(); }, [&] { makeCells(faces.size()); });
}

std::size_t ExpansionMesh::cellOf(Point2 p) const {
    const auto step = [](double offset, double per_metre, Index count) -> std::size_t {
        const double cell = offset * per_metre;
        if (!(cell > 0)) return 0;
        return cell < count ? static_cast<std::size_t>(cell) : count - 1;
    };
    return step(p.y - cells_box.low.y, rows_per_metre, rows) * columns +
           step(p.x - cells_box.low.x, columns_per_metre, columns);
}

void ExpansionMesh::makeCells(std::size_t count) {
    if (cells_box.empty()) cells_box = {{0, 0}, {0, 0}};
    const double width = cells_box.width(), depth = cells_box.depth();
    const auto most = static_cast<double>(count);
    const auto share = [most](double extent, double other) {
        const double cells = std::sqrt(most) * std::sqrt(extent / other);
        return static_cast<Index>(std::clamp(std::isnan(cells) ? 1 : cells, 1.0, most));
    };
    columns = share(width, depth);
    rows = share(depth, width);
    if (width > 0) columns_per_metre = columns / width;
    if (depth > 0) rows_per_metre = rows / depth;
    cells.resize(std::size_t{columns} * rows);
    // To and fro, so that the next cell is near; several blocks of rows at once.
    constexpr Index kRows = 64;
    const auto place = [&](Index column, Index row) {
        return Point2{cells_box.low.x + (column + 0.5) / columns * width,
                      cells_box.low.y + (row + 0.5) / rows * depth};
    };
    std::vector<Index> first((rows + kRows - 1) / kRows, 0);
    for (Index i = 1; i < first.size(); ++i)
        first[i] = locateFrom(place(0, i * kRows), first[i - 1]);
    tbb::parallel_for(std::size_t{0}, first.size(), [&](std::size_t block) {
        Index triangle = first[block];
        const auto begin = static_cast<Index>(block) * kRows;
        for (Index row = begin; row < std::min(rows, begin + kRows); ++row) {
            for (Index i = 0; i < columns; ++i) {
                const Index column = row % 2 == 0 ? i : columns - 1 - i;
                triangle = locateFrom(place(column, row), triangle);
                cells[std::size_t{row} * columns + column] = triangle;
            }
        }
    });
}

Index ExpansionMesh::locateFrom(Point2 p, Index triangle) const {
    // A walk towards p may go in circles where lines keep triangles from being Delaunay: after some
    // steps it takes edges in random order, and at last every triangle has its turn.
    constexpr int kStraightSteps = 200, kMaxSteps = 100'000;
    const auto is_right = [&](Index edge) {
        const Point2 a = portals[nextOf(edge)].corner, b = portals[beforeOf(edge)].corner;
        const double turn = surelyTurns(a - p, b - p);
        if (turn != 0) return turn < 0;
        return orientation(p, a, b) == Turn::Right;
    };
    std::uint32_t random = 1, came = Portal::kFree;
    for (int step = 0; step < kMaxSteps; ++step) {
        if (step > kStraightSteps) random = random * 1664525U + 1013904223U;
        Index next = Portal::kFree;
        for (Index k = 0; k < 3 && next == Portal::kFree; ++k) {
            const Index edge = 3 * triangle + (k + (random >> 16)) % 3;
            if (edge != came && is_right(edge)) next = portals[edge].behind;
        }
        if (next == Portal::kFree) return triangle;
        came = next;
        triangle = next / 3;
    }
    for (triangle = 0; std::size_t{3} * triangle < portals.size(); ++triangle)
        if (!is_right(3 * triangle) && !is_right(3 * triangle + 1) && !is_right(3 * triangle + 2))
            return triangle;
    return 0;
}

}  // namespace ispace
