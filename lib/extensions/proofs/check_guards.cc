// SPDX-License-Identifier: GPL-3.0-or-later
// Checks that no point of the floor sees more weight of witnesses than a unit. The floor is cut
// into convex parts along cones of witnesses, the heaviest first, until in each part the witnesses
// whose cones may meet it weigh no more. Tests err to one side: a cone counts unless it is clear of
// the part by more than its blur, which bounds all roundings. So a valid proof may be refused for
// its size, but no wrong one passes.
#include "extensions/proofs/check_guards.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include "extensions/proofs/guard_cones.h"

namespace ispace::proofs {

namespace {

using poses::Convex;
using poses::Side2;

/// Most visits of cones by parts of the floor in a check, in all.
constexpr std::size_t kMaxVisits = 12'000'000;

class GuardChecker {
  public:
    GuardChecker(std::span<const Region> floor, const GuardCertificate& certificate,
                 const std::string& name)
        : floor_(floor, name), certificate_(certificate) {}

    GuardCheck check(std::span<const Point2> guards);

  private:
    using Rows = std::vector<std::pair<std::uint32_t, std::int64_t>>;
    using Pairs = std::vector<std::array<std::uint32_t, 2>>;
    /// A leaf, and the pairs on the path to it.
    struct Leaf {
        Rows weights;
        Pairs together, apart;
        std::vector<std::int64_t> of = {};  // by witness; empty but while the leaf is checked
    };
    /// A convex part of a triangle, with the cones that may meet it.
    struct Part {
        Convex outline;
        std::vector<const GuardCone*> cones;
    };

    /// Counts visits of cones.
    void visit(std::size_t cones) const {
        if ((visits_ += cones) > kMaxVisits)
            floor_.refuse("its leaves divide the floor into too many parts: give fewer witnesses");
    }
    void readLeaves(const GuardCertificate::Tree& tree, std::size_t& at, Leaf path,
                    std::vector<Leaf>& leaves) const;
    using Leaves = std::vector<Leaf>;  // of a tree
    /// Returns the number of points that a tree proves if no point sees more than kUnit.
    [[nodiscard]] static std::size_t claimOf(const Leaves& leaves);
    /// Returns the number of points that a tree proves, 0 if that is less than `least`.
    std::size_t boundOf(const Leaves& leaves, const GuardCones& sights, std::size_t least,
                        std::size_t& cells) const;
    /// Returns the number of points that all trees prove, 0 if that is less than stated.
    std::size_t boundOf(const std::vector<Leaves>& trees, const GuardCones& sights,
                        std::size_t& cells) const;
    /// True if no point sees witnesses of two trees.
    bool areApart(const std::vector<Leaves>& trees, const GuardCones& sights,
                  std::size_t& cells) const;
    /// Returns the largest weight of witnesses and pairs that a point of the part may see.
    /// \param tries of subsets without a pair that is apart; once they are used up, more is
    /// returned
    [[nodiscard]] std::int64_t weightOf(const Leaf& leaf, std::vector<std::uint32_t> seen,
                                        int& tries) const;
    [[nodiscard]] std::int64_t weightOf(const Leaf& leaf, const Part& part) const;
    [[nodiscard]] bool isClear(const GuardCone& cone, const Convex& outline) const;
    /// Cuts a part by a line of a cone; returns false if that leaves it whole.
    bool cut(const Part& part, Part& inside, Part& outside, const Leaf& leaf) const;
    template <typename Weight>
    std::int64_t heaviest(const Leaf& leaf, std::size_t triangle, const GuardCones& sights,
                          std::size_t& cells, Weight weight_of) const;

