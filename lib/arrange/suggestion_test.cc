// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/suggestion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/test_arrange.h"

namespace ispace {
namespace {

struct Advised {
    Scene scene;
    Coverage coverage;
    std::vector<Suggestion> suggestions;

    [[nodiscard]] const Suggestion* find(Suggestion::Kind kind) const {
        const auto found = std::find_if(suggestions.begin(), suggestions.end(),
                                        [kind](const Suggestion& one) { return one.kind == kind; });
        return found == suggestions.end() ? nullptr : &*found;
    }
};

Coverage coverageOf(const Scene& scene, const CoverageOptions& options) {
    Worlds worlds(scene.environment);
    return measureCoverage(scene, worlds, options);
}

Advised adviseOn(const std::string& room, const std::string& layout,
                 const std::vector<Requirement>& requirements = {}) {
    const Document placed = layoutFrom(layout);
    SuggestOptions options{.most = 7, .measure = {}, .requirements = requirements};
    options.measure.cells = CellSize{0.25};
    Scene scene = roomScene(room, &placed);
    Coverage coverage = coverageOf(scene, options.measure);
    SilentProgress silent;
    std::vector<Suggestion> found =
        suggestChanges(scene, coverage, options, DeviceCatalogue(), silent);
    for (const Suggestion& one : found) {
        const Scene after =
            makeScene(edited(scene.records, one.edits, sceneSchemas()), scene, DeviceCatalogue());
        const double share = *coverageOf(after, options.measure).report.coverage.exact;
        EXPECT_NEAR(one.share, share, 1e-12) << one.text;
        EXPECT_NEAR(one.gained,
                    (share - *coverage.report.coverage.exact) * coverage.report.indoor_area, 1e-9)
            << one.text;
    }
    return {std::move(scene), std::move(coverage), std::move(found)};
}

constexpr const char* kHall = "#env 1\nispace id=hall size=8,6,2.5\n";

TEST(Suggestions, TurnALaserThatFacesTheWall) {
    // A quarter disc of 3 m about a corner, all of it outside the room.
    const Advised advised =
        adviseOn(kHall, "laser id=l at=-3.99,-2.99 heading=-135 fov=90 range=3\n");
    const Suggestion* turn = advised.find(Suggestion::Kind::Turn);
    ASSERT_NE(turn, nullptr);
    ASSERT_EQ(turn->edits.size(), 1U);
    EXPECT_EQ(std::abs(turn->edits[0].angle.degrees()), 180);
    EXPECT_NEAR(turn->gained, std::acos(-1) * 9 / 4, 0.05) << "the whole sector";
    const Suggestion* add = advised.find(Suggestion::Kind::Add);
    ASSERT_NE(add, nullptr);
    EXPECT_NEAR(add->gained, std::acos(-1) * 9 / 4, 0.1);
}

TEST(Suggestions, RemoveADoubledLaser) {
    const Advised advised = adviseOn(kHall,
                                     "laser id=a at=0,0 fov=360 range=3\n"
                                     "laser id=b at=0,0.001 fov=360 range=3 cost=40\n");
    const Suggestion* remove = advised.find(Suggestion::Kind::Remove);
    ASSERT_NE(remove, nullptr);
    EXPECT_NEAR(remove->gained, 0, 0.01);
    EXPECT_LE(remove->gained, 0);
}

TEST(Suggestions, MoveTheCubeInFrontOfALaser) {
    const Advised advised =
        adviseOn(std::string(kHall) + "cube id=crate at=-2.5,0 size=0.8,0.8,1\n",
                 "laser id=l at=-3.9,0 heading=0 fov=120 range=5\n");
    const Suggestion* furniture = advised.find(Suggestion::Kind::Furniture);
    ASSERT_NE(furniture, nullptr);
    EXPECT_EQ(furniture->edits[0].text.substr(0, 6), "crate:");
    EXPECT_GT(furniture->gained, 0.5);
}

TEST(Suggestions, MeetARequirement) {
    const std::vector<Requirement> wanted = {parseRequirement("90%")};
    const Advised advised = adviseOn(kHall, "laser id=l at=-3,-2 fov=360 range=3\n", wanted);
    ASSERT_FALSE(advised.suggestions.empty());
    const Suggestion& together = advised.suggestions.front();
    EXPECT_EQ(together.kind, Suggestion::Kind::Together);
    EXPECT_GE(together.share, 0.9 - 1e-9);
    EXPECT_GE(together.edits.size(), 2U) << "two discs of 3 m have less than 90 % of 48 m2";
}

TEST(Suggestions, TellOneAdditionThatMeetsAllOnce) {
    const std::vector<Requirement> wanted = {parseRequirement("70%")};
    const Advised advised = adviseOn(kHall, "laser id=l at=-2,0 fov=360 range=3.2\n", wanted);
    ASSERT_FALSE(advised.suggestions.empty());
    EXPECT_EQ(advised.suggestions.front().kind, Suggestion::Kind::Together);
    EXPECT_EQ(advised.suggestions.front().edits.size(), 1U);
    for (std::size_t i = 1; i < advised.suggestions.size(); ++i)
        EXPECT_NE(advised.suggestions[i].text, advised.suggestions.front().text);
}

TEST(Suggestions, AddALaserToARoomWithOverAMillionCandidatesAtTheUsualStep) {
    const Advised advised = adviseOn("#env 1\nispace id=field size=300,300,3\n",
                                     "laser id=l at=100,100 fov=360 range=30\n");
    const Suggestion* add = advised.find(Suggestion::Kind::Add);
    ASSERT_NE(add, nullptr);
    EXPECT_NEAR(add->gained, std::acos(-1) * 900, 5);
}

TEST(Suggestions, AreNoneForASceneThatSeesAll) {
    const Advised advised = adviseOn(kHall, "laser id=l at=0,0 fov=360 range=20\n");
    EXPECT_TRUE(advised.suggestions.empty());
}

}  // namespace
}  // namespace ispace
