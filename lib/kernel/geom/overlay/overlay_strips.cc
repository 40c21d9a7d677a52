// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/overlay/overlay_strips.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

#include "base/parallel.h"
#include "geom/overlay/overlay_cells.h"

namespace ispace::lattice {

namespace {

/// Ends of edges in a strip; smaller strips repeat work for edges that lie in several.
constexpr std::size_t kQuick = 2048;
/// With fewer layers than this not many edges lie along each other, and bundles do not pay.
constexpr std::size_t kManyLayers = 256;
/// Strips in which an edge lies, on average, at most.
constexpr std::size_t kMaxStrips = 6;
/// Points that a thread takes at once.
constexpr std::size_t kAtOnce = 16'384;

/// Edges that are routed through ends together: of similar length and similar x.
struct Bundle {
    std::vector<Index> edges;
    std::vector<Edge> pieces;
    std::unique_ptr<SetStore> sets;
};

/// merged(splitAtVertices()): many edges lie along each other at walls, and through the ends of
/// all, but their pieces are few. So they are merged where they are made, and then all together.
class EndRouter {
  public:
    EndRouter(const std::vector<Edge>& edges, const std::vector<Point>& points, SetStore& sets)
        : edges_(edges), points_(points), sets_(sets), by_x_(points.size()) {
        std::iota(by_x_.begin(), by_x_.end(), Index{0});
        tbb::parallel_sort(by_x_.begin(), by_x_.end(), [&](Index i, Index k) {
            return points[i].x != points[k].x ? points[i].x < points[k].x : i < k;
        });
    }

    std::vector<Edge> run() {
        divide();
        tbb::parallel_for(std::size_t{0}, bundles_.size(),
                          [this](std::size_t i) { lead(bundles_[i]); });
        by_x_ = {};
        std::size_t count = 0;
        for (const Bundle& bundle : bundles_) count += bundle.pieces.size();
        std::vector<Edge> pieces;
        pieces.reserve(count);
        std::vector<Index> layers;
        for (Bundle& bundle : bundles_) {
            for (Edge& piece : bundle.pieces) {
                if (bundle.sets->isOwn(piece.set)) {
                    const std::span<const Index> set = (*bundle.sets)[piece.set];
                    layers.assign(set.begin(), set.end());
                    piece.set = sets_.addOdd(layers);
                }
                pieces.push_back(piece);
            }
            bundle = Bundle();
        }
        bundles_.clear();
        return merged(std::move(pieces), points_, sets_);
    }

  private:
    void divide() {
        std::vector<std::int32_t> from;  // first columns of strips
        for (std::size_t i = 0; i < by_x_.size(); i += kQuick) from.push_back(points_[by_x_[i]].x);
        const auto strip_at = [&](Index point) {
            const auto next = std::upper_bound(from.begin(), from.end(), points_[point].x);
            return static_cast<std::size_t>(next - from.begin()) - 1;
        };
        // Bundles of edges that lie in two neighbours of the strips, then of these in fours, and
        // so on.
        for (Index i = 0; i < edges_.size(); ++i) {
            std::size_t first = strip_at(edges_[i].from), last = strip_at(edges_[i].to);
            std::size_t begin = 0;
            for (std::size_t count = from.size(); last - first > 1; count = count / 4 + 1) {
                begin += count;
                first /= 4;
                last /= 4;
            }
            if (begin + first >= bundles_.size()) bundles_.resize(begin + first + 1);
            bundles_[begin + first].edges.push_back(i);
        }
    }

    void lead(Bundle& bundle) const {
        if (bundle.edges.empty()) return;
        std::int32_t low = std::numeric_limits<std::int32_t>::max(), high = -low;
        for (const Index i : bundle.edges) {
            low = std::min(low, points_[edges_[i].from].x - kReach);
            high = std::max(high, points_[edges_[i].to].x + kReach);
        }
        const auto first = std::partition_point(by_x_.begin(), by_x_.end(),
                                                [&](Index i) { return points_[i].x < low; });
        const auto last =
            std::partition_point(first, by_x_.end(), [&](Index i) { return points_[i].x <= high; });
        // In the order of their numbers, so that results do not depend on bundles.
        std::vector<Index> numbers(first, last);
        std::sort(numbers.begin(), numbers.end());
        const auto number_of = [&](Index point) {
            return static_cast<Index>(std::lower_bound(numbers.begin(), numbers.end(), point) -
                                      numbers.begin());
        };
        std::vector<Point> points;
        points.reserve(numbers.size());
        for (const Index i : numbers) points.push_back(points_[i]);
        std::vector<Edge> edges;
        edges.reserve(bundle.edges.size());
        for (const Index i : bundle.edges) {
            edges.push_back(edges_[i]);
            edges.back().from = number_of(edges_[i].from);
            edges.back().to = number_of(edges_[i].to);
        }
        bundle.sets = std::make_unique<SetStore>(&sets_);
        bundle.pieces = merged(splitAtVertices(edges, points), points, *bundle.sets);
        for (Edge& piece : bundle.pieces) {
            piece.from = numbers[piece.from];
            piece.to = numbers[piece.to];
        }
    }

