// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/check_guards.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "arrange/poses/box_sides.h"
#include "arrange/poses/fat_view.h"
#include "base/error.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

using poses::Convex;
using poses::PoseFloor;
using poses::Side2;

/// Distances within this share of the extent of the floor are none; roundings are a thousandth of
/// it.
constexpr double kBlur = 0x1p-40;

/// The part of a triangle that an apex sees, between the lines through two points.
struct Cone {
    std::uint32_t of = 0;  // index of the apex
    bool is_whole = false;
    Point2 apex, right, left;
    [[nodiscard]] Side2 rightSide() const { return {apex, -perpendicular(unit(right))}; }
    [[nodiscard]] Side2 leftSide() const { return {apex, perpendicular(unit(left))}; }
    [[nodiscard]] Vec2 unit(Point2 end) const { return (1 / length(end - apex)) * (end - apex); }
};

/// Cones by triangle.
using Sights = std::vector<std::vector<Cone>>;

class GuardChecker {
  public:
    GuardChecker(std::span<const Region> floor, const GuardCertificate& certificate,
                 const std::string& name)
        : floor_(floor, 1), certificate_(certificate), name_(name) {
        const Box2& box = floor_.box();
        extent_ = std::max(
            {std::abs(box.low.x), std::abs(box.low.y), std::abs(box.high.x), std::abs(box.high.y)});
    }

    GuardCheck check(std::span<const Point2> guards);

  private:
    using Rows = std::vector<std::pair<std::uint32_t, std::int64_t>>;
    using Pairs = std::vector<std::array<std::uint32_t, 2>>;
    /// A leaf, and the pairs on the path to it.
    struct Leaf {
        Rows weights;
        Pairs together, apart;
        std::vector<std::int64_t> of;  // by witness
    };
    /// A convex part of a triangle, with the cones that may meet it.
    struct Part {
        Convex outline;
        std::vector<Cone> cones;
    };

    [[noreturn]] void refuse(const std::string& message) const {
        throw FormatError({name_, 0, 0, message});
    }
    [[nodiscard]] Sights sightsFrom(std::span<const Point2> points, bool must_be_on) const;
    void follow(const Cone& first, std::size_t triangle, std::size_t edge,
                const std::vector<char>& is_start, Sights& sights) const;
    /// Bounds the error of the distance of a point from a line of a cone.
    [[nodiscard]] double blurAt(const Cone& cone, Point2 end, Point2 p) const {
        return kBlur * extent_ * (1 + length(p - cone.apex) / length(end - cone.apex));
    }
    void readLeaves(const GuardCertificate::Tree& tree, std::size_t& at, Leaf path,
                    std::vector<Leaf>& leaves) const;
    using Leaves = std::vector<Leaf>;  // of a tree
    /// Returns the number of points that a tree proves.
    std::size_t boundOf(const Leaves& leaves, const Sights& sights, std::size_t& cells) const;
    /// True if no point sees witnesses of two trees.
    bool areApart(const std::vector<Leaves>& trees, const Sights& sights, std::size_t& cells) const;
    /// Returns the largest weight of witnesses and pairs that a point of the part may see.
    /// \param tries of subsets without a pair that is apart; once they are used up, more is
    /// returned
    [[nodiscard]] std::int64_t weightOf(const Leaf& leaf, std::vector<std::uint32_t> seen,
                                        int& tries) const;
    [[nodiscard]] std::int64_t weightOf(const Leaf& leaf, const Part& part) const;
    [[nodiscard]] bool isClear(const Cone& cone, const Convex& outline) const;
    /// Cuts a part by a line of a cone; returns false if that divides nothing.
    bool cut(const Part& part, Part& inside, Part& outside, const Leaf& leaf) const;
    template <typename Weight>
    std::int64_t heaviest(const Leaf& leaf, Part whole, std::size_t& cells, Weight weight_of) const;
    [[nodiscard]] double missedBy(const Sights& sights) const;

    PoseFloor floor_;
    const GuardCertificate& certificate_;
    const std::string& name_;
    double extent_ = 1;
};

