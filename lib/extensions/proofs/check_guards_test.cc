// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/proofs/check_guards.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "base/error.h"
#include "extensions/proofs/gallery/gallery.h"
#include "extensions/proofs/test_pose_floors.h"

namespace ispace::proofs {
namespace check_guards_test {

constexpr std::int64_t kUnit = GuardCertificate::kUnit;

GalleryCover coverOf(const Region& region) {
    SilentProgress silent;
    return guardGallery({&region, 1}, silent);
}

GuardCheck checkOf(const Region& region, const std::vector<Point2>& guards,
                   const GuardCertificate& certificate) {
    return checkGuards({&region, 1}, guards, certificate, "c");
}

/// Chvatal's comb, uneven so that lines of sight are generic.
Region unevenComb(int teeth) {
    Polygon outline = {{0, -0.3}, {2.0 * teeth, -0.37}};
    for (int i = teeth - 1; i >= 0; --i) {
        outline.push_back({2.0 * i + 1.41, 0});
        outline.push_back({2.0 * i + 0.5 + 0.05 * i, 5 + 0.1 * i});
        outline.push_back({2.0 * i + 0.13, 0.011 * i});
    }
    return {outline, {}};
}

/// A spiral around random corners, with pillars.
Region randomStar(int corners, unsigned seed, bool has_hole) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> far(2, 9);
    Region region;
    for (int i = 0; i < corners; ++i) {
        const double turn = 2 * std::numbers::pi * i / corners, reach = far(random);
        region.outline.push_back({reach * std::cos(turn), reach * std::sin(turn)});
    }
    if (has_hole) region.holes = {{{-0.4, -0.31}, {-0.37, 0.52}, {0.47, 0.44}, {0.33, -0.4}}};
    return region;
}

std::string refusalOf(const GuardCertificate& certificate) {
    try {
        checkOf(roomsWithPillar(), {}, certificate);
    } catch (const FormatError& error) {
        return error.what();
    }
    return "";
}

std::string refusalOf(const std::string& text) {
    try {
        readGuardCertificate(text, "c");
    } catch (const FormatError& error) {
        return error.what();
    }
    return "";
}

TEST(CheckGuards, ConfirmsProofs) {
    std::vector<Region> regions = {roomsWithPillar(), unevenComb(3), unevenComb(6)};
    for (unsigned seed = 1; seed <= 6; ++seed)
        regions.push_back(randomStar(12 + 6 * static_cast<int>(seed), seed, seed % 2 == 0));
    for (const Region& region : regions) {
        const GalleryCover cover = coverOf(region);
        const GuardCertificate made = certifyGuards(cover);
        EXPECT_EQ(made.bound, cover.bound);
        const GuardCheck check = checkOf(region, cover.guards, made);
        EXPECT_EQ(check.bound, cover.bound);
        EXPECT_NEAR(check.area, region.area(), 1e-9 * region.area());
        EXPECT_LE(check.missed, kMissedShare * check.area);
        // Without one of the guards, floor is missed, as much as another union says.
        std::vector<Point2> fewer = cover.guards;
        fewer.pop_back();
        EXPECT_GT(checkOf(region, fewer, made).missed, kMissedShare * check.area);
    }
}

TEST(CheckGuards, MeasuresMissedFloor) {
    const Region region = roomsWithPillar();
    const SeenAreas areas(region, {99, 7, 0});
    const GuardCertificate none;
    std::mt19937 random(2);
    std::uniform_real_distribution<double> x(0, 11), y(0, 5);
    for (int i = 0; i < 50; ++i) {
        std::vector<Point2> guards;
        std::vector<Pose2> poses;
        while (guards.size() < 2) {
            const Point2 at{x(random), y(random)};
            if (region.locate(at) != Side::Inside) continue;
            guards.push_back(at);
            poses.push_back({at, Angle()});
        }
        EXPECT_NEAR(checkOf(region, guards, none).missed, region.area() - areas.of(poses, 1), 1e-6);
    }
}

TEST(CheckGuards, FollowsPairs) {
    // A ring of five witnesses, of which a point sees two neighbours.
    const GalleryCover cover{.guards = {},
                             .missed = 0,
                             .bound = 3,
                             .witnesses = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}},
                             .sets = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {0, 4}},
                             .candidates = 0,
                             .rounds = 0,
                             .is_complete = true};
    const GuardCertificate made = certifyGuards(cover);
    EXPECT_EQ(made.bound, 3U);  // two and a half, rounded up
    EXPECT_EQ(weaknessOf(made, 3), "");
    EXPECT_EQ(weaknessOf(made, 4),
              "the certificate proves that 3 sensors are needed, not 4: more would take too many "
              "branches");
    GalleryCover seven = cover;
    // All sets of 4 of 7: fractional covers of 7/4, but two such sets of Fano's plane do not do.
    seven.bound = 3;
    seven.witnesses.clear();
    for (int i = 0; i < 7; ++i) seven.witnesses.push_back({static_cast<double>(i), 0});
    seven.sets = {{0, 1, 3, 5}, {0, 2, 3, 6}, {0, 4, 5, 6}, {1, 2, 5, 6},
                  {1, 3, 4, 6}, {2, 3, 4, 5}, {0, 1, 2, 4}};
    const GuardCertificate branched = certifyGuards(seven);
    EXPECT_EQ(branched.bound, 3U);
    ASSERT_EQ(branched.trees.size(), 1U);
    EXPECT_GT(branched.trees[0].size(), 1U);
    // In a room of which a point sees one of them, the branches hold as well.
    const Region comb = unevenComb(7);
    for (std::size_t i = 0; i < 7; ++i) seven.witnesses[i] = comb.outline[3 + 3 * i];
    GuardCertificate real = certifyGuards(seven);
    ASSERT_GT(real.trees[0].size(), 1U);
    const GuardCheck check = checkOf(comb, {}, real);
    EXPECT_EQ(check.bound, 3U);
    EXPECT_GT(check.leaves, 1U);
    // Where a point sees all, they prove a single one.
    for (std::size_t i = 0; i < 7; ++i)
        real.witnesses[i] = {1.0 + 0.1 * static_cast<double>(i), -0.1};
    real.bound = 1;
    EXPECT_EQ(checkOf(comb, {}, real).bound, 1U);
}

