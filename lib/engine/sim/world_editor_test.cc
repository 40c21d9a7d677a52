// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/world_editor.h"

#include <gtest/gtest.h>

#include "base/file.h"
#include "support/test_folder.h"
#include "support/test_source.h"

namespace ispace {
namespace world_editor_test {

using std::chrono::milliseconds;
using testing::findings;

const std::string kRoom = "ispace id=room size=8,6\n";
const std::string kRobots =
    "robot id=r1 model=pioneer-2dx at=0,0\nrobot id=r2 at=2,2 heading=90\nlaser id=l1 on=r1\n";

struct Edited {
    Edited()
        : world(std::make_shared<const Scene>(testing::scene(kRoom, kRobots)), milliseconds(100)),
          simulation(world, {}, {Clock::Kind::Step, 1}, std::nullopt),
          editor(simulation,
                 std::make_shared<testing::TextSource>(
                     std::map<std::string, std::string>{{"hall.env", "ispace size=20,20\n"},
                                                        {"hall.3dm", "robot id=r1 at=9,9\n"},
                                                        {"bad.3dm", "robot id=r1 at=10,0\n"}})) {}
    void edit(Edit::Kind kind, const std::string& text) {
        const std::vector<Edit> edits = {parseEdit(kind, text)};
        editor.edit(edits).carryOut();
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) world.step();
    }
    World world;
    Simulation simulation;
    WorldEditor editor;
};

TEST(WorldEditor, Adds) {
    Edited it;
    it.edit(Edit::Kind::Add, "robot at=-2,-2");
    it.edit(Edit::Kind::Add, "human id=h at=-2,2");
    ASSERT_EQ(it.world.robots().size(), 3U);
    EXPECT_EQ(it.world.robots()[2].id, "robot1");
    EXPECT_EQ(it.world.scene().ids.back(), "h");
    EXPECT_EQ(findings([&] { it.edit(Edit::Kind::Add, "robot id=h at=3,0"); }),
              "error: --add robot id=h at=3,0: the id `h` is taken by the human added before\n");
    EXPECT_EQ(findings([&] { it.edit(Edit::Kind::Add, "cube at=0,0 size=1"); }),
              "room.3dm:2:1: error: robot r1 stands in cube1 near (0.0, -0.5); move it, e.g. by "
              "0.75 m\n");
    EXPECT_EQ(it.world.changes(), 2);
    EXPECT_EQ(it.world.scene().ids.back(), "h");
}

TEST(WorldEditor, SetsAPlaceOfARobotOnTheWay) {
    Edited it;
    it.world.command(0, {Verb::Left, 90});
    it.run(30);
    it.world.command(0, {Verb::Forward, 1});
    it.run(60);
    EXPECT_NEAR(it.world.status(0).pose.position.y, 1, 1e-9);
    // Only what is set changes.
    it.edit(Edit::Kind::Set, "r1.heading=0");
    EXPECT_NEAR(it.world.status(0).pose.position.y, 1, 1e-9);
    EXPECT_EQ(it.world.status(0).pose.heading.degrees(), 0);
    it.edit(Edit::Kind::Set, "r1.heading=45");
    it.edit(Edit::Kind::Set, "r1.at=0,0");
    EXPECT_EQ(it.world.status(0).pose.position, (Point2{0, 0}));
    EXPECT_EQ(it.world.status(0).pose.heading.degrees(), 45);
    // Its record says so already, and it is put there all the same.
    it.world.command(0, {Verb::Forward, 1});
    it.run(60);
    it.edit(Edit::Kind::Set, "r1.at=0,0");
    EXPECT_EQ(it.world.status(0).pose.position, (Point2{0, 0}));
    // Others stay in their way.
    it.world.command(1, {Verb::Backward, 1});
    it.run(60);
    it.edit(Edit::Kind::Set, "r1.max_speed=0.4");
    EXPECT_NEAR(it.world.status(1).pose.position.y, 1, 1e-9);
}

TEST(WorldEditor, TheWorldGoesOnWhileAChangeIsPrepared) {
    for (const std::string request : {"r1.heading=30", "r1.at=1,-1", "r2.max_speed=0.4"}) {
        Edited early, late;
        for (Edited* it : {&early, &late}) {
            it->world.command(0, {Verb::Forward, 1});
            it->world.command(1, {Verb::Backward, 1});
            it->run(5);
        }
        const std::vector<Edit> edits = {parseEdit(Edit::Kind::Set, request)};
        const WorldChange change = early.editor.edit(edits);
        change.prepare();
        for (Edited* it : {&early, &late}) it->run(5);
        change.adopt();
        late.editor.edit(edits).carryOut();
        // It is as if all of it had been done at once.
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_EQ(early.world.status(i).pose, late.world.status(i).pose) << request << i;
            EXPECT_EQ(early.world.status(i).speed, late.world.status(i).speed) << request << i;
        }
        EXPECT_EQ(early.world.scene().records, late.world.scene().records) << request;
        EXPECT_EQ(early.world.reading(0).scan().ranges, late.world.reading(0).scan().ranges);
        for (Edited* it : {&early, &late}) it->run(20);
        EXPECT_EQ(early.world.status(0).pose, late.world.status(0).pose) << request;
        EXPECT_EQ(early.world.reading(0).scan().ranges, late.world.reading(0).scan().ranges);
    }
}

