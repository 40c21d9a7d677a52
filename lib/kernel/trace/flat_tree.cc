// SPDX-License-Identifier: GPL-3.0-or-later
// The tree of a FlatWorld: built in an order of boxes, edited by lines and bodies.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "geom/point.h"
#include "geom/spatial_index.h"
#include "geom/tolerance.h"
#include "trace/flat_world.h"

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
Box2 boxOf(const Ellipse& round) { return round.box().expanded(kContactTolerance); }

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
            if (!Box2{{node.left[i], node.low[i]}, {node.right[i], node.high[i]}}.meets({p, p}))
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

}  // namespace ispace