TEST(CheckGuards, TooLargeClaimsAreNotConfirmed) {
    const Region region = roomsWithPillar();
    const GalleryCover cover = coverOf(region);
    GuardCertificate made = certifyGuards(cover);
    ASSERT_TRUE(made.trees[0][0].is_leaf);
    // Heavier weights, a tree twice, and another witness beside one that is seen with it.
    for (auto& tree : made.trees)
        for (auto& [row, weight] : tree[0].weights) weight = kUnit;
    EXPECT_LE(checkOf(region, cover.guards, made).bound, cover.bound);
    made.trees.push_back(made.trees[0]);
    EXPECT_LE(checkOf(region, cover.guards, made).bound, cover.bound);
    GuardCertificate doubled = certifyGuards(cover);
    const auto added = static_cast<std::uint32_t>(doubled.witnesses.size());
    doubled.witnesses.push_back(doubled.witnesses[doubled.trees[0][0].weights[0].first]);
    doubled.trees[0][0].weights.emplace_back(added, kUnit);
    EXPECT_LE(checkOf(region, cover.guards, doubled).bound, cover.bound);
    // A branch that supposes that no point sees two witnesses leaves the other one to prove.
    GuardCertificate split;
    split.witnesses = {{1, 1}, {1.5, 1}};
    split.trees = {
        {{false, {0, 1}, {}}, {true, {}, {{2, kUnit}}}, {true, {}, {{0, kUnit}, {1, kUnit}}}}};
    EXPECT_EQ(checkOf(region, {}, split).bound, 1U);
    std::swap(split.trees[0][1], split.trees[0][2]);

    EXPECT_NE(refusalOf(split).find("no pair"), std::string::npos);
}

TEST(CheckGuards, TreesThatShareAPointDoNotAddUp) {
    GuardCertificate shared;
    shared.witnesses = {{1, 1}, {1.5, 1}};
    shared.trees = {{{true, {}, {{0, kUnit}}}}, {{true, {}, {{1, kUnit}}}}};
    EXPECT_EQ(checkOf(roomsWithPillar(), {}, shared).bound, 1U);
    shared.bound = 2;
    EXPECT_LT(checkOf(roomsWithPillar(), {}, shared).bound, 2U);
    // In two rooms of the comb they do.
    const Region comb = unevenComb(3);
    shared.witnesses = {comb.outline[3], comb.outline[6]};
    EXPECT_EQ(checkOf(comb, {}, shared).bound, 2U);
}

TEST(CheckGuards, StopsAtALeafThatProvesTooFew) {
    GuardCertificate weak;
    weak.bound = 2;
    weak.witnesses = {{1, 1}, {1.5, 1}};
    const GuardCertificate::Node leaf{true, {}, {{0, kUnit}, {1, kUnit}}};
    weak.trees = {{{false, {0, 1}, {}}, leaf, leaf}};
    const GuardCheck check = checkOf(roomsWithPillar(), {}, weak);
    EXPECT_EQ(check.bound, 0U);
    EXPECT_GT(check.cells, 0U);
    // Less weight than the bound takes is not followed at all.
    weak.trees = {{{true, {}, {{0, kUnit}}}}};
    EXPECT_EQ(checkOf(roomsWithPillar(), {}, weak).cells, 0U);
}

