// SPDX-License-Identifier: GPL-3.0-or-later
// Logs that are simulated with known noise, poses and rooms.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numeric>
#include <random>

#include "base/error.h"
#include "base/file.h"
#include "extensions/reality/fit.h"
#include "extensions/reality/reality_report.h"
#include "io/importers.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "sense/noise.h"
#include "support/test_folder.h"
#include "support/test_scenes.h"

namespace ispace::reality {
namespace reality_test {

const std::string kRoom =
    "fence id=f path=0,0;8,0;8,6;0,6 closed=yes height=2.5\n"
    "pillar id=p at=5,2 size=0.4\n";

std::vector<Pose2> loopOfPoses(int count) {
    std::vector<Pose2> poses;
    for (int i = 0; i < count; ++i) {
        const double turn = 2 * 3.14159265358979 * i / count;
        poses.push_back(
            {{3 + 1.5 * std::cos(turn), 3 + 1.5 * std::sin(turn)}, Angle::radians(turn + 0.3)});
    }
    return poses;
}

struct LoggedLaser {
    Laser laser;
    LoggedLaser() {
        laser.max_range = 30;
        laser.first = Angle::degrees(-135);
        laser.step = Angle::degrees(1.5);
        laser.beams = 181;
    }
};

/// Reads a room at some poses, with the noise of the laser.
Log logOf(const Scene& scene, const std::vector<Pose2>& poses, const Laser& laser,
          std::uint64_t seed) {
    Log log;
    log.name = "a.log";
    log.format = "carmen";
    const RayWorld world = RayWorld::ofSlice(scene.environment.slice(kScanHeight));
    for (std::size_t i = 0; i < poses.size(); ++i) {
        LogScan scan;
        scan.sensor = "l1";
        scan.time = static_cast<double>(i);
        scan.first = laser.first;
        scan.step = laser.step;
        scan.max_range = laser.max_range;
        scan.ranges.resize(static_cast<std::size_t>(laser.beams));
        const Pose3 pose{
            {poses[i].position.x, poses[i].position.y, kScanHeight}, poses[i].heading, {}, {}};
        MeasuredScan measured;
        measured.scan = &scan;
        std::vector<float> cosines(scan.ranges.size());
        world.cast(pose.position, measured.rays(pose).directions, laser.max_range, scan.ranges,
                   cosines);
        addNoise(laser.noise, laser.min_range, laser.max_range, {seed, 7, i, Purpose::Range},
                 cosines, scan.ranges);
        scan.poses.corrected = pose;
        log.scans.push_back(std::move(scan));
    }
    return log;
}

LoggedRun simulated(const Log& log, const Scene& scene, RayScenes& worlds) {
    LoggedRun run = runOf(log, scene, {});
    SurfaceFinder surfaces(scene.environment);
    simulate(run, worlds, surfaces);
    return run;
}

TEST(Reality, ALogOfTheSameRoomHasTheNoiseOfTheDevice) {
    const Scene scene = sceneOf(kRoom);
    LoggedLaser device;
    device.laser.noise.sigma = {0.02, 0, 0};
    device.laser.noise.bias = 0.01;
    device.laser.noise.dropout = 0.1;
    const Log log = logOf(scene, loopOfPoses(60), device.laser, 1);
    RayScenes worlds(scene.environment);
    const LoggedRun run = simulated(log, scene, worlds);
    const RealityReport report = measureReality(log, run, scene.environment, {});
    EXPECT_EQ(report.scans, 60U);
    EXPECT_DOUBLE_EQ(report.inliers, 1);
    EXPECT_NEAR(report.sigma, 0.02, 0.001);
    EXPECT_NEAR(report.bias, 0.01, 0.001);
    EXPECT_NEAR(report.fit.model.max, 0.1, 0.01);
    EXPECT_NEAR(report.fit.model.hit, 0.9, 0.01);
    EXPECT_TRUE(report.errors.errors.empty());
    for (const ResidualTable& table : report.tables) {
        if (table.by != "surface") continue;
        ASSERT_EQ(table.rows.size(), 2U);
        for (const ResidualRow& row : table.rows) EXPECT_TRUE(row.name == "f" || row.name == "p");
    }
}

TEST(Reality, RequirementsCompareTheirFigures) {
    RealityReport report;
    report.inliers = 0.85;
    report.sigma = 0.04;
    report.bias = -0.02;
    report.residuals = 10;
    const auto unmet = [&](const char* text) {
        return !unmetRequirements(report, {parseRealityRequirement(text)}).empty();
    };
    EXPECT_FALSE(unmet("inliers=85%"));
    EXPECT_TRUE(unmet("inliers=0.9"));
    EXPECT_FALSE(unmet("sigma=4cm"));
    EXPECT_TRUE(unmet("sigma=0.03"));
    EXPECT_TRUE(unmet("bias=15mm"));
    EXPECT_FALSE(unmet("bias=2cm"));
    for (const char* bad : {"inliers", "inliers=90", "sigma=x", "sigma=-1", "hit=3%", ""})
        EXPECT_THROW(static_cast<void>(parseRealityRequirement(bad)), UsageError) << bad;
}

TEST(Reality, ALogWithoutReturnsMeetsNoRequirement) {
    const Scene scene = sceneOf(kRoom);
    LoggedLaser device;
    Log log = logOf(scene, loopOfPoses(5), device.laser, 1);
    for (LogScan& scan : log.scans)
        for (float& range : scan.ranges) range = kNoReturn;
    RayScenes worlds(scene.environment);
    const LoggedRun run = simulated(log, scene, worlds);
    const RealityReport report = measureReality(log, run, scene.environment, {});
    EXPECT_EQ(report.residuals, 0U);
    for (const char* text : {"inliers=1%", "sigma=1m", "bias=1m"}) {
        const auto unmet = unmetRequirements(report, {parseRealityRequirement(text)});
        ASSERT_EQ(unmet.size(), 1U) << text;
        EXPECT_NE(unmet.front().find(text), std::string::npos) << unmet.front();
    }
}

TEST(Reality, PosesAreAlignedToThePlan) {
    const Scene scene = sceneOf(kRoom);
    LoggedLaser device;
    device.laser.noise.sigma = {0.01, 0, 0};
    const std::vector<Pose2> poses = loopOfPoses(20);
    Log log = logOf(scene, poses, device.laser, 1);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> shift(-0.15, 0.15), turn(-4, 4);
    for (LogScan& scan : log.scans) {
        scan.poses.corrected->position.x += shift(random) + 0.1;
        scan.poses.corrected->position.y += shift(random);
        scan.poses.corrected->heading =
            scan.poses.corrected->heading + Angle::degrees(turn(random));
    }
    RayScenes worlds(scene.environment);
    LoggedRun run = simulated(log, scene, worlds);
    const Alignment alignment = align(run, worlds);
    EXPECT_EQ(alignment.kept, 0U);
    EXPECT_GT(alignment.median_metres, 0.05);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const Pose3& pose = run.scans[i].pose;
        EXPECT_LT(distance(pose.position.onFloor(), poses[i].position), 0.005) << i;
        EXPECT_LT(std::abs(wrapped(pose.heading - poses[i].heading).degrees()), 0.1) << i;
    }
}

TEST(Reality, APlanIsWrongWhereScansAgreeAndNotWherePeopleWalk) {
    const Scene plan = sceneOf(kRoom + "cube id=old at=6.5,4.8 size=0.6,0.6,1\n");
    LoggedLaser device;
    device.laser.noise.sigma = {0.01, 0, 0};
    const std::vector<Pose2> poses = loopOfPoses(40);
    Log log;
    // In the room there is a cube elsewhere, and a person who walks along y = 5.
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const double x = 1 + 0.12 * static_cast<double>(i);
        const Scene room =
            sceneOf(kRoom + "cube id=new at=1,1 size=0.6,0.6,1\ncylinder at=" + std::to_string(x) +
                    ",5.2 size=0.3 height=1.7\n");
        Log one = logOf(room, {poses[i]}, device.laser, i);
        log.scans.push_back(std::move(one.scans.front()));
    }
    RayScenes worlds(plan.environment);
    const LoggedRun run = simulated(log, plan, worlds);
    const RealityReport report = measureReality(log, run, plan.environment, {});
    std::size_t added = 0, gone = 0;
    for (const PlanError& error : report.errors.errors) {
        if (error.kind == PlanError::Kind::New) {
            ++added;
            EXPECT_LT(distance(error.center, {1, 1}), 0.5);
        } else {
            ++gone;
            ASSERT_GE(error.element, 0);
            EXPECT_EQ(plan.environment.elements()[static_cast<std::size_t>(error.element)].id,
                      "old");
            EXPECT_GT(error.share, 0.8);
        }
    }
    EXPECT_EQ(added, 1U);
    EXPECT_GE(gone, 1U);
    ASSERT_FALSE(report.records.empty());
    // Records are in the language of .env.
    for (const std::string& record : report.records)
        EXPECT_NO_THROW(sceneOf(kRoom + record + "\n"));
    EXPECT_TRUE(
        realityJson(report, plan.environment).starts_with("{\"schema\":\"ispace-reality/1\""));
}

