// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/flat_world.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/simd.h"
#include "geom/point.h"
#include "geom/spatial_index.h"
#include "trace/flat_kernels.h"
#include "trace/rays.h"

namespace ispace {

namespace {

constexpr std::size_t kWidth = FlatTree::kWidth;
static_assert(kWidth == BoxOrder::kWidth && FlatTree::kDepth == BoxOrder::kDepth + 1);

/// Builds nodes in a given order.
class Builder {
  public:
    Builder(const BoxOrder& order, FlatTree& tree) : order_(order), tree_(tree) {}

    /// Calls put_leaf(indices) -> Box2 for each leaf in order. \return the root
    template <typename PutLeaf>
    std::int32_t build(PutLeaf put_leaf) {
        return node(put_leaf).first;
    }

  private:
    template <typename PutLeaf>
    std::pair<std::int32_t, Box2> node(PutLeaf& put_leaf) {
        const auto index = static_cast<std::int32_t>(tree_.nodes.size());
        tree_.nodes.emplace_back();
        FlatTree::Node made{};
        const std::uint8_t* const sizes = order_.shape.data() + place_ + 1;
        const std::size_t count = sizes[-1];
        place_ += 1 + count;
        made.count = static_cast<std::int32_t>(count);
        Box2 all;
        for (std::size_t i = 0; i < count; ++i) {
            const auto [child, box] = sizes[i] == 0 ? node(put_leaf) : leaf(sizes[i], put_leaf);
            made.child[i] = child;
            put(made, i, box);
            all.add(box.low);
            all.add(box.high);
        }
        for (std::size_t i = count; i < kWidth; ++i)
            put(made, i, {{made.left[0], made.low[0]}, {made.right[0], made.high[0]}});
        tree_.nodes[static_cast<std::size_t>(index)] = made;
        return {index, all};
    }

    template <typename PutLeaf>
    std::pair<std::int32_t, Box2> leaf(std::size_t size, PutLeaf& put_leaf) {
        const std::span<const std::uint32_t> items(order_.items.data() + item_, size);
        item_ += size;
        return put_leaf(items);
    }

    static void put(FlatTree::Node& node, std::size_t child, const Box2& box) {
        node.left[child] = box.low.x;
        node.right[child] = box.high.x;
        node.low[child] = box.low.y;
        node.high[child] = box.high.y;
    }

