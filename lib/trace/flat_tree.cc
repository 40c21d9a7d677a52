// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/flat_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "geom/point.h"

namespace ispace {

namespace {

constexpr std::size_t kWidth = FlatTree::kWidth;
/// From this depth on ranges are halved, whatever their shape.
constexpr int kDeep = 12;
constexpr std::size_t kBins = 32;

struct Item {
    Segment2 line;
    std::size_t round = 0;  ///< index, for the hierarchy of round bodies
    Box2 box;
    double middle[2] = {};  ///< times two, along x and y
};

struct Group {
    std::size_t begin = 0, end = 0;
    Box2 box;
    [[nodiscard]] std::size_t size() const { return end - begin; }
};

double halfPerimeter(const Box2& box) {
    return box.empty() ? 0 : box.high.x - box.low.x + box.high.y - box.low.y;
}

void merge(Box2& box, const Box2& other) {
    if (other.empty()) return;
    box.add(other.low);
    box.add(other.high);
}

/// What a group costs: how likely it is met, times the vectors of lines in it.
double cost(const Box2& box, std::size_t size) {
    const std::size_t vectors = (size + kWidth - 1) / kWidth;
    return halfPerimeter(box) * static_cast<double>(vectors);
}

struct Cut {
    int axis = 0;
    double at = 0;  ///< items with smaller bins go left
    double low = 0, scale = 0;
    std::size_t bin = 0;
    double cost = std::numeric_limits<double>::infinity();

    [[nodiscard]] std::size_t binOf(const Item& item) const {
        const double place = (item.middle[axis] - low) * scale;
        return std::min(static_cast<std::size_t>(std::max(place, 0.0)), kBins - 1);
    }
};

class Builder {
  public:
    /// `most`: items that make a leaf, of lines or, if 1, of a round body.
    Builder(std::vector<Item> items, FlatTree& tree, std::size_t most)
        : items_(std::move(items)), tree_(tree), most_(most) {}

    /// \return the root \pre there are items
    std::int32_t build() { return node(group(0, items_.size()), 0); }

  private:
    [[nodiscard]] Group group(std::size_t begin, std::size_t end) const {
        Group out{begin, end, {}};
        for (std::size_t i = begin; i < end; ++i) merge(out.box, items_[i].box);
        return out;
    }

    /// The cheapest cut along one axis.
    [[nodiscard]] Cut cutAlong(const Group& all, int axis) const {
        double low = items_[all.begin].middle[axis], high = low;
        for (std::size_t i = all.begin; i < all.end; ++i) {
            low = std::min(low, items_[i].middle[axis]);
            high = std::max(high, items_[i].middle[axis]);
        }
        Cut cut;
        cut.axis = axis;
        cut.low = low;
        if (!(low < high)) return cut;
        cut.scale = static_cast<double>(kBins) / (high - low);
        std::array<Box2, kBins> boxes;
        std::array<std::size_t, kBins> sizes{};
        for (std::size_t i = all.begin; i < all.end; ++i) {
            const std::size_t bin = cut.binOf(items_[i]);
            merge(boxes[bin], items_[i].box);
            ++sizes[bin];
        }
        // Costs of what lies right of each cut, then those of what lies left.
        std::array<double, kBins> right{};
        Box2 box;
        std::size_t size = 0;
        for (std::size_t bin = kBins; bin-- > 1;) {
            merge(box, boxes[bin]);
            size += sizes[bin];
            right[bin] = size == 0 ? std::numeric_limits<double>::infinity() : cost(box, size);
        }
        box = {};
        size = 0;
        for (std::size_t bin = 1; bin < kBins; ++bin) {
            merge(box, boxes[bin - 1]);
            size += sizes[bin - 1];
            const double here =
                size == 0 ? std::numeric_limits<double>::infinity() : cost(box, size) + right[bin];
            if (here < cut.cost) {
                cut.cost = here;
                cut.bin = bin;
            }
        }
        return cut;
    }

    /// Reorders the items of a group; returns where its second part begins.
    std::size_t split(const Group& all, int depth) {
        const auto begin = items_.begin() + static_cast<std::ptrdiff_t>(all.begin);
        const auto end = items_.begin() + static_cast<std::ptrdiff_t>(all.end);
        if (depth < kDeep) {
            const Cut x = cutAlong(all, 0), y = cutAlong(all, 1);
            const Cut& cut = y.cost < x.cost ? y : x;
            if (cut.bin > 0) {
                const auto middle = std::partition(
                    begin, end, [&](const Item& item) { return cut.binOf(item) < cut.bin; });
                return static_cast<std::size_t>(middle - items_.begin());
            }
        }
        const bool is_tall = all.box.high.y - all.box.low.y > all.box.high.x - all.box.low.x;
        const auto middle = begin + (end - begin) / 2;
        std::nth_element(begin, middle, end, [&](const Item& a, const Item& b) {
            return a.middle[is_tall ? 1 : 0] < b.middle[is_tall ? 1 : 0];
        });
        return static_cast<std::size_t>(middle - items_.begin());
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
            const Group old = groups[most];
            const std::size_t middle = split(old, depth);
            groups[most] = group(old.begin, middle);
            groups.push_back(group(middle, old.end));
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
        if (most_ == 1) return ~static_cast<std::int32_t>(items_[all.begin].round);
        FlatTree::Leaf made{};
        made.count = static_cast<std::int32_t>(all.size());
        for (std::size_t i = 0; i < kWidth; ++i) {
            const bool is_used = i < all.size();
            const Segment2& line = items_[is_used ? all.begin + i : all.begin].line;
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
    FlatTree& tree_;
    std::size_t most_;
};

Item itemOf(const Box2& box) {
    Item item;
    item.box = box;
    item.middle[0] = box.low.x + box.high.x;
    item.middle[1] = box.low.y + box.high.y;
    return item;
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

}  // namespace

FlatTree::FlatTree(std::span<const Segment2> lines, std::span<const Ellipse> round_bodies) {
    std::vector<Item> items;
    items.reserve(lines.size());
    for (const Segment2& line : lines) {
        if (line.a == line.b) continue;
        Item item = itemOf(bounds(line));
        item.line = lexLess(line.a, line.b) ? line : Segment2{line.b, line.a};
        items.push_back(item);
    }
    if (!items.empty()) Builder(std::move(items), *this, kWidth).build();
    if (round_bodies.empty()) return;
    if (nodes.empty()) nodes.push_back({});
    items.clear();
    rounds.reserve(round_bodies.size());
    for (std::size_t i = 0; i < round_bodies.size(); ++i) {
        items.push_back(itemOf(boxOf(round_bodies[i])));
        items.back().round = i;
        rounds.push_back(unitMapOf(round_bodies[i]));
    }
    round_root = Builder(std::move(items), *this, 1).build();
}

}  // namespace ispace