Sights GuardChecker::sightsFrom(std::span<const Point2> points, bool must_be_on) const {
    const std::size_t count = floor_.triangles().size();
    std::vector<Sights> own(points.size());
    std::vector<char> is_off(points.size());
    tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
        const Point2 at = points[i];
        own[i].resize(count);
        std::vector<char> is_start(count);
        for (std::size_t t = 0; t < count; ++t) {
            const PoseFloor::Corners corners = floor_.cornersOf(t);
            bool is_in = true;
            for (std::size_t k = 0; k < 3 && is_in; ++k) {
                const Segment2 edge{corners[k], corners[(k + 1) % 3]};
                is_in = cross(edge.b - edge.a, at - edge.a) >= 0;
            }
            for (std::size_t k = 0; k < 3 && !is_in; ++k)
                is_in = distance(at, Segment2{corners[k], corners[(k + 1) % 3]}) <= kBlur * extent_;
            is_start[t] = is_in ? 1 : 0;
            if (is_in) own[i][t].push_back({static_cast<std::uint32_t>(i), true, at, at, at});
        }
        is_off[i] = std::find(is_start.begin(), is_start.end(), 1) == is_start.end() ? 1 : 0;
        for (std::size_t t = 0; t < count; ++t)
            for (std::size_t edge = 0; edge < 3 && is_start[t] != 0; ++edge)
                follow({static_cast<std::uint32_t>(i), false, at, at, at}, t, edge, is_start,
                       own[i]);
    });
    if (must_be_on && std::find(is_off.begin(), is_off.end(), 1) != is_off.end())
        refuse("a witness is not on the floor");
    Sights all(count);
    for (const Sights& sights : own)
        for (std::size_t t = 0; t < count; ++t)
            all[t].insert(all[t].end(), sights[t].begin(), sights[t].end());
    return all;
}

/// Follows all lines of sight that leave a triangle with the apex by an edge.
void GuardChecker::follow(const Cone& first, std::size_t triangle, std::size_t edge,
                          const std::vector<char>& is_start, Sights& sights) const {
    constexpr int kMostSteps = 1'000'000;
    struct Step {
        std::size_t triangle, edge;  // that it leaves, and by which edge
        Cone cone;
    };
    const auto triangles = floor_.triangles();
    std::vector<Step> open;
    Cone cone = first;
    const auto ends_of = [&](std::size_t of, std::size_t k) {
        const auto& corners = triangles[of].corners;
        return std::pair(floor_.at(corners[k]), floor_.at(corners[(k + 1) % 3]));
    };
    std::tie(cone.right, cone.left) = ends_of(triangle, edge);
    open.push_back({triangle, edge, cone});
    for (int steps = 0; !open.empty(); ++steps) {
        if (steps == kMostSteps) refuse("a point sees the floor through too many edges");
        const Step step = open.back();
        open.pop_back();
        const std::int32_t next = triangles[step.triangle].beyond[step.edge];
        if (next < 0) continue;
        const auto beyond = static_cast<std::size_t>(next);
        if (is_start[beyond] != 0) continue;
        sights[beyond].push_back(step.cone);
        for (std::size_t k = 0; k < 3; ++k) {
            if (triangles[beyond].beyond[k] == static_cast<std::int32_t>(step.triangle)) continue;
            const auto [right, left] = ends_of(beyond, k);
            Cone narrow = step.cone;
            if (narrow.rightSide().beyond(right) < 0) narrow.right = right;
            if (narrow.leftSide().beyond(left) < 0) narrow.left = left;
            if (narrow.rightSide().beyond(narrow.left) > blurAt(narrow, narrow.right, narrow.left))
                continue;
            open.push_back({beyond, k, narrow});
        }
    }
}

void GuardChecker::readLeaves(const GuardCertificate::Tree& tree, std::size_t& at, Leaf path,
                              std::vector<Leaf>& leaves) const {
    constexpr std::size_t kDeepest = 32;
    if (at == tree.size()) refuse("a tree ends early");
    const GuardCertificate::Node& node = tree[at++];
    const std::size_t witnesses = certificate_.witnesses.size();
    if (node.is_leaf) {
        path.weights = node.weights;
        if (!node.weights.empty() && node.weights.back().first >= witnesses + path.together.size())
            refuse("a leaf gives a weight to no witness and no pair");
        path.of.assign(witnesses, 0);
        for (const auto& [row, weight] : node.weights)
            if (row < witnesses) path.of[row] = weight;
        leaves.push_back(std::move(path));
        return;
    }
    if (std::max(node.pair[0], node.pair[1]) >= witnesses) refuse("a pair of no witnesses");
    if (path.together.size() + path.apart.size() == kDeepest) refuse("the tree is too deep");
    Leaf together = path;
    together.together.push_back(node.pair);
    readLeaves(tree, at, std::move(together), leaves);
    path.apart.push_back(node.pair);
    readLeaves(tree, at, std::move(path), leaves);
}