    const BoxOrder& order_;
    FlatTree& tree_;
    std::size_t place_ = 0, item_ = 0;
};

double squareOf(const Segment2& line) {
    const Vec2 along = line.b - line.a;
    return dot(along, along);
}

/// Shortest lengths also count as points.
bool isPoint(const Segment2& line) { return squareOf(line) == 0; }

/// The line as leaves store it.
Segment2 ordered(const Segment2& line) {
    return lexLess(line.a, line.b) ? line : Segment2{line.b, line.a};
}

FlatTree::Leaf leafOf(std::span<const std::uint32_t> items, std::span<const Segment2> lines) {
    FlatTree::Leaf made{};
    for (std::size_t i = 0; i < kWidth; ++i) {
        const bool is_used = i < items.size();
        const Segment2 line = ordered(lines[items[is_used ? i : 0]]);
        const Point2 b = is_used ? line.b : line.a;
        made.ax[i] = line.a.x;
        made.ay[i] = line.a.y;
        made.bx[i] = b.x;
        made.by[i] = b.y;
        // The last bit of std::hypot is unspecified.
        made.length[i] = std::sqrt(squareOf({line.a, b}));
    }
    return made;
}

Box2 boxOf(const FlatTree::Leaf& leaf) {
    Box2 box;
    // Lines beyond the last one are points of the first.
    for (std::size_t i = 0; i < kWidth; ++i) {
        box.low.x = std::min(box.low.x, leaf.ax[i]);
        box.high.x = std::max(box.high.x, leaf.bx[i]);
        box.low.y = std::min({box.low.y, leaf.ay[i], leaf.by[i]});
        box.high.y = std::max({box.high.y, leaf.ay[i], leaf.by[i]});
    }
    return box;
}

/// Bounding boxes of round bodies, enlarged by the rounding of intersections.
Box2 boxOf(const Ellipse& round) {
    constexpr double kMargin = 1e-9;
    const Box2 box = round.box();
    const Vec2 margin{kMargin, kMargin};
    return {box.low - margin, box.high + margin};
}

FlatTree::Round unitMapOf(const Ellipse& round) {
    const auto [c, s] = round.axis;
    return {round.center.x,        round.center.y,        c / round.half_length,
            s / round.half_length, -s / round.half_width, c / round.half_width};
}

void addLines(std::span<const Segment2> lines, const BoxOrder& order, FlatTree& tree) {
    // Of each child that is a node the shape has a 0.
    const auto inner = static_cast<std::size_t>(
        std::count(order.shape.begin(), order.shape.end(), std::uint8_t{0}));
    tree.nodes.reserve(inner + 1);
    tree.leaves.reserve(order.shape.size() - 1 - 2 * inner);
    Builder(order, tree).build([&](std::span<const std::uint32_t> items) {
        tree.leaves.push_back(leafOf(items, lines));
        return std::pair{~static_cast<std::int32_t>(tree.leaves.size() - 1),
                         boxOf(tree.leaves.back())};
    });
}

}  // namespace

FlatTree::FlatTree(std::span<const Segment2> lines, std::span<const Ellipse> round_bodies) {
    if (std::any_of(lines.begin(), lines.end(), isPoint)) {
        std::vector<Segment2> some(lines.begin(), lines.end());
        std::erase_if(some, isPoint);
        if (!some.empty()) addLines(some, orderOf(some), *this);
    } else if (!lines.empty()) {
        addLines(lines, orderOf(lines), *this);
    }
    if (round_bodies.empty()) return;
    if (nodes.empty()) nodes.push_back({});
    std::vector<Box2> boxes;
    boxes.reserve(round_bodies.size());
    rounds.reserve(round_bodies.size());
    for (const Ellipse& round : round_bodies) {
        boxes.push_back(boxOf(round));
        rounds.push_back(unitMapOf(round));
    }
    const BoxOrder round_order = orderOf(boxes, 1);
    round_root = Builder(round_order, *this).build([&](std::span<const std::uint32_t> items) {
        return std::pair{~static_cast<std::int32_t>(items.front()), boxes[items.front()]};
    });
}

namespace {

/// Removes a line from its leaf. \returns false if the leaf does not have it
bool removeFrom(FlatTree::Leaf& leaf, const Segment2& line) {
    const int last = leaf.count() - 1;
    for (int i = 0; i <= last; ++i) {
        if (Point2{leaf.ax[i], leaf.ay[i]} != line.a || Point2{leaf.bx[i], leaf.by[i]} != line.b)
            continue;
        for (double* lanes : {leaf.ax, leaf.ay, leaf.bx, leaf.by, leaf.length})
            lanes[i] = lanes[last];
        leaf.bx[last] = leaf.ax[last] = leaf.ax[0];
        leaf.by[last] = leaf.ay[last] = leaf.ay[0];
        leaf.length[last] = 0;
        return true;
    }
    return false;
}

/// Visits the nodes around a point from `root` on, visit(node, child), until a visit of a leaf
/// returns true.
template <typename Visit>
void findLeaf(FlatTree& tree, std::int32_t root, Point2 p, Visit visit) {
    std::vector<std::int32_t> open{root};
    while (!open.empty()) {
        FlatTree::Node& node = tree.nodes[static_cast<std::size_t>(open.back())];
        open.pop_back();
        for (int i = 0; i < node.count; ++i) {
            if (!meets({{node.left[i], node.low[i]}, {node.right[i], node.high[i]}}, {p, p}))
                continue;
            if (node.child[i] >= 0)
                open.push_back(node.child[i]);
            else if (visit(node, i))
                return;
        }
    }
    assert(false && "the tree has it");
}

/// Removes a line; the boxes around it stay.
void remove(FlatTree& tree, const Segment2& line) {
    findLeaf(tree, 0, line.a, [&](FlatTree::Node& node, int child) {
        return removeFrom(tree.leaves[~static_cast<std::uint32_t>(node.child[child])], line);
    });
}

/// Removes a round body from its node.
void remove(FlatTree& tree, const FlatTree::Round& round) {
    findLeaf(tree, tree.round_root, {round.cx, round.cy}, [&](FlatTree::Node& node, int child) {
        if (tree.round(node.child[child]) != round) return false;
        const int last = --node.count;
        for (double* lanes : {node.left, node.right, node.low, node.high}) {
            lanes[child] = lanes[last];
            lanes[last] = lanes[0];
        }
        node.child[child] = node.child[last];
        return true;
    });
}

/// Returns a node above two subtrees.
FlatTree::Node joined(const FlatTree& tree, std::int32_t a, std::int32_t b) {
    FlatTree::Node made{};
    made.count = 2;
    for (std::size_t i = 0; i < kWidth; ++i) {
        made.child[i] = i == 1 ? b : a;
        const FlatTree::Node& node = tree.node(made.child[i]);
        made.left[i] = *std::min_element(node.left, node.left + kWidth);
        made.right[i] = *std::max_element(node.right, node.right + kWidth);
        made.low[i] = *std::min_element(node.low, node.low + kWidth);
        made.high[i] = *std::max_element(node.high, node.high + kWidth);
    }
    return made;
}

}  // namespace

FlatTree::FlatTree(const FlatTree& base, const FlatBodies& removed, const FlatBodies& added)
    : round_root(base.round_root) {
    const FlatTree more(added.lines, added.rounds);
    const auto copy = [](auto& items, const auto& from, std::size_t others) {
        items.reserve(from.size() + others);
        items = from;
    };
    constexpr std::size_t kRoots = 3;
    copy(nodes, base.nodes, more.nodes.size() + kRoots);
    copy(leaves, base.leaves, more.leaves.size());
    copy(rounds, base.rounds, more.rounds.size());
    for (const Segment2& line : removed.lines)
        if (!isPoint(line)) remove(*this, ordered(line));
    for (const Ellipse& body : removed.rounds) remove(*this, unitMapOf(body));
    if (more.nodes.empty()) return;
    if (nodes.empty()) nodes.push_back({});
    const auto first = static_cast<std::int32_t>(nodes.size());
    const auto first_leaf = static_cast<std::int32_t>(leaves.size());
    const auto first_round = static_cast<std::int32_t>(rounds.size());
    for (const Node& node : more.nodes) {
        const bool is_of_lines =
            more.round_root < 0 || &node < &more.nodes[static_cast<std::size_t>(more.round_root)];
        Node& copy = nodes.emplace_back(node);
        for (std::int32_t& child : copy.child)
            child += child >= 0 ? first : -(is_of_lines ? first_leaf : first_round);
    }
    leaves.insert(leaves.end(), more.leaves.begin(), more.leaves.end());
    rounds.insert(rounds.end(), more.rounds.begin(), more.rounds.end());
    const auto append = [&](const Node& node) {
        nodes.push_back(Node(node));
        return static_cast<std::int32_t>(nodes.size() - 1);
    };
    if (nodes.front().count == 0)
        nodes.front() = Node(node(first));
    else if (node(first).count > 0)
        nodes.front() = joined(*this, append(nodes.front()), first);
    if (more.round_root < 0) return;
    const std::int32_t root = more.round_root + first;
    round_root = round_root < 0 ? root : append(joined(*this, round_root, root));
}

namespace {

constexpr int kNodeWidth = FlatTree::kWidth;

struct UnitVector {
    double x, y;
};

/// More than kFlatEdge plus the rounding of cross products with unit vectors.
ISPACE_INLINE double slackOf(double x, double y) {
    return 2 * kFlatEdge + 1e-12 * (std::fabs(x) + std::fabs(y));
}

/// Pushes the children that the ray may meet, the nearest on top.
ISPACE_INLINE void visit(const FlatTree::Node& node, const FlatView& view, const UnitVector& ray,
                         const FlatHit& hit, FlatStack& stack) {
    alignas(64) double distance[kNodeWidth];
    ISPACE_LANES for (int i = 0; i < kNodeWidth; ++i) {
        const double left = node.left[i] - view.x, right = node.right[i] - view.x;
        const double low = node.low[i] - view.y, high = node.high[i] - view.y;
        // The ray passes the box if corners lie on both of its sides, and one is ahead.
        const double p = ray.x * low, q = ray.x * high, r = ray.y * left, s = ray.y * right;
        const double right_side = flatMin(p, q) - flatMax(r, s);
        const double left_side = flatMax(p, q) - flatMin(r, s);
        const double ahead =
            flatMax(ray.x * left, ray.x * right) + flatMax(ray.y * low, ray.y * high);
        const double slack = slackOf(flatMax(std::fabs(left), std::fabs(right)),
                                     flatMax(std::fabs(low), std::fabs(high)));
        const double near = distanceOf(left, right, low, high);
        const bool meets = (right_side <= slack) & (left_side >= -slack) & (ahead >= -slack) &
                           mayBeNearer(near, hit.inverse_range);
        distance[i] = flatChoice(meets, near, -1.0);
    }
    stack.push(node, distance);
}

ISPACE_INLINE void meetLeaf(const FlatTree& tree, const FlatView& view, const FlatTree::Leaf& leaf,
                            const UnitVector& ray, FlatHit& hit) {
    alignas(64) double meets[kNodeWidth];
    ISPACE_LANES for (int i = 0; i < kNodeWidth; ++i) {
        const double px = leaf.ax[i] - view.x, py = leaf.ay[i] - view.y;
        const double qx = leaf.bx[i] - view.x, qy = leaf.by[i] - view.y;
        const double p = ray.x * py - ray.y * px, q = ray.x * qy - ray.y * qx;
        const double most =
            slackOf(flatMax(std::fabs(px), std::fabs(qx)), flatMax(std::fabs(py), std::fabs(qy)));
        const double ahead = flatMax(ray.x * px + ray.y * py, ray.x * qx + ray.y * qy);
        const double near =
            distanceOf(flatMin(px, qx), flatMax(px, qx), flatMin(py, qy), flatMax(py, qy));
        const double least = flatMin(p, q), greatest = flatMax(p, q);
        // Ends lie on both sides of the ray's line, and not both behind.
        const bool is_met = (least <= most) & (greatest >= -most) & (ahead >= -most) &
                            mayBeNearer(near, hit.inverse_range);
        meets[i] = is_met ? 1.0 : 0.0;
    }
    for (int i = 0, end = leaf.count(); i < end; ++i) {
        if (meets[i] == 0) continue;
        const FlatLine line = lineFrom(leaf, i, view.x, view.y);
        const double inverse_range = inverseRangeAlong(line, ray.x, ray.y);
        if (!line.stops || inverse_range < hit.inverse_range || inverse_range <= 0) continue;
        const double cosine = inverse_range * line.height;
        if (inverse_range == hit.inverse_range && cosine <= hit.cosine) continue;
        if (mayContinueTouched(line.height, view.ray_epsilon) &&
            continuesTouched(tree, leaf, i, view.x, view.y, view.ray_epsilon))
            continue;
        hit = {inverse_range, cosine};
    }
}

ISPACE_INLINE void meetRound(const FlatTree::Round& round, const FlatView& view,
                             const UnitVector& ray, FlatHit& hit) {
    const RoundFrom::Hit met =
        RoundFrom(round, view.x, view.y, view.ray_epsilon).meet<true>(ray.x, ray.y);
    if (met.inverse_range <= 0 || met.inverse_range < hit.inverse_range) return;
    if (met.inverse_range == hit.inverse_range && met.cosine <= hit.cosine) return;
    hit = {met.inverse_range, met.cosine};
}

}  // namespace

ISPACE_SIMD_CLONES
FlatHit firstLine(const FlatTree& tree, const FlatView& view, double x, double y,
                  double min_inverse_range) {
    FlatHit hit{min_inverse_range};
    if (tree.nodes.empty()) return hit;
    const UnitVector ray{x, y};
    FlatStack stack;
    visit(tree.nodes.front(), view, ray, hit, stack);
    while (!stack.empty()) {
        const FlatStack::Entry box = stack.pop();
        if (!mayBeNearer(box.distance, hit.inverse_range)) continue;
        if (box.child >= 0)
            visit(tree.node(box.child), view, ray, hit, stack);
        else
            meetLeaf(tree, view, tree.leaf(box.child), ray, hit);
    }
    if (tree.round_root < 0) return hit;
    visit(tree.node(tree.round_root), view, ray, hit, stack);
    while (!stack.empty()) {
        const FlatStack::Entry box = stack.pop();
        if (!mayBeNearer(box.distance, hit.inverse_range)) continue;
        if (box.child >= 0)
            visit(tree.node(box.child), view, ray, hit, stack);
        else
            meetRound(tree.round(box.child), view, ray, hit);
    }
    return hit;
}

namespace {

/// Rays and their output arrays.
struct Cast {
    const Point2* origins;
    bool is_one_origin;
    const Directions& directions;
    double ray_epsilon;
    FlatLimit limit;
    float* ranges;
    float* cosines;  ///< or null

