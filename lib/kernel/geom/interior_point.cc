// SPDX-License-Identifier: GPL-3.0-or-later
// Finds points well inside regions among the middles of chords on scanlines, level and upright: 24
// scanlines halfway between vertices and 24 at even steps, three chords of each. Their distances
// from the boundary are compared, those with the longest chords first, as half of a chord bounds
// the distance; edges are looked up in bands of height. Only the exact locate() decides that a
// point is inside.
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "geom/polygon.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

constexpr std::size_t kLevels = 24;        // scanlines per direction, of each kind
constexpr std::size_t kManyLevels = 2000;  // the same if the first levels find no point
constexpr std::size_t kChordsPerLine = 3;  // the longest are tried

std::vector<Segment2> edgesOf(const Region& region) {
    std::vector<Segment2> edges;
    region.forEachEdge([&](const Segment2& e) { edges.push_back(e); });
    return edges;
}

/// A point with x and y exchanged if `swapped`, so that one scan serves both directions.
Point2 turned(Point2 p, bool swapped) { return swapped ? Point2{p.y, p.x} : p; }

double middle(double a, double b) { return a / 2 + b / 2; }

/// From one vertex to the next above it.
struct Step {
    double low, high;
    [[nodiscard]] double width() const { return high - low; }
};

/// Finds the steps between neighbours that are wider than twice a part of the extent, if there are
/// so many, in ascending order: those between neighbouring parts. Any others are narrower.
std::optional<std::vector<Step>> wideSteps(const std::vector<double>& ys, std::size_t most) {
    constexpr std::size_t kInPart = 8;
    const std::size_t count = ys.size() / kInPart;
    if (count < most) return std::nullopt;
    const auto [low, high] = std::minmax_element(ys.begin(), ys.end());
    const double extent = *high - *low, per_metre = static_cast<double>(count) / extent;
    if (!(std::isfinite(per_metre) && per_metre > 0)) return std::nullopt;
    constexpr double kFar = std::numeric_limits<double>::infinity();
    std::vector<Step> parts(count, {kFar, -kFar});  // the extent of the vertices in each
    for (const double y : ys) {
        const auto part = static_cast<std::size_t>((y - *low) * per_metre);
        auto& [least, largest] = parts[std::min(part, count - 1)];
        least = std::min(least, y);
        largest = std::max(largest, y);
    }
    std::vector<Step> steps;
    double last = *low;
    for (const auto& [least, largest] : parts) {
        if (least > largest) continue;
        if (least - last > 2 / per_metre) steps.push_back({last, least});
        last = largest;
    }
    if (steps.size() < most) return std::nullopt;
    return steps;
}

/// All steps between neighbours, in ascending order.
std::vector<Step> allSteps(std::vector<double> ys) {
    std::sort(ys.begin(), ys.end());
    ys.erase(std::unique(ys.begin(), ys.end()), ys.end());
    std::vector<Step> steps;
    for (std::size_t i = 1; i < ys.size(); ++i) steps.push_back({ys[i - 1], ys[i]});
    return steps;
}

/// Levels halfway between neighbouring vertices, at most `most` of them, widest steps first: each
/// of them holds a chord of the region.
std::vector<double> levelsBetweenVertices(const std::vector<Segment2>& edges, bool swapped,
                                          std::size_t most) {
    std::vector<double> ys;
    ys.reserve(edges.size());
    for (const Segment2& e : edges) ys.push_back(turned(e.a, swapped).y);
    std::vector<Step> steps;
    if (auto wide = wideSteps(ys, most))
        steps = std::move(*wide);
    else
        steps = allSteps(std::move(ys));
    const auto last = steps.begin() + static_cast<std::ptrdiff_t>(std::min(steps.size(), most));
    std::partial_sort(steps.begin(), last, steps.end(), [](const Step& a, const Step& b) {
        return a.width() != b.width() ? a.width() > b.width() : a.low < b.low;
    });
    steps.erase(last, steps.end());
    std::vector<double> levels;
    levels.reserve(steps.size());
    for (const Step& step : steps) levels.push_back(middle(step.low, step.high));
    return levels;
}

