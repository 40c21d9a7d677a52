// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/reading_run.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/number.h"
#include "support/test_readings.h"

namespace ispace {

namespace reading_run_test {

const std::string kRoom =
    "ispace at=4,3 size=8,6,2.5\ndesk at=2,2 heading=20\ncylinder at=5,4 size=1,1,1\n";

/// All sensors of a scene, some frames of them, in a format.
std::string run(const Scene& scene, const std::string& format, int frames,
                const TakerOptions& options = {}) {
    const Sensors sensors = sensorsOf(scene, {});
    RayScenes worlds(scene.environment);
    const MovingBodies bodies(bodiesOf(scene));
    ReadingSampler taker(sensors, worlds, bodies, options);
    StillSource source(sensors, frames);
    SilentProgress progress;
    const auto writer = makeFormat(format, sensors, {});
    std::string out;
    runReadings(source, taker, sensors, *writer, Packing::Stream, Coordinates::World, progress,
                [&](Readings& readings) { out += readings.text; });
    return out;
}

const std::string kSensors =
    "robot id=r1 at=6,2\n"
    "human at=3,4\n"
    "laser at=1,1 sigma=0.01,0.01 dropout=0.05 incidence=60,80\n"
    "laser at=6,5,0.4 tilt=-20 sigma=0.02 angle_sigma=0.2 spin=10\n"
    "laser on=r1 model=urg-04lx\n"
    "laser at=4,3,2 tilt=-90 sweep=heading sweep_step=10 spin=20\n"
    "ranger at=1,5,1 heading=-30 tilt=-15 pixels=40,30 sigma=0.01 resolution=0.001\n"
    "ranger at=7,5,1 model=vlp-16 pixels=90,16\n"
    "ultrasound at=1,1,2.4 tilt=-90 sigma=0.01\nultrasound at=7,1,2.4 tilt=-90 sigma=0.01\n"
    "ultrasound at=1,5,2.4 tilt=-90 sigma=0.01\nultrasound at=7,5,2.4 tilt=-90 sigma=0.01\n"
    "tag at=4,3,0.5\ntag at=5,2,1 locate=simple\n";

TEST(ReadingRun, SameBytesForAnyNumberOfThreads) {
    const Scene scene = testing::scene(kRoom, kSensors);
    const std::string once = run(scene, "jsonl", 20, {.noise_seed = 7});
    EXPECT_EQ(std::count(once.begin(), once.end(), '\n'), 20 * (3 + 36 + 2 + 2));
    for (const std::size_t threads : {1U, 2U, 5U}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        EXPECT_EQ(run(scene, "jsonl", 20, {.noise_seed = 7}), once) << threads;
    }
    EXPECT_NE(run(scene, "jsonl", 20, {.noise_seed = 8}), once);
    EXPECT_NE(run(scene, "jsonl", 20), once);
}

TEST(ReadingRun, NoiseOfASensorDoesNotDependOnTheOthers) {
    const auto ranges = [](const std::string& layout) {
        const std::vector<Scan> scans =
            testing::scans(testing::scene(kRoom, layout), {.noise_seed = 3});
        return scans.back().ranges;
    };
    const std::string laser = "laser id=a at=1,1 model=utm-30lx\n";
    EXPECT_EQ(ranges(laser), ranges("laser id=b at=2,5 model=utm-30lx\n" + laser));
    EXPECT_NE(ranges(laser), ranges("laser id=b at=1,1 model=utm-30lx\n"));
}

TEST(ReadingRun, FramesDifferByNoiseAlone) {
    const Scene scene = testing::scene(kRoom, "laser at=1,1 sigma=0.01\n");
    const std::string clean = run(scene, "raw", 3), noisy = run(scene, "raw", 3, {.noise_seed = 0});
    const std::size_t frame = clean.size() / 3;
    ASSERT_EQ(frame, 181 * sizeof(float));
    EXPECT_EQ(clean.substr(0, frame), clean.substr(frame, frame));
    EXPECT_NE(noisy.substr(0, frame), noisy.substr(frame, frame));
    EXPECT_NE(noisy.substr(0, frame), clean.substr(0, frame));
}

TEST(ReadingRun, ErrorsComeThrough) {
    const Scene scene = testing::scene(kRoom, "laser at=1,1 tilt=-5\n");
    EXPECT_THROW(run(scene, "carmen", 1), UsageError);
    const Scene ranger = testing::scene(kRoom, "ranger at=1,1\nlaser at=2,2\n");
    EXPECT_THROW(run(ranger, "carmen", 1), UsageError);
    EXPECT_THROW(makeFormat("csv", sensorsOf(ranger, {}), {})->checkStream(), UsageError);
}

TEST(ReadingRun, WhatComesBeforeAFailureIsWritten) {
    /// Fails behind its last job.
    class Failing final : public ReadingSource {
      public:
        void next(std::size_t most, std::vector<ReadingJob>& batch) override {
            EXPECT_FALSE(failed_) << "asked again";
            batch.clear();
            while (batch.size() < most) {
                failed_ = frame_ == 1000;
                if (failed_) throw FormatError({"poses", 1001, 0, "bad"});
                batch.push_back({0, frame_++, 0, {{1, 1, 0.15}, {}, {}, {}}, {}});
            }
        }

      private:
        int frame_ = 0;
        bool failed_ = false;
    };
    const Scene scene = testing::scene(kRoom, "laser at=1,1 step=5\n");
    const Sensors sensors = sensorsOf(scene, {});
    for (int i = 0; i < 10; ++i) {
        RayScenes worlds(scene.environment);
        const MovingBodies nobody;
        ReadingSampler taker(sensors, worlds, nobody, {});
        Failing source;
        SilentProgress progress;
        const auto raw = makeFormat("raw", sensors, {});
        std::size_t bytes = 0;
        EXPECT_THROW(
            runReadings(source, taker, sensors, *raw, Packing::Stream, Coordinates::World, progress,
                        [&](Readings& readings) { bytes += readings.text.size(); }),
            FormatError);
        EXPECT_EQ(bytes, 1000 * 37 * sizeof(float));
    }
}

TEST(Sensors, AChoiceOfTagsIsNoChoiceOfReceivers) {
    const Scene scene = testing::scene(kRoom,
                                       "ultrasound id=u1 at=1,1,2\nultrasound id=u2 at=2,1,2\ntag "
                                       "id=t1 at=1,2\ntag id=t2 at=2,2\n");
    const Sensors tag = sensorsOf(scene, {"t2"});
    ASSERT_EQ(tag.read.size(), 1U);
    EXPECT_EQ(tag.read[0].id, "t2");
    EXPECT_EQ(tag.receivers.size(), 2U);
    EXPECT_EQ(sensorsOf(scene, {"t1", "u2"}).receivers.size(), 1U);
    EXPECT_TRUE(sensorsOf(scene, {"u*"}).read.empty());
    EXPECT_THROW(sensorsOf(scene, {"x*"}), UsageError);
}

/// A trajectory as a source would read it, in pieces of some bytes.
PoseLines linesOf(const std::string& text, std::size_t piece = 7) {
    auto left = std::make_shared<std::string>(text);
    return {[left, piece](std::string& buffer) {
                const std::size_t n = std::min(piece, left->size());
                buffer += left->substr(0, n);
                left->erase(0, n);
                return n > 0;
            },
            "poses.txt"};
}

/// Two rooms with a tag, a receiver and a laser each.
struct TwoRooms {
    std::vector<std::shared_ptr<const Scene>> scenes;
    std::vector<std::string> ids = {"a", "b"};
    TwoRooms() {
        for (const char* records :
             {"ultrasound id=u at=1,1,2\ntag id=t at=1,2\nlaser id=l at=2,1\n",
              "ultrasound id=u at=1,1,1\ntag id=t at=1,2\n"})
            scenes.push_back(std::make_shared<const Scene>(testing::scene(kRoom, records)));
    }
};

TEST(Sensors, OfSeveralRoomsHaveTheRoomBeforeTheirIds) {
    const TwoRooms site;
    const auto [sensors, rooms] = sensorsOf(site.scenes, site.ids, {});
    ASSERT_EQ(sensors.read.size(), 3U);
    EXPECT_EQ(sensors.read[0].id, "a/t");
    EXPECT_EQ(sensors.read[2].id, "b/t");
    EXPECT_EQ(roomOf(rooms, 1), 0U);
    EXPECT_EQ(roomOf(rooms, 2), 1U);
    ASSERT_EQ(receiversIn(rooms, 1, sensors).size(), 1U) << "those of its room";
    EXPECT_EQ(receiversIn(rooms, 1, sensors)[0].id, "b/u");
    EXPECT_EQ(sensorsOf(site.scenes, site.ids, {"b/*"}).sensors.read.size(), 1U);
    try {
        static_cast<void>(sensorsOf(site.scenes, site.ids, {"t"}));
        FAIL();
    } catch (const UsageError& error) {
        EXPECT_STREQ(error.what(), "no sensor matches `t` (there are a/u, a/t, a/l, b/u, b/t)");
    }
}

TEST(RoomParts, EndWhereTheRoomChanges) {
    const TwoRooms site;
    const SiteSensors all = sensorsOf(site.scenes, site.ids, {});
    StillSource source(all.sensors, 2, all.rooms);
    EXPECT_EQ(source.skip(1), 1);
    RoomParts parts(source, [&](const ReadingJob& job) { return roomOf(all.rooms, job.sensor); });
    std::vector<ReadingJob> batch;
    std::string text;
    while (const auto room = parts.begin(1)) {
        text += std::to_string(*room) + ':';
        for (parts.next(2, batch); !batch.empty(); parts.next(2, batch))
            for (const ReadingJob& job : batch)
                text += all.sensors.read[job.sensor].id + std::to_string(job.frame) + ' ';
    }
    EXPECT_EQ(text, "0:a/l0 a/t1 a/l1 1:b/t0 b/t1 ") << "frame by frame in each room";
}

TEST(RoomParts, GiveTheJobsBeforeAFailure) {
    PoseSource source(linesOf("0 1 1 0 0 0 0 1\n1 1 1 3 0 0 0 1\n2 x\n"));
    RoomParts parts(source,
                    [](const ReadingJob& job) { return job.pose.position.z > 2 ? 1U : 0U; });
    std::vector<ReadingJob> batch;
    EXPECT_EQ(parts.begin(1), 0U);
    parts.next(10, batch);
    EXPECT_EQ(batch.size(), 1U);
    parts.next(10, batch);
    EXPECT_TRUE(batch.empty());
    EXPECT_EQ(parts.begin(1), 1U);
    parts.next(10, batch);
    EXPECT_EQ(batch.size(), 1U);
    EXPECT_THROW(parts.next(10, batch), FormatError);
}

TEST(ReadingRun, JobsInTheFrameOfTheSite) {
    const Scene scene = testing::scene(kRoom, "laser id=l at=1,1 step=30 spin=10\n");
    const Sensors sensors = sensorsOf(scene, {});
    const auto run_at = [&](const std::string& pose, const Pose3* site_from_room) {
        PoseSource source(linesOf("0 " + pose + "\n"));
        RayScenes worlds(scene.environment);
        const MovingBodies nobody;
        ReadingSampler taker(sensors, worlds, nobody, {.follows_poses = true});
        const auto writer = makeFormat("jsonl", sensors, {});
        SilentProgress progress;
        std::string text;
        runReadings(
            source, taker, sensors, *writer, Packing::Stream, Coordinates::World, progress,
            [&text](Readings& readings) { text += readings.text; }, site_from_room);
        return text;
    };
    const Pose3 site_from_room{{10, 0, 3}, {}, {}, {}};
    const std::string own = run_at("1 2 0.2 0 0 0 1", nullptr);
    const std::string moved = run_at("11 2 3.2 0 0 0 1", &site_from_room);
    EXPECT_NE(moved.find("\"pose\":[11,2,3.2,0,0,0]"), std::string::npos) << moved;
    EXPECT_EQ(own.substr(own.find("ranges")), moved.substr(moved.find("ranges")));
    EXPECT_EQ(toOuter(site_from_room, toInner(site_from_room, {{1, 2, 4}, {}, {}, {}})),
              (Pose3{{1, 2, 4}, {}, {}, {}}));
}

TEST(PoseSource, OneJobAPose) {
    PoseSource source(linesOf("# a comment\n0.5 1 2 0.15 0 0 0 1\n\n1.5 2 2 0.15 0 0 1 0"));
    std::vector<ReadingJob> batch, all;
    for (source.next(10, batch); !batch.empty(); source.next(10, batch))
        all.insert(all.end(), batch.begin(), batch.end());
    ASSERT_EQ(all.size(), 2U);
    EXPECT_EQ(all[0].time, 0.5);
    EXPECT_EQ(all[0].frame, 0);
    EXPECT_EQ(all[1].frame, 1);
    EXPECT_EQ(all[1].pose.position, (Point3{2, 2, 0.15}));
    EXPECT_NEAR(std::fabs(all[1].pose.heading.degrees()), 180, 1e-12);
    EXPECT_TRUE(all[1].way.empty());
}

TEST(PoseSource, GivesWhatIsThereBeforeItWaits) {
    int reads = 0;
    PoseSource source(PoseLines(
        [&reads](std::string& buffer) {
            buffer += "0 1 2 0.15 0 0 0 1\n1 1 2 0.15 0 0 0 1\n";
            return ++reads < 100;
        },
        "poses"));
    std::vector<ReadingJob> batch;
    source.next(50, batch);
    EXPECT_EQ(batch.size(), 2U);
    EXPECT_EQ(reads, 1);
}

TEST(PoseSource, ACommentBehindAPoseDoesNotHoldItBack) {
    for (const std::string tail : {"# wait\n", "\n\n", "2 1", ""}) {
        int reads = 0;
        const auto read = [&](std::string& buffer) {
            buffer += "0 1 2 0.15 0 0 0 1\n1 1 2 0.15 0 0 0 1\n" + tail;
            return ++reads < 2;
        };
        std::vector<ReadingJob> batch;
        PoseSource source(PoseLines(read, "poses"));
        source.next(50, batch);
        EXPECT_EQ(batch.size(), 2U) << tail;
        EXPECT_EQ(reads, 1) << tail;
        reads = 0;
        MotionSource motion(PoseLines(read, "poses"), 1, 0);
        motion.next(50, batch);
        EXPECT_EQ(batch.size(), 2U) << tail;
        EXPECT_EQ(reads, 1) << tail;
    }
}

TEST(PoseSource, BadLinesAreNamedByNumber) {
    PoseSource source(linesOf("# t\n0 1 2 0.15 0 0 0 1\n1 1 2 0.15 0 0 nan 1\n"));
    std::vector<ReadingJob> batch;
    const std::string found = testing::findings([&] {
        while (true) {
            source.next(1, batch);
            if (batch.empty()) return 0;
        }
    });
    EXPECT_EQ(found, "poses.txt:3:16: error: qz `nan` is not a number\n");
    PoseSource marked(
        linesOf("\xef\xbb\xbf"
                "0 1 2 0.15 0 0 0 1\r\n"));
    marked.next(1, batch);
    EXPECT_EQ(batch.size(), 1U) << "a byte order mark";
    PoseSource endless(PoseLines(
        [](std::string& buffer) {
            buffer.append(1000, '7');
            return true;
        },
        "zeros"));
    EXPECT_EQ(testing::findings([&] {
                  endless.next(1, batch);
                  return 0;
              }),
              "zeros:1: error: a line of more than 4096 bytes; a pose is `t x y z qx qy qz qw`\n");
}

TEST(MotionSource, FiresAtItsRateWhileTheWayLasts) {
    MotionSource source(
        linesOf("10 0 0 0.15 0 0 0 1\n10.25 1 0 0.15 0 0 0 1\n11 4 0 0.15 0 0 0 1\n"), 10, 0.06);
    std::vector<ReadingJob> batch, all;
    for (source.next(4, batch); !batch.empty(); source.next(4, batch))
        all.insert(all.end(), batch.begin(), batch.end());
    // Scans from 10.0 to 10.9; that at 11.0 would end after the way.
    ASSERT_EQ(all.size(), 10U);
    EXPECT_NEAR(all[1].pose.position.x, 0.4, 1e-12);
    EXPECT_NEAR(all[2].pose.position.x, 0.8, 1e-12);
    EXPECT_EQ(all[2].way.size(), 3U) << "its 60 ms pass a pose";
    EXPECT_EQ(all[0].way.size(), 2U);
    EXPECT_NEAR(all[9].time, 10.9, 1e-12);
    EXPECT_EQ(all[9].frame, 9);
    MotionSource back(linesOf("1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"), 10, 0.06);
    EXPECT_EQ(testing::findings([&] {
                  back.next(1, batch);
                  return 0;
              }),
              "poses.txt:2: error: time does not grow; a sensor in motion is at one place at a "
              "time\n");
}

// A mistyped time: 100 million readings would have filled the disk.
TEST(MotionSource, BoundsReadingsBetweenTwoPoses) {
    const std::string way = "0 0 0 0.15 0 0 0 1\n10000000 1 0 0.15 0 0 0 1\n";
    std::vector<ReadingJob> batch;
    MotionSource far(linesOf(way), 10, 0.06);
    EXPECT_EQ(testing::findings([&] {
                  far.next(1, batch);
                  return 0;
              }),
              "poses.txt:2: error: from t=0 to t=10000000 are 100000000 readings at 10 Hz, wanted "
              "at most 100000 between two poses; are times in seconds? --frames N takes as many as "
              "N\n");
    MotionSource asked(linesOf(way), 10, 0.06, 150'000);
    std::size_t count = 0;
    for (asked.next(4000, batch); !batch.empty(); asked.next(4000, batch)) count += batch.size();
    EXPECT_EQ(count, 150'000U);
    MotionSource near(linesOf("0 0 0 0.15 0 0 0 1\n10000 1 0 0.15 0 0 0 1\n"), 10, 0.06);
    EXPECT_NO_THROW(near.next(1, batch));
}

TEST(StillSource, FrameByFrameEachAtItsRate) {
    const Scene scene = testing::scene(kRoom,
                                       "laser at=1,1 rate=40\n"
                                       "ranger at=1,2 rate=30\n"
                                       "laser at=1,3 rate=20 sweep=tilt sweep_span=9\n");
    const Sensors sensors = sensorsOf(scene, {});
    StillSource source(sensors, 3);
    EXPECT_EQ(source.count(), 9);
    std::vector<ReadingJob> batch, all;
    for (source.next(4, batch); !batch.empty(); source.next(4, batch))
        all.insert(all.end(), batch.begin(), batch.end());
    ASSERT_EQ(all.size(), 9U);
    EXPECT_EQ(all[3].sensor, 0U);
    EXPECT_EQ(all[3].frame, 1);
    EXPECT_EQ(all[3].time, 1.0 / 40);
    EXPECT_EQ(all[4].time, 0.033333333) << "whole nanoseconds";
    EXPECT_EQ(all[5].time, 10.0 / 20) << "a sweep has ten scans";
}

}  // namespace reading_run_test

}  // namespace ispace