    const std::vector<Edge>& edges_;
    const std::vector<Point>& points_;
    SetStore& sets_;
    std::vector<Index> by_x_;  // numbers of points
    std::vector<Bundle> bundles_;
};

/// A piece of an edge from one strip to another.
struct Crossing {
    Index edge;
    Point from, to;
};

/// A strip: first its part of the edges, then their routes, then the pieces from other strips.
struct Strip {
    Columns columns;
    std::vector<Index> edges;   // numbers of those that lie in it or end there
    std::vector<Index> points;  // numbers of the ends that lie in it
    PointTable table;           // its points, then ends elsewhere
    std::vector<Edge> parts;    // as edges, by its own table
    EdgeWaypoints ways;
    std::vector<Crossing> entering;
    std::vector<Point> beyond;  // where the last piece of each edge ends that leaves it
    std::size_t open = 0;       // edges of which that is not known yet
};

/// Finds the strip, of several side by side, that holds the column.
std::size_t stripAt(const std::vector<Strip>& strips, std::int32_t x) {
    const auto next =
        std::upper_bound(strips.begin(), strips.end(), x,
                         [](std::int32_t v, const Strip& s) { return v < s.columns.first; });
    return static_cast<std::size_t>(next - strips.begin()) - 1;
}

class Sweep {
  public:
    Sweep(std::span<const Layer> layers, const std::vector<Edge>& edges,
          const std::vector<Point>& points, const SetStore& sets, PassBudget& budget)
        : layers_(layers), edges_(edges), points_(points), sets_(sets), budget_(budget) {}

    /// Makes strips with so many ends in each. Returns false, without strips, if they are too
    /// narrow.
    bool divide(std::size_t ends) {
        if (xs_.empty()) {
            xs_.reserve(points_.size());
            for (const Point p : points_) xs_.push_back(p.x);
            tbb::parallel_sort(xs_.begin(), xs_.end());
        }
        strips_.resize(1);
        for (std::size_t i = ends; i + ends <= xs_.size(); i += ends) {
            if (xs_[i] <= strips_.back().columns.first || xs_[i] == xs_.front()) continue;
            strips_.back().columns.last = xs_[i] - 1;
            strips_.emplace_back().columns.first = xs_[i];
        }
        findStrips();
        if (!areWide()) {
            strips_.clear();
            return false;
        }
        for (Index i = 0; i < points_.size(); ++i) strips_[strip_of_[i]].points.push_back(i);
        for (Index i = 0; i < edges_.size(); ++i) {
            const Index last = lastOf(edges_[i]);
            for (Index k = firstOf(edges_[i]); k <= last; ++k) strips_[k].edges.push_back(i);
        }
        return true;
    }

    void run(const PartVisitor& visit) {
        last_of_.resize(edges_.size());
        const auto at_once = 4 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
        OrderedCalls products(strips_.size());
        // Strips before `made` are parts, those up to `known` become parts, all up to `found` have
        // their ways, and the next ones get theirs: all at once.
        std::size_t found = 0, known = 0, made = 0;
        while (made < strips_.size()) {
            const std::size_t goal = std::min(strips_.size(), found + at_once);
            const std::size_t parts = known - made;
            // Called in order by any thread, so that their results need not wait.
            std::atomic<std::size_t> next = 0;
            tbb::parallel_for(
                tbb::blocked_range<std::size_t>(0, parts + (goal - found), 1),
                [&](const auto& range) {
                    for (std::size_t k = range.begin(); k < range.end(); ++k) {
                        const std::size_t i = next++;
                        if (i < parts)
                            products.add(made + i, partFrom(strips_[made + i], visit));
                        else
                            find(strips_[found + i - parts]);
                    }
                },
                tbb::simple_partitioner());
            for (; found < goal; ++found) link(found);
            made = known;
            while (known < found && strips_[known].open == 0) ++known;
        }
    }

  private:
    [[nodiscard]] Index firstOf(const Edge& edge) const { return strip_of_[edge.from]; }
    [[nodiscard]] Index lastOf(const Edge& edge) const { return strip_of_[edge.to]; }
    void findStrips() {
        strip_of_.resize(points_.size());
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points_.size(), kAtOnce),
                          [&](const auto& range) {
                              std::size_t strip = 0;  // neighbours are mostly in the same
                              for (std::size_t i = range.begin(); i < range.end(); ++i) {
                                  if (!strips_[strip].columns.hold(points_[i]))
                                      strip = stripAt(strips_, points_[i].x);
                                  strip_of_[i] = static_cast<Index>(strip);
                              }
                          });
    }
    [[nodiscard]] bool areWide() const {
        std::size_t count = 0;
        for (const Edge& edge : edges_) count += lastOf(edge) - firstOf(edge) + 1;
        return count <= kMaxStrips * edges_.size();
    }

    std::function<void()> partFrom(Strip& strip, const PartVisitor& visit) const {
        std::function<void()> finish = visit(partOf(strip));
        strip = Strip();
        return finish;
    }

