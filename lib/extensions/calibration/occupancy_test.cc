// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/calibration/occupancy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/number.h"
#include "env/level.h"
#include "extensions/reality/log.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"
#include "sense/scan.h"
#include "support/test_layout.h"

namespace ispace::calibration {
namespace occupancy_test {

/// Returns the scans of a log with corrected poses.
std::vector<PosedScan> carmenScans(const std::string& file) {
    std::vector<PosedScan> scans;
    for (reality::LogScan& scan : reality::readLog(file).scans) {
        const Pose3 pose = scan.poses.best().value();
        scans.push_back({{pose.position.onFloor(), pose.heading},
                         scan.first,
                         scan.step,
                         scan.max_range,
                         std::move(scan.ranges)});
    }
    return scans;
}

Scene roomOf(std::span<const PosedScan> scans, double resolution) {
    ImportOptions options;
    options.clean = 3 * resolution;  // as readLogRoom()
    ImportRecords out(sceneSchemas(), "log", options);
    writeCellMap(occupancyOf(scans, resolution, "log"), {"log", "scans see no floor"}, options,
                 out);
    return makeScene(out.take(), nullptr, {});
}

struct Agreement {
    double share = 0, bias = 0;
    std::size_t beams = 0;
};
Agreement agreementOf(const Scene& room, std::span<const PosedScan> scans) {
    Agreement sum;
    const RayWorld world = RayWorld::ofLevel(room.environment, 0.3, nullptr);
    for (const PosedScan& scan : scans) {
        Laser laser;
        laser.max_range = scan.max_range;
        laser.first = scan.first;
        laser.step = scan.step;
        laser.beams = static_cast<int>(scan.ranges.size());
        const Sensor sensor{
            "l",
            laser,
            {{scan.pose.position.x, scan.pose.position.y, 0.3}, scan.pose.heading, {}, {}}};
        const std::vector<float> simulated = castBeams(world, sensor);
        for (std::size_t k = 0; k < simulated.size(); ++k) {
            if (!(scan.ranges[k] < scan.max_range)) continue;
            ++sum.beams;
            const double off = scan.ranges[k] - simulated[k];
            if (std::abs(off) > 0.2) continue;
            ++sum.share;
            sum.bias += off;
        }
    }
    sum.bias /= sum.share;
    sum.share /= static_cast<double>(sum.beams);
    return sum;
}

/// Scans of a room from points on a grid.
std::vector<PosedScan> scansOf(const Scene& scene, std::span<const Pose2> poses) {
    const RayWorld world = RayWorld::ofLevel(scene.environment, 0.3, nullptr);
    std::vector<PosedScan> scans;
    for (const Pose2& pose : poses) {
        Laser laser;
        laser.max_range = 30;
        laser.first = Angle::degrees(-180);
        laser.step = Angle::degrees(0.5);
        laser.beams = 720;
        const Sensor sensor{
            "l", laser, {{pose.position.x, pose.position.y, 0.3}, pose.heading, {}, {}}};
        scans.push_back({pose, laser.first, laser.step, laser.max_range, castBeams(world, sensor)});
    }
    return scans;
}

TEST(Occupancy, ScansOfARoomGiveItsOutlineBack) {
    const Scene scene = testing::scene(
        "fence path=0,0;9,0;9,4;5,4;5,7;0,7 closed=yes height=2.5\ninside at=1,1\n"
        "cube at=3,2 size=1,1,0.7\n");
    std::vector<Pose2> poses;
    for (const double x : {1.0, 2.0, 4.5, 6.5, 8.2})
        for (const double y : {0.8, 3.4, 5.6})
            if (scene.environment.level(0.3)->isFree({x, y}))
                poses.push_back({{x, y}, Angle::degrees(17 * x)});
    const std::vector<PosedScan> scans = scansOf(scene, poses);
    const Scene learned = roomOf(scans, 0.05);
    EXPECT_NEAR(learned.environment.indoor().area(), 9 * 4 + 5 * 3, 3);
    const Agreement agreement = agreementOf(learned, scans);
    EXPECT_GT(agreement.share, 0.97);
    EXPECT_LT(std::abs(agreement.bias), 0.075);                    // a cell and a half
    EXPECT_FALSE(learned.environment.level(0.3)->isFree({3, 2}));  // the cube
}

TEST(Occupancy, APersonInOneScanIsErasedByOthers) {
    const Scene scene = testing::scene("ispace at=4,3 size=8,6,2.5\n");
    const Scene with =
        testing::scene("ispace at=4,3 size=8,6,2.5\ncylinder at=4,2 size=0.4,0.4,1.7\n");
    const std::vector<Pose2> poses(6, Pose2{{2, 2}, {}});
    std::vector<PosedScan> scans = scansOf(scene, poses);
    scans[1] = scansOf(with, std::span(poses).first(1)).front();
    const CellMap map = occupancyOf(scans, 0.05, "log");
    const CellIndex at = map.placeOf({3.81, 2.01});
    EXPECT_TRUE(map.free.contains(at.x, at.y));
}

TEST(Occupancy, ALogIsReadAsARoom) {
    // A turn in the middle of a room of 4 x 4 m.
    std::string log;
    for (int i = 0; i < 8; ++i) {
        log += "FLASER 181";
        for (int k = 0; k <= 180; ++k) {
            const double angle = (i * 45 + k - 90) * std::numbers::pi / 180;
            const double range = 2 / std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
            log += ' ' + formatFixed(range, 3);
        }
        const std::string pose = " 0 0 " + formatFixed(i * std::numbers::pi / 4, 6);
        log += pose + (i % 2 == 0 ? pose : " 1 0 0") + " 1 host 1\n";
    }
    ASSERT_TRUE(reality::isLog(log));
    const Document room = readLogRoom(log, "log", {}, sceneSchemas());
    EXPECT_NEAR(makeScene(room, nullptr, {}).environment.indoor().area(), 16, 1.5);
    // A fixed laser: a calibration finds its pose.
    const std::string still =
        R"({"schema":"ispace-scan/1","history":[],"seed":0}
{"sensor":"l1","t":0,"frame":0,"pose":[0,0,0.3,0,0,0],"angle_min":0,"angle_max":1,"angle_increment":1,)"
        R"("range_min":0,"range_max":9,"ranges":[1,2]}
)";
    ASSERT_TRUE(reality::isLog(still));
    try {
        static_cast<void>(readLogRoom(still, "log", {}, sceneSchemas()));
        FAIL() << "a room of a laser without a pose";
    } catch (const FormatError& error) {
        EXPECT_TRUE(
            error.diagnostics().front().message.starts_with("no level scan of the log has a pose"))
            << error.what();
    }
}

TEST(Occupancy, RefusesScansWithoutReturns) {
    const std::vector<PosedScan> scans{{{}, {}, Angle::degrees(1), 8, {INFINITY, 8, 9}}};
    EXPECT_THROW(static_cast<void>(occupancyOf(scans, 0.05, "log")), FormatError);
    EXPECT_THROW(static_cast<void>(occupancyOf({}, 0.05, "log")), FormatError);
    const std::vector<PosedScan> far{{{}, {}, Angle::degrees(1), 1e7, {9e5F, 9e5F}}};
    try {
        static_cast<void>(occupancyOf(far, 0.05, "log"));
        ADD_FAILURE() << "more cells than fit";
    } catch (const FormatError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("wanted a --resolution above 3.7"), std::string::npos) << message;
    }
}

TEST(Occupancy, EvenScansOfCsailPredictTheOddOnes) {
    const char* const data = std::getenv("ISPACE_TEST_DATA");
    if (data == nullptr) GTEST_SKIP() << "ISPACE_TEST_DATA is not set";
    const std::vector<PosedScan> all = carmenScans(std::string(data) + "/logs/csail.corrected.clf");
    ASSERT_EQ(all.size(), 406U);
    std::vector<PosedScan> even, odd;
    for (std::size_t i = 0; i < all.size(); ++i) (i % 2 == 0 ? even : odd).push_back(all[i]);
    const Agreement agreement = agreementOf(roomOf(even, kLearnedCell), odd);
    EXPECT_GE(agreement.share, 0.855) << agreement.beams << " beams";
    EXPECT_LT(agreement.bias, 0.04);
}

}  // namespace occupancy_test
}  // namespace ispace::calibration