    [[nodiscard]] Point2 origin(std::size_t i) const { return origins[is_one_origin ? 0 : i]; }
};

bool isScan(const Directions& directions) {
    if (!directions.arc || directions.size() < FlatScan::kMin) return false;
    const double step = std::fabs(directions.arc->step.radians());
    return step >= FlatScan::kMinStep && step <= FlatScan::kMaxStep;
}

bool isForScan(double coordinate) { return std::fabs(coordinate) <= FlatScan::kMaxCoordinate; }

bool isForScan(const FlatTree::Node& node) {
    for (int i = 0; i < node.count; ++i)
        for (const double at : {node.left[i], node.right[i], node.low[i], node.high[i]})
            if (!isForScan(at)) return false;
    return true;
}

/// True if all rays are.
bool isForScan(const FlatTree& tree) {
    return (tree.nodes.empty() || isForScan(tree.nodes.front())) &&
           (tree.round_root < 0 || isForScan(tree.node(tree.round_root)));
}

}  // namespace

struct FlatWorld::Data {
    FlatTree tree;

    double widest_packet;
    bool is_for_scan;

    explicit Data(FlatTree made)
        : tree(std::move(made)), widest_packet(widestPacket(tree)), is_for_scan(isForScan(tree)) {}

    void castRay(const Cast& cast, std::size_t i) const {
        const Point2 origin = cast.origin(i);
        const FlatHit hit =
            firstLine(tree, {origin.x, origin.y, cast.ray_epsilon}, cast.directions.x[i],
                      cast.directions.y[i], cast.limit.inverse_range);
        cast.ranges[i] = cast.limit.rangeOf(hit.inverse_range);
        if (cast.cosines != nullptr)
            cast.cosines[i] = cast.limit.cosineOf(cast.ranges[i], hit.cosine);
    }

