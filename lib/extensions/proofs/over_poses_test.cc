// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/proofs/over_poses.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <numbers>
#include <string>

#include "base/number.h"
#include "coverage/coverage.h"
#include "env/level.h"
#include "geom/arrangement.h"
#include "scene/placement_schemas.h"
#include "support/test_arrange.h"
#include "support/test_problems.h"
#include "support/test_results.h"

namespace ispace::proofs {
namespace over_poses_test {

const FewestProof* fewestOf(const Arrangement& found) {
    return dynamic_cast<const FewestProof*>(found.proof.get());
}

const CoverageProof* boundOf(const Arrangement& found) {
    return dynamic_cast<const CoverageProof*>(found.proof.get());
}

ArrangeOptions provenOverPoses() {
    ArrangeOptions options;
    options.target = 1;
    options.prover = std::make_shared<const PosesProver>();
    return options;
}

Arrangement overPoses(const std::string& room, const char* sensor = "laser,range=99,fov=360") {
    const Scene scene = roomScene(room);
    return arranged(scene, groupsOf(scene, {sensor}, true), provenOverPoses());
}

std::string refusalOf(const std::string& room, const char* sensor = "laser,range=99,fov=360") {
    try {
        overPoses(room, sensor);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

TEST(OverPoses, ABoxInTheRoomTakesTwo) {
    const Arrangement found = overPoses("#env 1\nispace size=8,6\ncube at=0,0 size=2,2,2\n");
    ASSERT_TRUE(fewestOf(found));
    EXPECT_TRUE(fewestOf(found)->isProven());
    EXPECT_EQ(found.sensors.size(), 2U);
    EXPECT_EQ(found.least, 2);
    EXPECT_TRUE(found.is_reached);
    EXPECT_NEAR(fewestOf(found)->floor, 44, 1e-9);
    EXPECT_LE(fewestOf(found)->missed, 44e-9);
    EXPECT_GE(fewestOf(found)->seen_apart.size(), 2U);
}

TEST(OverPoses, FewerThanNeededMissTheTarget) {
    const Arrangement found =
        overPoses("#env 1\nispace size=8,6\ncube at=0,0 size=2,2,2\n", "laser,range=99,fov=360:1");
    EXPECT_FALSE(found.is_reached);
    EXPECT_EQ(found.sensors.size(), 1U);
    EXPECT_EQ(fewestOf(found)->cover, 2U);
}

TEST(OverPoses, TheResultHoldsTheWitnesses) {
    const Scene scene = roomScene("#env 1\nispace size=8,6\n");
    const auto groups = groupsOf(scene, {"laser,range=99,fov=360"}, true);
    const Arrangement found = arranged(scene, groups, provenOverPoses());
    const Document layout =
        layoutDocument({{}, "", scene.digest(), "poses", "exact"}, nullptr, groups, found);
    const Record& result = layout.records.back();
    EXPECT_EQ(result.text("proof"), "poses");
    EXPECT_EQ(result.number("least"), 1);
    EXPECT_EQ(writeRecordText(readRecordText(writeRecordText(layout), "a.3dm", sceneSchemas())),
              writeRecordText(layout));
}

TEST(OverPoses, RefusesRoomsAndSensorsThatAreNoGallery) {
    const std::string room = "#env 1\nispace size=8,6\n";
    EXPECT_NE(refusalOf(room, "laser,range=9,fov=360").find("ends within the room of 10.0 m"),
              std::string::npos);
    EXPECT_NE(refusalOf(room, "laser,range=99,fov=180").find("see all around"), std::string::npos);
    EXPECT_NE(refusalOf(room, "camera").find("see all around"), std::string::npos);
    EXPECT_NE(refusalOf(room + "cylinder id=pillar at=0,0 size=1,1,1\n")
                  .find("round bodies stand at the height of the lasers (pillar)"),
              std::string::npos);
    EXPECT_NE(refusalOf(room + "wall from=0,0 to=1,0 thickness=0\n").find("without thickness"),
              std::string::npos);
    EXPECT_NE(refusalOf(room + "laser at=1,1\n").find("stand in the room"), std::string::npos);
    EXPECT_EQ(refusalOf(room + "wall from=0,0 to=1,0 thickness=0.1\n"), "");
}

TEST(OverPoses, RefusesRoomsWithSightThroughTheirEdges) {
    const std::string rooms =
        "#env 1\nfence path=0,0;12,0;12,4;0,4 closed=yes\n"
        "inside at=1,1\ninside at=6,1\ninside at=9,1\n";
    const auto walls = [](const std::string& keys) {
        return "wall id=p from=4,0 to=4,4" + keys + "\nwall id=q from=8,0 to=8,4" + keys + '\n';
    };
    EXPECT_EQ(refusalOf(rooms + walls("")), "");
    EXPECT_NE(refusalOf(rooms + walls(" height=0.1")).find("over a low wall"), std::string::npos);
    // In both walls; a window in the outer one alone shows no floor.
    EXPECT_NE(refusalOf(rooms + walls(" thickness=0.2") +
                        "window wall=p offset=2 size=3,0.1,2 sill=0 glass=none\n"
                        "window wall=q offset=2 size=3,0.1,2 sill=0 glass=clear\n")
                  .find("through the edge of the floor at"),
              std::string::npos);
    EXPECT_EQ(refusalOf(rooms + walls("") + "window at=2,0 size=3,0.1,2 sill=0 glass=none\n"), "");
    EXPECT_NE(refusalOf(rooms + walls("") +
                        "window at=2,0 size=3,0.1,2 sill=0 glass=none\n"
                        "window at=10,0 size=3,0.1,2 sill=0 glass=none\n")
                  .find("through the edge of the floor at"),
              std::string::npos);
}

TEST(OverPoses, RefusesSheetsOfWhichAPartStandsOutsideOfBodies) {
    EXPECT_NE(refusalOf("#env 1\nispace size=8,6\nwall from=-3,-1 to=3,-1 thickness=0\n"
                        "cube at=0,-1 size=0.4,0.4,1\n")
                  .find("without thickness"),
              std::string::npos);
}

/// Reads a gallery of the AGP library: the number of corners, then each as two fractions.
std::string galleryRoom(const std::string& file) {
    std::ifstream in(file);
    std::size_t count = 0;
    in >> count;
    const auto fraction = [&in] {
        double top = 0, bottom = 1;
        char slash = 0;
        in >> top >> slash >> bottom;
        return formatDouble(top / bottom);
    };
    std::string path;
    for (std::size_t i = 0; i < count; ++i) {
        if (i > 0) path += ';';
        path += fraction();
        path += ',' + fraction();
    }
    return in ? "#env 1\nfence closed=yes path=" + path + "\n" : "";
}

// What is proven to see all of the floor is measured so, whatever the range, but for the lattice of
// the room.
TEST(OverPoses, CoverageOfProvenGalleriesIsWhole) {
    const char* data = std::getenv("ISPACE_TEST_DATA");
    if (data == nullptr) GTEST_SKIP() << "ISPACE_TEST_DATA is not set";
    const auto begin = std::chrono::steady_clock::now();
    int count = 0;
    for (int number = 1; number <= 8; ++number) {
        for (const int corners : {60, 100, 200}) {
            if (std::chrono::steady_clock::now() - begin > std::chrono::seconds(15)) break;
            const std::string name =
                "/agp/randsimple-" + std::to_string(corners) + '-' + std::to_string(number);
            const std::string room = galleryRoom(data + name + ".pol");
            if (room.empty()) continue;
            for (const char* sensor : {"laser,range=1e6,fov=360", "laser,range=1000,fov=360"}) {
                const Scene scene = roomScene(room);
                const auto groups = groupsOf(scene, {sensor}, true);
                const Arrangement found = arranged(scene, groups, provenOverPoses());
                if (!found.is_reached) continue;  // on a slow machine
                const Scene whole = withPlaced(scene, groups, found.sensors);
                RayScenes worlds(whole.environment);
                const CoverageReport report =
                    measureCoverage(whole, worlds, {.keep_depths = false}).report;
                EXPECT_NEAR(*report.coverage.exact, 1, 1e-8) << name << ' ' << sensor;
                ++count;
            }
        }
    }
    if (count == 0) GTEST_SKIP() << "no galleries in the folder agp of ISPACE_TEST_DATA";
}

// Lasers that see all of an L-shaped room: areas add up to its floor, up to rounding.
TEST(OverPoses, NoValueOrBoundIsAboveTheFloor) {
    for (int i = 0; i < 18; ++i) {
        const double a = 3.9 + 0.5 * (i % 6), b = 2.1 + 0.3 * (i % 5), c = 1.7 + 0.4 * (i % 4);
        const std::string width = formatDouble(a), depth = formatDouble(b + c),
                          low = formatDouble(b), inner = formatDouble(a - 1.2 - 0.3 * (i % 3));
        const Scene scene =
            roomScene("#env 1\nfence closed=yes path=0,0;" + width + ",0;" + width + ',' + low +
                      ';' + inner + ',' + low + ';' + inner + ',' + depth + ";0," + depth +
                      "\ninside at=1,1\n" + (i % 2 == 0 ? "" : "cube at=0.5,0.5 size=0.2,0.2,1\n"));
        ArrangeOptions options = coarse();
        options.refine = true;
        options.prover = std::make_shared<const PosesProver>();
        const auto groups = groupsOf(scene, {"laser,range=9,fov=180:2"});
        const Arrangement found = arranged(scene, groups, options);
        ASSERT_TRUE(boundOf(found));
        const double floor = totalArea(scene.environment.level(0.15)->freeFloor());
        EXPECT_LE(boundOf(found)->bound, floor + 1e-9 * floor) << i;
        EXPECT_LE(boundOf(found)->found, boundOf(found)->bound) << i;
        EXPECT_LE(found.refined_after, floor + 1e-9 * floor) << i;
        const Document layout =
            layoutDocument({{}, "", scene.digest(), "all", "swap"}, nullptr, groups, found);
        EXPECT_LE(layout.records.back().number("value"), 1) << i;
        EXPECT_LE(layout.records.back().number("bound"), 1) << i;
    }
}

TEST(OverPoses, BoundsTheCoverageOfAnyPoses) {
    const Scene scene = roomScene("#env 1\nispace size=12,8\n");
    ArrangeOptions options = coarse();
    options.refine = true;
    options.prover = std::make_shared<const PosesProver>();
    const auto groups = groupsOf(scene, {"laser,range=4,fov=240:2"});
    const Arrangement found = arranged(scene, groups, options);
    ASSERT_TRUE(boundOf(found));
    const double sector = 32 * std::numbers::pi / 3;  // fits twice
    EXPECT_NEAR(boundOf(found)->bound, 2 * sector, 1e-6);
    EXPECT_NEAR(boundOf(found)->found, 2 * sector, 0.005 * 2 * sector);
    EXPECT_NEAR(boundOf(found)->floor, 96, 1e-9);
    EXPECT_NEAR(found.bound, 2 * sector / 96, 1e-9);
    const Document layout =
        layoutDocument({{}, "", scene.digest(), "all", "swap"}, nullptr, groups, found);
    const Record& result = layout.records.back();
    EXPECT_EQ(result.text("proof"), "poses");
    EXPECT_NEAR(result.number("value"), boundOf(found)->found / 96, 1e-9);
    EXPECT_GE(result.number("bound"), result.number("value"));
}

constexpr const char* kPlainRoom = "#env 1\nfence path=0,0;6,0;6,5;0,5 closed=yes\ninside at=3,2\n";

/// Options with one pose as candidates, so that a search over candidates places one sensor.
ArrangeOptions fromOnePlace() {
    ArrangeOptions options = coarse();
    options.refine = true;
    options.prover = std::make_shared<const PosesProver>();
    options.strategy = Strategy::List;
    options.list = {{{0.5, 0.5}, {Angle()}}};
    options.search.gap = 0.45;
    return options;
}

TEST(OverPoses, SearchesAllSensorsIfFewerWerePlaced) {
    const Scene scene = roomScene(kPlainRoom);
    ArrangeOptions options = fromOnePlace();
    const auto groups = groupsOf(scene, {"laser,range=2,fov=360:2"});
    const double disc = 4 * std::numbers::pi;
    for (const int redundancy : {1, 2}) {
        options.redundancy = redundancy;
        const Arrangement found = arranged(scene, groups, options);
        ASSERT_TRUE(boundOf(found)) << redundancy;
        EXPECT_EQ(found.sensors.size(), 2U);
        EXPECT_EQ(found.unplaced, 0U);
        EXPECT_NE(found.sensors.front().sensor, found.sensors.back().sensor);
        EXPECT_TRUE(found.is_complete);
        EXPECT_GE(boundOf(found)->found, 0.55 * boundOf(found)->bound - 1e-9);
        EXPECT_LE(boundOf(found)->found, disc * (redundancy == 1 ? 2 : 1) + 1e-9);
        EXPECT_LE(boundOf(found)->bound, 30 + 1e-9);
    }
}

TEST(OverPoses, KeepsTheStateOfAllSensorsIfFewerWerePlaced) {
    const Scene scene = roomScene(kPlainRoom);
    ArrangeOptions options = fromOnePlace();
    const auto groups = groupsOf(scene, {"laser,range=2,fov=360:2"});
    const Arrangement single = arranged(scene, groups, options);
    TestResults kept;
    Arrangement last;
    int runs = 0;
    for (int asking = 40;; asking *= 2) {
        TestResults results(true);
        results.takeFrom(kept);
        results.get()->setInterval(0);
        options.search.share.results = results.get();
        StopWhen stop(afterAsking(asking));
        last = arrange(scene, groups, options, stop);
        kept.takeFrom(results);
        ++runs;
        if (!stop.stopped()) break;
    }
    EXPECT_GT(runs, 1);
    ASSERT_TRUE(boundOf(last));
    EXPECT_EQ(boundOf(last)->found, boundOf(single)->found);
    EXPECT_EQ(last.sensors.size(), 2U);
    // Another run takes the state of the whole search.
    TestResults again(true);
    again.takeFrom(kept);
    options.search.share.results = again.get();
    EXPECT_EQ(boundOf(arranged(scene, groups, options))->bound, boundOf(last)->bound);
    // A damaged one is refused by the name of its file.
    TestResults damaged(true);
    damaged.takeFrom(kept);
    damaged.get()->store("posestate1", kept.get()->find("posestate1").value().substr(0, 30));
    options.search.share.results = damaged.get();
    try {
        (void)arranged(scene, groups, options);
        ADD_FAILURE() << "a damaged state is taken";
    } catch (const FormatError& error) {
        EXPECT_EQ(error.diagnostics().front().file, damaged.get()->file());
        EXPECT_NE(std::string(error.what()).find("delete it"), std::string::npos);
    }
}

TEST(OverPoses, TheLastZoneOfAPointDecidesItsWeight) {
    const auto zone = [](double x0, double y0, double x1, double y1) {
        return NamedZone{
            "", {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {(x0 + x1) / 2, (y0 + y1) / 2}};
    };
    const auto weightAt = [](const poses::FloorWeighting& weighting, Point2 p) {
        double weight = weighting.elsewhere;
        int pieces = 0;
        for (const auto& piece : weighting.pieces) {
            if (Region{piece.outline, {}}.locate(p) != Side::Inside) continue;
            weight = piece.weight;
            ++pieces;
        }
        EXPECT_LE(pieces, 1);
        return weight;
    };
    FloorWeights weights;
    weights.weights = {{zone(0, 0, 4, 4), 2}, {zone(2, 2, 6, 6), 5}, {zone(2.9, 2.9, 3.4, 3.4), 0}};
    const poses::FloorWeighting all = weightingOf(weights);
    EXPECT_EQ(weightAt(all, {1.1, 1.2}), 2);
    EXPECT_EQ(weightAt(all, {2.3, 2.6}), 5);
    EXPECT_EQ(weightAt(all, {3.1, 3.2}), 0);
    EXPECT_EQ(weightAt(all, {7.3, 1.1}), 1);
    weights.targets = {zone(3, 0, 8, 3), zone(3.2, 1, 9, 4)};
    const poses::FloorWeighting some = weightingOf(weights);
    EXPECT_EQ(weightAt(some, {1.1, 1.2}), 0);
    EXPECT_EQ(weightAt(some, {3.3, 1.2}), 2);
    EXPECT_EQ(weightAt(some, {3.1, 3.2}), 0);
    EXPECT_EQ(weightAt(some, {3.9, 3.7}), 5);
    EXPECT_EQ(weightAt(some, {7.3, 1.1}), 1);
    EXPECT_EQ(weightAt(some, {7.3, 3.6}), 1);
    EXPECT_EQ(weightAt(some, {7.3, 4.6}), 0);
}

TEST(OverPoses, BoundsWeightedFloor) {
    const Scene scene = roomScene("#env 1\nispace size=12,8\n");
    ArrangeOptions options = coarse();
    options.refine = true;
    options.prover = std::make_shared<const PosesProver>();
    options.weights.weights = {{{"", {{-3, -2}, {3, -2}, {3, 2}, {-3, 2}}, {0, 0}}, 4}};
    const auto groups = groupsOf(scene, {"laser,range=2,fov=90:2"});
    const Arrangement found = arranged(scene, groups, options);
    ASSERT_TRUE(boundOf(found));
    EXPECT_NEAR(boundOf(found)->bound, 4 * 2 * std::numbers::pi, 1e-6);
    EXPECT_NEAR(boundOf(found)->found, 8 * std::numbers::pi, 0.005 * 8 * std::numbers::pi);
    EXPECT_NEAR(boundOf(found)->floor, 96 + 3 * 24, 1e-6);
    options.prover = std::make_shared<const PosesProver>(true);
    const Arrangement proven = arranged(scene, groups, options);
    const PoseCertificate& certificate = *boundOf(proven)->trees;
    const Scene placed = withPlaced(scene, groups, proven.sensors);
    const CheckedPoses checked = checkPoses(placed, options.weights, 1, certificate, "c");
    EXPECT_NEAR(checked.found, boundOf(proven)->found, 1e-6);
    EXPECT_NEAR(checked.floor, 96 + 3 * 24, 1e-6);
    EXPECT_LE(checked.check.bound, certificate.bound * (1 + 1e-9));
    // No pose is seen twice in full, and a heavier zone needs another proof.
    EXPECT_LT(checkPoses(placed, {}, 2, certificate, "c").found, checked.found);
    options.weights.weights[0].second = 5;
    EXPECT_GT(checkPoses(placed, options.weights, 1, certificate, "c").check.bound,
              certificate.bound);
}

TEST(OverPoses, ChecksTheCertificateForALayout) {
    const Scene scene = roomScene("#env 1\nispace size=5,4\n");
    ArrangeOptions options = coarse();
    options.refine = true;
    options.prover = std::make_shared<const PosesProver>(true);
    options.search.gap = 0.05;
    const auto groups = groupsOf(scene, {"laser,range=99,fov=360:1"});
    const Arrangement found = arranged(scene, groups, options);
    ASSERT_TRUE(boundOf(found) && boundOf(found)->trees);
    const PoseCertificate& certificate = *boundOf(found)->trees;
    const CheckedPoses checked =
        checkPoses(withPlaced(scene, groups, found.sensors), {}, 1, certificate, "c");
    EXPECT_EQ(checked.sensors, 1U);
    EXPECT_NEAR(checked.found, boundOf(found)->found, 1e-6);
    EXPECT_NEAR(checked.floor, 20, 1e-9);
    EXPECT_GE(checked.check.bound, checked.found);
    EXPECT_LE(checked.check.bound, certificate.bound * (1 + 1e-9));
    // The same trees prove less of a larger room.
    const Scene larger = roomScene("#env 1\nispace size=7,4\n");
    EXPECT_GT(
        checkPoses(withPlaced(larger, groups, found.sensors), {}, 1, certificate, "c").check.bound,
        certificate.bound);
}

TEST(OverPoses, ChecksLevelLasersOfOneKindAlone) {
    const auto refusal = [](const std::string& sensors) -> std::string {
        try {
            checkPoses(roomScene("#env 1\nispace size=8,6\n" + sensors), {}, 1,
                       {.bound = 9, .boxes = ".", .tuples = "."}, "c");
        } catch (const UsageError& error) {
            return error.what();
        }
        return "";
    };
    const std::string laser = "laser at=1,1\n";
    EXPECT_EQ(refusal(laser + laser), "");
    EXPECT_NE(refusal("").find("1 to 4 lasers"), std::string::npos);
    EXPECT_NE(refusal(laser + laser + laser + laser + laser).find("1 to 4"), std::string::npos);
    EXPECT_NE(refusal("laser id=out at=9,1\n").find("out is not on the free floor"),
              std::string::npos);
    EXPECT_NE(refusal("camera at=1,1,2\n").find("level lasers"), std::string::npos);
    EXPECT_NE(refusal("laser at=1,1 tilt=5\n").find("level lasers"), std::string::npos);
    EXPECT_NE(refusal(laser + "laser at=2,1 range=3\n").find("one kind"), std::string::npos);
    EXPECT_NE(refusal(laser + "laser at=2,1,1\n").find("one height"), std::string::npos);
}

TEST(OverPoses, RefusesSensorsThatItCannotBound) {
    const auto refusal = [](const std::string& room, const char* sensor,
                            const ArrangeOptions& options) -> std::string {
        try {
            const Scene scene = roomScene(room);
            arranged(scene, groupsOf(scene, {sensor}), options);
        } catch (const UsageError& error) {
            return error.what();
        }
        return "";
    };
    const std::string room = "#env 1\nispace size=8,6\n";
    ArrangeOptions options = coarse();
    options.refine = true;
    options.prover = std::make_shared<const PosesProver>();
    EXPECT_NE(refusal(room, "camera", options).find("level lasers"), std::string::npos);
    EXPECT_NE(refusal(room, "laser,tilt=10", options).find("level lasers"), std::string::npos);
    EXPECT_NE(refusal(room, "laser:5", options).find("at most 4"), std::string::npos);
    EXPECT_NE(refusal(room + "laser at=1,1\n", "laser", options).find("stand in the room"),
              std::string::npos);
    EXPECT_NE(refusal(room + "cylinder at=0,0 size=1,1,1\n", "laser", options).find("round"),
              std::string::npos);
    options.redundancy = 3;
    EXPECT_NE(refusal(room, "laser:2", options).find("takes as many"), std::string::npos);
}

}  // namespace over_poses_test
}  // namespace ispace::proofs
