// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/scene.h"

#include <gtest/gtest.h>

#include "layout/test_layout.h"
#include "record/digest.h"

namespace ispace {

using testing::devices;
using testing::findings;
using testing::layoutDocument;
using testing::roomDocument;
using testing::scene;

namespace {

const std::string kRoom =
    "ispace id=room at=4,3 size=8,6\n"
    "desk at=2,2\n"
    "desk id=d at=5,4\n";

std::string sceneFindings(const std::string& room, const std::string& layout) {
    return findings([&] { return scene(room, layout); });
}

TEST(MakeScene, EnvironmentAlone) {
    const Scene made = scene(kRoom);
    EXPECT_EQ(made.ids, (std::vector<std::string>{"room", "desk1", "d"}));
    EXPECT_EQ(made.environment.elements().size(), 3U);
    EXPECT_TRUE(made.lasers.empty());
    EXPECT_TRUE(made.pending.empty());
    EXPECT_EQ(made.digest, environmentDigest(roomDocument(kRoom).records));
}

TEST(MakeScene, SensorsOfLayoutFollowPlacedAndPending) {
    const Scene made = scene(kRoom,
                             "environment file=room.glb digest=sha256:0\n"
                             "laser id=a model=urg-04lx at=1,2,0.3 heading=-90\n"
                             "laser range=4\n"
                             "laser at=3,3\n"
                             "result coverage=97.4% area=12 bound=0.99 strategy=grid\n");
    EXPECT_EQ(made.records.size(), 6U);
    EXPECT_EQ(made.ids, (std::vector<std::string>{"room", "desk1", "d", "a", "laser1", "laser2"}));
    ASSERT_EQ(made.lasers.size(), 2U);
    EXPECT_EQ(made.lasers[0].id, "a");
    EXPECT_EQ(made.lasers[0].laser.model, "urg-04lx");
    EXPECT_EQ(made.lasers[0].pose.position, (Point3{1, 2, 0.3}));
    EXPECT_EQ(made.lasers[0].pose.heading.degrees(), -90);
    EXPECT_EQ(made.lasers[1].id, "laser2");
    EXPECT_EQ(made.lasers[1].pose.position.z, kScanHeight);
    ASSERT_EQ(made.pending.size(), 1U);
    EXPECT_EQ(made.pending[0].id, "laser1");
    EXPECT_EQ(made.pending[0].laser.max_range, 4);
    EXPECT_EQ(made.pending[0].record, made.records[4]);
}

TEST(MakeScene, LayoutReplacesWrittenIdsInTheirPlace) {
    const Scene made = scene(kRoom, "chair at=1,1\ndesk id=d at=6,5\nlaser id=room2 at=1,1\n");
    EXPECT_EQ(made.ids, (std::vector<std::string>{"room", "desk1", "d", "chair1", "room2"}));
    EXPECT_EQ(made.records[2].tuple("at"), (Tuple{6, 5}));
    EXPECT_EQ(made.environment.elements().size(), 4U);
}

TEST(MakeScene, AutomaticIdsAreNeverReplacedAndSkipWrittenOnes) {
    // ENV's first desk was desk1; the layout's written desk1 is another desk.
    const Scene made = scene(kRoom, "desk id=desk1 at=6,1\n");
    EXPECT_EQ(made.ids, (std::vector<std::string>{"room", "desk2", "d", "desk1"}));
}

TEST(MakeScene, DigestIsOfTheEnvironmentBeforeTheLayout) {
    const std::string plain = scene(kRoom).digest;
    EXPECT_EQ(scene(kRoom, "desk id=d at=6,5\nlaser at=1,1\n").digest, plain);
    EXPECT_EQ(scene(kRoom + "laser at=1,1\n").digest, plain);
    EXPECT_NE(scene(kRoom + "chair at=1,1\n").digest, plain);
}

TEST(MakeScene, SensorsOfTheEnvironmentCanBeMovedByTheLayout) {
    const Scene made =
        scene(kRoom + "laser id=l at=1,1\nlaser id=m at=2,1\n", "laser id=l at=3,3\n");
    ASSERT_EQ(made.lasers.size(), 2U);
    EXPECT_EQ(made.lasers[0].pose.position.x, 3);
    EXPECT_EQ(made.lasers[1].pose.position.x, 2);
}

TEST(MakeScene, DoubledIdWithinOneFileIsAnError) {
    // Readers refuse it; so does a scene of records that a program has made.
    Document room = roomDocument(kRoom);
    room.records.push_back(room.records.back());
    EXPECT_NE(findings([&] { return makeScene(room, nullptr, devices()); }), "");
    const Document good = roomDocument(kRoom);
    Document layout = layoutDocument("laser id=l at=1,1\n");
    layout.records.push_back(layout.records.back());
    EXPECT_NE(findings([&] { return makeScene(good, &layout, devices()); }), "");
}

TEST(MakeScene, MountedSensorsAreRefusedAtTheirKey) {
    const std::string text = sceneFindings(kRoom, "laser on=d at=0,0\n");
    EXPECT_EQ(text.find("room.3dm:2:10: error: `on`"), 0U) << text;
}

TEST(MakeScene, FindingsOfSensorsAndRoomComeTogether) {
    const std::string text = sceneFindings(
        "wall from=0,0 to=4,0\n", "laser model=urg at=1,1\nlaser range=3,2\nlaser at=1,1 on=r1\n");
    EXPECT_NE(text.find("room.3dm:2:13: error: unknown model"), std::string::npos) << text;
    EXPECT_NE(text.find("room.3dm:3:13:"), std::string::npos) << text;
    EXPECT_NE(text.find("room.3dm:4:17:"), std::string::npos) << text;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4) << text;
}

TEST(EnvironmentReference, TellsFileAndDigest) {
    const auto reference = environmentReference(
        layoutDocument("environment file=\"my room.glb\" digest=sha256:12\nlaser\n"));
    ASSERT_TRUE(reference);
    EXPECT_EQ(reference->file, "my room.glb");
    EXPECT_EQ(reference->digest, "sha256:12");
    EXPECT_EQ(reference->record.keyword(), "environment");
    const auto bare = environmentReference(layoutDocument("environment\n"));
    ASSERT_TRUE(bare);
    EXPECT_EQ(bare->file, "");
    EXPECT_EQ(bare->digest, "");
    EXPECT_FALSE(environmentReference(layoutDocument("laser\n")));
}

TEST(EnvironmentReference, OneLayoutHasOneEnvironment) {
    const std::string one = "environment file=a.glb\n";
    EXPECT_TRUE(environmentReference(layoutDocument(one + one)));
    EXPECT_NE(findings([&] {
                  return environmentReference(layoutDocument(one + "environment file=b.glb\n"));
              }),
              "");
}

TEST(SceneSchemas, EveryKeywordOnceAndIdFirst) {
    std::vector<std::string> seen;
    for (const Schema& schema : sceneSchemas().all()) {
        EXPECT_EQ(std::count(seen.begin(), seen.end(), schema.keyword), 0) << schema.keyword;
        seen.push_back(schema.keyword);
        ASSERT_FALSE(schema.keys.empty());
        EXPECT_EQ(schema.keys.front().name, "id") << schema.keyword;
    }
    for (const char* keyword : {"ispace", "desk", "laser", "environment", "result"})
        EXPECT_NE(sceneSchemas().find(keyword), nullptr) << keyword;
    EXPECT_EQ(&sceneSchemas(), &sceneSchemas());
}

TEST(SceneSchemas, CanonicalFormOfTheDesignsExample) {
    const std::string lines =
        "environment file=room.glb digest=sha256:00\n"
        "laser id=l1 model=urg-04lx at=-0.67,1.45,0.15 heading=-90\n"
        "result coverage=97.4% area=12.5 bound=99% strategy=wall complete=no\n";
    EXPECT_EQ(writeRecordText(layoutDocument(lines)), "#3dm 1\n" + lines);
    // Defaults are left out.
    EXPECT_EQ(
        writeRecordText(layoutDocument("laser tilt=0 roll=0 heading=0\nresult complete=yes\n")),
        "#3dm 1\nlaser\nresult\n");
}

}  // namespace

}  // namespace ispace
