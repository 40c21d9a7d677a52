// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/recorder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "base/error.h"
#include "base/file.h"
#include "sense/formats/reading_text.h"
#include "support/file_size_limit.h"
#include "support/test_folder.h"
#include "support/test_layout.h"

namespace ispace {
namespace recorder_test {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

constexpr const char* kRoom = "ispace size=8,6\n";
constexpr const char* kRobots =
    "robot id=r1 at=0.5,1 accel=0.25\n"
    "robot id=r2 at=-1,-2 heading=90\n";
constexpr const char* kHeader =
    "t,id,x,y,heading_deg,speed,rotspeed_deg,accel,rotaccel_deg,stall\n";

/// A folder of its own for each test, removed afterwards.
class RecorderTest : public ::testing::Test {
  protected:
    [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }
    [[nodiscard]] std::string text(const std::string& name) const { return readAll(path(name)); }

    testing::TestFolder folder_;
};

/// The error that `action` throws, as it reads; "" for none.
template <typename Action>
std::string errorOf(Action action) {
    try {
        action();
    } catch (const std::system_error& error) {
        return error.what();
    }
    return "";
}

auto linesOf(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

/// Two steps of a second with a robot that speeds up.
void recordRun(const std::string& folder, bool flush_at_the_end = true) {
    const Scene scene =
        testing::scene(kRoom, std::string(kRobots) + "laser id=l1 at=0,0 rate=1 fov=2\n");
    World world(scene, std::chrono::seconds(1));
    Recorder recorder(folder, world, {.history = {"simrun room.env"}, .seed = 7});
    world.command(0, {Verb::Speed, 1});
    for (int i = 0; i < 2; ++i) {
        world.step();
        recorder.record(world);
    }
    if (flush_at_the_end) recorder.flush(world);
}

TEST_F(RecorderTest, OneRunAtATimeInAFolder) {
    const Scene scene = testing::scene(kRoom, kRobots);
    World world(scene, milliseconds(5));
    const auto second = [&] {
        const Recorder recorder(path("run"), world, {.history = {"second"}});
    };
    {
        const Recorder first(path("run"), world, {.history = {"first"}});
        EXPECT_GE(first.lock(), 0);
        EXPECT_EQ(testing::findings([&] {
                      second();
                      return 0;
                  }),
                  path("run") + ": error: another run is being recorded here\n");
        EXPECT_NE(text("run/scans.jsonl").find("first"), std::string::npos);
    }
    second();
    EXPECT_NE(text("run/scans.jsonl").find("second"), std::string::npos);
}

TEST_F(RecorderTest, WritesTheRobotsOfEachStep) {
    recordRun(path("run"));
    EXPECT_EQ(text("run/robots.csv"), std::string(kHeader) +
                                          "0,r1,0.5,1,0,0,0,0,0,0\n"
                                          "0,r2,-1,-2,90,0,0,0,0,0\n"
                                          "1,r1,0.625,1,0,0.25,0,0.25,0,0\n"
                                          "1,r2,-1,-2,90,0,0,0,0,0\n"
                                          "2,r1,1,1,0,0.5,0,0.25,0,0\n"
                                          "2,r2,-1,-2,90,0,0,0,0,0\n");
    EXPECT_EQ(text("run/info.csv"), "dt,control_interval,steps,elapsed,seed,noise\n1,1,2,2,7,0\n");
}

TEST_F(RecorderTest, WritesScansAsScanDoes) {
    const Scene scene = testing::scene(kRoom,
                                       "laser id=l1 at=0,0 rate=1 fov=4\n"
                                       "laser id=l2 at=1,0 rate=2 fov=2\n");
    World world(scene, milliseconds(500));
    Recorder recorder(path("run"), world, {.history = {"simrun \"room\".env"}, .seed = 7});
    std::string expected = scanHeaderLine({"simrun \"room\".env"}, 7);
    const auto append = [&] {
        for (const std::size_t laser : world.latestReadings())
            appendLine(expected, viewOf(world.sensors()[laser], world.reading(laser).scan()));
    };
    append();
    EXPECT_EQ(text("run/scans.jsonl"), expected) << "time 0 is there from the start";
    for (int i = 0; i < 4; ++i) {
        world.step();
        recorder.record(world);
        append();
    }
    recorder.flush(world);
    EXPECT_EQ(text("run/scans.jsonl"), expected);
    EXPECT_EQ(linesOf(expected), 1 + 3 + 5);
}

TEST_F(RecorderTest, GivesTheSameBytesTwice) {
    recordRun(path("a"));
    recordRun(path("b"), false);  // the destructor writes the rest
    for (const char* name : {"/robots.csv", "/scans.jsonl", "/info.csv"})
        EXPECT_EQ(text(std::string("a") + name), text(std::string("b") + name)) << name;
}

TEST_F(RecorderTest, TimingNamesTimeAndSteps) {
    recordRun(path("run"));
    const std::string timing = text("run/timing.csv");
    EXPECT_TRUE(timing.starts_with("t,wall,steps\n0,")) << timing;
    EXPECT_TRUE(timing.ends_with(",2\n")) << timing;
    EXPECT_NE(timing.find("\n2,"), std::string::npos) << timing;
}

TEST_F(RecorderTest, StartsAnewInAFolderThatIsThere) {
    fs::create_directory(path("run"));
    for (const char* name : {"robots.csv", "scans.jsonl", "info.csv", "timing.csv"})
        writeAll(path("run/") + name, std::string(100000, 'x'));
    recordRun(path("run"));
    recordRun(path("new"));
    for (const char* name : {"/robots.csv", "/scans.jsonl", "/info.csv"})
        EXPECT_EQ(text(std::string("run") + name), text(std::string("new") + name)) << name;
    EXPECT_EQ(text("run/timing.csv").find('x'), std::string::npos);
}

TEST_F(RecorderTest, AWorldWithNothingInItHasHeaders) {
    const Scene scene = testing::scene(kRoom);
    World world(scene, milliseconds(5));
    const Recorder recorder(path("run"), world, {});
    EXPECT_EQ(text("run/robots.csv"), kHeader);
    EXPECT_EQ(text("run/scans.jsonl"), scanHeaderLine({}, 0));
    EXPECT_EQ(text("run/info.csv"),
              "dt,control_interval,steps,elapsed,seed,noise\n0.005,0.005,0,0,0,0\n");
}

TEST_F(RecorderTest, DoesNotHoldMoreThanItShould) {
    const Scene scene = testing::scene(kRoom, kRobots);
    World world(scene, milliseconds(5));
    Recorder recorder(path("run"), world, {});
    constexpr std::size_t kRecords = 50000;
    for (std::size_t i = 0; i < kRecords; ++i) recorder.record(world);
    const std::string robots = text("run/robots.csv");
    EXPECT_TRUE(robots.ends_with('\n'));
    constexpr std::size_t kLine = sizeof("0,r1,0.5,1,0,0,0,0,0,0");
    EXPECT_GT(robots.size() + 1200000, kRecords * 2 * kLine);
}

TEST_F(RecorderTest, NamesTheFolderItCannotMake) {
    const Scene scene = testing::scene(kRoom);
    World world(scene, milliseconds(5));
    const auto start = [&](const std::string& folder) {
        return errorOf([&] { Recorder(folder, world, {}); });
    };
    EXPECT_EQ(start(path("no/run")), path("no/run") + ": No such file or directory");
    writeAll(path("file"), "x");
    EXPECT_EQ(start(path("file")), path("file") + ": Not a directory");
    EXPECT_EQ(readAll(path("file")), "x");
    fs::create_directories(path("run/scans.jsonl"));
    EXPECT_EQ(start(path("run")), path("run/scans.jsonl") + ": Is a directory");
}

TEST_F(RecorderTest, NamesTheFileAFullDiskRefuses) {
    const Scene scene = testing::scene(kRoom, kRobots);
    World world(scene, milliseconds(5));
    for (const char* name : {"robots.csv", "scans.jsonl", "info.csv", "timing.csv"}) {
        const fs::path folder = folder_ / "on" / name, file = folder / name;
        fs::create_directories(folder);
        fs::create_symlink("/dev/full", file);
        EXPECT_EQ(errorOf([&] { Recorder(folder, world, {}); }),
                  file.string().append(": No space left on device"));
    }
}

TEST_F(RecorderTest, KeepsWholeLinesWhenTheDiskIsFull) {
    const Scene scene = testing::scene(kRoom, kRobots);
    World world(scene, milliseconds(5));
    constexpr rlim_t kSpace = 10007;
    {
        Recorder recorder(path("run"), world, {});
        const testing::FileSizeLimit limit(kSpace);
        // A slow machine may meet it in record().
        const auto run = [&] {
            for (int i = 0; i < 1000; ++i) recorder.record(world);
            recorder.flush(world);
        };
        const std::string error = errorOf(run);
        EXPECT_EQ(error, path("run/robots.csv") + ": File too large");
        EXPECT_EQ(errorOf(run), error) << "it stays an error: lines are missing";
    }
    const std::string robots = text("run/robots.csv");
    EXPECT_TRUE(robots.ends_with(",0\n"));
    EXPECT_LE(robots.size(), kSpace);
    EXPECT_GT(robots.size() + 60, kSpace);
}

/// Steps that robots.csv holds, as both robots have a line of each.
std::string infoOf(const std::string& robots) {
    const std::int64_t steps = (linesOf(robots) - 1) / 2 - 1;
    return "dt,control_interval,steps,elapsed,seed,noise\n0.005,0.005," + std::to_string(steps) +
           "," + formatSimTime(steps * milliseconds(5)) + ",0,0\n";
}

TEST_F(RecorderTest, InfoTellsTheStepsThatAreThereWhenTheDiskIsFull) {
    const auto run = [&](const std::string& sensor, int steps) {
        const Scene scene = testing::scene(kRoom, kRobots + sensor);
        World world(scene, milliseconds(5));
        Recorder recorder(path("run"), world, {});
        const testing::FileSizeLimit limit(10007);
        return errorOf([&] {
            for (int i = 0; i < steps; ++i) {
                world.step();
                recorder.record(world);
            }
            recorder.flush(world);
        });
    };
    EXPECT_EQ(run("", 1000), path("run/robots.csv") + ": File too large");
    std::string robots = text("run/robots.csv");
    EXPECT_EQ(linesOf(robots) % 2, 1) << "the header, and whole steps";
    EXPECT_GT(linesOf(robots), 200);
    EXPECT_EQ(text("run/info.csv"), infoOf(robots));

    // Scans take more room than robots, and end with them.
    EXPECT_EQ(run("laser id=l1 at=0,0 rate=200 fov=90\n", 150),
              path("run/scans.jsonl") + ": File too large");
    robots = text("run/robots.csv");
    EXPECT_EQ(linesOf(robots) % 2, 1);
    EXPECT_EQ(text("run/info.csv"), infoOf(robots));
    EXPECT_EQ(linesOf(text("run/scans.jsonl")), (linesOf(robots) - 1) / 2 + 1);
}

TEST_F(RecorderTest, LinksAreNotFollowed) {
    const Scene scene = testing::scene(kRoom, kRobots);
    World world(scene, milliseconds(5));
    writeAll(path("mine"), "old");
    for (const char* name : {"robots.csv", "info.csv"}) {
        fs::remove_all(path("run"));
        fs::create_directory(path("run"));
        fs::create_hard_link(path("mine"), path("run/") + name);
        { const Recorder recorder(path("run"), world, {}); }
        EXPECT_EQ(text("mine"), "old");
        EXPECT_NE(text(std::string("run/") + name), "old");
        fs::remove(path("run/") + name);
        for (const char* target : {"../mine", "../none"}) {
            fs::create_symlink(target, path("run/") + name);
            EXPECT_THROW(Recorder(path("run"), world, {}), FormatError);
            EXPECT_EQ(text("mine"), "old");
            EXPECT_FALSE(fs::exists(path("none")));
            fs::remove(path("run/") + name);
        }
    }
}

TEST_F(RecorderTest, EndsTheRunAtItsLimit) {
    const Scene scene = testing::scene(kRoom, kRobots);
    World world(scene, milliseconds(5));
    Recorder recorder(path("run"), world, {.max_bytes = 100'000});
    std::string error;
    try {
        for (int i = 0; i < 100'000; ++i) {
            world.step();
            recorder.record(world);
        }
    } catch (const FormatError& failed) {
        error = failed.what();
    }
    EXPECT_NE(error.find("wanted at most 100000"), std::string::npos) << error;
    const std::string lines = text("run/robots.csv");
    std::uintmax_t whole = 0;
    for (const auto& file : fs::directory_iterator(path("run"))) whole += file.file_size();
    EXPECT_GT(whole, 100'000U);
    EXPECT_LT(lines.size(), 3'000'000U) << "a flush beyond";
    EXPECT_TRUE(lines.ends_with('\n'));
    EXPECT_EQ(linesOf(lines), 1 + 2 * (world.steps() + 1)) << "those of the last step, too";
}

TEST_F(RecorderTest, ScenesCountForTheLimit) {
    const Scene scene = testing::scene(kRoom, kRobots);
    World world(scene, milliseconds(5));
    Recorder recorder(path("run"), world, {.max_bytes = 100'000});
    EXPECT_EQ(recorder.recordScene(std::string(60'000, ' ')), "scenes/scene-000001.env");
    EXPECT_NO_THROW(recorder.flush(world));
    EXPECT_EQ(recorder.recordScene(std::string(60'000, ' ')), "scenes/scene-000002.env");
    EXPECT_THROW(recorder.flush(world), FormatError);
}

}  // namespace recorder_test
}  // namespace ispace
