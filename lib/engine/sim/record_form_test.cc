// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/record_form.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <system_error>

#include "base/error.h"
#include "base/file.h"
#include "base/zstd_text.h"
#include "scene/run/run_reader.h"
#include "sim/recorder.h"
#include "sim/replay.h"
#include "support/file_size_limit.h"
#include "support/test_folder.h"
#include "support/test_layout.h"

namespace ispace {
namespace record_form_test {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

constexpr SimTime kStep = milliseconds(20);
constexpr const char* kRoom = "ispace size=8,6\npillar id=post at=2,0 size=0.2,0.2,2.5\n";
constexpr const char* kWho =
    "robot id=r1 at=0,0\nrobot id=r2 at=-2,-2\nlaser id=l1 on=r1 range=4 rate=10\n"
    "human id=h1 at=1,2\n";

class RecordFormTest : public ::testing::Test {
  protected:
    [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }
    /// The text of a file of a record, unpacked.
    [[nodiscard]] std::string text(const std::string& name) const {
        const std::string packed = path(name) + std::string(kZstdSuffix);
        TextFile file(fs::exists(packed) ? packed : path(name));
        std::string text;
        while (file.read(text)) continue;
        return text;
    }
    /// Drives r1 round a bend into the post, in so many steps.
    void record(const std::string& name, const RecordForm& form, int steps = 200) {
        World world(scene_, kStep);
        Recorder recorder(path(name), world, {.odometry = true, .form = form});
        world.command(0, {.verb = Verb::Speed, .value = 1.2});
        world.command(0, {.verb = Verb::Rotspeed, .value = 2});
        for (int i = 0; i < steps; ++i) {
            world.step();
            recorder.record(world);
        }
        recorder.flush(world);
    }

