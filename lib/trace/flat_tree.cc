// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/flat_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "geom/point.h"

namespace ispace {

namespace {

constexpr std::size_t kWidth = FlatTree::kWidth;
/// From this depth on ranges are halved, whatever their shape.
constexpr int kDeep = 12;
constexpr std::size_t kBins = 32;

/// A line or a round body, which splits only move by its box.
struct Item {
    Box2 box;
    std::uint32_t index = 0;

    /// Times two.
    [[nodiscard]] double middle(std::size_t axis) const {
        return axis == 0 ? box.low.x + box.high.x : box.low.y + box.high.y;
    }
};

struct Group {
    std::size_t begin = 0, end = 0;
    Box2 box;
    [[nodiscard]] std::size_t size() const { return end - begin; }
};

double halfPerimeter(const Box2& box) {
    return box.empty() ? 0 : box.high.x - box.low.x + box.high.y - box.low.y;
}

/// An empty one changes nothing.
void merge(Box2& box, const Box2& other) {
    box.low.x = std::min(box.low.x, other.low.x);
    box.low.y = std::min(box.low.y, other.low.y);
    box.high.x = std::max(box.high.x, other.high.x);
    box.high.y = std::max(box.high.y, other.high.y);
}

/// What a group costs: how likely it is met, times the vectors of lines in it.
double cost(const Box2& box, std::size_t size) {
    const std::size_t vectors = (size + kWidth - 1) / kWidth;
    return halfPerimeter(box) * static_cast<double>(vectors);
}

/// A cut between bins along an axis: items with smaller bins go left.
struct Cut {
    std::size_t axis = 0;
    double low = 0, scale = 0;
    std::size_t bin = 0;  ///< 0: there is none
    double cost = std::numeric_limits<double>::infinity();
    Box2 left, right;

    [[nodiscard]] std::size_t binOf(const Item& item) const {
        const double place = (item.middle(axis) - low) * scale;
        return std::min(static_cast<std::size_t>(std::max(place, 0.0)), kBins - 1);
    }
};

/// The items of a group, sorted into bins along an axis.
struct Bins {
    Cut cut;  ///< where bins are
    std::array<Box2, kBins> boxes;
    std::array<std::size_t, kBins> sizes{};

    void add(const Item& item) {
        const std::size_t bin = cut.binOf(item);
        merge(boxes[bin], item.box);
        ++sizes[bin];
    }

    /// The cheapest cut.
    [[nodiscard]] Cut cheapest() const {
        // What lies right of each cut, then what lies left; only bins with items change it.
        std::array<double, kBins> right_costs;
        std::array<Box2, kBins> rights;
        Box2 box;
        std::size_t size = 0;
        double here = std::numeric_limits<double>::infinity();
        for (std::size_t bin = kBins; bin-- > 1;) {
            if (sizes[bin] > 0) {
                merge(box, boxes[bin]);
                size += sizes[bin];
                here = ispace::cost(box, size);
            }
            rights[bin] = box;
            right_costs[bin] = here;
        }
        Cut best = cut;
        box = {};
        size = 0;
        for (std::size_t bin = 1; bin < kBins; ++bin) {
            if (sizes[bin - 1] == 0) continue;
            merge(box, boxes[bin - 1]);
            size += sizes[bin - 1];
            here = ispace::cost(box, size) + right_costs[bin];
            if (here < best.cost) {
                best.cost = here;
                best.bin = bin;
                best.left = box;
                best.right = rights[bin];
            }
        }
        return best;
    }
};

class Builder {
  public:
    /// `most`: items that make a leaf, of lines or, if 1, of a round body. \param lines those of
    /// the items
    Builder(std::vector<Item> items, std::span<const Segment2> lines, FlatTree& tree,
            std::size_t most)
        : items_(std::move(items)), lines_(lines), tree_(tree), most_(most) {}

    /// \return the root \pre there are items
    std::int32_t build() { return node(group(0, items_.size()), 0); }

  private:
    [[nodiscard]] Group group(std::size_t begin, std::size_t end) const {
        Group out{begin, end, {}};
        for (std::size_t i = begin; i < end; ++i) merge(out.box, items_[i].box);
        return out;
    }

    /// The cheapest cut along one axis or the other.
    [[nodiscard]] Cut cheapestCut(const Group& all) const {
        const std::span items = std::span(items_).subspan(all.begin, all.size());
        std::array<double, 2> low{}, high{};
        for (const std::size_t axis : {0U, 1U}) low[axis] = high[axis] = items.front().middle(axis);
        for (const Item& item : items)
            for (const std::size_t axis : {0U, 1U}) {
                low[axis] = std::min(low[axis], item.middle(axis));
                high[axis] = std::max(high[axis], item.middle(axis));
            }
        std::array<Bins, 2> bins;
        for (const std::size_t axis : {0U, 1U}) {
            bins[axis].cut.axis = axis;
            bins[axis].cut.low = low[axis];
            // Without extent all are in the first bin.
            if (low[axis] < high[axis])
                bins[axis].cut.scale = static_cast<double>(kBins) / (high[axis] - low[axis]);
        }
        for (const Item& item : items)
            for (Bins& along : bins) along.add(item);
        const Cut x = bins[0].cheapest(), y = bins[1].cheapest();
        return y.cost < x.cost ? y : x;
    }

