// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/flat_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>

#include "base/simd.h"
#include "geom/point.h"

namespace ispace {

namespace {

constexpr std::size_t kWidth = FlatTree::kWidth;
/// From this depth on ranges are halved, whatever their shape.
constexpr int kDeep = 12;
constexpr std::uint32_t kBins = 32;

/// Two numbers of a box.
using Pair = double __attribute__((vector_size(16)));

ISPACE_INLINE void lower(Pair& a, const Pair& b) { a = b < a ? b : a; }

/// A box with its upper ends negated, so that boxes are merged by minima alone.
struct Extent {
    Pair low = {kNone, kNone}, high = {kNone, kNone};

    static constexpr double kNone = std::numeric_limits<double>::infinity();
    Extent() = default;
    explicit Extent(const Box2& box) : low{box.low.x, box.low.y}, high{-box.high.x, -box.high.y} {}

    ISPACE_INLINE void add(const Extent& other) {
        lower(low, other.low);
        lower(high, other.high);
    }
    [[nodiscard]] double wide() const { return -high[0] - low[0]; }
    [[nodiscard]] double tall() const { return -high[1] - low[1]; }
    [[nodiscard]] double halfPerimeter() const { return wide() - high[1] - low[1]; }
};

/// A line or a round body, which splits only move by its box.
struct Item {
    Extent box;
    std::uint32_t index = 0;