    /// Casts rays begin .. begin + count - 1. \returns false, without changes, if single rays are
    /// faster
    [[nodiscard]] bool castPacket(const Cast& cast, std::size_t begin, std::size_t count) const {
        if (count < FlatPacket::kMin) return false;
        constexpr std::size_t kBlock = FlatPacket::kBlock;
        const std::size_t lanes = (count + kBlock - 1) / kBlock * kBlock;
        FlatPacket packet;
        packet.count = static_cast<int>(lanes);
        const auto set = [&](std::size_t lane, std::size_t i) {
            packet.x[lane] = cast.directions.x[i];
            packet.y[lane] = cast.directions.y[i];
            const Point2 origin = cast.origin(i);
            packet.origin_x[lane] = origin.x;
            packet.origin_y[lane] = origin.y;
        };
        for (std::size_t i = 0; i < count; ++i) set(i, begin + i);
        for (std::size_t i = count; i < lanes; ++i) set(i, begin + count / 2);
        const FlatPacketLimits limits{cast.ray_epsilon, cast.limit.inverse_range, widest_packet};
        if (!(cast.cosines == nullptr ? drawLines(tree, limits, packet)
                                      : drawLinesAndCosines(tree, limits, packet)))
            return false;
        float* const ranges = cast.ranges + begin;
        for (std::size_t i = 0; i < count; ++i)
            ranges[i] = cast.limit.rangeOf(packet.inverse_range[i]);
        if (cast.cosines != nullptr)
            for (std::size_t i = 0; i < count; ++i)
                cast.cosines[begin + i] = cast.limit.cosineOf(ranges[i], packet.cosine[i]);
        return true;
    }