TEST(Reality, AWallThatStandsElsewhereIsAMove) {
    // A partition that both of its ends show, and a shelf that was turned into another place.
    const std::string wall = "cube id=partition size=2.4,0.1,2 at=";
    const Scene plan = sceneOf(kRoom + wall + "4,4.6\n");
    const Scene room = sceneOf(kRoom + wall + "4,5.02\n");
    LoggedLaser device;
    device.laser.noise.sigma = {0.01, 0, 0};
    const Log log = logOf(room, loopOfPoses(40), device.laser, 3);
    RayScenes worlds(plan.environment);
    const LoggedRun run = simulated(log, plan, worlds);
    const RealityReport report = measureReality(log, run, plan.environment, {});
    ASSERT_EQ(report.errors.moves.size(), 1U) << realityText(report, plan.environment);
    const PlanMove& move = report.errors.moves.front();
    EXPECT_EQ(plan.environment.elements()[static_cast<std::size_t>(move.element)].id, "partition");
    EXPECT_NEAR(move.shift.x, 0, 0.06);
    EXPECT_NEAR(move.shift.y, 0.42, 0.03);
    ASSERT_FALSE(report.records.empty());
    EXPECT_NE(report.records.front().find("envc --move partition:"), std::string::npos)
        << report.records.front();
}