    /// Reorders the items of a group into two.
    std::pair<Group, Group> split(const Group& all, int depth) {
        const auto begin = items_.begin() + static_cast<std::ptrdiff_t>(all.begin);
        const auto end = items_.begin() + static_cast<std::ptrdiff_t>(all.end);
        if (depth < kDeep) {
            const Cut cut = cheapestCut(all);
            if (cut.bin > 0) {
                const auto middle = static_cast<std::size_t>(
                    std::partition(begin, end,
                                   [&](const Item& item) { return cut.binOf(item) < cut.bin; }) -
                    items_.begin());
                return {{all.begin, middle, cut.left}, {middle, all.end, cut.right}};
            }
        }
        const bool is_tall = all.box.high.y - all.box.low.y > all.box.high.x - all.box.low.x;
        const auto middle = begin + (end - begin) / 2;
        std::nth_element(begin, middle, end,
                         [axis = std::size_t{is_tall}](const Item& a, const Item& b) {
                             return a.middle(axis) < b.middle(axis);
                         });
        const auto at = static_cast<std::size_t>(middle - items_.begin());
        return {group(all.begin, at), group(at, all.end)};
    }

    /// Splits what is most expensive until there are eight parts.
    std::vector<Group> parts(const Group& all, int depth) {
        std::vector<Group> groups{all};
        groups.reserve(kWidth);
        while (groups.size() < kWidth) {
            std::size_t most = 0;
            double highest = -1;
            for (std::size_t i = 0; i < groups.size(); ++i) {
                const double here = depth < kDeep ? cost(groups[i].box, groups[i].size())
                                                  : static_cast<double>(groups[i].size());
                if (groups[i].size() > most_ && here > highest) {
                    highest = here;
                    most = i;
                }
            }
            if (highest < 0) break;
            const auto [first, second] = split(groups[most], depth);
            groups[most] = first;
            groups.push_back(second);
        }
        return groups;
    }

    std::int32_t node(const Group& all, int depth) {
        const std::vector<Group> groups = parts(all, depth);
        const std::size_t index = tree_.nodes.size();
        tree_.nodes.emplace_back();
        FlatTree::Node made{};
        made.count = static_cast<std::int32_t>(groups.size());
        for (std::size_t i = 0; i < kWidth; ++i) {
            const Box2& box = groups[i < groups.size() ? i : 0].box;
            made.left[i] = box.low.x;
            made.right[i] = box.high.x;
            made.low[i] = box.low.y;
            made.high[i] = box.high.y;
            if (i < groups.size())
                made.child[i] =
                    groups[i].size() > most_ ? node(groups[i], depth + 1) : leaf(groups[i]);
        }
        tree_.nodes[index] = made;
        return static_cast<std::int32_t>(index);
    }

    std::int32_t leaf(const Group& all) {
        if (most_ == 1) return ~static_cast<std::int32_t>(items_[all.begin].index);
        FlatTree::Leaf made{};
        made.count = static_cast<std::int32_t>(all.size());
        for (std::size_t i = 0; i < kWidth; ++i) {
            const bool is_used = i < all.size();
            const Segment2& given = lines_[items_[is_used ? all.begin + i : all.begin].index];
            const Segment2 line = lexLess(given.a, given.b) ? given : Segment2{given.b, given.a};
            const Point2 b = is_used ? line.b : line.a;
            made.ax[i] = line.a.x;
            made.ay[i] = line.a.y;
            made.bx[i] = b.x;
            made.by[i] = b.y;
            // Not std::hypot, whose last bit is nobody's promise.
            const Vec2 along = b - line.a;
            made.length[i] = std::sqrt(dot(along, along));
        }
        tree_.leaves.push_back(made);
        return ~static_cast<std::int32_t>(tree_.leaves.size() - 1);
    }

    std::vector<Item> items_;
    std::span<const Segment2> lines_;
    FlatTree& tree_;
    std::size_t most_;
};

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

}  // namespace

FlatTree::FlatTree(std::span<const Segment2> lines, std::span<const Ellipse> round_bodies) {
    std::vector<Item> items;
    items.reserve(lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i)
        if (lines[i].a != lines[i].b)
            items.push_back({bounds(lines[i]), static_cast<std::uint32_t>(i)});
    if (!items.empty()) Builder(std::move(items), lines, *this, kWidth).build();
    if (round_bodies.empty()) return;
    if (nodes.empty()) nodes.push_back({});
    items.clear();
    rounds.reserve(round_bodies.size());
    for (std::size_t i = 0; i < round_bodies.size(); ++i) {
        items.push_back({boxOf(round_bodies[i]), static_cast<std::uint32_t>(i)});
        rounds.push_back(unitMapOf(round_bodies[i]));
    }
    round_root = Builder(std::move(items), {}, *this, 1).build();
}

}  // namespace ispace
