// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/record_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/file.h"
#include "sense/ultrasound_burst.h"
#include "sim/recorder.h"
#include "support/test_folder.h"
#include "support/test_layout.h"

namespace ispace {
namespace record_lines_test {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

/// A folder of its own for each test, removed afterwards.
class RecordLines : public ::testing::Test {
  protected:
    [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }
    [[nodiscard]] std::size_t filesIn(const std::string& name) const {
        const fs::directory_iterator all(path(name));
        return static_cast<std::size_t>(std::distance(begin(all), end(all)));
    }

    testing::TestFolder folder_;
};

constexpr std::uint32_t kAll = ~std::uint32_t{0};  // columns

const std::string kThings =
    "robot id=r1 at=1,1\n"
    "human id=h1 at=0,0 heading=90\n"
    "camera id=c1 at=-2,0,1 pixels=8,6 rate=10\n"
    "ranger id=d1 at=-2,0,1 pixels=4,3 rate=4\n"
    "mat id=m1 at=0,0 rate=1\n"
    "gate id=g1 at=0,2 rate=1\n";

Scene room(const std::string& more = "") {
    return testing::scene("ispace size=8,6\n", kThings + more);
}

std::string lineOf(const World& world, const std::string& id) {
    const std::size_t i = world.sensorNamed(id).value();
    std::string out;
    appendReadingLine(out, world.sensors()[i], world.reading(i), {}, "pictures/x.png");
    return out;
}

TEST_F(RecordLines, OfWhatLiesOnTheFloor) {
    const Scene scene = room();
    const World world(scene, milliseconds(100));
    EXPECT_EQ(lineOf(world, "m1"),
              "{\"sensor\":\"m1\",\"t\":0,\"frame\":0,\"pose\":[0,0,0,0,0,0],\"on\":[\"h1\"]}\n");
    EXPECT_EQ(lineOf(world, "g1"),
              "{\"sensor\":\"g1\",\"t\":0,\"frame\":0,\"pose\":[0,2,0,0,0,0],\"in\":0,\"out\":0,"
              "\"last\":null,\"way\":null,\"broken\":false}\n");
}

TEST_F(RecordLines, OfReceivers) {
    const Scene scene =
        room("ultrasound id=u1 at=0,-2,2 tilt=-90\ntag id=t1 at=0,-2,1\ntag id=t2 at=0,-2,3\n");
    const World world(scene, milliseconds(100));
    const std::string line = lineOf(world, "u1");
    // A metre at 343.42 m/s.
    EXPECT_NE(line.find("\"tags\":[{\"tag\":\"t1\",\"time_of_flight\":0.00291188631996}"),
              std::string::npos)
        << line;
    EXPECT_TRUE(line.ends_with("{\"tag\":\"t2\",\"time_of_flight\":null}]}\n")) << line;
}

TEST_F(RecordLines, PeopleHaveATable) {
    const Scene scene = room();
    World world(scene, milliseconds(100));
    std::string out, again;
    RowTexts known, fresh;
    appendPeopleRows(out, world, known, kAll);
    EXPECT_EQ(out, "0,h1,0,0,90,0,0,0,0,0\n");
    world.command(1, {Verb::Speed, 1});
    for (int i = 0; i < 10; ++i) world.step();
    out.clear();
    appendPeopleRows(out, world, known, kAll);
    appendPeopleRows(again, world, fresh, kAll);
    EXPECT_EQ(out, again);
    const RobotStatus status = world.status(1);
    EXPECT_GT(status.phase, 0);
    EXPECT_TRUE(out.starts_with("1,h1,")) << out;
    EXPECT_EQ(std::count(out.begin(), out.end(), ','),
              std::count(kPeopleHead.begin(), kPeopleHead.end(), ','));
}

/// A change in the step of a frame does not make it due again, nor bumpers felt anew.
TEST_F(RecordLines, AFrameIsRecordedOnceAlsoIfTheWorldChanges) {
    const Scene scene =
        room("camera id=c9 at=0,1,1 pixels=8,6 rate=1\nrobot id=p model=pioneer-2dx at=2.5,-2\n");
    World world(scene, milliseconds(50));
    RecordOptions options;
    options.frame_taker = [&](const FrameJob& job) {
        job.use(world.captureLater(job.sensor)());
        job.deliver(nullptr);
    };
    {
        Recorder recorder(path("run"), world, options);
        for (int i = 0; i < 50; ++i) {
            world.step();
            recorder.record(world);
            EXPECT_TRUE(recorder.finishStep(world, std::chrono::steady_clock::time_point::max()));
            if (i % 10 == 9) world.change(Scene(scene));
        }
        recorder.end(world);
    }
    const std::string scans = readAll(path("run/scans.jsonl"));
    std::size_t frames = 0;
    for (auto at = scans.find("\"c9\""); at != std::string::npos; at = scans.find("\"c9\"", at + 1))
        ++frames;
    EXPECT_EQ(frames, 3U) << "at 0, 1 and 2 s";
    const std::string bumpers = readAll(path("run/bumpers.csv"));
    EXPECT_EQ(std::count(bumpers.begin(), bumpers.end(), '\n'), 2) << bumpers;
}

TEST_F(RecordLines, FramesMayBeLeftOut) {
    const Scene scene = room("camera id=c9 at=0,1,1 pixels=8,6 rate=1\n");
    World world(scene, milliseconds(50));
    {
        Recorder recorder(path("run"), world, {.readings = false});
        world.step();
        recorder.record(world);
        recorder.end(world);
    }
    EXPECT_EQ(readAll(path("run/scans.jsonl")).find("c9"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(path("run/pictures")));
}

/// The record does not depend on the thread that makes frames; frames unfinished at the end are
/// left out.
TEST_F(RecordLines, FramesMayBeMadeAside) {
    const Scene scene = room("laser id=l1 at=0,1 rate=10\n");
    const auto run = [&](const std::string& name, bool aside, bool ends) {
        World world(scene, milliseconds(50));
        std::vector<std::function<void()>> jobs;
        RecordOptions options;
        if (aside)
            options.frame_taker = [&](const FrameJob& job) {
                jobs.push_back([take = world.captureLater(job.sensor), job] {
                    const SensorReading reading = take();
                    job.use(reading);
                    job.deliver(nullptr);
                });
            };
        Recorder recorder(path(name), world, options);
        constexpr auto kEver = std::chrono::steady_clock::time_point::max();
        for (int i = 0; i <= 40; ++i) {
            EXPECT_EQ(recorder.finishStep(world, kEver), jobs.empty());
            EXPECT_EQ(recorder.awaitsFrames(), !jobs.empty());
            if (i == 40 && !ends) break;
            for (const auto& job : jobs) job();
            jobs.clear();
            EXPECT_TRUE(recorder.finishStep(world, kEver));
            if (i == 40) break;
            world.step();
            recorder.record(world);
        }
        recorder.end(world);
        return readAll(path(name + "/scans.jsonl"));
    };
    const std::string whole = run("whole", false, true);
    EXPECT_EQ(run("aside", true, true), whole);
    EXPECT_EQ(filesIn("aside/pictures"), filesIn("whole/pictures"));
    const std::string cut = run("cut", true, false);
    EXPECT_TRUE(whole.starts_with(cut));
    const std::string last = whole.substr(cut.size());
    EXPECT_NE(last.find("pictures/c1-000020.png"), std::string::npos) << last;
    EXPECT_EQ(std::count(last.begin(), last.end(), '\n'), 2) << last;
    EXPECT_EQ(filesIn("cut/pictures") + 1, filesIn("whole/pictures"));
    for (const char* file : {"/robots.csv", "/info.csv"})
        EXPECT_EQ(readAll(path("cut") + file), readAll(path("whole") + file));
}

TEST_F(RecordLines, FramesAreRecordedAtTheirRate) {
    const auto run = [&](const std::string& name, double rate) {
        const Scene scene = room();
        World world(scene, milliseconds(50));
        Recorder recorder(path(name), world, {.frame_rate = rate});
        for (int i = 0; i < 40; ++i) {
            world.step();
            recorder.record(world);
            // Pictures of another client are not those of the record.
            if (i % 7 == 0) world.captureNow(0);
        }
        recorder.flush(world);
    };
    run("one", 1);
    EXPECT_EQ(filesIn("one/pictures"), 3U);
    EXPECT_EQ(filesIn("one/depths"), 3U);
    EXPECT_TRUE(fs::exists(path("one/pictures/c1-000010.png")));
    EXPECT_TRUE(fs::exists(path("one/depths/d1-000008.png")));
    run("all", 100);
    EXPECT_EQ(filesIn("all/pictures"), 21U);
    EXPECT_EQ(filesIn("all/depths"), 9U);
    // The same folder again: no file of the run before is left.
    run("all", 0);
    EXPECT_EQ(filesIn("all/pictures"), 0U);
    EXPECT_EQ(filesIn("all/depths"), 0U);
    const std::string scans = readAll(path("one/scans.jsonl"));
    EXPECT_NE(scans.find("\"file\":\"pictures/c1-000010.png\"}\n"), std::string::npos);
}

TEST_F(RecordLines, OthersFilesStayAmongTheFrames) {
    fs::create_directories(path("run/pictures"));
    for (const char* name : {"mine.png", "c1-12.png", "notes-000001.txt", "c1-000001.png"})
        writeAll(path("run/pictures/") + name, "x");
    const Scene scene = room();
    World world(scene, milliseconds(50));
    { const Recorder recorder(path("run"), world, {.frame_rate = 0}); }
    EXPECT_EQ(filesIn("run/pictures"), 3U);
    EXPECT_FALSE(fs::exists(path("run/pictures/c1-000001.png")));
}

TEST_F(RecordLines, FramesBehindTheEndAreTakenBack) {
    FrameFiles frames(path("frames"));
    frames.write("a-000001.png", "1", 1);
    frames.keepUpTo(1);
    frames.write("a-000002.png", "22", 2);
    frames.write("a-000003.png", "333", 3);
    EXPECT_EQ(frames.size(), 6U);
    frames.cutBehind(2);
    EXPECT_EQ(filesIn("frames"), 2U);
    EXPECT_EQ(readAll(path("frames/a-000002.png")), "22");
}

TEST_F(RecordLines, StepsBeforeTheLastWholeOneCannotBeTakenBack) {
    LineFile file(path("lines"));
    for (std::int64_t step = 1; step <= 3; ++step) {
        file.pending += std::to_string(step) + "\n";
        file.endStep(step);
    }
    file.flush();
    file.forgetBefore(2);
    EXPECT_EQ(file.wholeSteps(), 3);
    file.cutBehind(1);
    EXPECT_EQ(readAll(path("lines")), "1\n2\n3\n");
    file.cutBehind(2);
    EXPECT_EQ(readAll(path("lines")), "1\n2\n");
}

TEST(FrameName, HasTheIdAndThePeriod) {
    EXPECT_EQ(frameName("c1", 5), "c1-000005.png");
    EXPECT_EQ(frameName("hall/c1", 12345678), "hall%2Fc1-12345678.png");
}

TEST_F(RecordLines, EventsHaveATable) {
    const Scene scene = room();
    World world(scene, milliseconds(100));
    EventLog events(world);
    Recorder recorder(path("run"), world, {}, &events);
    events.add(EventKind::Mark, "begin");
    world.step();
    events.stepped();
    recorder.record(world);
    recorder.flush(world);
    const std::string table = readAll(path("run/events.csv"));
    EXPECT_NE(table.find("0,mark,,,,,"), std::string::npos) << table;
    EXPECT_NE(table.find("0.1,mat,m1,h1,"), std::string::npos) << table;
}

TEST_F(RecordLines, EventsAfterTheLastStepAreKept) {
    const Scene scene = room();
    World world(scene, milliseconds(100));
    EventLog events(world);
    Recorder recorder(path("run"), world, {}, &events);
    world.step();
    events.stepped();
    recorder.record(world);
    recorder.flush(world);
    EXPECT_FALSE(recorder.flushDue(std::chrono::steady_clock::now()));
    const std::string before = readAll(path("run/events.csv"));
    // In a world that waits they are written, too, when others are.
    events.add(EventKind::Mark, "first");
    EXPECT_TRUE(recorder.flushDue({}));
    EXPECT_FALSE(recorder.flushDue(std::chrono::steady_clock::time_point::max()));
    EXPECT_EQ(readAll(path("run/events.csv")), before + "0.1,mark,,,,,,first\n");
    events.add(EventKind::Mark, "last");
    recorder.flush(world);
    EXPECT_EQ(readAll(path("run/events.csv")),
              before + "0.1,mark,,,,,,first\n0.1,mark,,,,,,last\n");
}

}  // namespace record_lines_test
}  // namespace ispace