std::int64_t GuardChecker::weightOf(const Leaf& leaf, std::vector<std::uint32_t> seen,
                                    int& tries) const {
    const auto is_seen = [&seen](std::uint32_t witness) {
        return std::binary_search(seen.begin(), seen.end(), witness);
    };
    for (const auto& pair : leaf.apart) {
        if (!is_seen(pair[0]) || !is_seen(pair[1]) || tries <= 0) continue;
        --tries;
        std::int64_t most = 0;
        for (const std::uint32_t left_out : pair) {
            std::vector<std::uint32_t> rest = seen;
            std::erase(rest, left_out);
            most = std::max(most, weightOf(leaf, std::move(rest), tries));
        }
        return most;
    }
    std::int64_t sum = 0;
    for (const std::uint32_t witness : seen) sum += leaf.of[witness];
    const std::size_t witnesses = certificate_.witnesses.size();
    for (auto it = leaf.weights.rbegin(); it != leaf.weights.rend() && it->first >= witnesses;
         ++it) {
        const auto& pair = leaf.together[it->first - witnesses];
        if (is_seen(pair[0]) && is_seen(pair[1])) sum += it->second;
    }
    return sum;
}

std::int64_t GuardChecker::weightOf(const Leaf& leaf, const Part& part) const {
    std::vector<std::uint32_t> seen;
    for (const Cone& cone : part.cones) seen.push_back(cone.of);
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    int tries = 1000;
    return weightOf(leaf, std::move(seen), tries);
}

bool GuardChecker::isClear(const Cone& cone, const Convex& outline) const {
    if (cone.is_whole) return false;
    const auto is_beyond = [&](const Side2& side, Point2 end) {
        return std::all_of(outline.begin(), outline.end(),
                           [&](Point2 p) { return side.beyond(p) > blurAt(cone, end, p); });
    };
    return is_beyond(cone.rightSide(), cone.right) || is_beyond(cone.leftSide(), cone.left);
}

bool GuardChecker::cut(const Part& part, Part& inside, Part& outside, const Leaf& leaf) const {
    constexpr double kOff = 3;  // blurs, so that the outside is clear
    const Cone* best = nullptr;
    Side2 best_side;
    std::int64_t heaviest = -1;
    double deepest = 0;
    for (const Cone& cone : part.cones) {
        if (cone.is_whole || leaf.of[cone.of] < heaviest) continue;
        for (auto [side, end] :
             {std::pair(cone.rightSide(), cone.right), std::pair(cone.leftSide(), cone.left)}) {
            double off = 0, depth = 0;
            for (const Point2 p : part.outline) off = std::max(off, kOff * blurAt(cone, end, p));
            for (const Point2 p : part.outline) depth = std::max(depth, side.beyond(p) - off);
            if (depth <= off || (leaf.of[cone.of] == heaviest && depth <= deepest)) continue;
            side.at = side.at + off * side.outwards;
            best = &cone;
            best_side = side;
            heaviest = leaf.of[cone.of];
            deepest = depth;
        }
    }
    if (best == nullptr) return false;
    poses::divide(part.outline, best_side, inside.outline, &outside.outline);
    if (outside.outline.empty()) return false;
    for (Part* half : {&inside, &outside}) {
        half->cones.clear();
        if (half->outline.empty()) continue;
        for (const Cone& cone : part.cones)
            if (!isClear(cone, half->outline)) half->cones.push_back(cone);
    }
    return true;
}

/// Returns the largest weight that a point may see, or kUnit if it is less.
/// \param weight_of (part) bounds the weight that a point of it sees
template <typename Weight>
std::int64_t GuardChecker::heaviest(const Leaf& leaf, Part whole, std::size_t& cells,
                                    Weight weight_of) const {
    constexpr std::size_t kMostCells = 1'000'000;
    std::int64_t most = GuardCertificate::kUnit;
    std::erase_if(whole.cones, [&](const Cone& cone) {
        return leaf.of[cone.of] == 0 &&
               std::none_of(leaf.together.begin(), leaf.together.end(), [&](const auto& pair) {
                   return pair[0] == cone.of || pair[1] == cone.of;
               });
    });
    std::vector<Part> open;
    open.push_back(std::move(whole));
    while (!open.empty()) {
        const Part part = std::move(open.back());
        open.pop_back();
        ++cells;
        const std::int64_t weight = weight_of(part);
        if (weight <= most) continue;
        Part inside, outside;
        if (cells >= kMostCells || !cut(part, inside, outside, leaf)) {
            most = weight;
            continue;
        }
        if (!inside.outline.empty()) open.push_back(std::move(inside));
        open.push_back(std::move(outside));
    }
    return most;
}