TEST(Reality, ASensorThatStandsStillHasThePoseOfTheLayout) {
    const Scene scene = sceneOf(kRoom + "laser id=l1 at=2,2 heading=30 range=30 fov=270\n");
    LoggedLaser device;
    Log log = logOf(scene, {{{2, 2}, Angle::degrees(30)}}, device.laser, 1);
    log.scans.front().poses.corrected.reset();
    RayScenes worlds(scene.environment);
    const LoggedRun run = simulated(log, scene, worlds);
    EXPECT_TRUE(run.sensors.front().stands);
    for (const MeasuredBeam& beam : run.beams) EXPECT_EQ(beam.measured, beam.expected);
    // --model is a device: the pose is that of the layout all the same.
    Sensor model = scene.sensors.front();
    model.pose = {};
    const LoggedRun modelled = runOf(log, scene, {.select = {}, .model = model});
    EXPECT_TRUE(modelled.sensors.front().stands);
    EXPECT_EQ(modelled.scans.front().pose.position.x, 2);
    const Scene other = sceneOf(kRoom);
    try {
        static_cast<void>(runOf(log, other, {}));
        ADD_FAILURE() << "a sensor without a pose";
    } catch (const FormatError& error) {
        EXPECT_NE(error.diagnostics().front().message.find("the log has " + log.scans[0].sensor),
                  std::string::npos)
            << error.diagnostics().front().message;
    }
}