    /// Casts in packets as large as the distance between rays permits.
    void castRays(const Cast& cast) const {
        const std::size_t size = cast.directions.size();
        std::size_t most = FlatPacket::kMax;
        int before_more = 0;
        for (std::size_t begin = 0; begin < size;) {
            const std::size_t count = std::min(most, size - begin);
            if (castPacket(cast, begin, count)) {
                begin += count;
                if (--before_more > 0 || most == FlatPacket::kMax) continue;
                most *= 2;
            } else if (count > FlatPacket::kBlock) {
                while (most >= count) most /= 2;
                before_more = 8;
            } else {
                for (const std::size_t end = begin + count; begin < end; ++begin)
                    castRay(cast, begin);
            }
        }
    }

    /// Casts beams begin .. begin + count - 1 of a scan.
    void castPart(const FlatView& view, const Directions& directions, const FlatLimit& limit,
                  std::size_t begin, std::size_t count, float* ranges, float* cosines) const {
        const double step = directions.arc->step.radians();
        const FlatBeams beams{directions.x.data() + begin,
                              directions.y.data() + begin,
                              static_cast<int>(count),
                              std::fabs(step),
                              ranges + begin,
                              cosines == nullptr ? nullptr : cosines + begin};
        step > 0 ? castScan(tree, view, limit, beams) : castReversed(view, limit, beams);
    }