std::vector<double> evenLevels(const std::vector<Segment2>& edges, bool swapped) {
    Box2 box;
    for (const Segment2& e : edges) box.add(turned(e.a, swapped));
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

/// Adds the middles of the longest chords of the region at a level, between these crossings; of
/// chords of one length the first ones.
void addChordMiddles(std::span<const double> xs, double y, std::vector<Candidate>& middles) {
    const auto first = static_cast<std::ptrdiff_t>(middles.size());
    for (std::size_t i = 1; i < xs.size(); i += 2) {
        const double a = xs[i - 1], b = xs[i], room = (b - a) / 2;
        auto place = middles.end();
        while (place - middles.begin() > first && std::prev(place)->room < room) --place;
        middles.insert(place, {{middle(a, b), y}, room});
        middles.resize(std::min(middles.size(), static_cast<std::size_t>(first) + kChordsPerLine));
    }
}

/// The same at some levels, one after another.
void addChordMiddles(const std::vector<Segment2>& edges, bool swapped,
                     std::span<const double> levels, std::vector<Candidate>& middles) {
    std::vector<std::pair<double, std::size_t>> by_height;
    for (std::size_t i = 0; i < levels.size(); ++i) by_height.emplace_back(levels[i], i);
    std::sort(by_height.begin(), by_height.end());
    std::vector<std::pair<std::size_t, double>> crossings;  // of a level
    std::vector<std::size_t> next(levels.size() + 2, 0);
    for (const Segment2& edge : edges) {
        const Point2 a = turned(edge.a, swapped), b = turned(edge.b, swapped);
        const double low = std::min(a.y, b.y), high = std::max(a.y, b.y);
        auto level = std::lower_bound(by_height.begin(), by_height.end(), low,
                                      [](const auto& l, double y) { return l.first < y; });
        for (; level != by_height.end() && level->first < high; ++level) {
            crossings.emplace_back(level->second,
                                   a.x + (b.x - a.x) * ((level->first - a.y) / (b.y - a.y)));
            ++next[level->second + 2];
        }
    }
    std::partial_sum(next.begin(), next.end(), next.begin());
    std::vector<double> xs(crossings.size());
    for (const auto& [level, x] : crossings) xs[next[level + 1]++] = x;
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const auto line = std::span(xs).subspan(next[i], next[i + 1] - next[i]);
        std::sort(line.begin(), line.end());
        addChordMiddles(line, levels[i], middles);
    }
}

/// Edges by the bands of height that they pass, to look at the near ones first.
class Bands {
  public:
    explicit Bands(const std::vector<Segment2>& edges) {
        double climbed = 0;
        for (const auto& [a, b] : edges) {
            box_.add(a);
            climbed += std::abs(b.y - a.y);
        }
        // Enough bands that an edge lies in at most three on average.
        const auto most = static_cast<double>(edges.size());
        const double count = std::min(std::sqrt(most), 2 * most * (box_.depth() / climbed));
        if (count > 1 && count <= most) per_metre_ = std::floor(count) / box_.depth();
        if (!std::isfinite(per_metre_)) per_metre_ = 0;
        std::vector<std::size_t> next(bandOf(box_.high.y) + 2, 0);
        const auto for_each_band = [&](const Segment2& e, const auto& visit) {
            const std::size_t last = bandOf(std::max(e.a.y, e.b.y));
            for (std::size_t i = bandOf(std::min(e.a.y, e.b.y)); i <= last; ++i) visit(i);
        };
        for (const Segment2& e : edges) for_each_band(e, [&](std::size_t i) { ++next[i + 1]; });
        std::partial_sum(next.begin(), next.end(), next.begin());
        first_ = next;
        edges_.resize(first_.back());
        for (const Segment2& e : edges)
            for_each_band(e, [&](std::size_t i) { edges_[next[i]++] = e; });
    }

    /// Calls visit(edge) for all edges, band by band away from y, until reach() is less than the
    /// distance of a band.
    template <typename Visit, typename Reach>
    void forEachNear(double y, Visit visit, Reach reach) const {
        const auto count = static_cast<std::ptrdiff_t>(first_.size() - 1);
        const auto middle = static_cast<std::ptrdiff_t>(bandOf(y));
        for (std::ptrdiff_t away = 0; away < count; ++away) {
            // One band less, against rounding.
            if (static_cast<double>(away - 2) > reach() * per_metre_) return;
            for (const std::ptrdiff_t i : {middle - away, middle + away}) {
                if (i < 0 || i >= count) continue;
                const auto band = static_cast<std::size_t>(i);
                for (std::size_t k = first_[band]; k < first_[band + 1]; ++k)
                    if (!visit(edges_[k])) return;
                if (away == 0) break;
            }
        }
    }

  private:
    [[nodiscard]] std::size_t bandOf(double y) const {
        const double band = (y - box_.low.y) * per_metre_;
        return band > 0 ? static_cast<std::size_t>(std::min(band, (box_.depth() * per_metre_))) : 0;
    }

    Box2 box_;
    double per_metre_ = 0;
    std::vector<std::size_t> first_;  // of each band's edges
    std::vector<Segment2> edges_;
};

/// Stores the candidate farthest from the boundary.
class Best {
  public:
    explicit Best(const Region& region) : region_(region), edges_(edgesOf(region)), bands_(edges_) {
        for (const Segment2& e : edges_)
            for (const double v : {e.a.x, e.a.y}) rounding_ = std::max(rounding_, std::abs(v));
        rounding_ *= 1e-12;
    }

