// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/polygon.h"

#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>

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

Box2 bounds(const Regions& regions) {
    Box2 box;
    for (const Region& part : regions.parts)
        for (const Point2 p : part.outline) box.add(p);
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

constexpr std::size_t kLevels = 24;        // scanlines per direction, of each kind
constexpr std::size_t kManyLevels = 2000;  // the same where the first ones found nothing
constexpr std::size_t kChordsPerLine = 3;  // the longest are tried

/// The region's edges; `swapped`: with x and y exchanged, so that one scan serves both directions.
std::vector<Segment2> edgesOf(const Region& region, bool swapped) {
    std::vector<Segment2> edges;
    region.forEachEdge([&](const Segment2& e) {
        edges.push_back(swapped ? Segment2{{e.a.y, e.a.x}, {e.b.y, e.b.x}} : e);
    });
    return edges;
}

double middle(double a, double b) { return a / 2 + b / 2; }

/// Levels halfway between neighbouring vertices, at most `most` of them, widest steps first: each
/// of them holds a chord of the region.
std::vector<double> levelsBetweenVertices(const std::vector<Segment2>& edges, std::size_t most) {
    std::vector<double> ys;
    ys.reserve(edges.size());
    for (const Segment2& e : edges) ys.push_back(e.a.y);
    std::sort(ys.begin(), ys.end());
    ys.erase(std::unique(ys.begin(), ys.end()), ys.end());
    std::vector<std::size_t> steps;
    for (std::size_t i = 1; i < ys.size(); ++i) steps.push_back(i);
    const auto last = steps.begin() + static_cast<std::ptrdiff_t>(std::min(steps.size(), most));
    std::partial_sort(steps.begin(), last, steps.end(), [&](std::size_t i, std::size_t k) {
        const double wide = ys[i] - ys[i - 1], other = ys[k] - ys[k - 1];
        return wide != other ? wide > other : i < k;
    });
    steps.erase(last, steps.end());
    std::vector<double> levels;
    levels.reserve(steps.size());
    for (const std::size_t i : steps) levels.push_back(middle(ys[i - 1], ys[i]));
    return levels;
}

std::vector<double> evenLevels(const std::vector<Segment2>& edges) {
    Box2 box;
    for (const Segment2& e : edges) box.add(e.a);
    std::vector<double> levels;
    for (std::size_t i = 0; i < kLevels; ++i) {
        const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(kLevels);
        levels.push_back(box.low.y + share * box.depth());
    }
    return levels;
}

/// The middle of a chord of the region.
struct Candidate {
    Point2 at;
    double room = 0;  ///< from there to an end of the chord
};

/// Middles of the longest chords of the region at a level, between these crossings of its boundary.
void addChordMiddles(std::vector<double>& xs, double y, std::vector<Candidate>& middles) {
    std::sort(xs.begin(), xs.end());
    std::vector<std::pair<double, Point2>> chords;
    for (std::size_t i = 1; i < xs.size(); i += 2)
        chords.push_back({xs[i] - xs[i - 1], {middle(xs[i - 1], xs[i]), y}});
    std::stable_sort(chords.begin(), chords.end(),
                     [](const auto& c, const auto& d) { return c.first > d.first; });
    chords.resize(std::min(chords.size(), kChordsPerLine));
    for (const auto& [width, p] : chords) middles.push_back({p, width / 2});
}

/// The same at some levels, one after another.
void addChordMiddles(const std::vector<Segment2>& edges, std::span<const double> levels,
                     std::vector<Candidate>& middles) {
    std::vector<std::pair<double, std::size_t>> by_height;
    for (std::size_t i = 0; i < levels.size(); ++i) by_height.emplace_back(levels[i], i);
    std::sort(by_height.begin(), by_height.end());
    std::vector<std::vector<double>> xs(levels.size());
    for (const auto& [a, b] : edges) {
        const double low = std::min(a.y, b.y), high = std::max(a.y, b.y);
        auto level = std::lower_bound(by_height.begin(), by_height.end(), low,
                                      [](const auto& l, double y) { return l.first < y; });
        for (; level != by_height.end() && level->first < high; ++level)
            xs[level->second].push_back(a.x + (b.x - a.x) * ((level->first - a.y) / (b.y - a.y)));
    }
    for (std::size_t i = 0; i < levels.size(); ++i) addChordMiddles(xs[i], levels[i], middles);
}

/// Keeps the candidate farthest from the boundary.
class Best {
  public:
    explicit Best(const Region& region) : region_(region), edges_(edgesOf(region, false)) {
        for (const Segment2& e : edges_)
            for (const double v : {e.a.x, e.a.y}) rounding_ = std::max(rounding_, std::abs(v));
        rounding_ *= 1e-12;
    }

    void offer(const Candidate& candidate) {
        // The ends of its chord are near enough to tell.
        if (candidate.room < (1 - 1e-9) * clearance_ - rounding_) return;
        offer(candidate.at);
    }
    void offer(Point2 p) {
        const double distance = clearance(p);
        if (distance <= clearance_ || region_.locate(p) != Side::Inside) return;
        clearance_ = distance;
        point_ = p;
    }
    [[nodiscard]] std::size_t edges() const { return edges_.size(); }
    [[nodiscard]] bool found() const { return clearance_ >= 0; }
    [[nodiscard]] Point2 point() const { return point_; }

  private:
    /// Distance from the nearest edge, or any smaller number once that is no better.
    [[nodiscard]] double clearance(Point2 p) const {
        double nearest = std::numeric_limits<double>::infinity(), reach = nearest;
        for (const Segment2& e : edges_) {
            const double dx = std::max(std::min(e.a.x, e.b.x) - p.x, p.x - std::max(e.a.x, e.b.x));
            const double dy = std::max(std::min(e.a.y, e.b.y) - p.y, p.y - std::max(e.a.y, e.b.y));
            if (dx > reach || dy > reach) continue;  // the box about it is too far
            nearest = std::min(nearest, distance(p, e));
            if (nearest <= clearance_) break;
            reach = (1 + 1e-9) * nearest + rounding_;
        }
        return nearest;
    }

    const Region& region_;
    std::vector<Segment2> edges_;
    double rounding_ = 0;  ///< no distance errs by as much
    double clearance_ = -1;
    Point2 point_;
};

/// Candidates on scanlines, from both directions.
std::vector<Candidate> candidates(const Region& region, bool swapped, std::size_t most) {
    constexpr std::size_t kAtOnce = 64;  // levels
    const auto edges = edgesOf(region, swapped);
    auto levels = levelsBetweenVertices(edges, most);
    const auto even = evenLevels(edges);
    levels.insert(levels.end(), even.begin(), even.end());
    std::vector<Candidate> middles;
    for (std::size_t i = 0; i < levels.size(); i += kAtOnce)
        addChordMiddles(edges, std::span(levels).subspan(i, std::min(kAtOnce, levels.size() - i)),
                        middles);
    if (swapped)
        for (Candidate& c : middles) std::swap(c.at.x, c.at.y);
    return middles;
}

void scan(const Region& region, std::size_t most, Best& best) {
    constexpr std::size_t kManyEdges = 10'000;
    std::vector<Candidate> up, across;
    const auto find_up = [&] { up = candidates(region, false, most); };
    const auto find_across = [&] { across = candidates(region, true, most); };
    if (best.edges() < kManyEdges) {
        find_up();
        find_across();
    } else {
        tbb::this_task_arena::isolate([&] { tbb::parallel_invoke(find_up, find_across); });
    }
    for (const std::vector<Candidate>* found : {&up, &across})
        for (const Candidate& candidate : *found) best.offer(candidate);
}

/// Middles of the triangles at the corners, and the doubles about them: where a region is so thin
/// that no scanline's middle survives rounding.
void tryCorners(const Region& region, Best& best) {
    const auto around = [&](const Polygon& curve) {
        for (std::size_t i = 0; i < curve.size(); ++i) {
            const Point2 a = curve[i], b = curve[(i + 1) % curve.size()];
            const Point2 c = curve[(i + 2) % curve.size()];
            const Point2 center{a.x / 3 + b.x / 3 + c.x / 3, a.y / 3 + b.y / 3 + c.y / 3};
            constexpr double kFar = std::numeric_limits<double>::infinity();
            for (const double x :
                 {std::nextafter(center.x, -kFar), center.x, std::nextafter(center.x, kFar)}) {
                for (const double y :
                     {std::nextafter(center.y, -kFar), center.y, std::nextafter(center.y, kFar)})
                    best.offer(Point2{x, y});
            }
        }
    };
    around(region.outline);
    for (const Polygon& hole : region.holes) around(hole);
}

}  // namespace

Point2 interiorPoint(const Region& region) {
    Best best(region);
    scan(region, kLevels, best);
    if (!best.found()) scan(region, kManyLevels, best);
    if (!best.found()) tryCorners(region, best);
    if (!best.found())
        throw std::invalid_argument(
            "region without inside: too thin for a point between its edges");
    return best.point();
}

}  // namespace ispace
