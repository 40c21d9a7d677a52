// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/spatial_index.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "base/simd.h"
#include "geom/point.h"

namespace ispace {

std::uint64_t mortonCode(std::uint32_t x, std::uint32_t y) {
    const auto spread = [](std::uint64_t bits) {  // spreads bits to even positions
        bits = (bits | bits << 16U) & 0x0000FFFF0000FFFFU;
        bits = (bits | bits << 8U) & 0x00FF00FF00FF00FFU;
        bits = (bits | bits << 4U) & 0x0F0F0F0F0F0F0F0FU;
        bits = (bits | bits << 2U) & 0x3333333333333333U;
        return (bits | bits << 1U) & 0x5555555555555555U;
    };
    return spread(x) | spread(y) << 1U;
}

SegmentGrid::SegmentGrid(std::span<const Segment2> segments, double margin) : margin_(margin) {
    double total = 0;
    for (const auto& [a, b] : segments) {
        box_.add(a);
        box_.add(b);
        total += distance(a, b);
    }
    if (segments.empty()) box_ = {{0, 0}, {0, 0}};
    const auto count = static_cast<double>(std::max<std::size_t>(1, segments.size()));
    // Not below the mean length, so that the lists stay short; a box without width is divided by
    // `count`.
    size_ = std::max({std::sqrt(box_.width() / count) * std::sqrt(box_.depth()), total / count,
                      std::max(box_.width(), box_.depth()) / count, 8 * margin_});
    if (!std::isfinite(size_)) size_ = std::numeric_limits<double>::max();
    const auto along = [&](double extent) {
        return extent / size_ < count ? static_cast<std::int64_t>(extent / size_) + 1
                                      : static_cast<std::int64_t>(count) + 1;
    };
    columns_ = along(box_.width());
    rows_ = along(box_.depth());

    // Count, then fill: the lists of all cells lie in one array.
    first_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
    for (const Segment2& s : segments)
        forEachCellOf(s, [&](auto column, auto row) { ++first_[indexOf(column, row) + 1]; });
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    indices_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < segments.size(); ++i) {
        forEachCellOf(segments[i], [&](auto column, auto row) {
            indices_[next[indexOf(column, row)]++] = static_cast<std::uint32_t>(i);
        });
    }
}

std::int64_t SegmentGrid::cellOf(double offset, std::int64_t count) const {
    const double cell = offset / size_;
    if (!(cell > 0)) return 0;
    return cell < static_cast<double>(count) ? static_cast<std::int64_t>(cell) : count - 1;
}

std::span<const std::uint32_t> SegmentGrid::cell(std::int64_t column, std::int64_t row) const {
    const std::size_t i = indexOf(column, row);
    return std::span(indices_).subspan(first_[i], first_[i + 1] - first_[i]);
}

std::span<const std::uint32_t> SegmentGrid::near(Point2 p) const {
    return cell(column(p.x), row(p.y));
}

BoxTree::BoxTree(std::span<const Box2> boxes) {
    items_.reserve(boxes.size());
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
        if (!boxes[i].empty()) items_.push_back({boxes[i], i});
    if (!items_.empty()) build(0, static_cast<std::uint32_t>(items_.size()));
}

void BoxTree::build(std::uint32_t first, std::uint32_t count) {
    const std::span<Item> items = std::span(items_).subspan(first, count);
    Box2 box;
    for (const Item& item : items) {
        box.add(item.box.low);
        box.add(item.box.high);
    }
    const auto at = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({box, first, count, 0});
    if (count <= kLeaf) return;
    const bool is_wide = box.width() >= box.depth();
    const auto center = [is_wide](const Item& item) {
        return is_wide ? item.box.center().x : item.box.center().y;
    };
    const std::uint32_t half = count / 2;
    std::nth_element(items.begin(), items.begin() + half, items.end(),
                     [&](const Item& a, const Item& b) {
                         const double x = center(a), y = center(b);
                         return x < y || (x == y && a.index < b.index);
                     });
    build(first, half);  // depth is the logarithm of the number
    nodes_[at].right = static_cast<std::uint32_t>(nodes_.size());
    build(first + half, count - half);
}

namespace {

/// Larger coordinates are not rotated, since their products would overflow.
constexpr double kMaxTurned = 1e100;

/// Computes the direction, modulo a right angle, of most segments, weighted by length.
Vec2 mainAxis(std::span<const Segment2> segments) {
    // Four times the angle is the same for all sides of a rectangle: sum its unit vectors.
    Vec2 sum{0, 0};
    for (const auto& [a, b] : segments) {
        const double apart = distance(a, b);
        if (!(apart > 0)) continue;
        const Vec2 unit = (1 / apart) * (b - a);
        const Vec2 twice{unit.x * unit.x - unit.y * unit.y, 2 * unit.x * unit.y};
        sum = sum + apart * Vec2{twice.x * twice.x - twice.y * twice.y, 2 * twice.x * twice.y};
    }
    const double angle = std::atan2(sum.y, sum.x) / 4;
    return {std::cos(angle), std::sin(angle)};
}

}  // namespace

SegmentTree::SegmentTree(std::span<const Segment2> segments) {
    double farthest = 0;
    for (const auto& [a, b] : segments)
        farthest = std::max({farthest, std::abs(a.x), std::abs(a.y), std::abs(b.x), std::abs(b.y)});
    if (farthest <= kMaxTurned) axis_ = mainAxis(segments);
    slack_ = 8 * std::numeric_limits<double>::epsilon() * farthest;
    std::vector<Box2> boxes;
    boxes.reserve(segments.size());
    for (const Segment2& segment : segments) boxes.push_back(boxOf(segment, 0));
    tree_ = BoxTree(boxes);
}

Box2 SegmentTree::boxOf(const Segment2& segment, double reach) const {
    Box2 box;
    for (const Point2 p : {segment.a, segment.b})
        box.add({axis_.x * p.x + axis_.y * p.y, axis_.x * p.y - axis_.y * p.x});
    return box.expanded(reach + slack_);
}

namespace {

constexpr std::size_t kWidth = BoxOrder::kWidth;
/// From this depth on ranges are halved, regardless of their shape.
constexpr int kDeep = 12;
constexpr std::uint32_t kBins = 32;

/// Two numbers of a box.
using Pair = double __attribute__((vector_size(16)));

ISPACE_INLINE void lower(Pair& a, const Pair& b) { a = b < a ? b : a; }

/// Stores a box with its upper ends negated, so that minima alone merge boxes.
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

/// Sums that splits update.
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

/// Cost of a group: the probability that a query meets it, times the vectors of lines in it.
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
        // Clamped as an integer; from 0 on these sort like the numbers.
        return std::min(static_cast<std::uint32_t>(static_cast<std::int32_t>(place)), kBins - 1);
    }
};

/// A cut between bins along an axis: items with smaller bins go left.
struct Cut {
    std::size_t axis = 0;
    Axis bins;
    std::uint32_t bin = 0;  ///< 0: no cut
    double cost = std::numeric_limits<double>::infinity();
    Extent left, right;
};

/// The items of a group, sorted into bins along an axis.
struct Bins {
    std::uint32_t used = 0;  ///< a bit for each non-empty bin; other bins hold stale data
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

    /// Stores the cheapest cut in `best` if it is cheaper.
    void cheapen(std::size_t axis, const Axis& bins, Cut& best) const {
        // Sums over the bins to the right, then over those to the left.
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

    /// Finds the cheapest cut along either axis.
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
            // Without extent the first bin holds all items.
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

    /// Partitions the items of a group.
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

    /// Splits the most expensive part until there are eight.
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
