// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/uwbs/uwb_ranges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "extensions/uwbs/uwbs_test.h"
#include "scene/sensor/sensor_keys.h"
#include "sense/formats/reading_fields.h"
#include "sense/shared_results.h"
#include "sense/site_sensors.h"
#include "support/test_readings.h"

namespace ispace::uwbs {
namespace uwb_ranges_test {

/// Returns the readings of all anchors in a room of 12 m and 2.5 m height.
std::vector<UwbRanges> rangesIn(const std::string& room, const std::string& layout,
                                const TakerOptions& options = {}, int frame = 0) {
    const Scene scene = testing::scene("ispace size=12,12,2.5\n" + room, layout);
    std::vector<UwbRanges> all;
    for (const Reading& reading : testing::readings(scene, options, frame))
        all.push_back(std::get<AddedReading>(reading).as<UwbRanges>());
    return all;
}

/// Returns the ranges of the first anchor.
std::vector<UwbRange> tagsIn(const std::string& room, const std::string& layout,
                             const TakerOptions& options = {}, int frame = 0) {
    return rangesIn(room, layout, options, frame).front().tags;
}

TEST(UwbRanges, OfAMomentShareThePositionsOfTags) {
    std::string layout = "human at=1,2 tag=anna\nrobot model=pioneer-2dx at=-2,-2 tag=r7\n";
    for (const char* const at : {"-5,-5,1", "5,-5,2", "5,5,1", "-5,5,2", "0,5,1.5"})
        layout += std::string("uwb at=") + at + " sigma=0.05\n";
    const Scene scene = testing::scene(
        "ispace size=12,12,2.5\nwall from=2,-6 to=2,-1\ncube at=4,0 size=0.4 tag=crate\n", layout);
    RayScenes worlds(scene.environment);
    worlds.prepareMesh(kindOf(scene.sensors.front().model).stopped_by);
    const MovingBodies bodies(bodiesOf(scene));
    const auto ranges_of = [&](const Sensor& sensor, const Pose3& pose, int frame,
                               const TakerOptions& options) {
        return readingOf(sensor.as<Uwb>(),
                         Moment{sensor, pose, frame, 0.1 * frame, worlds, bodies, {}, options});
    };
    const TakerOptions alone{.noise_seed = 3};
    TakerOptions shared = alone;
    shared.shared = std::make_shared<SharedResults>();
    int fixes = 0;
    for (const int frame : {0, 1, 0, 20})
        for (const Sensor& sensor : scene.sensors)
            for (const Pose3& pose : {sensor.pose, Pose3{{0.5, -0.5, 1}, {}, {}, {}}}) {
                const auto one = ranges_of(sensor, pose, frame, alone).tags;
                const auto other = ranges_of(sensor, pose, frame, shared).tags;
                ASSERT_EQ(one.size(), 3U);
                ASSERT_EQ(other.size(), 3U);
                for (std::size_t i = 0; i < one.size(); ++i) {
                    EXPECT_EQ(one[i].range, other[i].range);
                    ASSERT_EQ(one[i].fix.has_value(), other[i].fix.has_value());
                    if (!one[i].fix) continue;
                    ++fixes;
                    EXPECT_EQ(one[i].fix->position, other[i].fix->position) << frame << sensor.id;
                }
            }
    EXPECT_GT(fixes, 40);
    const Sensor& first = scene.sensors.front();
    const Moment now{first, first.pose, 0, 0, worlds, bodies, {}, shared};
    const Sensor& last = scene.sensors.back();
    const Moment same{last, last.pose, 0, 0, worlds, bodies, {}, shared};
    UwbFixes& kept = shared.shared->of<UwbFixes>();
    EXPECT_EQ(kept.at(first.as<Uwb>(), now), kept.at(last.as<Uwb>(), same));
    const Moment later{last, last.pose, 1, 0, worlds, bodies, {}, shared};
    EXPECT_NE(kept.at(first.as<Uwb>(), now), kept.at(last.as<Uwb>(), later));
}

constexpr const char* kCrate = "cube at=4,0 size=0.4,0.4,0.99 tag=crate\n";  // its tag: 4,0,1

TEST(UwbRanges, AreThoseOfPeopleRobotsAndThings) {
    const auto tags = tagsIn(kCrate,
                             "uwb at=0,0,1\n"
                             "robot model=pioneer-2dx at=2,-2 tag=r7\n"
                             "human at=2,2 heading=-135 tag=anna height=1.8\n"
                             "human at=-2,2\n");
    ASSERT_EQ(tags.size(), 3U);
    EXPECT_EQ(tags[0].tag, "anna");
    EXPECT_EQ(tags[1].tag, "crate");
    EXPECT_EQ(tags[2].tag, "r7");
    EXPECT_NEAR(tags[1].range, 4, 1e-9);
    // On the chest, before the middle; above the top.
    EXPECT_GT(tags[0].range, std::hypot(1.8, 1.8));
    EXPECT_LT(tags[0].range, std::hypot(2, 2));
    EXPECT_GT(tags[2].range, std::hypot(2, 2));
    for (const UwbRange& one : tags) {
        EXPECT_FALSE(one.is_blocked) << one.tag;
        EXPECT_FALSE(one.fix) << "by one anchor";
    }
    // Of two tags with one text, the nearest.
    const auto twins = tagsIn(kCrate, "uwb at=0,0,1\nhuman at=2,0.8 tag=crate\n");
    ASSERT_EQ(twins.size(), 1U);
    EXPECT_LT(twins[0].range, 3);
}

TEST(UwbRanges, WallsShortenTheReach) {
    const std::string wall = "wall from=2,-6 to=2,6\n";
    const auto tags = tagsIn(wall + kCrate, "uwb at=0,0,1 range=8\n");
    ASSERT_EQ(tags.size(), 1U);
    EXPECT_TRUE(tags[0].is_blocked);
    EXPECT_NEAR(tags[0].range, 4, 1e-9) << "without noise the distance";
    // 6.0206 dB halve the range.
    EXPECT_EQ(tagsIn(wall + kCrate, "uwb at=0,0,1 range=8 loss=6.1\n").size(), 0U);
    EXPECT_EQ(tagsIn(wall + kCrate, "uwb at=0,0,1 range=7.9 loss=6\n").size(), 0U);
    EXPECT_EQ(tagsIn(kCrate, "uwb at=0,0,1 range=4\n").size(), 1U) << "ends are included";
    EXPECT_EQ(tagsIn(kCrate, "uwb at=0,0,1 range=3.9\n").size(), 0U);
    EXPECT_EQ(tagsIn(kCrate, "uwb at=0,0,1 range=4.1,9\n").size(), 0U);
    const std::string door = "door at=2,0 open=yes\n";
    EXPECT_FALSE(tagsIn(wall + door + kCrate, "uwb at=0,0,1 range=8\n")[0].is_blocked);
    // An anchor on the wall itself.
    EXPECT_FALSE(tagsIn(kCrate, "uwb at=-6,0,1\n")[0].is_blocked);
}

TEST(UwbRanges, PeopleBlockThem) {
    const auto blocked = [](const std::string& people) {
        const auto tags = tagsIn("", "uwb at=0,0,1.2\n" + people);
        return tags.size() == 1 && tags[0].is_blocked;
    };
    EXPECT_FALSE(blocked("human at=4,0 heading=180 tag=anna\n"));
    EXPECT_TRUE(blocked("human at=4,0 heading=0 tag=anna\n")) << "her own back";
    EXPECT_TRUE(blocked("human at=4,0 heading=180 tag=anna\nhuman at=2,0\n"));
    EXPECT_FALSE(blocked("human at=4,0 heading=180 tag=anna\nhuman at=2,1\n"));
    // The carrier of the anchor does not.
    const auto tags = tagsIn(kCrate, "uwb at=0,0,1 on=h1\nhuman id=h1\n");
    ASSERT_EQ(tags.size(), 1U);
    EXPECT_FALSE(tags[0].is_blocked);
}

TEST(UwbRanges, ThreeAnchorsInSightLocateATag) {
    // Along three axes: each distance is a coordinate, and the errors of all are alike.
    const std::string thing = "cube at=0,0 size=0.2,0.2,0.99 tag=t\n";
    const std::string three = "uwb id=a at=3,0,1\nuwb id=b at=0,3,1\n", third = "uwb at=0,0,2.4\n";
    const auto all = rangesIn(thing, three + third);
    ASSERT_EQ(all.size(), 3U);
    for (const UwbRanges& one : all) {
        ASSERT_TRUE(one.tags.at(0).fix);
        const PositionFix& fix = *one.tags[0].fix;
        EXPECT_LT(length(fix.position - Point3{0, 0, 1}), 1e-6);
        EXPECT_NEAR(fix.pdop, std::sqrt(3.0), 1e-6);
        EXPECT_NEAR(fix.hdop, std::sqrt(2.0), 1e-6);
        EXPECT_NEAR(fix.vdop, 1, 1e-6);
        EXPECT_NEAR(fix.residual, 0, 1e-9);
    }
    EXPECT_FALSE(tagsIn(thing, three)[0].fix) << "two";
    EXPECT_FALSE(tagsIn(thing + "wall from=-1,2 to=1,2\n", three + third)[0].fix)
        << "one of them does not see it";
    EXPECT_FALSE(tagsIn(thing, three + "robot id=r at=-3,0\nuwb at=0,0,1 on=r\n")[0].fix)
        << "one of them drives";
    EXPECT_FALSE(tagsIn(thing, three + "uwb at=0,0,2.4 range=1.3\n")[0].fix)
        << "one of them does not reach it";
    EXPECT_TRUE(tagsIn(thing, three + third + "uwb at=5,5,2 range=1\n")[0].fix);
}

// Three anchors at the wall x = 4, so mirror images lie beyond it.
TEST(UwbRanges, ThePlanDecidesBetweenMirrorImages) {
    const auto fix_of = [](const std::string& room) {
        const auto tags = tagsIn(room + "cube at=1,0 size=0.2,0.2,0.99 tag=t\n",
                                 "uwb id=a at=4,-3,1 heading=180\nuwb id=b at=4,3,2 heading=180\n"
                                 "uwb id=c at=4,0.5,1.5 heading=180\n");
        return tags.at(0).fix.value();
    };
    const auto expect = [](const PositionFix& fix, bool is_one_of_two, const char* why) {
        EXPECT_LT(length(fix.position - Point3{1, 0, 1}), 1e-5) << why;
        EXPECT_EQ(fix.is_one_of_two, is_one_of_two) << why;
        EXPECT_EQ(std::isfinite(fix.pdop), !is_one_of_two) << why;
    };
    // The mirror image is (7, 0, 1).
    expect(fix_of(""), false, "beyond the outer wall");
    expect(fix_of("wall from=4.4,-6 to=4.4,6\n"), false, "in another region");
    // From here on the room is larger.
    const std::string wide = "fence closed=yes path=-8,-8;12,-8;12,8;-8,8\n";
    const auto wide_fix = [&wide](const std::string& things, const std::string& heading) {
        const Scene scene = testing::scene(
            wide + "inside at=0,0\n" + things + "cube at=1,0 size=0.2,0.2,0.99 tag=t\n",
            "uwb id=a at=4,-3,1" + heading + "\nuwb id=b at=4,3,2" + heading +
                "\nuwb id=c at=4,0.5,1.5" + heading + "\n");
        const auto all = testing::readings(scene, {}, 0);
        return std::get<AddedReading>(all.front()).as<UwbRanges>().tags.at(0).fix.value();
    };
    expect(wide_fix("", " heading=180"), true, "both are possible");
    expect(wide_fix("wall from=5,-4 to=5,4\n", " heading=180"), false, "hidden by a wall");
    expect(wide_fix("cube at=7,0 size=1,1,2\n", ""), false, "in a thing, and the anchors face it");
}

TEST(UwbRanges, TheSixteenNearestAnchorsInSightLocateATag) {
    // Sixteen without errors on a circle, and farther ones that err by half a metre.
    const std::string thing = "cube at=0,0 size=0.2,0.2,0.99 tag=t\n";
    std::string exact, biased;
    for (int i = 0; i < 16; ++i) {
        const double angle = i * 0.39;
        const auto anchor = [&](double radius, double height, const std::string& keys) {
            return "uwb at=" + std::to_string(radius * std::cos(angle)) + ',' +
                   std::to_string(radius * std::sin(angle)) + ',' + std::to_string(height) + keys +
                   '\n';
        };
        exact += anchor(3, 1.5 + 0.05 * i, "");
        if (i < 5) biased += anchor(5, 2.2, " bias=0.5");
    }
    const auto error = [&](const std::string& room) {
        const auto tags = tagsIn(room + thing, biased + exact, {.noise_seed = 1});
        return length(tags.at(0).fix.value().position - Point3{0, 0, 1});
    };
    EXPECT_LT(error(""), 1e-5);
    EXPECT_GT(error("wall from=1,-3 to=1,-1\n"), 1e-3) << "farther ones instead of those behind it";
}

TEST(UwbRanges, ARoundHasTimeForTheNearestTagsThatAnswer) {
    std::string room = "wall from=0,-6 to=0,6\n";
    for (int i = 0; i < 40; ++i)
        room.append("cube at=")
            .append(std::to_string(-5.7 + 0.29 * i))
            .append(",")
            .append(std::to_string(i % 3 - 1))
            .append(" size=0.1 tag=t")
            .append(std::to_string(i))
            .append("\n");
    // Behind the wall tags answer up to 3 m.
    const std::string anchor = "uwb at=-1,0,1 range=12 loss=12.0412 sigma=0.2 dropout=10%";
    const TakerOptions noisy{.noise_seed = 5};
    const Point3 at{-1, 0, 1};
    const auto distance_of = [&](const UwbRange& range) {
        const int i = std::stoi(range.tag.substr(1));
        return length(Point3{-5.7 + 0.29 * i, i % 3 - 1.0, 0.1} - at);
    };
    std::vector<UwbRange> all = tagsIn(room, anchor + " slots=40", noisy);
    EXPECT_GE(all.size(), 20U);
    EXPECT_LT(all.size(), 36U);
    std::sort(all.begin(), all.end(), [&](const UwbRange& a, const UwbRange& b) {
        return distance_of(a) < distance_of(b);
    });
    for (const std::size_t slots : {1U, 2U, 7U, 20U}) {
        std::vector<UwbRange> nearest(all.begin(),
                                      all.begin() + static_cast<std::ptrdiff_t>(slots));
        std::sort(nearest.begin(), nearest.end(),
                  [](const UwbRange& a, const UwbRange& b) { return a.tag < b.tag; });
        const std::string keys = " slots=" + std::to_string(slots);
        const std::vector<UwbRange> taken = tagsIn(room, anchor + keys, noisy);
        ASSERT_EQ(taken.size(), slots);
        for (std::size_t k = 0; k < slots; ++k) {
            EXPECT_EQ(taken[k].tag, nearest[k].tag) << slots;
            EXPECT_EQ(taken[k].range, nearest[k].range) << slots;
        }
    }
}

TEST(UwbRanges, HaveErrorsInSightAndLargerOnesThroughWalls) {
    const std::string keys = "uwb at=0,0,1 bias=0.1 sigma=0.05 blocked=0.4,0.2\n";
    constexpr int kFrames = 600;
    for (const bool blocked : {false, true}) {
        const std::string room = blocked ? std::string("wall from=2,-6 to=2,6\n") + kCrate : kCrate;
        double sum = 0, squares = 0;
        for (int frame = 0; frame < kFrames; ++frame) {
            const double error = tagsIn(room, keys, {.noise_seed = 3}, frame).at(0).range - 4;
            sum += error;
            squares += error * error;
        }
        const double mean = sum / kFrames, sigma = std::sqrt(squares / kFrames - mean * mean);
        const double expected = blocked ? std::hypot(0.05, 0.2) : 0.05;
        EXPECT_NEAR(mean, blocked ? 0.5 : 0.1, 5 * expected / std::sqrt(1.0 * kFrames));
        EXPECT_NEAR(sigma, expected, 5 * expected / std::sqrt(2.0 * kFrames));
    }
    int heard = 0;
    for (int frame = 0; frame < kFrames; ++frame)
        heard += static_cast<int>(
            tagsIn(kCrate, "uwb at=0,0,1 dropout=25%\n", {.noise_seed = 3}, frame).size());
    EXPECT_NEAR(heard, 0.75 * kFrames, 5 * 10.6);
    EXPECT_EQ(tagsIn(kCrate, "uwb at=0,0,1 sigma=9\n")[0].range, tagsIn(kCrate, keys)[0].range);
}

TEST(UwbRanges, AllAnchorsComputeThePositionOfTheRangesThatTheyReport) {
    const std::string anchors =
        "uwb id=a at=-5,-5,2.2 sigma=0.05\nuwb id=b at=5,-5,2.3 model=dwm1000\n"
        "uwb id=c at=5,5,1.2 sigma=0.05\nuwb id=d at=-5,5,2.4 sigma=0.05\n";
    const std::vector<Point3> at = {{-5, -5, 2.2}, {5, -5, 2.3}, {5, 5, 1.2}, {-5, 5, 2.4}};
    for (int frame = 0; frame < 5; ++frame) {
        const auto all = rangesIn(kCrate, anchors, {.noise_seed = 8}, frame);
        std::vector<Hearing> heard;
        for (std::size_t i = 0; i < all.size(); ++i)
            heard.push_back(
                {at[i], {0, 0, -1}, Angle::degrees(360), all[i].tags.at(0).range, 0.05});
        const auto expected = locate(heard, {3, 0, 2.5});
        ASSERT_TRUE(expected);
        EXPECT_GT(length(expected->position - Point3{4, 0, 1}), 1e-3) << "ranges have errors";
        for (const UwbRanges& one : all) {
            ASSERT_TRUE(one.tags[0].fix);
            EXPECT_LT(length(one.tags[0].fix->position - expected->position), 1e-6);
        }
    }
}

TEST(UwbRanges, OfAStoreyAreThoseOfItsPositions) {
    const std::vector<Point3> at = {{-5, -5, 2.2}, {5, -5, 2.3}, {5, 5, 1.2}, {-5, 5, 2.4}};
    std::string anchors;
    for (const Point3 p : at)
        anchors += "uwb at=" + std::to_string(p.x) + ',' + std::to_string(p.y) + ',' +
                   std::to_string(p.z) + " sigma=0.05\n";
    const std::vector scenes = {std::make_shared<const Scene>(
        testing::scene("ispace size=12,12,2.5\n" + std::string(kCrate), anchors))};
    const std::vector<std::string> ids = {"ground"};
    const SiteSensors site = sensorsOf(scenes, ids, {});
    RayScenes worlds(scenes[0]->environment);
    const MovingBodies bodies(bodiesOf(*scenes[0]));
    ReadingSampler sampler(site.sensors, worlds, bodies, {.noise_seed = 8});
    std::vector<Hearing> heard;
    std::optional<PositionFix> fix;
    for (std::size_t i = 0; i < at.size(); ++i) {
        const ReadingJob job{i, 0, 0, site.sensors.read[i].pose, {}};
        sampler.prepare(job);
        const UwbRange range = std::get<AddedReading>(sampler.take(job)).as<UwbRanges>().tags.at(0);
        heard.push_back({at[i], {0, 0, -1}, Angle::degrees(360), range.range, 0.05});
        fix = range.fix;
    }
    const auto expected = locate(heard, {3, 0, 2.5});
    ASSERT_TRUE(fix && expected);
    EXPECT_LT(length(fix->position - expected->position), 1e-6);
}

TEST(UwbRanges, HaveATopic) {
    const auto topics = readingKind(modelOf(Uwb())).topics;
    ASSERT_EQ(topics.size(), 1U);
    EXPECT_EQ(topics[0].name, "tags");
    EXPECT_EQ(topics[0].type, RosType::String);
}

TEST(Uwb, ReadsItsKeys) {
    const auto read = [](const std::string& keys) {
        const Record record = testing::sensorRecord("uwb " + keys);
        return parametersOf<Uwb>(record, testing::deviceFor(record));
    };
    EXPECT_EQ(read(""), Uwb());
    EXPECT_FALSE(Uwb().isNoisy());
    const Uwb uwb =
        read("range=0.2,30 loss=9 bias=-0.02 sigma=0.03 blocked=0.3,0.2 dropout=2% rate=5 slots=7");
    EXPECT_EQ(uwb.min_range, 0.2);
    EXPECT_EQ(uwb.max_range, 30);
    EXPECT_EQ(uwb.loss, 9);
    EXPECT_EQ(uwb.noise.bias, -0.02);
    EXPECT_EQ(uwb.noise.sigma[0], 0.03);
    EXPECT_EQ(uwb.noise.dropout, 0.02);
    EXPECT_EQ(uwb.blocked_bias, 0.3);
    EXPECT_EQ(uwb.blocked_sigma, 0.2);
    EXPECT_EQ(uwb.rate, 5);
    EXPECT_EQ(uwb.slots, 7U);
    EXPECT_TRUE(uwb.isNoisy());
    EXPECT_TRUE(read("model=dwm1000").isNoisy());
    EXPECT_NE(testing::findings([&] { return read("range=3,2"); }).find("above the greatest"),
              std::string::npos);
    EXPECT_NE(testing::findings([&] { return read("blocked=1"); }), "");
    EXPECT_NE(testing::findings([&] { return read("slots=0"); }), "");
    EXPECT_NE(testing::findings([&] { return read("slots=2.5"); }), "");
}

}  // namespace uwb_ranges_test
}  // namespace ispace::uwbs