    GuardFloor floor_;
    const GuardCertificate& certificate_;
    mutable std::atomic<std::size_t> visits_ = 0;
};

void GuardChecker::readLeaves(const GuardCertificate::Tree& tree, std::size_t& at, Leaf path,
                              std::vector<Leaf>& leaves) const {
    constexpr std::size_t kMaxDepth = 32;
    if (at == tree.size()) floor_.refuse("a tree ends early");
    const GuardCertificate::Node& node = tree[at++];
    const std::size_t witnesses = certificate_.witnesses.size();
    if (node.is_leaf) {
        path.weights = node.weights;
        if (!node.weights.empty() && node.weights.back().first >= witnesses + path.together.size())
            floor_.refuse("a leaf gives a weight to no witness and no pair");
        leaves.push_back(std::move(path));
        return;
    }
    if (std::max(node.pair[0], node.pair[1]) >= witnesses) floor_.refuse("a pair of no witnesses");
    if (path.together.size() + path.apart.size() == kMaxDepth)
        floor_.refuse("the tree is too deep");
    Leaf together = path;
    together.together.push_back(node.pair);
    readLeaves(tree, at, std::move(together), leaves);
    path.apart.push_back(node.pair);
    readLeaves(tree, at, std::move(path), leaves);
}

std::int64_t GuardChecker::weightOf(const Leaf& leaf, std::vector<std::uint32_t> seen,
                                    int& tries) const {
    visit(seen.size() / 4 + leaf.apart.size() + leaf.together.size());
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
    for (const GuardCone* cone : part.cones) seen.push_back(cone->of);
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    int tries = 1000;
    return weightOf(leaf, std::move(seen), tries);
}

bool GuardChecker::isClear(const GuardCone& cone, const Convex& outline) const {
    if (cone.is_whole) return false;
    const auto is_beyond = [&](const Side2& side, Point2 end) {
        return std::all_of(outline.begin(), outline.end(),
                           [&](Point2 p) { return side.beyond(p) > floor_.blurAt(cone, end, p); });
    };
    return is_beyond(cone.rightSide(), cone.right) || is_beyond(cone.leftSide(), cone.left);
}

bool GuardChecker::cut(const Part& part, Part& inside, Part& outside, const Leaf& leaf) const {
    constexpr double kOff = 3;  // blurs, so that the outside is clear
    const GuardCone* best = nullptr;
    Side2 best_side;
    std::int64_t heaviest = -1;
    double deepest = 0;
    for (const GuardCone* of_part : part.cones) {
        const GuardCone& cone = *of_part;
        if (cone.is_whole || leaf.of[cone.of] < heaviest) continue;
        for (auto [side, end] :
             {std::pair(cone.rightSide(), cone.right), std::pair(cone.leftSide(), cone.left)}) {
            double off = 0, depth = 0;
            for (const Point2 p : part.outline)
                off = std::max(off, kOff * floor_.blurAt(cone, end, p));
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
        for (const GuardCone* cone : part.cones)
            if (!isClear(*cone, half->outline)) half->cones.push_back(cone);
    }
    return true;
}

/// Returns the largest weight that a point of a triangle may see, or kUnit if it is less.
/// \param weight_of (part) bounds the weight that a point of it sees
template <typename Weight>
std::int64_t GuardChecker::heaviest(const Leaf& leaf, std::size_t triangle,
                                    const GuardCones& sights, std::size_t& cells,
                                    Weight weight_of) const {
    std::int64_t most = GuardCertificate::kUnit;
    Part whole{floor_.outlineOf(triangle), {}};
    visit(sights[triangle].size() / 4 + 1);
    for (const GuardCone& cone : sights[triangle])
        if (leaf.of[cone.of] != 0 ||
            std::any_of(leaf.together.begin(), leaf.together.end(),
                        [&](const auto& pair) { return pair[0] == cone.of || pair[1] == cone.of; }))
            whole.cones.push_back(&cone);
    std::vector<Part> open;
    open.push_back(std::move(whole));
    while (!open.empty()) {
        const Part part = std::move(open.back());
        open.pop_back();
        ++cells;
        visit(part.cones.size() + 1);
        const std::int64_t weight = weight_of(part);
        if (weight <= most) continue;
        Part inside, outside;
        if (!cut(part, inside, outside, leaf)) {
            most = weight;
            continue;
        }
        if (!inside.outline.empty()) open.push_back(std::move(inside));
        open.push_back(std::move(outside));
    }
    return most;
}

std::size_t GuardChecker::claimOf(const Leaves& leaves) {
    std::size_t claim = std::numeric_limits<std::size_t>::max();
    for (const Leaf& leaf : leaves) {
        std::int64_t sum = GuardCertificate::kUnit - 1;
        for (const auto& weight : leaf.weights) sum += weight.second;
        claim = std::min(claim, static_cast<std::size_t>(sum / GuardCertificate::kUnit));
    }
    return claim;
}

std::size_t GuardChecker::boundOf(const Leaves& leaves, const GuardCones& sights, std::size_t least,
                                  std::size_t& cells) const {
    const std::size_t count = floor_.triangles();
    std::size_t bound = std::numeric_limits<std::size_t>::max();
    for (const Leaf& packed : leaves) {
        Leaf leaf = packed;
        visit(certificate_.witnesses.size() / 16);
        leaf.of.assign(certificate_.witnesses.size(), 0);
        for (const auto& [row, weight] : leaf.weights)
            if (row < leaf.of.size()) leaf.of[row] = weight;
        std::vector<std::int64_t> most(count);
        std::vector<std::size_t> parts(count);
        tbb::parallel_for(std::size_t{0}, count, [&](std::size_t t) {
            most[t] = heaviest(leaf, t, sights, parts[t],
                               [&](const Part& part) { return weightOf(leaf, part); });
        });
        std::int64_t unit = GuardCertificate::kUnit, sum = 0;
        for (std::size_t t = 0; t < count; ++t) {
            unit = std::max(unit, most[t]);
            cells += parts[t];
        }
        for (const auto& weight : leaf.weights) sum += weight.second;
        bound = std::min(bound, static_cast<std::size_t>((sum + unit - 1) / unit));
        if (bound < least) return 0;
    }
    return bound;
}

std::size_t GuardChecker::boundOf(const std::vector<Leaves>& trees, const GuardCones& sights,
                                  std::size_t& cells) const {
    const std::size_t stated = certificate_.bound;
    std::size_t most = 0, claimed = 0;
    for (const Leaves& leaves : trees) {
        most = std::max(most, claimOf(leaves));
        claimed += claimOf(leaves);
    }
    if (claimed < stated) return 0;
    if (trees.size() > 1 && !areApart(trees, sights, cells)) {
        std::size_t bound = 0;
        for (std::size_t i = 0; i < trees.size() && most >= stated; ++i)
            bound = std::max(bound, boundOf(trees[i], sights, stated, cells));
        return bound;
    }
    for (const Leaves& leaves : trees) {  // `claimed` becomes the bound, tree by tree
        claimed -= claimOf(leaves);
        const std::size_t least = stated > claimed ? stated - claimed : 0;
        const std::size_t bound = boundOf(leaves, sights, least, cells);
        if (bound < least) return 0;
        claimed += bound;
    }
    return claimed;
}

bool GuardChecker::areApart(const std::vector<Leaves>& trees, const GuardCones& sights,
                            std::size_t& cells) const {
    constexpr std::int64_t kUnit = GuardCertificate::kUnit;
    const std::size_t witnesses = certificate_.witnesses.size();
    std::vector<std::size_t> tree_of(witnesses, trees.size());
    Leaf all;
    all.of.assign(witnesses, 0);
    for (std::size_t i = 0; i < trees.size(); ++i)
        for (const Leaf& leaf : trees[i]) {
            std::vector<std::uint32_t> own;
            for (const auto& weight : leaf.weights)
                if (weight.first < witnesses) own.push_back(weight.first);
            for (const auto& pair : leaf.together) own.insert(own.end(), pair.begin(), pair.end());
            for (const std::uint32_t witness : own) {
                if (tree_of[witness] != trees.size() && tree_of[witness] != i) return false;
                tree_of[witness] = i;
                all.of[witness] = 1;
            }
        }
    for (std::size_t t = 0; t < sights.size(); ++t) {
        const auto weight_of = [&](const Part& part) {
            const auto is_other = [&](const GuardCone* cone) {
                return tree_of[cone->of] != tree_of[part.cones.front()->of];
            };
            return std::any_of(part.cones.begin(), part.cones.end(), is_other) ? kUnit + 1 : kUnit;
        };
        if (heaviest(all, t, sights, cells, weight_of) > kUnit) return false;
    }
    return true;
}

GuardCheck GuardChecker::check(std::span<const Point2> guards) {
    GuardCheck result;
    std::vector<Leaves> trees;
    for (const GuardCertificate::Tree& tree : certificate_.trees) {
        std::size_t at = 0;
        readLeaves(tree, at, {}, trees.emplace_back());
        if (at != tree.size()) floor_.refuse("more nodes than a tree has");
        result.leaves += trees.back().size();
    }
    result.trees = trees.size();
    const GuardCones sights = floor_.conesFrom(certificate_.witnesses, true);
    result.bound = boundOf(trees, sights, result.cells);
    for (std::size_t t = 0; t < sights.size(); ++t)
        result.area += poses::areaOf(floor_.outlineOf(t));
    result.missed = floor_.missedBy(floor_.conesFrom(guards, false));
    return result;
}

}  // namespace

GuardCheck checkGuards(std::span<const Region> floor, std::span<const Point2> guards,
                       const GuardCertificate& certificate, const std::string& name) {
    return GuardChecker(floor, certificate, name).check(guards);
}

}  // namespace ispace::proofs