double GuardChecker::missedBy(const Sights& sights) const {
    double missed = 0;
    for (std::size_t t = 0; t < sights.size(); ++t) {
        const PoseFloor::Corners corners = floor_.cornersOf(t);
        std::vector<Convex> open = {{corners.begin(), corners.end()}};
        for (const Cone& cone : sights[t]) {
            if (cone.is_whole) open.clear();
            std::vector<Convex> rest;
            for (Convex& piece : open)
                for (const Side2& side : {cone.rightSide(), cone.leftSide()}) {
                    Convex inside, outside;
                    poses::divide(piece, side, inside, &outside);
                    if (!outside.empty()) rest.push_back(std::move(outside));
                    piece = std::move(inside);
                }
            open = std::move(rest);
        }
        for (const Convex& piece : open) missed += poses::areaOf(piece);
    }
    return missed;
}

std::size_t GuardChecker::boundOf(const Leaves& leaves, const Sights& sights,
                                  std::size_t& cells) const {
    const std::size_t count = floor_.triangles().size();
    std::size_t bound = std::numeric_limits<std::size_t>::max();
    for (const Leaf& leaf : leaves) {
        std::vector<std::int64_t> most(count);
        std::vector<std::size_t> parts(count);
        tbb::parallel_for(std::size_t{0}, count, [&](std::size_t t) {
            const PoseFloor::Corners corners = floor_.cornersOf(t);
            most[t] = heaviest(leaf, {{corners.begin(), corners.end()}, sights[t]}, parts[t],
                               [&](const Part& part) { return weightOf(leaf, part); });
        });
        std::int64_t unit = GuardCertificate::kUnit, sum = 0;
        for (std::size_t t = 0; t < count; ++t) {
            unit = std::max(unit, most[t]);
            cells += parts[t];
        }
        for (const auto& weight : leaf.weights) sum += weight.second;
        bound = std::min(bound, static_cast<std::size_t>((sum + unit - 1) / unit));
    }
    return bound;
}

bool GuardChecker::areApart(const std::vector<Leaves>& trees, const Sights& sights,
                            std::size_t& cells) const {
    constexpr std::int64_t kUnit = GuardCertificate::kUnit;
    const std::size_t witnesses = certificate_.witnesses.size();
    std::vector<std::size_t> tree_of(witnesses, trees.size());
    Leaf all;
    all.of.assign(witnesses, 0);
    for (std::size_t i = 0; i < trees.size(); ++i)
        for (const Leaf& leaf : trees[i]) {
            std::vector<std::uint32_t> own;
            for (std::uint32_t witness = 0; witness < witnesses; ++witness)
                if (leaf.of[witness] > 0) own.push_back(witness);
            for (const auto& pair : leaf.together) own.insert(own.end(), pair.begin(), pair.end());
            for (const std::uint32_t witness : own) {
                if (tree_of[witness] != trees.size() && tree_of[witness] != i) return false;
                tree_of[witness] = i;
                all.of[witness] = 1;
            }
        }
    for (std::size_t t = 0; t < sights.size(); ++t) {
        const PoseFloor::Corners corners = floor_.cornersOf(t);
        const auto weight_of = [&](const Part& part) {
            const auto is_other = [&](const Cone& cone) {
                return tree_of[cone.of] != tree_of[part.cones.front().of];
            };
            return std::any_of(part.cones.begin(), part.cones.end(), is_other) ? kUnit + 1 : kUnit;
        };
        if (heaviest(all, {{corners.begin(), corners.end()}, sights[t]}, cells, weight_of) > kUnit)
            return false;
    }
    return true;
}

GuardCheck GuardChecker::check(std::span<const Point2> guards) {
    GuardCheck result;
    std::vector<Leaves> trees;
    for (const GuardCertificate::Tree& tree : certificate_.trees) {
        std::size_t at = 0;
        readLeaves(tree, at, {}, trees.emplace_back());
        if (at != tree.size()) refuse("more nodes than a tree has");
        result.leaves += trees.back().size();
    }
    result.trees = trees.size();
    const Sights sights = sightsFrom(certificate_.witnesses, true);
    const bool adds_up = trees.size() < 2 || areApart(trees, sights, result.cells);
    for (const Leaves& leaves : trees) {
        const std::size_t bound = boundOf(leaves, sights, result.cells);
        result.bound = adds_up ? result.bound + bound : std::max(result.bound, bound);
    }
    for (std::size_t t = 0; t < sights.size(); ++t) {
        const PoseFloor::Corners corners = floor_.cornersOf(t);
        result.area += poses::areaOf({corners.begin(), corners.end()});
    }
    result.missed = missedBy(sightsFrom(guards, false));
    return result;
}

}  // namespace

GuardCheck checkGuards(std::span<const Region> floor, std::span<const Point2> guards,
                       const GuardCertificate& certificate, const std::string& name) {
    return GuardChecker(floor, certificate, name).check(guards);
}

}  // namespace ispace
