// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/run/run_reader.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/error.h"
#include "base/file.h"
#include "support/test_damage.h"
#include "support/test_folder.h"
#include "support/test_sensors.h"

namespace ispace {
namespace run_reader_test {

namespace fs = std::filesystem;

constexpr const char* kRobots =
    "t,id,x,y,heading_deg,speed,rotspeed_deg,accel,rotaccel_deg,stall\n"
    "0,r1,0,0,0,0,0,0,0,0\n0,r2,1,1,90,0,0,0,0,0\n"
    "0.005,r1,0.5,0,10,0.3,20,0.1,5,0\n0.005,r2,1,1,90,0,0,0,0,1\n";
constexpr const char* kPeople =
    "t,id,x,y,heading_deg,speed,rotspeed_deg,phase\n0,h1,2,2,0,0,0,0\n0.005,h1,2.1,2,0,1,0,0.25\n";

/// Reads to the end: the number of moments.
int readAllOf(RunReader& reader) {
    int moments = 0;
    while (reader.next()) ++moments;
    return moments;
}

int momentsOf(const std::string& robots, const std::string& people = "") {
    RunReader reader(robots, people);
    return readAllOf(reader);
}

TEST(RunReader, ReadsBumpersWhereTheyChange) {
    RunReader reader(kRobots, "", "", "", "t,id,hit\n0,r1,0;0;1\n0,r2,0\n0.004,r1,1;0;0\n1,r2,1");
    ASSERT_TRUE(reader.next());
    ASSERT_EQ(reader.bumpers().size(), 2U);
    EXPECT_EQ(reader.bumpers()[0].id, "r1");
    EXPECT_EQ(reader.bumpers()[0].hit, (std::vector<bool>{false, false, true}));
    EXPECT_EQ(reader.bumpers()[1].hit, std::vector<bool>{false});
    ASSERT_TRUE(reader.next());
    ASSERT_EQ(reader.bumpers().size(), 1U);
    EXPECT_EQ(reader.bumpers()[0].hit, (std::vector<bool>{true, false, false}));
    EXPECT_FALSE(reader.next());
}

TEST(RunReader, RefusesBumpersThatAreNone) {
    const auto error_of = [](const std::string& bumpers) {
        return testing::findings([&] {
            RunReader reader(kRobots, "", "", "", bumpers);
            return readAllOf(reader);
        });
    };
    EXPECT_EQ(error_of("t,id\n"),
              "bumpers.csv:1: error: no bumpers of a run: wanted the columns t,id,hit\n");
    EXPECT_EQ(error_of("t,id,hit\n0,r1,0;2\n"),
              "bumpers.csv:2: error: hit is `0;2`, wanted 0 or 1 of each bumper, like 0;1\n");
    EXPECT_EQ(error_of("t,id,hit\n0.004,r1,0\n0.002,r1,1\n"),
              "bumpers.csv:3: error: wanted t,id,hit in order of time: `0.002,r1,1`\n");
    EXPECT_EQ(error_of("t,id,hit\n0,r1\n"),
              "bumpers.csv:2: error: wanted t,id,hit in order of time: `0,r1`\n");
}

TEST(RunReader, ReadsMomentsOfRobotsAndPeople) {
    RunReader reader(kRobots, kPeople);
    ASSERT_TRUE(reader.next());
    EXPECT_EQ(reader.time(), 0);
    ASSERT_EQ(reader.states().size(), 3U);
    ASSERT_TRUE(reader.next());
    EXPECT_EQ(reader.time(), 0.005);
    const RunState& robot = reader.states()[0];
    EXPECT_EQ(reader.members()[robot.member].id, "r1");
    EXPECT_EQ(robot.pose, (Pose2{{0.5, 0}, Angle::degrees(10)}));
    EXPECT_EQ(robot.speed, 0.3);
    EXPECT_EQ(robot.rotspeed, Angle::degrees(20));
    EXPECT_EQ(robot.accel, 0.1);
    EXPECT_EQ(robot.rotaccel, Angle::degrees(5));
    EXPECT_FALSE(robot.is_stalled);
    EXPECT_TRUE(reader.states()[1].is_stalled);
    const RunState& person = reader.states()[2];
    EXPECT_EQ(reader.members()[person.member].id, "h1");
    EXPECT_TRUE(reader.members()[person.member].is_person);
    EXPECT_EQ(person.phase, 0.25);
    EXPECT_FALSE(reader.next());
    EXPECT_FALSE(reader.isCut());
}

TEST(RunReader, ReadsRunsWithoutRobots) {
    const std::string header = std::string(kRobots).substr(0, std::string(kRobots).find('\n') + 1);
    EXPECT_EQ(momentsOf(header, kPeople), 2);
    EXPECT_EQ(momentsOf(header), 0);
    EXPECT_EQ(momentsOf(header, "t,id,x,y,heading_deg\n"), 0);
    EXPECT_EQ(momentsOf(kRobots, "t,id,x,y,heading_deg\n"), 2);
}

TEST(RunReader, LeavesOutWhatAKilledRunLeftHalf) {
    const std::string text = kRobots;
    for (std::size_t length = text.find("0.005,r1"); length < text.size(); ++length) {
        RunReader reader(text.substr(0, length), "");
        EXPECT_EQ(readAllOf(reader), 1) << length;
        EXPECT_EQ(reader.isCut(), length > text.find("0.005,r1")) << length;
    }
    const std::string people = kPeople;
    RunReader reader(text, people.substr(0, people.find("0.005,h1")));
    EXPECT_EQ(readAllOf(reader), 1);
    EXPECT_TRUE(reader.isCut());
}

TEST(RunReader, SomeMayComeAndGo) {
    RunReader reader(
        "t,id,x,y,heading_deg\n0,a,0,0,0\n0,b,0,0,0\n1,a,0,0,0\n2,a,0,0,0\n2,c,1,1,1\n", "");
    EXPECT_EQ(readAllOf(reader), 3);
    EXPECT_EQ(reader.members().size(), 3U);
}

std::string errorOf(const std::string& robots, const std::string& people = "") {
    return errorsOf([&] { momentsOf(robots, people); });
}

TEST(RunReader, NamesTheLineOfWhatIsWrong) {
    const std::string header = "t,id,x,y,heading_deg\n";
    EXPECT_EQ(errorOf("a,b\n"),
              "robots.csv:1: error: no record of a run: wanted the columns t,id,x,y,heading_deg,…, "
              "as `simrun --record` writes\n");
    EXPECT_NE(errorOf(""), "no error");
    EXPECT_EQ(errorOf(header + "0,r1,0,0\n"),
              "robots.csv:2: error: has 4 columns, wanted 5: `0,r1,0,0`\n");
    EXPECT_EQ(errorOf(header + "0,r1,0,nan,0\n"),
              "robots.csv:2: error: y is `nan`, wanted a number\n");
    EXPECT_EQ(errorOf(header + "1,r1,0,0,0\n0,r1,0,0,0\n"),
              "robots.csv:3: error: time runs backwards\n");
    EXPECT_EQ(errorOf(header + "1,r1,0,0,0\n1,r1,0,0,0\n"),
              "robots.csv:3: error: r1 is there twice at t=1\n");
    EXPECT_EQ(errorOf(header + "-1,r1,0,0,0\n"), "robots.csv:2: error: t is out of bounds: `-1`\n");
    EXPECT_EQ(errorOf(header + std::string(20000, 'x')),
              "robots.csv:1: error: a line is longer than 16384 bytes\n");
    EXPECT_EQ(errorOf(header + "0,r1,0,0,0\n2,r1,0,0,0\n", header + "0,h1,0,0,0\n1,h1,0,0,0\n"),
              "people.csv:3: error: the moment t=1 is none of robots.csv, which goes on at t=2\n");
}

TEST(RunReader, ReadsCollisions) {
    const std::string events =
        "t,kind,id,other,x,y,value,text\n0,enter,r1,z,0,0,,\n0.005,collision,r1,post,0.5,0,,\n"
        "0.005,mark,,,,,,\"a, b\"\n0.005,collision,r2,h1,1,1,,\n";
    RunReader reader(kRobots, kPeople, events);
    ASSERT_TRUE(reader.next());
    EXPECT_TRUE(reader.collisions()->empty());
    ASSERT_TRUE(reader.next());
    ASSERT_EQ(reader.collisions()->size(), 2U);
    EXPECT_EQ((*reader.collisions())[1].id, "r2");
    EXPECT_EQ((*reader.collisions())[1].other, "h1");
    EXPECT_FALSE(RunReader(kRobots, kPeople).collisions());
    EXPECT_EQ(errorsOf([] { RunReader(kRobots, "", "a,b\n"); }),
              "events.csv:1: error: no events of a run: wanted t,kind,id,other,…\n");
    surviveDamage(events, [](const std::string& bytes) {
        RunReader damaged(kRobots, "", bytes);
        readAllOf(damaged);
    });
}

TEST(RunReader, SurvivesDamage) {
    surviveDamage(kRobots, [](const std::string& bytes) { momentsOf(bytes, kPeople); });
    surviveDamage(kPeople, [](const std::string& bytes) { momentsOf(kRobots, bytes); });
}

TEST(RunReader, ReadsFoldersPieceByPiece) {
    const testing::TestFolder temporary;
    const fs::path folder = temporary / "run";
    fs::create_directory(folder);
    std::string text = "t,id,x,y,heading_deg\n";
    constexpr int kMoments = 20000;
    for (int i = 0; i < kMoments; ++i)
        text += std::to_string(i) + ",r1," + std::to_string(i) + ".125,-0.25,30\n";
    writeAll((folder / "robots.csv").string(), text);
    RunReader reader(folder.string());
    EXPECT_EQ(readAllOf(reader), kMoments);
    EXPECT_EQ(reader.states()[0].pose.position.x, kMoments - 1 + 0.125);

    EXPECT_FALSE(recordedInfo(folder.string()));
    const std::string info = (folder / "info.csv").string();
    writeAll(info, "dt,control_interval,steps\n0.005,0.005,2000\n");
    EXPECT_EQ(recordedInfo(folder.string()).value().step, 0.005);
    EXPECT_FALSE(recordedInfo(folder.string()).value().noise);
    writeAll(info,
             "dt,control_interval,steps,elapsed,seed,noise\n0.01,0.1,1,0.01,9007199254740993,1\n");
    EXPECT_EQ(recordedInfo(folder.string()).value().step, 0.01);
    EXPECT_EQ(recordedInfo(folder.string()).value().seed, 9007199254740993U);
    EXPECT_TRUE(recordedInfo(folder.string()).value().noise);
    // No longer than time can be counted.
    writeAll(info, "dt,control_interval,steps\n0.005,0.1,1e15\n");
    EXPECT_EQ(recordedInfo(folder.string()).value().steps, 800'000'000'000);
    for (const char* wrong : {"dt,control_interval,steps\n", "dt,x\n0,0\n", "a\n1\n"}) {
        writeAll((folder / "info.csv").string(), wrong);
        EXPECT_THROW(recordedInfo(folder.string()), FormatError) << wrong;
    }
    fs::remove_all(folder);
    EXPECT_THROW(RunReader{folder.string()}, std::system_error);
}

TEST(RunReader, PeopleComeAndGoInAChangedWorld) {
    const std::string robots =
        "t,id,x,y,heading_deg\n0,r1,0,0,0\n0,r2,0,0,0\n1,r1,1,0,0\n2,r1,2,0,0\n5,r1,5,0,0\n";
    const std::string people = "t,id,x,y,heading_deg\n1,h1,0,0,0\n3,h1,0,0,0\n";
    const std::string events = "t,kind,id,other,x,y,value,text\n0,change,,,,,,DELETE r2\n";
    RunReader reader(robots, people, events);
    std::string moments;
    while (reader.next()) {
        moments += std::to_string(static_cast<int>(reader.time()));
        for (const RunState& state : reader.states())
            moments += ' ' + reader.members()[state.member].id;
        moments += '\n';
    }
    EXPECT_EQ(moments, "0 r1 r2\n1 r1 h1\n2 r1\n3 h1\n5 r1\n");
    EXPECT_FALSE(reader.isCut());
    EXPECT_THROW(momentsOf(robots, people), FormatError) << "nobody came or went";
}

TEST(RunReader, ReadsWhatRobotsBelieve) {
    const std::string odometry =
        "t,id,x,y,heading_deg\n0,r1,0,0,0\n0,r2,0,0,0\n"
        "0.005,r1,0.4,0.1,9\n0.005,r2,0,0,0\n";
    RunReader reader(kRobots, kPeople, "", odometry);
    EXPECT_TRUE(reader.hasOdometry());
    ASSERT_TRUE(reader.next());
    ASSERT_TRUE(reader.next());
    ASSERT_TRUE(reader.states()[0].odometry);
    EXPECT_EQ(reader.states()[0].odometry->pose, (Pose2{{0.4, 0.1}, Angle::degrees(9)}));
    EXPECT_EQ(reader.states()[0].odometry->covariance, PoseCovariance()) << "older records";
    EXPECT_FALSE(reader.states()[2].odometry) << "a person";
    EXPECT_EQ(reader.members().size(), 3U);
    EXPECT_FALSE(reader.next());
    EXPECT_FALSE(reader.isCut());

    RunReader none(kRobots, kPeople, "", "t,id,x,y,heading_deg\n");
    EXPECT_FALSE(none.hasOdometry());
    EXPECT_EQ(readAllOf(none), 2);
    // Of a killed run.
    RunReader cut(kRobots, "", "", odometry.substr(0, odometry.size() - 3));
    EXPECT_EQ(readAllOf(cut), 1);
    EXPECT_TRUE(cut.isCut());
    RunReader other(kRobots, "", "", "t,id,x,y,heading_deg\n0,r1,0,0,0\n0,r3,0,0,0\n");
    EXPECT_THROW(readAllOf(other), FormatError);
}

}  // namespace run_reader_test
}  // namespace ispace
