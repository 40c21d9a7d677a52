// SPDX-License-Identifier: GPL-3.0-or-later
// arrange --facing and --privacy: layouts against the exact rules of coverage.
#include <gtest/gtest.h>

#include <algorithm>

#include "extensions/camerarules/facing_cells.h"
#include "extensions/camerarules/layout_privacy.h"
#include "support/test_arrange.h"

namespace ispace::camerarules {
namespace arrange_rules_test {

const std::string kOffice =
    "#env 1\n"
    "fence id=f path=-4,-3;4,-3;4,3;-4,3 closed=yes height=2.5\n"
    "door id=north from=-2.5,3 to=-1.5,3\n"
    "zone id=entrance path=-3,1;-1,1;-1,2.95;-3,2.95\n"
    "zone id=desk1 path=2,-2.5;3,-2.5;3,-1.5;2,-1.5\n"
    "zone id=slot path=0.01,-0.02;0.04,-0.02;0.04,0.02;0.01,0.02\n";

Arrangement camerasIn(const Scene& scene, const ArrangeOptions& options,
                      std::initializer_list<const char*> cameras = {"camera:2"}) {
    return arranged(scene, groupsOf(scene, cameras), options);
}

std::vector<PrivacyResult> privacyOf(const Scene& scene, const Arrangement& found,
                                     const std::vector<PrivacyRule>& rules) {
    return measurePrivacy(withPlaced(scene, groupsOf(scene, {"camera:2"}), found.sensors), 0,
                          rules);
}

/// Returns options with the rules of privacy of a room alone.
ArrangeOptions withPrivacy(const Scene& scene, ArrangeOptions options,
                           const std::vector<PrivacyRule>& rules) {
    RoomGoals goals;
    const Environment* const room = &scene.environment;
    askPrivacy({rules}, {&room, 1}, options, {&goals, 1});
    return options;
}

TEST(ArrangeRules, NoLayoutSeesAPrivateZone) {
    const Scene scene = roomScene(kOffice);
    ArrangeOptions options = coarse();
    const std::vector<PrivacyRule> rules = {parsePrivacy("desk*")};
    const Arrangement plain = camerasIn(scene, options);
    EXPECT_FALSE(isMet(privacyOf(scene, plain, rules)[0]));
    const Arrangement found = camerasIn(scene, withPrivacy(scene, options, rules));
    EXPECT_TRUE(isMet(privacyOf(scene, found, rules)[0]));
    EXPECT_EQ(found.sensors.size(), 2U);
    EXPECT_LE(found.candidate_value, plain.bound);
    EXPECT_GE(found.bound, found.candidate_value);
    EXPECT_LT(found.candidates, plain.candidates);
}

TEST(ArrangeRules, ZonesWithoutACellAreKeptByTheirExactRegions) {
    const Scene scene = roomScene(kOffice);
    ArrangeOptions options = coarse();
    options.cells = CellSize{0.25};
    const std::vector<PrivacyRule> rules = {parsePrivacy("slot")};
    EXPECT_FALSE(isMet(privacyOf(scene, camerasIn(scene, coarse()), rules)[0]));
    const Arrangement found = camerasIn(scene, withPrivacy(scene, options, rules));
    EXPECT_TRUE(isMet(privacyOf(scene, found, rules)[0]));
}

TEST(ArrangeRules, PrivacyFromADensityOnAllowsCamerasFarAway) {
    const Scene scene = roomScene(kOffice);
    ArrangeOptions options = coarse();
    options.pixel_density = 300;  // limits coverage, not privacy
    const std::vector<PrivacyRule> near = {parsePrivacy("desk1,200")};
    const Arrangement far = camerasIn(scene, withPrivacy(scene, options, near));
    EXPECT_TRUE(isMet(privacyOf(scene, far, near)[0]));
    const std::vector<PrivacyRule> any = {parsePrivacy("desk1")};
    const Arrangement none = camerasIn(scene, withPrivacy(scene, options, any));
    EXPECT_TRUE(isMet(privacyOf(scene, none, any)[0]));
    EXPECT_LT(none.candidates, far.candidates);
    EXPECT_LE(none.candidate_value, far.bound);
}

TEST(ArrangeRules, NoPlaceIsLeft) {
    const Scene scene = roomScene(kOffice + "zone id=all path=-4,-3;4,-3;4,3;-4,3\n");
    ArrangeOptions options = withPrivacy(scene, coarse(), {parsePrivacy("all")});
    options.mount.tilts = {Angle::degrees(-90)};
    EXPECT_THROW(camerasIn(scene, options), UnmetError);
    options.strategy = Strategy::Random;
    EXPECT_THROW(camerasIn(scene, options), UnmetError);
    EXPECT_EQ(arranged(scene, groupsOf(scene, {"laser:2"}), options).sensors.size(), 2U);
}

TEST(ArrangeRules, FacesCountByTheExactRule) {
    const Scene scene = roomScene(kOffice);
    ArrangeOptions options = coarse();
    options.cells = CellSize{0.05};
    options.weights.targets = {readZone("entrance", scene.environment)};
    const FacingRule rule = parseFacing("entrance,45deg");
    const std::vector<FacingRule> rules = facingIn(scene.environment, {&rule, 1});
    options.cover_rule = coverRuleOf(rules);
    const Arrangement found = camerasIn(scene, options, {"camera"});
    const Scene whole = withPlaced(scene, groupsOf(scene, {"camera"}), found.sensors);
    RayScenes worlds(whole.environment);
    const auto faced = measureFacing(whole, measureCoverage(whole, worlds, {}), rules);
    ASSERT_EQ(faced.size(), 1U);
    EXPECT_NEAR(found.value.value(), faced[0].share.value(), 0.02);
    EXPECT_NEAR(found.candidate_value, *found.value, 1e-9);
    EXPECT_GE(found.bound, *found.value);
    // South of the door, where the plain search may stand anywhere.
    EXPECT_LT(found.sensors[0].pose.position.y, 1);
    EXPECT_GT(*found.value, 0.5);
    const Arrangement lasers = arranged(scene, groupsOf(scene, {"laser,range=9,fov=360"}), options);
    EXPECT_EQ(lasers.candidate_value, 0);
}

TEST(ArrangeRules, StandingCamerasSeeFacesToo) {
    const Document layout = layoutFrom(
        "camera id=c at=-2,-2.9,2.2 heading=90 tilt=-20\nlaser id=l at=-2,2 heading=0\n");
    const Scene scene = roomScene(kOffice, &layout);
    ArrangeOptions options = coarse();
    options.weights.targets = {readZone("entrance", scene.environment)};
    options.cover_rule = coverRuleOf({parseFacing("entrance,60deg,-90")});
    const Arrangement ahead = camerasIn(scene, options, {"laser,range=1"});
    EXPECT_GT(ahead.candidate_value, 0.3);
    EXPECT_NEAR(ahead.candidate_value, ahead.value.value(), 1e-9);
    options.cover_rule = coverRuleOf({parseFacing("entrance,60deg,90")});
    EXPECT_EQ(camerasIn(scene, options, {"laser,range=1"}).candidate_value, 0);
}

}  // namespace arrange_rules_test
}  // namespace ispace::camerarules