TEST(Reality, BeamsOfARobotThatTurnsHaveTheirTimes) {
    const Scene scene = sceneOf(kRoom);
    LoggedLaser device;
    Log log;
    const RayWorld world = RayWorld::ofSlice(scene.environment.slice(kScanHeight));
    constexpr double kPeriod = 0.1, kTurn = 60;  // degrees a second
    for (int i = 0; i < 5; ++i) {
        LogScan scan;
        scan.sensor = "/scan";
        scan.time = kPeriod * i;
        scan.first = device.laser.first;
        scan.step = device.laser.step;
        scan.beam_time = kPeriod / 240;
        scan.max_range = 30;
        scan.poses.corrected =
            Pose3{{2, 2, kScanHeight}, Angle::degrees(kTurn * scan.time), {}, {}};
        for (int k = 0; k < device.laser.beams; ++k) {
            Directions one;
            one.resize(1);
            const Angle heading = Angle::degrees(kTurn * (scan.time + k * scan.beam_time));
            const Vec2 way = unitVector(heading + device.laser.bearing(k));
            one.set(0, {way.x, way.y, 0});
            float range = 0;
            world.cast({2, 2, kScanHeight}, one, 30, std::span(&range, 1));
            scan.ranges.push_back(range);
        }
        log.scans.push_back(std::move(scan));
    }
    RayScenes worlds(scene.environment);
    const LoggedRun run = simulated(log, scene, worlds);
    EXPECT_TRUE(run.scans.front().motion);
    for (std::size_t i = 0; i + 1 < run.scans.size(); ++i)
        for (const MeasuredBeam& beam : run.beamsOf(run.scans[i]))
            EXPECT_NEAR(beam.measured, beam.expected, 1e-4);
}

/// Draws from a beam model.
std::vector<BeamSample> drawn(const BeamModel& model, std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1), distances(1, 12);
    std::normal_distribution<double> normal;
    std::vector<BeamSample> samples;
    constexpr double kLimit = 20;
    for (std::size_t i = 0; i < count; ++i) {
        const double z = distances(random);
        BeamSample sample{0, z, 1, kLimit, z, z};
        if (i % 5 == 0) sample.edge_far = z + 2;
        const double u = uniform(random);
        if (sample.isAtEdge() && uniform(random) < model.mixed) {
            sample.measured = z + 2 * uniform(random);
        } else if (u < model.hit) {
            sample.measured = z + model.bias + model.sigmaAt(z) * normal(random);
        } else if (u < model.hit + model.nearer) {
            const double whole = -std::expm1(-model.lambda * z);
            sample.measured = -std::log1p(-uniform(random) * whole) / model.lambda;
        } else if (u < model.hit + model.nearer + model.random) {
            sample.measured = kLimit * uniform(random);
        } else {
            sample.measured = std::numeric_limits<double>::infinity();
        }
        samples.push_back(sample);
    }
    return samples;
}

TEST(BeamFit, EveryParameterLiesInItsIntervalForAHundredSeeds) {
    BeamModel truth;
    truth.hit = 0.75;
    truth.nearer = 0.1;
    truth.max = 0.05;
    truth.random = 0.1;
    truth.lambda = 0.8;
    truth.bias = 0.03;
    truth.sigma = {0.02, 0.005, 0};
    truth.mixed = 0.2;
    std::map<std::string, int> misses;
    constexpr int kSeeds = 100;
    for (unsigned seed = 0; seed < kSeeds; ++seed) {
        const BeamFit fit = fitBeams(drawn(truth, 4000, seed), SpreadTerms::Linear);
        const auto check = [&](const char* name, double value, double error, double expected) {
            constexpr double k99 = 2.576;
            if (!(std::abs(value - expected) <= k99 * error)) ++misses[name];
        };
        const BeamModel& m = fit.model;
        check("hit", m.hit, fit.errors.hit, truth.hit);
        check("short", m.nearer, fit.errors.nearer, truth.nearer);
        check("max", m.max, fit.errors.max, truth.max);
        check("random", m.random, fit.errors.random, truth.random);
        check("lambda", m.lambda, fit.errors.lambda, truth.lambda);
        check("bias", m.bias, fit.errors.bias, truth.bias);
        check("mixed", m.mixed, fit.errors.mixed, truth.mixed);
        check("s0", m.sigma[0], fit.errors.sigma[0], truth.sigma[0]);
        check("s1", m.sigma[1], fit.errors.sigma[1], truth.sigma[1]);
    }
    // One in a hundred is expected outside; five or more have a chance of 0.3 %.
    for (const auto& [name, count] : misses) EXPECT_LE(count, 5) << name;
}