    /// Computes the routes of its edges inside the strip.
    void find(Strip& strip) {
        strip.table.reserve(2 * strip.points.size());
        for (const Index i : strip.points) strip.table.add(points_[i]);
        strip.parts.reserve(strip.edges.size());
        for (const Index i : strip.edges) {
            Edge part = edges_[i];
            part.from = strip.table.add(points_[part.from]);
            part.to = strip.table.add(points_[part.to]);
            strip.parts.push_back(part);
        }
        strip.ways = waysThroughPixels(strip.parts, strip.table, strip.columns, budget_);
    }

    /// Joins the routes in a strip to those in the strips before it.
    void link(std::size_t number) {
        Strip& strip = strips_[number];
        const std::vector<Point>& points = strip.table.points();
        strip.beyond.resize(strip.edges.size());
        for (Index k = 0; k < strip.edges.size(); ++k) {
            const Edge& part = strip.parts[k];
            const std::span<const Index> way = strip.ways[k];
            const bool enters = points[part.from].x < strip.columns.first;
            const bool leaves = points[part.to].x > strip.columns.last;
            if (enters && (!way.empty() || !leaves))
                close(strip.edges[k], number, points[way.empty() ? part.to : way.front()]);
            if (leaves && (!way.empty() || !enters)) {
                last_of_[strip.edges[k]] = {static_cast<Index>(number), k,
                                            points[way.empty() ? part.from : way.back()]};
                ++strip.open;
            }
        }
    }

    void close(Index edge, std::size_t number, Point to) {
        const Last& last = last_of_[edge];
        strips_[last.strip].beyond[last.index] = to;
        --strips_[last.strip].open;
        for (std::size_t i = last.strip + 1; i <= number; ++i)
            strips_[i].entering.push_back({edge, last.at, to});
    }

    /// Returns the pieces of its edges that begin in it.
    [[nodiscard]] Part partOf(Strip& strip) const {
        const auto x_of = [&](Index point) { return strip.table.points()[point].x; };
        for (Index k = 0; k < strip.parts.size(); ++k) {
            Edge& part = strip.parts[k];
            const bool enters = x_of(part.from) < strip.columns.first;
            if (x_of(part.to) > strip.columns.last)
                part.to =
                    enters && strip.ways[k].empty() ? kNone : strip.table.add(strip.beyond[k]);
            if (enters) part.from = kNone;
        }
        std::vector<Edge> pieces = routed(strip.parts, strip.ways);
        for (const Crossing& crossing : strip.entering) {
            Edge piece = edges_[crossing.edge];
            piece.from = strip.table.add(crossing.from);
            piece.to = strip.table.add(crossing.to);
            pieces.push_back(piece);
        }
        SetStore sets(&sets_);
        Part part;
        part.edges = merged(std::move(pieces), strip.table.points(), sets);
        part.labels = labelsOf(layers_, strip.table.points(), part.edges, sets, strip.columns);
        std::size_t count = 0;
        for (std::size_t i = 0; i < part.edges.size(); ++i) {
            if (x_of(part.edges[i].from) < strip.columns.first) continue;
            part.edges[count] = part.edges[i];
            part.labels[count++] = part.labels[i];
        }
        part.edges.resize(count);
        part.labels.resize(count);
        part.points = strip.table.points();
        return part;
    }

    /// The last point of an edge so far, with the strip in which it is and the edge's index there.
    struct Last {
        Index strip, index;
        Point at;
    };

    std::span<const Layer> layers_;
    const std::vector<Edge>& edges_;
    const std::vector<Point>& points_;
    const SetStore& sets_;
    PassBudget& budget_;
    std::vector<Strip> strips_;
    std::vector<Index> strip_of_;   // of each point
    std::vector<Last> last_of_;     // edges that lie in several strips
    std::vector<std::int32_t> xs_;  // of all points, ascending
};

}  // namespace

void forEachPart(std::span<const Layer> layers, std::vector<Edge> edges, PointTable table,
                 SetStore& sets, std::size_t at_least, const PartVisitor& visit,
                 std::size_t most_passes) {
    PassBudget budget(most_passes);
    // A waiting thread must not start other work.
    if (tbb::this_task_arena::isolate([&] {
            if (layers.size() < kManyLayers || table.points().size() < 2 * kQuick)
                edges = merged(splitAtVertices(edges, table.points()), table.points(), sets);
            else
                edges = EndRouter(edges, table.points(), sets).run();
            std::size_t ends = at_least == 0 ? kQuick : at_least;
            Sweep sweep(layers, edges, table.points(), sets, budget);
            for (; 2 * ends <= table.points().size(); ends *= 2) {
                if (!sweep.divide(ends)) continue;
                sweep.run(visit);
                return true;
            }
            return false;
        }))
        return;
    const EdgeWaypoints ways = waysThroughPixels(edges, table, {}, budget);
    edges = merged(routed(edges, ways), table.points(), sets);
    std::vector<EdgeLabels> labels = labelsOf(layers, table.points(), edges, sets);
    visit({table.points(), std::move(edges), std::move(labels), true})();
}

}  // namespace ispace::lattice
