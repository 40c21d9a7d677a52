// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/flat_tree.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "geom/box_order.h"
#include "geom/point.h"

namespace ispace {

namespace {

constexpr std::size_t kWidth = FlatTree::kWidth;
static_assert(kWidth == BoxOrder::kWidth && FlatTree::kDepth == BoxOrder::kDepth);

/// Makes nodes as an order has them.
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

/// The shortest lines count as points, too.
bool isPoint(const Segment2& line) { return squareOf(line) == 0; }

FlatTree::Leaf leafOf(std::span<const std::uint32_t> items, std::span<const Segment2> lines) {
    FlatTree::Leaf made{};
    for (std::size_t i = 0; i < kWidth; ++i) {
        const bool is_used = i < items.size();
        const Segment2& given = lines[items[is_used ? i : 0]];
        const Segment2 line = lexLess(given.a, given.b) ? given : Segment2{given.b, given.a};
        const Point2 b = is_used ? line.b : line.a;
        made.ax[i] = line.a.x;
        made.ay[i] = line.a.y;
        made.bx[i] = b.x;
        made.by[i] = b.y;
        // Not std::hypot, whose last bit is nobody's promise.
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

/// What rays meet of round bodies, computed with rounding, lies in these boxes.
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

}  // namespace ispace