TEST(BeamFit, TheNoiseOfASimulatedDeviceLiesInItsIntervals) {
    const Scene scene = sceneOf(kRoom);
    LoggedLaser device;
    RangeNoise& noise = device.laser.noise;
    noise.sigma = {0.01, 0.002, 0};
    noise.bias = 0.02;
    noise.dropout = 0.04;
    noise.resolution = 0.001;
    int misses = 0, terms = 0;
    constexpr int kSeeds = 20;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        const Log log = logOf(scene, loopOfPoses(30), device.laser, seed);
        RayScenes worlds(scene.environment);
        const LoggedRun run = simulated(log, scene, worlds);
        const std::vector<SensorFit> fits = fitSensors(run);
        ASSERT_EQ(fits.size(), 1U);
        const SensorFit& fit = fits.front();
        EXPECT_EQ(fit.resolution, 0.001);
        EXPECT_GT(fit.held_out_beams, 1000U);
        EXPECT_NEAR(fit.held_out, fit.fit.log_likelihood, 0.15);
        constexpr double k99 = 2.576;
        const auto check = [&](double value, double error, double expected) {
            if (!(std::abs(value - expected) <= k99 * error)) ++misses;
        };
        check(fit.fit.model.bias, fit.fit.errors.bias, noise.bias);
        check(fit.dropout.dropout, fit.dropout.error, noise.dropout);
        EXPECT_FALSE(fit.dropout.graze);
        if (fit.fit.terms != SpreadTerms::Linear) continue;
        ++terms;
        check(fit.fit.model.sigma[0], fit.fit.errors.sigma[0], noise.sigma[0]);
        check(fit.fit.model.sigma[1], fit.fit.errors.sigma[1], noise.sigma[1]);
    }
    EXPECT_GE(terms, kSeeds * 9 / 10);
    EXPECT_LE(misses, 4);  // of 80
}

TEST(BeamFit, LossesByIncidenceAreFound) {
    const Scene scene = sceneOf(kRoom);
    LoggedLaser device;
    RangeNoise& noise = device.laser.noise;
    noise.sigma = {0.01, 0, 0};
    noise.dropout = 0.05;
    noise.graze_from = Angle::degrees(50);
    noise.graze_to = Angle::degrees(80);
    const Log log = logOf(scene, loopOfPoses(60), device.laser, 3);
    RayScenes worlds(scene.environment);
    const SensorFit fit = fitSensors(simulated(log, scene, worlds)).front();
    ASSERT_TRUE(fit.dropout.graze);
    EXPECT_NEAR(fit.dropout.graze->first.degrees(), 50, 3);
    EXPECT_NEAR(fit.dropout.graze->second.degrees(), 80, 3);
    EXPECT_NEAR(fit.dropout.dropout, 0.05, 3 * fit.dropout.error);
}

