// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/motes/mote_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "extensions/luxes/illuminance.h"
#include "extensions/motes/motes_test.h"
#include "scene/sensor/sensor_keys.h"
#include "sense/formats/reading_fields.h"
#include "sense/site_sensors.h"
#include "support/test_readings.h"

namespace ispace::motes {
namespace mote_report_test {

/// A report and the pose of its mote.
struct PlacedReport : MoteReport {
    Pose3 pose;
};

/// Returns the reports of all motes in a room of 40 x 12 m.
std::vector<PlacedReport> reportsIn(const std::string& room, const std::string& layout,
                                    const TakerOptions& options = {}) {
    const Scene scene = testing::scene("ispace size=40,12,2.5 ceiling=yes\n" + room, layout);
    std::vector<PlacedReport> all;
    for (const Reading& reading : testing::readings(scene, options))
        if (const auto* report = std::get_if<AddedReading>(&reading))
            all.push_back({report->as<MoteReport>(), report->pose});
    return all;
}

/// Returns the neighbours of the first mote, separated by blanks.
std::string heardIn(const std::string& room, const std::string& layout) {
    const auto reports = reportsIn(room, layout);
    std::string ids;
    for (const Neighbour& one : reports.front().neighbours)
        ids.append(ids.empty() ? "" : " ").append(one.mote);
    return ids;
}

TEST(MoteReport, OfAStoreyNamesItsMotes) {
    const std::vector scenes = {std::make_shared<const Scene>(
        testing::scene("ispace size=40,12,2.5\n",
                       "mote id=a at=-10,0,1 radio=12\nmote id=b at=0,0,1\nmote id=c at=9,0,1\n"))};
    const std::vector<std::string> ids = {"ground"};
    const SiteSensors site = sensorsOf(scenes, ids, {});
    RayScenes worlds(scenes[0]->environment);
    const MovingBodies bodies(bodiesOf(*scenes[0]));
    ReadingSampler sampler(site.sensors, worlds, bodies, {});
    const ReadingJob job{0, 0, 0, site.sensors.read[0].pose, {}};
    sampler.prepare(job);
    const Reading reading = sampler.take(job);
    const auto& report = std::get<AddedReading>(reading).as<MoteReport>();
    ASSERT_EQ(report.neighbours.size(), 1U) << "not itself";
    EXPECT_EQ(report.neighbours[0].mote, "ground/b");
}

TEST(MoteReport, ListsTheMotesInRadioRange) {
    const std::string three =
        "mote id=a at=-10,0,1 radio=12\nmote id=b at=0,0,1\nmote id=c at=10,0,1\n";
    EXPECT_EQ(heardIn("", three), "b");
    const auto all = reportsIn("", three);
    ASSERT_EQ(all.size(), 3U);
    ASSERT_EQ(all[1].neighbours.size(), 2U);
    // In free space: 20 lg(30 / 10).
    EXPECT_NEAR(all[1].neighbours[0].margin, 9.5424, 1e-4);
    EXPECT_NEAR(all[0].neighbours[0].margin, 20 * std::log10(1.2), 1e-9);
    EXPECT_EQ(heardIn("", "mote id=a at=0,0 radio=10\nmote id=b at=10,0\n"), "b")
        << "ends are included";
    EXPECT_EQ(heardIn("", "mote id=a at=0,0\n"), "");
    EXPECT_EQ(heardIn("", "mote id=a at=0,0\nmote id=b at=0,0\n"), "b");
    EXPECT_EQ(heardIn("", "mote id=a at=0,0\nmote id=b\n"), "") << "it has no position yet";
}

TEST(MoteReport, WallsWeakenSignals) {
    const std::string wall = "wall from=2,-6 to=2,6\n", two = "mote id=b at=4,0,1\n";
    const auto margin = [&](const std::string& room, const std::string& keys) {
        const auto reports = reportsIn(room, "mote id=a at=0,0,1 " + keys + '\n' + two);
        return reports.front().neighbours.empty() ? -1 : reports.front().neighbours[0].margin;
    };
    const double free = 20 * std::log10(30 / 4.0);
    EXPECT_NEAR(margin("", ""), free, 1e-9);
    EXPECT_NEAR(margin(wall, ""), free - 6, 1e-9);
    EXPECT_NEAR(margin(wall, "loss=11"), free - 11, 1e-9);
    EXPECT_NEAR(margin(wall + "wall from=3,-6 to=3,6\n", "loss=8"), free - 16, 1e-9);
    EXPECT_EQ(margin(wall, "loss=18"), -1);
    EXPECT_NEAR(margin(wall + "door at=2,0 open=yes\n", "loss=18"), free, 1e-9);
}

TEST(MoteReport, MotesStandOnFurnitureAndMove) {
    EXPECT_EQ(heardIn("cube id=k at=5,2 heading=90 size=1,1,0.8\n",
                      "mote id=a at=0,0,0.9 radio=5.01\nmote id=b on=k at=-2,0,0.1\n"),
              "b")
        << "two metres to the right of the cube, as high as the other";
    // By the middle of the carrier.
    const auto reports = reportsIn("",
                                   "mote id=a at=0,0,0.3 radio=5\n"
                                   "robot id=r1 at=-9,0\n"
                                   "robot id=r2 model=pioneer-2dx at=4,0\n"
                                   "human id=h at=0,3\n"
                                   "mote id=b on=r2 at=0,0,0.3\n"
                                   "mote id=c on=h at=0,0,0.3\n"
                                   "mote id=d on=r1 at=0,0,0.3\n");
    ASSERT_EQ(reports.size(), 4U);
    ASSERT_EQ(reports[0].neighbours.size(), 2U);
    EXPECT_EQ(reports[0].neighbours[0].mote, "b");
    EXPECT_EQ(reports[0].neighbours[1].mote, "c");
    EXPECT_NEAR(reports[0].neighbours[1].margin, 20 * std::log10(5 / 3.0), 1e-6);
}

TEST(MoteReport, CarriedMotesHearAsTheyAreHeard) {
    for (const char* carried :
         {"human id=c at=4,4 height=1.6\nmote id=b on=c\n",
          "human id=c at=4,4 heading=30\nmote id=b on=c at=0,0\n",
          "human id=c at=4,4 heading=30\nmote id=b on=c at=0,0,0.9\n",
          "robot id=c model=pioneer-2dx at=4,4 heading=70\nmote id=b on=c at=0,0,0.3\n",
          "robot id=c at=4,4 heading=70\nmote id=b on=c\n"}) {
        const auto reports = reportsIn("", std::string("mote id=a at=1,1,1\n") + carried);
        ASSERT_EQ(reports.size(), 2U) << carried;
        for (const MoteReport& one : reports) ASSERT_EQ(one.neighbours.size(), 1U) << carried;
        EXPECT_NEAR(reports[0].neighbours[0].margin, reports[1].neighbours[0].margin, 1e-9)
            << carried;
        EXPECT_NEAR(reports[0].neighbours[0].margin,
                    20 * std::log10(30 / length(reports[1].pose.position - Point3{1, 1, 1})), 1e-9)
            << carried;
    }
}

TEST(MoteReport, OfManyMotesItListsTheStrongest) {
    // Behind the wall a signal loses 6 dB: half of the distance.
    std::string layout = "mote id=a at=0,0,1\n";
    std::vector<std::pair<double, int>> order;
    for (int i = 0; i < 300; ++i) {
        const double x = 0.06 * (i * 7 % 300) - 9, y = 0.3 * (i % 11) - 1.5;
        layout += "mote id=m" + std::to_string(i) + " at=" + std::to_string(x) + ',' +
                  std::to_string(y) + ",1\n";
        order.emplace_back(std::hypot(x, y) * (x > 0.1 ? std::pow(10, 0.3) : 1), i);
    }
    std::sort(order.begin(), order.end());
    const auto reports = reportsIn("wall from=0.1,-6 to=0.1,6\n", layout);
    ASSERT_EQ(reports.size(), 301U);
    const std::vector<Neighbour>& heard = reports.front().neighbours;
    ASSERT_EQ(heard.size(), Mote::kMostNeighbours);
    std::vector<int> best;
    for (std::size_t i = 0; i < heard.size(); ++i) best.push_back(order[i].second);
    std::sort(best.begin(), best.end());
    for (std::size_t i = 0; i < heard.size(); ++i)
        EXPECT_EQ(heard[i].mote, "m" + std::to_string(best[i])) << "in the order of the scene";
    for (const MoteReport& one : reports) EXPECT_EQ(one.neighbours.size(), Mote::kMostNeighbours);
    // At one point, and of equal signals, the first ones.
    std::string heap;
    for (int i = 0; i < 100; ++i) heap += "mote at=1,1,1\n";
    const auto crowd = reportsIn("", heap);
    ASSERT_EQ(crowd.size(), 100U);
    EXPECT_EQ(crowd.back().neighbours.size(), Mote::kMostNeighbours);
    EXPECT_EQ(crowd.back().neighbours.front().mote, "mote1");
    EXPECT_EQ(crowd.back().neighbours.back().mote, "mote64");
}

TEST(MoteReport, MeasuresLightAsAMeterDoes) {
    const std::string room =
        "lamp at=1,0 on=yes\nprojector at=-3,0 height=1 on=yes fov=60,40\ncube at=0.6,0.6 "
        "size=0.4\n";
    for (const char* pose : {"at=0,0,0.5 tilt=90", "at=2,1,1 heading=180"}) {
        std::string layout = "mote id=m max=1000 error=0.1 resolution=2 ";
        layout.append(pose).append("\nlux id=l max=1000 ").append(pose).append("\n");
        const Scene scene = testing::scene("ispace size=40,12,2.5 ceiling=yes\n" + room, layout);
        const auto readings = testing::readings(scene);
        const double lux = std::get<AddedReading>(readings[1]).as<luxes::Illuminance>().lux;
        EXPECT_GT(lux, 5);
        EXPECT_EQ(std::get<AddedReading>(readings[0]).as<MoteReport>().lux, lux);
        const auto noisy = testing::readings(scene, {.noise_seed = 4});
        const double measured = std::get<AddedReading>(noisy[0]).as<MoteReport>().lux;
        EXPECT_NE(measured, lux);
        EXPECT_EQ(std::fmod(measured, 2), 0);
    }
}

TEST(MoteReport, HasTopics) {
    const auto topics = readingKind(modelOf(Mote())).topics;
    ASSERT_EQ(topics.size(), 2U);
    EXPECT_EQ(topics[0].name, "illuminance");
    EXPECT_EQ(topics[0].type, RosType::Illuminance);
    EXPECT_EQ(topics[1].name, "neighbours");
    EXPECT_EQ(topics[1].type, RosType::String);
}

TEST(Mote, ReadsItsKeys) {
    const auto read = [](const std::string& keys) {
        const Record record = testing::sensorRecord("mote " + keys);
        return parametersOf<Mote>(record, testing::deviceFor(record));
    };
    EXPECT_EQ(read(""), Mote());
    EXPECT_FALSE(Mote().isNoisy());
    const Mote mote = read("radio=12 loss=9 max=500 resolution=2 error=5% rate=4");
    EXPECT_EQ(mote.radio, 12);
    EXPECT_EQ(mote.loss, 9);
    EXPECT_EQ(mote.meter.max, 500);
    EXPECT_EQ(mote.meter.resolution, 2);
    EXPECT_EQ(mote.meter.error, 0.05);
    EXPECT_EQ(mote.rate, 4);
    EXPECT_TRUE(mote.isNoisy());
    EXPECT_GT(read("model=telosb").radio, 10);
    EXPECT_NE(testing::findings([&] { return read("radio=0"); }), "");
}

}  // namespace mote_report_test
}  // namespace ispace::motes
