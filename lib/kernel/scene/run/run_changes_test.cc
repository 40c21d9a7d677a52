// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/run/run_changes.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/error.h"
#include "base/file.h"
#include "scene/run/run_reader.h"
#include "support/test_folder.h"
#include "support/test_layout.h"

namespace ispace {
namespace run_changes_test {

namespace fs = std::filesystem;

constexpr const char* kRoom = "ispace id=room size=8,6\n";
constexpr const char* kWho = "robot id=r1 at=0,0\nhuman id=h1 at=1,2\n";
constexpr const char* kHead = "t,kind,id,other,x,y,value,text\n";

class RunChangesTest : public ::testing::Test {
  protected:
    RunChanges changes(const std::string& rows, std::optional<std::uint64_t> max_work = {}) {
        writeAll((folder_ / "events.csv").string(), kHead + rows);
        return {folder_.path().string(),
                testing::scene(kRoom, kWho),
                {},
                [this](const std::string& file) {
                    EXPECT_EQ(file, (folder_ / "scenes/scene-000001.env").string());
                    if (!fs::exists(file)) throw FormatError({file, 0, 0, "is gone"});
                    return testing::scene("ispace id=other size=4,4\n", "robot id=r9 at=1,1\n");
                },
                max_work};
    }
    static std::optional<Pose2> nowhere(const std::string& /*id*/) { return std::nullopt; }

    testing::TestFolder folder_;
};

TEST_F(RunChangesTest, AreThoseOfTheTable) {
    EXPECT_TRUE(recordedChanges(folder_.path().string()).empty());
    changes(
        "0,seen,r1,,,,1,\n0.5,change,,,,,,\"SET h1.at=2,2\"\n"
        "0.5,change,,scenes/scene-000001.env,,,,LOAD other.env\n"
        "1.25,change,,,,,,\"ADD wall name=\"\"a, b\"\" from=0,0\"\n");
    const auto rows = recordedChanges(folder_.path().string());
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(rows[0].time, 0.5);
    EXPECT_EQ(rows[0].text, "SET h1.at=2,2");
    EXPECT_EQ(rows[0].line, 3);
    EXPECT_EQ(rows[1].scene, "scenes/scene-000001.env");
    EXPECT_EQ(rows[1].text, "LOAD other.env");
    EXPECT_EQ(rows[2].text, "ADD wall name=\"a, b\" from=0,0");
}

TEST_F(RunChangesTest, BeyondTheWorkAreSkipped) {
    std::string rows;
    for (int i = 0; i < 5; ++i)
        rows += "0.5,change,,,,,,SET r1.heading=" + std::to_string(i) + "\n";
    const Scene scene = testing::scene(kRoom, kWho);
    RunChanges bounded = changes(rows, 3 * scene.records.size());
    for (int round = 0; round < 2; ++round) {
        int steps = 0;
        while (bounded.next(1, scene, nowhere)) ++steps;
        EXPECT_EQ(steps, 3);
        EXPECT_NE(bounded.failure().find("events.csv:5: `SET r1.heading=3` at t=0.5 cannot be made "
                                         "again: it and those before make more than 9 units of "
                                         "work (`--max-work 18` allows more)"),
                  std::string::npos)
            << bounded.failure();
        bounded.rewind();
    }
}

TEST_F(RunChangesTest, HaveTimesOfARun) {
    for (const char* time : {"-1", "1e300", "soon"}) {
        const auto error =
            testing::findings([&] { changes(std::string(time) + ",change,,,,,,\n"); });
        EXPECT_NE(error.find("events.csv:2: error: t is `" + std::string(time) +
                             "`, wanted seconds from 0 on"),
                  std::string::npos)
            << error;
        EXPECT_EQ(testing::findings([&] { (void)recordedChange(folder_.path().string()); }), error);
    }
}

TEST_F(RunChangesTest, AreMadeInTheirTime) {
    RunChanges made = changes(
        "0.5,change,,,,,,ADD robto id=r2\n"
        "1,change,,,,,,\"ADD robot id=r2 at=-2,0\"\n"
        "1,change,,,,,,\"SET r1.heading=90\"\n2,change,,,,,,DELETE h1 r2\n3,change,,,,,,RESET\n");
    const Scene start = testing::scene(kRoom, kWho);
    EXPECT_FALSE(made.next(0.5, start, nowhere)) << "made after the step to 0.5";
    auto step = made.next(1.005, start, [](const std::string& id) {
        return id == "r1" ? std::optional(Pose2{{0.25, 0.5}, Angle::degrees(10)}) : std::nullopt;
    });
    ASSERT_TRUE(step);
    EXPECT_EQ(step->scene.robots.size(), 2U);
    EXPECT_TRUE(step->placed.empty());
    EXPECT_NE(made.failure().find("events.csv:2: "), std::string::npos) << made.failure();
    const Scene joined = std::move(step->scene);
    step = made.next(1.005, joined, [](const std::string& id) {
        return id == "r1" ? std::optional(Pose2{{0.25, 0.5}, Angle::degrees(10)}) : std::nullopt;
    });
    ASSERT_TRUE(step);
    EXPECT_EQ(step->placed, std::vector<std::string>{"r1"});
    EXPECT_EQ(step->scene.robots[0].pose, (Pose2{{0.25, 0.5}, Angle::degrees(90)}));
    const Scene turned = std::move(step->scene);
    EXPECT_FALSE(made.next(1.005, turned, nowhere));
    step = made.next(9, turned, nowhere);
    ASSERT_TRUE(step);
    EXPECT_EQ(step->scene.robots.size(), 1U);
    EXPECT_TRUE(step->scene.people.empty());
    const Scene left = std::move(step->scene);
    step = made.next(9, left, nowhere);
    ASSERT_TRUE(step);
    EXPECT_TRUE(step->restarts);
    EXPECT_EQ(step->scene.people.size(), 1U);
    EXPECT_FALSE(made.next(9, step->scene, nowhere));
    made.rewind();
    EXPECT_TRUE(made.next(9, start, nowhere));
}

TEST_F(RunChangesTest, LoadedScenesAreInTheRecord) {
    const std::string rows =
        "1,change,,scenes/scene-000001.env,,,,LOAD other.env\n2,change,,,,,,RESET\n"
        "3,change,,,,,,LOAD lost.env\n";
    const Scene start = testing::scene(kRoom, kWho);
    RunChanges gone = changes(rows);
    auto step = gone.next(9, start, nowhere);
    ASSERT_TRUE(step) << "RESET";
    EXPECT_EQ(step->scene.robots[0].id, "r1");
    EXPECT_NE(gone.failure().find("`LOAD other.env` at t=1 cannot be made again: "),
              std::string::npos)
        << gone.failure();

    fs::create_directory(folder_ / "scenes");
    writeAll((folder_ / "scenes/scene-000001.env").string(), "#env 1\n");
    RunChanges made = changes(rows);
    step = made.next(9, start, nowhere);
    ASSERT_TRUE(step);
    EXPECT_TRUE(step->restarts);
    EXPECT_EQ(step->scene.robots[0].id, "r9");
    EXPECT_EQ(made.failure(), "");
    step = made.next(9, step->scene, nowhere);
    ASSERT_TRUE(step);
    EXPECT_EQ(step->scene.robots[0].id, "r9") << "RESET leads to what was loaded last";
    EXPECT_FALSE(made.next(9, step->scene, nowhere));
    EXPECT_NE(made.failure().find("events.csv:4: "), std::string::npos) << made.failure();
}

}  // namespace run_changes_test
}  // namespace ispace