TEST(Fit, ItsFileIsALayoutWhoseSensorHasTheNoise) {
    const Scene scene = sceneOf(kRoom);
    LoggedLaser device;
    device.laser.noise.sigma = {0.03, 0, 0};
    const Log log = logOf(scene, loopOfPoses(30), device.laser, 1);
    RayScenes worlds(scene.environment);
    const LoggedRun run = simulated(log, scene, worlds);
    const std::string text =
        fittedLayout(fitSensors(run), {}, {}, run, scene, "scan room.env --against a.log");
    const Document layout = readRecordText(text, "fit.3dm", sceneSchemas());
    const Document room = readRecordText("#env 1\n" + kRoom, "test.env", sceneSchemas());
    const Scene joined = makeScene(room, &layout, {});
    ASSERT_EQ(joined.pending.size(), 1U);
    const Laser& laser = std::get<Laser>(joined.pending.front().model);
    EXPECT_NEAR(laser.noise.sigma[0], 0.03, 0.002);
    EXPECT_EQ(laser.beams, 181);
    EXPECT_NEAR(laser.first.degrees(), -135, 1e-9);
    EXPECT_NEAR(laser.max_range, 30, 1e-9);
}

/// Counts the seeds of a hundred for which each alpha lies outside its 99 % interval.
/// \param is_linear of CARMEN: alphas of standard deviations, not of variances
std::array<int, 4> missedAlphas(const std::array<double, 4>& alphas, bool is_linear) {
    std::array<int, 4> misses{};
    constexpr int kSeeds = 100;
    for (unsigned seed = 0; seed < kSeeds; ++seed) {
        std::mt19937 random(seed);
        std::normal_distribution<double> normal;
        std::uniform_real_distribution<double> turns(-0.8, 0.8), ways(0, 0.8);
        Log log;
        Pose2 truth, odometry;
        const auto move = [](const Pose2& from, double turn, double way) {
            const Pose2 middle{from.position, from.heading + Angle::radians(turn / 2)};
            return Pose2{middle * Point2{way, 0}, from.heading + Angle::radians(turn)};
        };
        for (int i = 0; i < 400; ++i) {
            LogScan scan;
            scan.sensor = "l1";
            scan.time = i;
            scan.ranges = {1};
            scan.poses.corrected =
                Pose3{{truth.position.x, truth.position.y, 0}, truth.heading, {}, {}};
            scan.poses.odometry = odometry;
            log.scans.push_back(std::move(scan));
            const double turn = turns(random), way = ways(random);
            truth = move(truth, turn, way);
            const double turn_sum = alphas[0] * std::abs(turn) + alphas[1] * std::abs(way);
            const double way_sum = alphas[2] * std::abs(way) + alphas[3] * std::abs(turn);
            const double turn_sigma = is_linear ? turn_sum : std::sqrt(turn_sum);
            const double way_sigma = is_linear ? way_sum : std::sqrt(way_sum);
            odometry = move(odometry, turn + turn_sigma * normal(random),
                            way + way_sigma * normal(random));
        }
        const auto fit = fitOdometry(log);
        if (!fit) {
            ADD_FAILURE() << "no fit";
            continue;
        }
        EXPECT_GT(fit->motions, 380U);
        const std::array<double, 4>& found = is_linear ? fit->carmen : fit->alphas;
        const std::array<double, 4>& errors = is_linear ? fit->carmen_errors : fit->errors;
        constexpr double k99 = 2.576;
        for (std::size_t k = 0; k < alphas.size(); ++k)
            // At 0 there is no interval: the value itself is its bound.
            if (errors[k] > 0 && std::abs(found[k] - alphas[k]) > k99 * errors[k]) ++misses[k];
    }
    return misses;
}

TEST(Fit, OdometryHasItsAlphas) {
    for (const int count : missedAlphas({0.004, 0.0005, 0.001, 0.0008}, false)) EXPECT_LE(count, 4);
}

TEST(Fit, OdometryOfCarmenHasItsAlphas) {
    for (const int count : missedAlphas({0.04, 0.015, 0.03, 0.02}, true)) EXPECT_LE(count, 4);
}