    /// Times two.
    [[nodiscard]] ISPACE_INLINE Pair middle() const { return box.low - box.high; }
};

struct Group {
    std::size_t begin = 0, end = 0;
    Extent box;
    [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// What a group costs: how likely it is met, times the vectors of lines in it.
double cost(const Extent& box, std::size_t size) {
    const std::size_t vectors = (size + kWidth - 1) / kWidth;
    return box.halfPerimeter() * static_cast<double>(vectors);
}

/// Bins side by side along an axis.
struct Axis {
    double low = 0, scale = 0;

    /// \param middle of an item
    [[nodiscard]] ISPACE_INLINE std::uint32_t binOf(double middle) const {
        const double place = (middle - low) * scale;
        // As integers, which order those from 0 on alike.
        return std::min(static_cast<std::uint32_t>(static_cast<std::int32_t>(place)), kBins - 1);
    }
};

/// A cut between bins along an axis: items with smaller bins go left.
struct Cut {
    std::size_t axis = 0;
    Axis bins;
    std::uint32_t bin = 0;  ///< 0: there is none
    double cost = std::numeric_limits<double>::infinity();
    Extent left, right;
};

/// The items of a group, sorted into bins along an axis.
struct Bins {
    std::uint32_t used = 0;  ///< a bit for each bin that has items; what others hold is old
    std::array<Extent, kBins> boxes;
    std::array<std::uint32_t, kBins> sizes;

    ISPACE_INLINE void add(std::uint32_t bin, const Extent& box) {
        const std::uint32_t bit = 1U << bin;
        if ((used & bit) == 0) {
            used |= bit;
            boxes[bin] = box;
            sizes[bin] = 1;
        } else {
            boxes[bin].add(box);
            ++sizes[bin];
        }
    }

    /// Puts the cheapest cut into `best` where it is cheaper.
    void cheapen(std::size_t axis, const Axis& bins, Cut& best) const {
        // What lies right of each bin that has items, then what lies left.
        std::array<double, kBins> right_costs;
        std::array<Extent, kBins> rights;
        Extent box;
        std::size_t size = 0;
        const auto last = static_cast<std::uint32_t>(std::bit_width(used)) - 1;
        for (std::uint32_t left = used & ~(1U << last), bin = last; left != 0;) {
            box.add(boxes[bin]);
            size += sizes[bin];
            bin = static_cast<std::uint32_t>(std::bit_width(left)) - 1;
            left &= ~(1U << bin);
            rights[bin] = box;
            right_costs[bin] = cost(box, size);
        }
        box = {};
        size = 0;
        for (std::uint32_t left = used & ~(1U << last); left != 0; left &= left - 1) {
            const auto bin = static_cast<std::uint32_t>(std::countr_zero(left));
            box.add(boxes[bin]);
            size += sizes[bin];
            const double here = cost(box, size) + right_costs[bin];
            if (here < best.cost) best = {axis, bins, bin + 1, here, box, rights[bin]};
        }
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
        for (std::size_t i = begin; i < end; ++i) out.box.add(items_[i].box);
        return out;
    }

    /// The cheapest cut along one axis or the other.
    [[nodiscard]] Cut cheapestCut(const Group& all) {
        const std::span items = std::span(items_).subspan(all.begin, all.size());
        Pair low = items.front().middle(), high = -low;
        for (const Item& item : items) {
            const Pair middle = item.middle();
            lower(low, middle);
            lower(high, -middle);
        }
        std::array<Axis, 2> axes;
        for (const std::size_t axis : {0U, 1U}) {
            axes[axis].low = low[axis];
            // Without extent all are in the first bin.
            if (low[axis] < -high[axis])
                axes[axis].scale = static_cast<double>(kBins) / (-high[axis] - low[axis]);
            bins_[axis].used = 0;
        }
        for (const Item& item : items) {
            const Pair middle = item.middle();
            bins_[0].add(axes[0].binOf(middle[0]), item.box);
            bins_[1].add(axes[1].binOf(middle[1]), item.box);
        }
        Cut best;
        for (const std::size_t axis : {0U, 1U}) bins_[axis].cheapen(axis, axes[axis], best);
        return best;
    }

    /// Reorders the items of a group into two.
    std::pair<Group, Group> split(const Group& all, int depth) {
        const auto begin = items_.begin() + static_cast<std::ptrdiff_t>(all.begin);
        const auto end = items_.begin() + static_cast<std::ptrdiff_t>(all.end);
        if (depth < kDeep) {
            const Cut cut = cheapestCut(all);
            if (cut.bin > 0) {
                const auto is_left = [&cut](const Item& item) {
                    return cut.bins.binOf(item.middle()[cut.axis]) < cut.bin;
                };
                const auto middle =
                    static_cast<std::size_t>(std::partition(begin, end, is_left) - items_.begin());
                return {{all.begin, middle, cut.left}, {middle, all.end, cut.right}};
            }
        }
        const auto axis = static_cast<std::size_t>(all.box.tall() > all.box.wide());
        const auto middle = begin + (end - begin) / 2;
        std::nth_element(begin, middle, end, [axis](const Item& a, const Item& b) {
            return a.middle()[axis] < b.middle()[axis];
        });
        const auto at = static_cast<std::size_t>(middle - items_.begin());
        return {group(all.begin, at), group(at, all.end)};
    }

    /// Up to eight parts of a group.
    struct Parts {
        std::array<Group, kWidth> groups;
        std::size_t count = 1;
    };

    /// Splits what is most expensive until there are eight parts.
    Parts parts(const Group& all, int depth) {
        Parts out{{all}};
        std::array<double, kWidth> costs{};  // of those that may be split; else below 0
        const auto rate = [&](std::size_t i) {
            const Group& group = out.groups[i];
            costs[i] = group.size() <= most_ ? -1
                       : depth < kDeep       ? cost(group.box, group.size())
                                             : static_cast<double>(group.size());
        };
        for (rate(0); out.count < kWidth; ++out.count) {
            const auto most = static_cast<std::size_t>(
                std::max_element(costs.begin(), costs.begin() + out.count) - costs.begin());
            if (costs[most] < 0) break;
            std::tie(out.groups[most], out.groups[out.count]) = split(out.groups[most], depth);
            rate(most);
            rate(out.count);
        }
        return out;
    }

    std::int32_t node(const Group& all, int depth) {
        const auto [groups, count] = parts(all, depth);
        const std::size_t index = tree_.nodes.size();
        tree_.nodes.emplace_back();
        FlatTree::Node made{};
        made.count = static_cast<std::int32_t>(count);
        for (std::size_t i = 0; i < kWidth; ++i) {
            const Extent& box = groups[i < count ? i : 0].box;
            made.left[i] = box.low[0];
            made.right[i] = -box.high[0];
            made.low[i] = box.low[1];
            made.high[i] = -box.high[1];
            if (i < count)
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
    std::array<Bins, 2> bins_;
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
            items.push_back({Extent(bounds(lines[i])), static_cast<std::uint32_t>(i)});
    if (!items.empty()) {
        // Most leaves have five to seven lines.
        leaves.reserve(items.size() / 5 + 1);
        Builder(std::move(items), lines, *this, kWidth).build();
    }
    if (round_bodies.empty()) return;
    if (nodes.empty()) nodes.push_back({});
    items.clear();
    rounds.reserve(round_bodies.size());
    for (std::size_t i = 0; i < round_bodies.size(); ++i) {
        items.push_back({Extent(boxOf(round_bodies[i])), static_cast<std::uint32_t>(i)});
        rounds.push_back(unitMapOf(round_bodies[i]));
    }
    round_root = Builder(std::move(items), {}, *this, 1).build();
}

}  // namespace ispace
