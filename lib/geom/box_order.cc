// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/box_order.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <tuple>
#include <utility>

#include "base/simd.h"
#include "geom/point.h"

namespace ispace {

namespace {

constexpr std::size_t kWidth = BoxOrder::kWidth;
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

/// What splits move.
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

class Orderer {
  public:
    Orderer(std::vector<Item> items, std::size_t most) : items_(std::move(items)), most_(most) {
        order_.items.reserve(items_.size());
    }

    /// \pre there are items
    BoxOrder order() {
        node(group(0, items_.size()), 0);
        return std::move(order_);
    }

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

    void node(const Group& all, int depth) {
        const auto [groups, count] = parts(all, depth);
        const auto is_leaf = [this](const Group& group) { return group.size() <= most_; };
        order_.shape.push_back(static_cast<std::uint8_t>(count));
        for (std::size_t i = 0; i < count; ++i)
            order_.shape.push_back(is_leaf(groups[i]) ? static_cast<std::uint8_t>(groups[i].size())
                                                      : std::uint8_t{0});
        for (std::size_t i = 0; i < count; ++i) {
            if (!is_leaf(groups[i])) {
                node(groups[i], depth + 1);
                continue;
            }
            for (std::size_t k = groups[i].begin; k < groups[i].end; ++k)
                order_.items.push_back(items_[k].index);
        }
    }

    std::vector<Item> items_;
    std::size_t most_;
    std::array<Bins, 2> bins_;
    BoxOrder order_;
};

}  // namespace

BoxOrder orderOf(std::span<const Box2> boxes, std::size_t most) {
    std::vector<Item> items;
    items.reserve(boxes.size());
    for (const Box2& box : boxes)
        items.push_back({Extent(box), static_cast<std::uint32_t>(items.size())});
    return Orderer(std::move(items), most).order();
}

BoxOrder orderOf(std::span<const Segment2> lines) {
    std::vector<Item> items;
    items.reserve(lines.size());
    for (const Segment2& line : lines)
        items.push_back({Extent(bounds(line)), static_cast<std::uint32_t>(items.size())});
    return Orderer(std::move(items), kWidth).order();
}

}  // namespace ispace
