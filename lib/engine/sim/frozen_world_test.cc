// SPDX-License-Identifier: GPL-3.0-or-later
// In a world without motion a run reads the same as `scan`, with noise and without.
#include <gtest/gtest.h>

#include <map>

#include "sense/reading.h"
#include "sim/world.h"
#include "support/test_layout.h"

namespace ispace {
namespace frozen_world_test {

constexpr const char* kRoom =
    "ispace size=8,6\npillar id=post at=2,0 size=0.2,0.2,2.5\nbarrier id=low at=-1,1 "
    "size=1,0.1,0.4\n";
constexpr const char* kThings =
    "robot id=r1 at=-2,-1 heading=30\nhuman id=h1 at=1,1.5\n"
    "laser id=flat rate=10 at=0,-2 heading=90 fov=180 sigma=0.02,0.01 angle_sigma=0.3 dropout=0.1\n"
    "laser id=tilted rate=10 at=0,2,2 tilt=-30 fov=90 sigma=0.02 incidence=40,80\n"
    "laser id=ridden rate=10 on=r1 at=0.1,0,0.2 fov=270 step=2 sigma=0.01 resolution=0.01\n"
    "laser id=swept at=-3,0,1 fov=30 rate=10 sweep=tilt sweep_span=30 sweep_step=15 sigma=0.05\n"
    "ranger id=depth rate=10 at=3,0,1.5 heading=180 tilt=-20 pixels=32,24 range=7 "
    "sigma=0.01,0,0.002\n"
    "camera id=eye rate=10 at=-3.5,-2.5,2 heading=45 tilt=-20 pixels=40,30\n"
    "ultrasound id=u1 at=-2,-2,2.5 tilt=-90 sigma=0.01\n"
    "ultrasound id=u2 at=2,-2,2.5 tilt=-90 sigma=0.01\n"
    "ultrasound id=u3 at=2,2,2.5 tilt=-90 sigma=0.01\n"
    "ultrasound id=u4 at=-2,2,2.5 tilt=-90 sigma=0.01 dropout=0.2\n"
    "tag id=heard at=0.5,0.5,1\ntag id=worn on=h1 at=0.3,0,1.2\n"
    "tag id=simple at=0,0,0.5 locate=simple sigma=0.1\n";

/// Readings by the sensor's id, its frame and, of a laser, the number of the scan.
using Key = std::tuple<std::string, int, int>;
using AllReadings = std::map<Key, std::vector<double>>;

void add(AllReadings& all, const std::string& id, const Scan& scan) {
    all[{id, scan.frame, scan.number}].assign(scan.ranges.begin(), scan.ranges.end());
}
void add(AllReadings& all, const std::string& id, const std::vector<Scan>& scans) {
    for (const Scan& scan : scans) add(all, id, scan);
}
void add(AllReadings& all, const std::string& id, const DepthFrame& frame) {
    all[{id, frame.frame, 0}].assign(frame.depths.begin(), frame.depths.end());
}
void add(AllReadings& all, const std::string& id, const Photo& photo) {
    all[{id, photo.frame, 0}].assign(photo.rgb.begin(), photo.rgb.end());
}
void add(AllReadings& all, const std::string& id, const Burst& burst) {
    std::vector<double>& values = all[{id, burst.frame, 0}];
    for (const TimeOfFlight& heard : burst.heard) values.push_back(heard.time);
    if (burst.fix) values.push_back(burst.fix->position.x);
    if (burst.simple) values.push_back(burst.simple->x);
}
void add(AllReadings& all, const std::string& id, const Hearings& hearings) {
    for (const HeardTag& tag : hearings.tags)
        all[{id + tag.tag, 0, 0}].push_back(tag.time_of_flight.value_or(-1));
}
/// Of kinds that the room lacks.
template <typename Other>
void add(AllReadings&, const std::string&, const Other&) {}

AllReadings readByRun(const Scene& scene, bool noise, SimTime duration) {
    AllReadings all;
    World world(scene, std::chrono::milliseconds(100), {.seed = 7, .sensor_noise = noise});
    for (;; world.step()) {
        for (std::size_t i = 0; i < world.sensors().size(); ++i) {
            const bool is_new = isHeavy(world.sensors()[i])
                                    ? world.captureNow(i).time == world.time()
                                    : world.reading(i).time == world.time();
            if (!is_new) continue;
            std::visit([&](const auto& value) { add(all, world.sensors()[i].id, value); },
                       world.reading(i).value);
        }
        if (world.time() >= duration) return all;
    }
}

AllReadings readByScan(const Scene& scene, bool noise, double duration) {
    AllReadings all;
    const Sensors sensors = sensorsOf(scene, {});
    RayScenes worlds(scene.environment);
    const MovingBodies bodies(bodiesOf(scene));
    const Photographer photographer(scene, {.seed = 7, .with_noise = noise});
    TakerOptions options{.photographer = &photographer};
    if (noise) options.noise_seed = 7;
    ReadingSampler taker(sensors, worlds, bodies, options);
    for (std::size_t i = 0; i < sensors.read.size(); ++i) {
        const double rate = readingRate(sensors.read[i].model);
        for (int frame = 0; frame / rate <= duration + 1e-9; ++frame) {
            const ReadingJob job{i, frame, frame / rate, sensors.read[i].pose, {}};
            taker.prepare(job);
            const Reading reading = taker.take(job);
            std::visit([&](const auto& value) { add(all, sensors.read[i].id, value); }, reading);
        }
    }
    return all;
}

TEST(FrozenWorld, ARunReadsWhatScanReads) {
    const Scene scene = testing::scene(kRoom, kThings);
    std::map<std::string, int> readings;
    for (const bool noise : {false, true}) {
        const AllReadings run = readByRun(scene, noise, std::chrono::seconds(1));
        const AllReadings scan = readByScan(scene, noise, 1);
        for (const auto& [key, values] : run) {
            const auto& [id, frame, number] = key;
            if (id.starts_with("u")) continue;  // what receivers hear is told below
            const auto same = scan.find(key);
            ASSERT_NE(same, scan.end()) << id << ' ' << frame;
            EXPECT_EQ(values, same->second) << id << ' ' << frame << ' ' << number << ' ' << noise;
            EXPECT_FALSE(values.empty());
            ++readings[id];
        }
    }
    for (const char* id :
         {"flat", "tilted", "ridden", "swept", "depth", "eye", "heard", "worn", "simple"})
        EXPECT_GE(readings[id], 2 * 10) << id;
}

TEST(FrozenWorld, NoiseIsThatOfEachReading) {
    const Scene scene = testing::scene(kRoom, kThings);
    const AllReadings ideal = readByRun(scene, false, std::chrono::milliseconds(200));
    const AllReadings noisy = readByRun(scene, true, std::chrono::milliseconds(200));
    for (const char* id : {"flat", "tilted", "ridden", "depth", "eye", "heard", "simple"}) {
        EXPECT_EQ(ideal.at({id, 0, 0}), ideal.at({id, 1, 0})) << id;
        EXPECT_NE(noisy.at({id, 0, 0}), ideal.at({id, 0, 0})) << id;
        EXPECT_NE(noisy.at({id, 0, 0}), noisy.at({id, 1, 0})) << id;
    }
    // A receiver hears each tag with the errors that the tag's burst has there.
    const auto& u3 = noisy.at({"u3heard", 0, 0});
    ASSERT_EQ(u3.size(), 3U);
    for (int frame = 0; frame < 3; ++frame)
        EXPECT_EQ(u3[static_cast<std::size_t>(frame)], noisy.at({"heard", frame, 0}).front());
}

}  // namespace frozen_world_test
}  // namespace ispace