    /// Those with the longest chords first, so that few others need a look; of equals the first.
    void offer(std::span<const Candidate> candidates) {
        std::vector<std::size_t> order(candidates.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        const auto is_later = [&](std::size_t i, std::size_t k) {
            const double room = roomOf(candidates[i]), other = roomOf(candidates[k]);
            return room != other ? room < other : i > k;
        };
        std::make_heap(order.begin(), order.end(), is_later);
        for (; !order.empty(); order.pop_back()) {
            std::pop_heap(order.begin(), order.end(), is_later);
            const std::size_t i = order.back();
            // The distance to the ends of its chord decides.
            if (candidates[i].room < (1 - 1e-9) * clearance_ - rounding_) return;
            offer(candidates[i].at, i);
        }
    }
    void offer(Point2 p, std::size_t number) {
        const double least = number < number_ ? std::nextafter(clearance_, -1) : clearance_;
        const double distance = clearance(p, least);
        if (distance <= least || region_.locate(p) != Side::Inside) return;
        clearance_ = distance;
        point_ = p;
        number_ = number;
    }
    [[nodiscard]] const std::vector<Segment2>& edges() const { return edges_; }
    [[nodiscard]] bool found() const { return clearance_ >= 0; }
    [[nodiscard]] Point2 point() const { return point_; }

  private:
    static double roomOf(const Candidate& candidate) {
        return std::isnan(candidate.room) ? std::numeric_limits<double>::infinity()
                                          : candidate.room;
    }
    /// Computes the distance from the nearest edge, or any smaller number once that is at most
    /// `least`.
    [[nodiscard]] double clearance(Point2 p, double least) const {
        double nearest = std::numeric_limits<double>::infinity(), reach = nearest;
        const auto look = [&](const Segment2& e) {
            const double dx = std::max(std::min(e.a.x, e.b.x) - p.x, p.x - std::max(e.a.x, e.b.x));
            const double dy = std::max(std::min(e.a.y, e.b.y) - p.y, p.y - std::max(e.a.y, e.b.y));
            if (dx > reach || dy > reach) return true;  // the box about it is too far
            nearest = std::min(nearest, distance(p, e));
            reach = (1 + 1e-9) * nearest + rounding_;
            return nearest > least;
        };
        bands_.forEachNear(p.y, look, [&reach] { return reach; });
        return nearest;
    }

    const Region& region_;
    std::vector<Segment2> edges_;
    Bands bands_;
    double rounding_ = 0;  ///< no distance errs by as much
    double clearance_ = -1;
    Point2 point_;
    std::size_t number_ = std::numeric_limits<std::size_t>::max();  ///< among those offered
};

/// Finds candidates on scanlines, in both directions.
std::vector<Candidate> candidates(const std::vector<Segment2>& edges, bool swapped,
                                  std::size_t most) {
    constexpr std::size_t kAtOnce = 64;  // levels
    auto levels = levelsBetweenVertices(edges, swapped, most);
    const auto even = evenLevels(edges, swapped);
    levels.insert(levels.end(), even.begin(), even.end());
    std::vector<Candidate> middles;
    for (std::size_t i = 0; i < levels.size(); i += kAtOnce)
        addChordMiddles(edges, swapped,
                        std::span(levels).subspan(i, std::min(kAtOnce, levels.size() - i)),
                        middles);
    if (swapped)
        for (Candidate& c : middles) std::swap(c.at.x, c.at.y);
    return middles;
}

void scan(std::size_t most, Best& best) {
    constexpr std::size_t kManyEdges = 10'000;
    std::vector<Candidate> up, across;
    const auto find_up = [&] { up = candidates(best.edges(), false, most); };
    const auto find_across = [&] { across = candidates(best.edges(), true, most); };
    if (best.edges().size() < kManyEdges) {
        find_up();
        find_across();
    } else {
        tbb::this_task_arena::isolate([&] { tbb::parallel_invoke(find_up, find_across); });
    }
    up.insert(up.end(), across.begin(), across.end());
    best.offer(up);
}

/// Middles of the triangles at the corners, and the doubles about them: where a region is so thin
/// that no scanline's middle survives rounding.
void tryCorners(const Region& region, Best& best) {
    std::size_t number = 0;
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
                    best.offer({x, y}, number++);
            }
        }
    };
    around(region.outline);
    for (const Polygon& hole : region.holes) around(hole);
}

}  // namespace

Point2 interiorPoint(const Region& region) {
    Best best(region);
    scan(kLevels, best);
    if (!best.found()) scan(kManyLevels, best);
    if (!best.found()) tryCorners(region, best);
    if (!best.found())
        throw std::invalid_argument(
            "region without inside: too thin for a point between its edges");
    return best.point();
}

}  // namespace ispace