    /// Casts beams at clockwise steps.
    [[gnu::noinline]] void castReversed(const FlatView& view, const FlatLimit& limit,
                                        const FlatBeams& beams) const {
        FlatBeams reversed = beams;
        double x[FlatScan::kMax], y[FlatScan::kMax];
        std::reverse_copy(beams.x, beams.x + beams.count, x);
        std::reverse_copy(beams.y, beams.y + beams.count, y);
        reversed.x = x;
        reversed.y = y;
        castScan(tree, view, limit, reversed);
        std::reverse(beams.ranges, beams.ranges + beams.count);
        if (beams.cosines != nullptr) std::reverse(beams.cosines, beams.cosines + beams.count);
    }
};

FlatWorld::FlatWorld(std::span<const Segment2> lines, std::span<const Ellipse> rounds)
    : data_(std::make_shared<const Data>(FlatTree(lines, rounds))) {}

FlatWorld::FlatWorld(const FlatWorld& base, const FlatBodies& removed, const FlatBodies& added)
    : data_(std::make_shared<const Data>(FlatTree(base.data_->tree, removed, added))) {}

void FlatWorld::cast(Point2 origin, const Directions& directions, double max_range,
                     double ray_epsilon, std::span<float> ranges, std::span<float> cosines) const {
    assert(ranges.size() == directions.size());
    assert(cosines.empty() || cosines.size() == directions.size());
    if (!(static_cast<float>(max_range) >= 0)) {
        std::fill(ranges.begin(), ranges.end(), kNoReturn);
        std::fill(cosines.begin(), cosines.end(), 1.0F);
        return;
    }
    const FlatLimit limit(max_range);
    const FlatView view{origin.x, origin.y, ray_epsilon};
    const std::size_t size = directions.size();
    if (isScan(directions) && data_->is_for_scan && isForScan(origin.x) && isForScan(origin.y)) {
        // Equal sizes, so that each part has enough beams.
        const std::size_t parts = (size + FlatScan::kMax - 1) / FlatScan::kMax;
        for (std::size_t part = 0; part < parts; ++part) {
            const std::size_t begin = size * part / parts, end = size * (part + 1) / parts;
            data_->castPart(view, directions, limit, begin, end - begin, ranges.data(),
                            cosines.empty() ? nullptr : cosines.data());
        }
        return;
    }
    data_->castRays({&origin, true, directions, ray_epsilon, limit, ranges.data(),
                     cosines.empty() ? nullptr : cosines.data()});
}

void FlatWorld::cast(std::span<const Point2> origins, const Directions& directions,
                     double max_range, double ray_epsilon, std::span<float> ranges,
                     std::span<float> cosines) const {
    assert(ranges.size() == directions.size() && origins.size() == directions.size());
    assert(cosines.empty() || cosines.size() == directions.size());
    if (!(static_cast<float>(max_range) >= 0)) {
        std::fill(ranges.begin(), ranges.end(), kNoReturn);
        std::fill(cosines.begin(), cosines.end(), 1.0F);
        return;
    }
    data_->castRays({origins.data(), false, directions, ray_epsilon, FlatLimit(max_range),
                     ranges.data(), cosines.empty() ? nullptr : cosines.data()});
}

}  // namespace ispace
