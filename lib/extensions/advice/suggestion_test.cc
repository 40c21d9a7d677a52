// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/advice/suggestion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "support/test_arrange.h"

namespace ispace::advice {
namespace suggestion_test {

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
    RayScenes worlds(scene.environment);
    return measureCoverage(scene, worlds, options);
}

/// Measures the rules of a scene afresh.
bool meetsRules(const Scene& scene, const SuggestOptions& options) {
    const Coverage coverage = coverageOf(scene, options.measure);
    const auto is_met = [](const auto& result) { return isMet(result); };
    const auto faces = camerarules::measureFacing(scene, coverage, options.facing);
    const auto zones = camerarules::measurePrivacy(scene, options.measure.plane, options.privacy);
    return std::all_of(faces.begin(), faces.end(), is_met) &&
           std::all_of(zones.begin(), zones.end(), is_met) &&
           std::all_of(
               options.requirements.begin(), options.requirements.end(),
               [&](const Requirement& one) { return checkRequirement(one, coverage).is_met; });
}

Advised adviseOn(const std::string& room, const std::string& layout, SuggestOptions options = {}) {
    const Document placed = layoutFrom(layout);
    options.most = 7;
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
        if (one.kind == Suggestion::Kind::Together) {
            EXPECT_TRUE(meetsRules(after, options)) << one.text;
        }
        EXPECT_GE(one.required, 0) << one.text;
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
    // Stairs and chimneys of a building model reach the ceiling.
    const Advised built_in =
        adviseOn(std::string(kHall) + "cube id=stairs at=-2.5,0 size=0.8,0.8,9\n",
                 "laser id=l at=-3.9,0 heading=0 fov=120 range=5\n");
    EXPECT_EQ(built_in.find(Suggestion::Kind::Furniture), nullptr);
}

TEST(Suggestions, MeetARequirement) {
    const SuggestOptions wanted{.requirements = {parseRequirement("90%")}};
    const Advised advised = adviseOn(kHall, "laser id=l at=-3,-2 fov=360 range=3\n", wanted);
    ASSERT_FALSE(advised.suggestions.empty());
    const Suggestion& together = advised.suggestions.front();
    EXPECT_EQ(together.kind, Suggestion::Kind::Together);
    EXPECT_GE(together.share, 0.9 - 1e-9);
    EXPECT_GE(together.edits.size(), 2U) << "two discs of 3 m have less than 90 % of 48 m2";
}

TEST(Suggestions, TellOneAdditionThatMeetsAllOnce) {
    const SuggestOptions wanted{.requirements = {parseRequirement("70%")}};
    const Advised advised = adviseOn(kHall, "laser id=l at=-2,0 fov=360 range=3.2\n", wanted);
    ASSERT_FALSE(advised.suggestions.empty());
    EXPECT_EQ(advised.suggestions.front().kind, Suggestion::Kind::Together);
    EXPECT_EQ(advised.suggestions.front().edits.size(), 1U);
    for (std::size_t i = 1; i < advised.suggestions.size(); ++i)
        EXPECT_NE(advised.suggestions[i].text, advised.suggestions.front().text);
}

const std::string kZones = std::string(kHall) +
                           "zone id=door path=-1,-1;1,-1;1,1;-1,1\n"
                           "zone id=desk path=3,-3;4,-3;4,-2;3,-2\n";

/// Looks down and sees the floor within a metre and a half.
std::string eyeAt(const std::string& id, const std::string& at) {
    return "camera id=" + id + " at=" + at +
           ",2.4 tilt=-90 projection=omni fov=90 pixels=2000,2000 range=30\n";
}

TEST(Suggestions, MendFacesByOneCameraAhead) {
    // People walk east, and the only camera stands west of the zone. One ahead sees each face: the
    // zone is 2 m long and an eye sees 2.4 m about its foot, so a foot on the east edge suffices
    // for the half of the zone within 2.4 m and 90 degrees.
    const SuggestOptions wanted{.facing = {camerarules::parseFacing("door,90deg,0=70%")}};
    const Advised advised = adviseOn(kZones, eyeAt("w", "-2.5,0"), wanted);
    ASSERT_FALSE(advised.suggestions.empty());
    const Suggestion& first = advised.suggestions.front();
    EXPECT_EQ(first.kind, Suggestion::Kind::Together);
    ASSERT_EQ(first.edits.size(), 1U) << first.text;
    EXPECT_EQ(first.edits[0].kind, Edit::Kind::Add);
    EXPECT_NEAR(first.required, 0.7 * 4, 1e-6) << "no face is seen before";
    // Without the share there is no requirement.
    const SuggestOptions told{.facing = {camerarules::parseFacing("door,90deg,0")}};
    for (const Suggestion& one : adviseOn(kZones, eyeAt("w", "-2.5,0"), told).suggestions)
        EXPECT_EQ(one.required, 0) << one.text;
}

TEST(Suggestions, MendFacesOfBothDirectionsByTwoCameras) {
    const SuggestOptions wanted{.facing = {camerarules::parseFacing("door,60deg,0=60%"),
                                           camerarules::parseFacing("door,60deg,180=60%")}};
    const Advised advised = adviseOn(kZones, eyeAt("n", "0,2.9"), wanted);
    ASSERT_FALSE(advised.suggestions.empty());
    const Suggestion& first = advised.suggestions.front();
    EXPECT_EQ(first.kind, Suggestion::Kind::Together);
    // A point is faced in one of the directions only, so no camera serves both.
    EXPECT_EQ(first.edits.size(), 2U) << first.text;
}

TEST(Suggestions, TurnACameraOffAPrivateZone) {
    // The picture is 60 degrees wide; the zone's corners lie within -37 and -18 degrees.
    const SuggestOptions wanted{.privacy = {camerarules::parsePrivacy("desk")}};
    const Advised advised = adviseOn(
        kZones, "camera id=c at=-3.9,2.9,2.2 heading=-40 tilt=-30 fov=60 pixels=1280,720\n",
        wanted);
    ASSERT_FALSE(advised.suggestions.empty());
    const Suggestion& first = advised.suggestions.front();
    EXPECT_EQ(first.kind, Suggestion::Kind::Together);
    EXPECT_EQ(first.edits.size(), 1U) << first.text;
}

TEST(Suggestions, RemoveADomeThatSeesAPrivateZone) {
    const SuggestOptions wanted{.requirements = {parseRequirement("20%")},
                                .privacy = {camerarules::parsePrivacy("desk")}};
    const Advised advised = adviseOn(kZones, eyeAt("e", "3.5,-2.5"), wanted);
    ASSERT_FALSE(advised.suggestions.empty());
    const Suggestion& first = advised.suggestions.front();
    EXPECT_EQ(first.kind, Suggestion::Kind::Together);
    EXPECT_NEAR(first.required, 1 + 0.2 * 48 - *advised.coverage.report.coverage.exact * 48, 1e-6)
        << "the zone is 1 m2, and the hall 48";
}

TEST(Suggestions, KeepPrivacyWhereItIsKept) {
    const SuggestOptions wanted{.privacy = {camerarules::parsePrivacy("desk")}};
    // Without the rule the best change of each kind sees the zone, in the corner that is unseen.
    const std::string seers = eyeAt("a", "-1.5,0") + eyeAt("b", "1.2,0");
    EXPECT_TRUE(meetsRules(roomScene(kZones + seers), wanted));
    const auto sees = [&](const Advised& advised) {
        return std::any_of(
            advised.suggestions.begin(), advised.suggestions.end(), [&](const Suggestion& one) {
                const Scene after =
                    makeScene(edited(advised.scene.records, one.edits, sceneSchemas()),
                              advised.scene, DeviceCatalogue());
                return !meetsRules(after, wanted);
            });
    };
    EXPECT_TRUE(sees(adviseOn(kZones, seers)));
    EXPECT_FALSE(sees(adviseOn(kZones, seers, wanted)));
}

TEST(Suggestions, AddALaserToARoomWithOverAMillionCandidatesAtTheUsualStep) {
    const Advised advised = adviseOn("#env 1\nispace id=field size=300,300,3\n",
                                     "laser id=l at=100,100 fov=360 range=30\n");
    const Suggestion* add = advised.find(Suggestion::Kind::Add);
    ASSERT_NE(add, nullptr);
    EXPECT_NEAR(add->gained, std::acos(-1) * 900, 5);
}

TEST(Suggestions, AddASensorWithAWideViewToAHallInSeconds) {
    // Some 20 000 sites with a view of 40 000 cells each would take minutes.
    const Advised hall =
        adviseOn("#env 1\nispace size=40,30\nwall from=0,-15 to=0,13\n",
                 "ranger id=d at=-10,0,2 fov=360,180 range=30 projection=spherical\n");
    const Suggestion* const added = hall.find(Suggestion::Kind::Add);
    ASSERT_NE(added, nullptr);
    EXPECT_GT(added->share, 0.99) << added->text;  // the half behind the wall
}

TEST(Suggestions, AreNoneForASceneThatSeesAll) {
    const Advised advised = adviseOn(kHall, "laser id=l at=0,0 fov=360 range=20\n");
    EXPECT_TRUE(advised.suggestions.empty());
}

/// Says stop after some suggestions were measured.
class StopsAfter final : public Progress {
  public:
    explicit StopsAfter(int most) : most_(most) {}
    void begin(std::string_view /*phase*/, std::int64_t /*total*/) override {}
    void advance(std::int64_t count) override { done_ += count; }
    void end() override {}
    [[nodiscard]] bool stopped() const override { return done_ >= most_; }

  private:
    std::int64_t most_, done_ = 0;
};

TEST(SuggestChanges, EndAtOnceAfterAStop) {
    const Document placed = layoutFrom("laser at=-3,-2 range=2\nlaser at=2,1 range=2\n");
    const Scene scene = roomScene("#env 1\nispace size=8,6\ncube at=0,0 size=1\n", &placed);
    SuggestOptions options;
    options.measure.cells = CellSize{0.25};
    const Coverage coverage = coverageOf(scene, options.measure);
    SilentProgress silent;
    const auto all = suggestChanges(scene, coverage, options, DeviceCatalogue(), silent);
    EXPECT_GE(all.size(), 3U);
    StopsAfter at_once(0), later(2);
    EXPECT_TRUE(suggestChanges(scene, coverage, options, DeviceCatalogue(), at_once).empty());
    EXPECT_LT(suggestChanges(scene, coverage, options, DeviceCatalogue(), later).size(),
              all.size());
}

}  // namespace suggestion_test
}  // namespace ispace::advice