    Scene scene_ = testing::scene(kRoom, kWho);
    testing::TestFolder folder_;
};

/// The rows of a table whose times are multiples of `every` ms, and of them these columns.
std::string thinned(const std::string& table, int every, const std::vector<std::size_t>& columns) {
    std::istringstream lines(table);
    std::string line, out;
    for (bool is_head = true; std::getline(lines, line); is_head = false) {
        std::vector<std::string> fields;
        std::istringstream rest(line);
        for (std::string field; std::getline(rest, field, ',');) fields.push_back(field);
        if (!is_head && std::lround(1000 * std::stod(fields[0])) % every != 0) continue;
        for (const std::size_t column : columns)
            out += (column == columns.front() ? "" : ",") + fields.at(column);
        out += '\n';
    }
    return out;
}

const std::vector<std::size_t> kAll = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
const std::vector<std::size_t> kOdometry = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10};

TEST_F(RecordFormTest, HasTheRowsOfTheWholeRecord) {
    record("whole", {});
    record("thin", {.every = milliseconds(100)});
    for (const char* name : {"robots.csv", "people.csv"})
        EXPECT_EQ(text(std::string("thin/") + name),
                  thinned(text(std::string("whole/") + name), 100, kAll));
    EXPECT_EQ(text("thin/odometry.csv"), thinned(text("whole/odometry.csv"), 100, kOdometry));
    for (const char* name : {"scans.jsonl", "sonars.csv", "bumpers.csv"})
        EXPECT_EQ(text(std::string("thin/") + name), text(std::string("whole/") + name));
    EXPECT_EQ(text("whole/info.csv"),
              "dt,control_interval,steps,elapsed,seed,noise\n0.02,0.02,200,4,0,0\n");
    EXPECT_EQ(text("thin/info.csv"),
              "dt,control_interval,steps,elapsed,seed,noise,every\n0.02,0.02,200,4,0,0,0.1\n");
    const auto info = recordedInfo(path("thin")).value();
    EXPECT_EQ(info.step, 0.02);
    EXPECT_EQ(info.every, 0.1);
    EXPECT_EQ(recordedInfo(path("whole")).value().every, 0.02);
}

TEST_F(RecordFormTest, HasTheColumnsOfTheWholeRecord) {
    record("whole", {});
    record("few", {.columns = std::vector<std::string>{"stall", "phase"}});
    record("poses", {.columns = std::vector<std::string>()});
    EXPECT_EQ(text("few/robots.csv"), thinned(text("whole/robots.csv"), 1, {0, 1, 2, 3, 4, 9}));
    EXPECT_EQ(text("few/people.csv"), thinned(text("whole/people.csv"), 1, {0, 1, 2, 3, 4, 7, 9}));
    EXPECT_EQ(text("poses/robots.csv"), thinned(text("whole/robots.csv"), 1, {0, 1, 2, 3, 4}));
    EXPECT_EQ(text("poses/odometry.csv"), text("whole/odometry.csv"));
}

TEST_F(RecordFormTest, CompressedFilesHoldTheSameText) {
    record("whole", {});
    record("packed", {.packs = true});
    for (const char* name :
         {"robots.csv", "people.csv", "odometry.csv", "sonars.csv", "scans.jsonl"}) {
        const std::string file = std::string("packed/") + name;
        EXPECT_FALSE(fs::exists(path(file)));
        EXPECT_EQ(text(file), text(std::string("whole/") + name));
    }
    EXPECT_LT(2 * fs::file_size(path("packed/robots.csv.zst")),
              fs::file_size(path("whole/robots.csv")));
    EXPECT_EQ(text("packed/info.csv"), text("whole/info.csv"));
}

TEST_F(RecordFormTest, NoFileOfAnEarlierRunRemains) {
    for (const bool packs : {true, false, true}) {
        record("run", {.packs = packs}, 3);
        EXPECT_EQ(fs::exists(path("run/robots.csv")), !packs);
        EXPECT_EQ(fs::exists(path("run/robots.csv.zst")), packs);
    }
    fs::create_symlink("elsewhere", path("run/people.csv"));
    EXPECT_THROW(record("run", {.packs = true}, 3), FormatError);
}

TEST_F(RecordFormTest, RefusesPartsOfSteps) {
    for (const int ms : {10, 30, 110})
        EXPECT_THROW((void)RecordForm{.every = milliseconds(ms)}.stride(kStep), UsageError) << ms;
    EXPECT_EQ(RecordForm{.every = milliseconds(100)}.stride(kStep), 5);
    EXPECT_EQ(RecordForm{}.stride(kStep), 1);
}

/// Replays step by step: times and places of r1.
std::string replayed(const std::string& folder, const Scene& scene) {
    Replay replay(folder);
    World world(scene, replay.stepLength());
    std::ostringstream out;
    while (replay.step(world))
        out << world.steps() << ' ' << world.time().count() << ' '
            << world.status(0).pose.position.x << ' ' << world.odometry(0).pose.position.x << '\n';
    EXPECT_FALSE(replay.isCut());
    EXPECT_EQ(replay.end(), world.time());
    return out.str();
}

TEST_F(RecordFormTest, IsReplayedInStepsOfItsMoments) {
    record("whole", {}, 203);
    record("packed", {.packs = true}, 203);
    record("thin", {.every = milliseconds(100), .packs = true}, 203);
    EXPECT_EQ(replayed(path("packed"), scene_), replayed(path("whole"), scene_));
    EXPECT_EQ(Replay(path("thin")).stepLength(), milliseconds(100));
    std::istringstream whole(replayed(path("whole"), scene_));
    std::string expected, step, rest;
    for (int i = 1; whole >> step && std::getline(whole, rest); ++i)
        if (i % 5 == 0) expected += std::to_string(i / 5) + rest + '\n';
    EXPECT_EQ(replayed(path("thin"), scene_), expected);
}

/// All files end with the step that info.csv names, which is one at which blocks end.
TEST_F(RecordFormTest, CompressedFilesEndTogetherWhenTheDiskIsFull) {
    Scene scene = testing::scene(kRoom, std::string(kWho) + "laser id=l2 on=r1 rate=50 fov=270\n");
    World world(scene, kStep);
    std::string error;
    {
        Recorder recorder(path("full"), world, {.odometry = true, .form = {.packs = true}});
        world.command(0, {.verb = Verb::Rotspeed, .value = 5});
        const testing::FileSizeLimit limit(100000);
        try {
            for (int i = 0; i < 3000; ++i) {
                world.step();
                recorder.record(world);
                if (i % 7 == 0) recorder.flush(world);
            }
        } catch (const std::system_error& failure) {
            error = failure.what();
        }
    }
    EXPECT_EQ(error, path("full/scans.jsonl.zst") + ": File too large");
    const std::int64_t steps = recordedInfo(path("full")).value().steps;
    EXPECT_GT(steps, 20);
    const auto count = [this](const char* name) {
        const std::string all = text(std::string("full/") + name);
        EXPECT_TRUE(all.ends_with('\n'));
        return std::count(all.begin(), all.end(), '\n') - 1;
    };
    EXPECT_EQ(count("robots.csv"), 2 * (steps + 1));
    EXPECT_EQ(count("odometry.csv"), 2 * (steps + 1));
    EXPECT_EQ(count("people.csv"), steps + 1);
    RunReader reader(path("full"));
    std::int64_t moments = 0;
    while (reader.next()) ++moments;
    EXPECT_EQ(moments, steps + 1);
    EXPECT_FALSE(reader.isCut());
}

TEST_F(RecordFormTest, ReadersSkipATornBlock) {
    record("run", {.packs = true});
    const std::string file = path("run/robots.csv.zst"), bytes = readAll(file);
    fs::resize_file(file, bytes.size() - 7);
    RunReader reader(path("run"));
    double last = 0;
    while (reader.next()) last = reader.time();
    EXPECT_GE(last, 0);
    EXPECT_LE(last, 4);
    EXPECT_TRUE(last == 4 || reader.isCut());
    writeAll(file, "t,id,x,y,heading_deg\n");
    EXPECT_THROW(RunReader(path("run")), FormatError);
}

}  // namespace record_form_test
}  // namespace ispace