TEST(WorldEditor, TheTextOfALoadedSceneIsPrepared) {
    const testing::TestFolder folder;
    Edited it;
    int texts = 0;
    RecordOptions options;
    options.scene_text = [&texts](const Scene& scene) {
        ++texts;
        return std::to_string(scene.robots.size()) + " robots";
    };
    Recorder recorder(folder / "run", it.world, options);
    it.simulation.recordWith(recorder);
    const WorldChange change = it.editor.load("hall.env", "hall.3dm");
    change.prepare();
    EXPECT_EQ(texts, 1);
    change.adopt();
    it.simulation.notifyChange("LOAD hall.env hall.3dm", change.news->scene_text);
    EXPECT_EQ(texts, 1);
    EXPECT_EQ(readAll(folder / "run/scenes/scene-000001.env"), "1 robots");
    // Without a name of a file the request is sufficient.
    const WorldChange edit = it.editor.edit({parseEdit(Edit::Kind::Set, "r1.heading=30")});
    edit.carryOut();
    EXPECT_EQ(edit.news->scene_text, "");
    EXPECT_EQ(texts, 1);
}

TEST(WorldEditor, SomebodyMayHaveComeMeanwhile) {
    Edited it;
    const WorldChange change =
        it.editor.edit({parseEdit(Edit::Kind::Add, "cube id=c at=1,0 size=0.3")});
    change.prepare();
    it.world.command(0, {Verb::Forward, 1});
    it.run(60);
    EXPECT_NE(findings([&] { change.adopt(); }).find("robot r1 stands in c"), std::string::npos);
    EXPECT_EQ(it.world.changes(), 0);
    EXPECT_NEAR(it.world.status(0).pose.position.x, 1, 1e-9);
}

TEST(WorldEditor, DeletesWhatNothingNeeds) {
    Edited it;
    EXPECT_EQ(findings([&] { it.edit(Edit::Kind::Delete, "r1"); }),
              "error: --delete r1: `l1` has `on=r1`; delete it, too, or set that anew\n");
    const std::vector<Edit> edits = {parseEdit(Edit::Kind::Delete, "l1"),
                                     parseEdit(Edit::Kind::Delete, "r1")};
    it.editor.edit(edits).carryOut();
    ASSERT_EQ(it.world.robots().size(), 1U);
    EXPECT_TRUE(it.world.sensors().empty());
    EXPECT_THROW(it.edit(Edit::Kind::Delete, "l*"), UnknownRecord);
    it.edit(Edit::Kind::Delete, "r[0-9]");
    EXPECT_TRUE(it.world.robots().empty());
}

TEST(WorldEditor, ResetsToTheBeginning) {
    Edited it;
    it.world.command(0, {Verb::Forward, 1});
    it.run(20);
    it.edit(Edit::Kind::Add, "robot at=-2,-2");
    it.edit(Edit::Kind::Set, "r1.at=1,1");
    it.editor.reset().carryOut();
    ASSERT_EQ(it.world.robots().size(), 2U);
    EXPECT_EQ(it.world.status(0).pose.position, (Point2{0, 0}));
    EXPECT_EQ(it.world.time(), milliseconds(2000));
}

TEST(WorldEditor, LoadsAnotherScene) {
    Edited it;
    it.run(5);
    EXPECT_NE(findings([&] { it.editor.load("missing.env", "").carryOut(); }), "");
    EXPECT_NE(findings([&] { it.editor.load("hall.env", "bad.3dm").carryOut(); }), "");
    EXPECT_EQ(it.world.changes(), 0);
    it.editor.load("hall.env", "hall.3dm").carryOut();
    ASSERT_EQ(it.world.robots().size(), 1U);
    EXPECT_EQ(it.world.status(0).pose.position, (Point2{9, 9}));
    EXPECT_EQ(it.world.time(), milliseconds(500));
    it.edit(Edit::Kind::Set, "r1.at=1,1");
    it.editor.reset().carryOut();
    EXPECT_EQ(it.world.status(0).pose.position, (Point2{9, 9}));
}

TEST(WorldEditor, FilesAreTheSourcesBusiness) {
    Edited it;
    EXPECT_NE(findings([&] {
                  it.edit(Edit::Kind::Add, "cube at=3,0 size=1 texture=/etc/motd");
              }).find("files are out of reach"),
              std::string::npos);
    it.edit(Edit::Kind::Add, "cube id=c at=3,0 size=1");
    EXPECT_NE(findings([&] {
                  it.edit(Edit::Kind::Set, "c.texture=a.png");
              }).find("files are out of reach"),
              std::string::npos);
}

}  // namespace world_editor_test
}  // namespace ispace