TEST(CheckGuards, RefusesFloorInTooManyParts) {
    const Region comb = unevenComb(20);
    const auto refusal = [&comb](const GuardCertificate& certificate) {
        try {
            checkOf(comb, {}, certificate);
        } catch (const FormatError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    // Many witnesses in the shaft of the comb, of which a point sees many.
    GuardCertificate many;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> x(0.1, 39), y(-0.29, -0.01);
    GuardCertificate::Node leaf;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        many.witnesses.push_back({x(random), y(random)});
        leaf.weights.emplace_back(i, kUnit / 1000);
    }
    many.trees = {{leaf}};
    EXPECT_NE(refusal(many).find("too many parts"), std::string::npos);
    // The budget is that of all leaves.
    GuardCertificate deep;
    for (std::uint32_t i = 0; i < 41; ++i) deep.witnesses.push_back(comb.outline[i]);
    leaf.weights.clear();
    for (std::uint32_t i = 0; i < 41; ++i) leaf.weights.emplace_back(i, kUnit - 1);
    deep.trees.emplace_back();
    const auto grow = [&](const auto& self, std::uint32_t depth) -> void {
        const bool is_leaf = depth == 14;
        deep.trees[0].push_back(is_leaf ? leaf : GuardCertificate::Node{false, {0, depth + 1}, {}});
        if (is_leaf) return;
        self(self, depth + 1);
        self(self, depth + 1);
    };
    grow(grow, 0);
    EXPECT_NE(refusal(deep).find("too many parts"), std::string::npos);
    GuardCertificate wide;
    wide.witnesses.assign(1'000'000, {1, -0.1});
    EXPECT_NE(refusal(wide).find("too many"), std::string::npos);
}

TEST(CheckGuards, RefusesTreesThatAreNone) {
    const GuardCertificate::Node split{false, {0, 1}, {}}, leaf;
    const std::vector<Point2> two = {{1, 1}, {2, 1}};
    EXPECT_EQ(refusalOf(GuardCertificate{1, two, {{split, leaf, leaf}}}), "");
    EXPECT_NE(refusalOf(GuardCertificate{1, two, {{split, leaf}}}).find("ends early"),
              std::string::npos);
    EXPECT_NE(refusalOf(GuardCertificate{1, two, {{leaf, leaf}}}).find("more nodes"),
              std::string::npos);
    EXPECT_NE(refusalOf(GuardCertificate{1, {{1, 1}}, {{split, leaf, leaf}}}).find("no witnesses"),
              std::string::npos);
    EXPECT_NE(refusalOf(GuardCertificate{1, {{-1, 1}}, {{leaf}}}).find("not on the floor"),
              std::string::npos);
}

TEST(CheckGuards, TextSurvivesWritingAndReading) {
    const GuardCertificate made = certifyGuards(coverOf(unevenComb(4)));
    const std::string text = certificateText(made, {"arrange a.env"});
    EXPECT_TRUE(isOfGuards(text));
    EXPECT_FALSE(isOfGuards("#certificate 1\nbound 3\n"));
    EXPECT_EQ(certificateText(readGuardCertificate(text, "c"), {"arrange a.env"}), text);
    const std::string head = "#certificate 1\nguards 2\nwitnesses\n0 1\n";
    EXPECT_EQ(refusalOf(head + "tree\nleaf 0:5\n"), "");
    for (const char* wrong :
         {"tree\nleaf 0\n", "tree\nleaf 0:0\n", "tree\nleaf 1:2 0:3\n", "tree\npair 0\n",
          "tree\npair 0 0\n", "tree\npair 0 1 2\n", "0 x\n", "tree\nleaf 0:1000000001\n",
          "tree\nleaf 0:5\nend\n", "leaf 0:5\n", "0 inf\n"})
        EXPECT_NE(refusalOf(head + wrong), "") << wrong;
    EXPECT_NE(refusalOf(std::string("#certificate 1\nbound 3\n")), "");
    EXPECT_NE(refusalOf(std::string("guards 3\n")), "");
    // Certificates that prove no guards.
    EXPECT_NE(refusalOf(head).find("proves no guards"), std::string::npos);
    EXPECT_NE(
        refusalOf("#certificate 1\nguards 0\nwitnesses\n0 1\ntree\nleaf 0:5\n").find("at least 1"),
        std::string::npos);
}

}  // namespace check_guards_test
}  // namespace ispace::proofs