TEST(Reality, OnCsailTheRoomOfTheEvenScansHoldsForTheOddOnes) {
    const char* const data = std::getenv("ISPACE_TEST_DATA");
    if (data == nullptr) GTEST_SKIP() << "ISPACE_TEST_DATA is not set";
    const Log log = readLog(std::string(data) + "/logs/csail.corrected.clf");
    // A map of 5 cm of the even scans: the cells where beams end, less those that beams cross.
    constexpr double kCell = 0.05, kFar = 30;
    Box2 box;
    const auto endOf = [](const LogScan& scan, std::size_t k, double range) {
        const Angle bearing = scan.first + static_cast<double>(k) * scan.step;
        const Pose3& pose = *scan.poses.corrected;
        return pose.position.onFloor() + range * unitVector(pose.heading + bearing);
    };
    Log odd;
    odd.name = log.name;
    odd.format = log.format;
    for (std::size_t i = 0; i < log.scans.size(); ++i) {
        if (i % 2 == 1) odd.scans.push_back(log.scans[i]);
        for (std::size_t k = 0; k < log.scans[i].ranges.size(); ++k)
            if (const double range = double{log.scans[i].ranges[k]}; range < kFar)
                box.add(endOf(log.scans[i], k, range));
    }
    box = box.expanded(1);
    const auto columns = static_cast<std::size_t>(std::ceil(box.width() / kCell));
    const auto rows = static_cast<std::size_t>(std::ceil(box.depth() / kCell));
    std::vector<double> hits(columns * rows), passed(columns * rows);
    const auto cellOf = [&](Point2 p) {
        const auto column = static_cast<std::size_t>((p.x - box.low.x) / kCell);
        const auto row = static_cast<std::size_t>((p.y - box.low.y) / kCell);
        return std::min(row, rows - 1) * columns + std::min(column, columns - 1);
    };
    for (std::size_t i = 0; i < log.scans.size(); i += 2)
        for (std::size_t k = 0; k < log.scans[i].ranges.size(); ++k) {
            const double range = double{log.scans[i].ranges[k]};
            if (!(range < kFar)) continue;
            hits[cellOf(endOf(log.scans[i], k, range))] += 1;
            for (double r = 0; r < range - kCell; r += kCell)
                passed[cellOf(endOf(log.scans[i], k, r))] += 1;
        }
    std::string picture = "P5\n" + std::to_string(columns) + ' ' + std::to_string(rows) + "\n255\n";
    for (std::size_t row = rows; row-- > 0;)
        for (std::size_t column = 0; column < columns; ++column) {
            const double hit = hits[row * columns + column], free = passed[row * columns + column];
            constexpr double kShare = 0.25;
            picture += hit + free == 0               ? char(-51)
                       : hit > kShare * (hit + free) ? char(0)
                                                     : char(-2);
        }
    const testing::TestFolder folder;
    writeAll(folder.file("map.pgm"), picture);
    writeAll(folder.file("map.yaml"),
             "image: map.pgm\nresolution: 0.05\norigin: [" + std::to_string(box.low.x) + ", " +
                 std::to_string(box.low.y) +
                 ", 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
    const Document room = readDocument(folder.file("map.yaml"), {}, sceneSchemas());
    const Scene scene = makeScene(room, nullptr, {});
    RayScenes worlds(scene.environment);
    LoggedRun run = simulated(odd, scene, worlds);
    RealityReport report = measureReality(odd, run, scene.environment, {});
    RecordProperty("inliers", std::to_string(report.inliers));
    EXPECT_GE(report.inliers, 0.83);
    EXPECT_LE(report.sigma, 0.06);
    EXPECT_NEAR(report.fit.model.max, 0.026, 0.003);
    const Alignment alignment = align(run, worlds);
    EXPECT_LT(alignment.median_metres, 0.05);
    SurfaceFinder surfaces(scene.environment);
    simulate(run, worlds, surfaces);
    report = measureReality(odd, run, scene.environment, alignment);
    EXPECT_GE(report.inliers, 0.85);
    const SensorFit fit = fitSensors(run).front();
    EXPECT_EQ(fit.resolution, 0.01);
    EXPECT_GT(fit.held_out, 0.2);
}

}  // namespace reality_test
}  // namespace ispace::reality
