// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/candidate.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <random>

#include "base/error.h"
#include "base/number.h"
#include "support/test_covering_sensors.h"
#include "support/test_scenes.h"

namespace ispace {
namespace candidate_views_test {

using Random = std::mt19937_64;

constexpr std::size_t kPlenty = std::size_t{1} << 40U;

double uniform(Random& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

std::string randomRoom(Random& random) {
    std::string text = "ispace size=8,6\nwall id=w from=0.3,-2 to=0.3,2\n";
    text.append("window wall=w offset=2 size=3\n");
    const auto number = [&random](double low, double high) {
        return formatDouble(std::round(uniform(random, low, high) * 8) / 8);
    };
    for (int i = 0; i < 2; ++i)
        text.append("wall from=" + number(-4, 4) + ',' + number(-3, 3) + " to=" + number(-4, 4) +
                    ',' + number(-3, 3) + '\n');
    for (int i = 0; i < 3; ++i)
        text.append("cube at=" + number(-3, 3) + ',' + number(-2, 2) + " size=" + number(0.25, 2) +
                    ',' + number(0.25, 2) + ',' + number(0.25, 2) + '\n');
    return text;
}

/// Creates sites with 1 to 5 headings, some of them equal.
std::vector<Site> randomSites(Random& random, int count) {
    std::vector<Site> sites;
    for (int i = 0; i < count; ++i) {
        Site site{{uniform(random, -4.1, 4.1), uniform(random, -3.1, 3.1)}, {}};
        if (i % 3 == 0) site.place = {std::round(site.place.x), std::round(site.place.y)};
        if (i % 4 == 1) {
            site.headings = sites.back().headings;
        } else {
            const double first = i % 2 == 0 ? 0 : uniform(random, -300, 300);
            for (std::uint64_t k = random() % 5 + 1; k > 0; --k)
                site.headings.push_back(Angle::degrees(first + 45 * static_cast<double>(k)));
        }
        sites.push_back(std::move(site));
    }
    return sites;
}

void place(Scene& scene, const SensorModel& device, const Pose3& pose) {
    scene.sensors.push_back({"s" + std::to_string(scene.sensors.size()), device, pose});
}

struct Mounted {
    SensorModel model;
    Pose3 mount;
    bool is_round = false;
};

std::vector<Mounted> devices() {
    const auto at = [](double z, double tilt, double roll = 0) {
        return poseAt({0, 0, z}, 0, tilt, roll);
    };
    Laser sweep = laserWith(3, -30, 60);
    sweep.sweep = SweepAxis::Heading;
    sweep.sweep_span = Angle::degrees(90);
    Laser turning = sweep;
    turning.sweep_span = Angle::degrees(360);
    Laser nodding = laserWith(4, -90, 180);
    nodding.sweep = SweepAxis::Tilt;
    nodding.sweep_span = Angle::degrees(60);
    nodding.sweep_step = Angle::degrees(5);
    const auto ranger = [](double fov_x, double fov_y, Projection projection) {
        return rangerAt({}, fov_x, fov_y, 4, projection).as<Ranger>();
    };
    return {{laserWith(3, -90, 180), at(kScanHeight, 0)},
            {laserWith(4, -135, 270), at(0.6, 0)},
            {laserWith(2.5, 0, 0), at(kScanHeight, 0)},
            {laserWith(2.5, 20, 359), at(kScanHeight, 0), true},
            {sweep, at(kScanHeight, 0)},
            {turning, at(kScanHeight, 0), true},
            {laserWith(4, -90, 180), at(1, -30)},
            {laserWith(4, -90, 180), at(1, 0, 20)},
            {nodding, at(1, -60)},
            {ranger(60, 45, Projection::Pinhole), at(1, -30)},
            {ranger(60, 45, Projection::Pinhole), at(2, -90)},
            {ranger(360, 120, Projection::Spherical), at(1.2, 0), true},
            {receiverAt({}, 100, 5).as<Receiver>(), at(2.4, -90), true},
            {receiverAt({}, 100, 5).as<Receiver>(), at(1, -45)}};
}

/// Candidates see the counted cells that measureCoverage() finds for such a sensor.
void expectSame(const Scene& scene, const Mounted& mounted, const std::vector<Site>& sites,
                bool only_free) {
    RayScenes worlds(scene.environment);
    const Target target = makeTarget(scene.environment, CellCount{40, 30}, kScanHeight);
    constexpr double kPlane = 0.1;
    const VisibleArea sight(scene.environment, kPlane, &worlds);
    const CandidateViews views(sight, target.grid, mounted.model, mounted.mount,
                               only_free ? &target.free : nullptr);
    ASSERT_EQ(views.isRound(), mounted.is_round);
    PosedCandidates set(target.grid.size());
    SilentProgress quiet;
    ASSERT_TRUE(addCandidates(set, views, sites, kPlenty, quiet));
    ASSERT_EQ(set.sites(), sites.size());
    Scene placed = scene;
    std::size_t count = 0;
    for (std::size_t i = 0; i < sites.size(); ++i) {
        ASSERT_EQ(set.firstOf(i), count);
        for (std::size_t k = 0; k < (mounted.is_round ? 1 : sites[i].headings.size()); ++k) {
            Pose3 pose = mounted.mount;
            pose.position = {sites[i].place.x, sites[i].place.y, pose.position.z};
            pose.heading = sites[i].headings[k];
            ASSERT_EQ(set.pose(count), pose);
            place(placed, mounted.model, pose);
            ++count;
        }
    }
    ASSERT_EQ(set.size(), count);
    const Coverage coverage = measureCoverage(
        placed, worlds, {.cells = CellCount{40, 30}, .plane = kPlane, .exact = false});
    ASSERT_EQ(coverage.sensors.size(), count);
    std::size_t some = 0;
    for (std::size_t i = 0; i < count; ++i) {
        CellSet seen = set.cellsOf(i), expected = coverage.sensors[i].cells;
        if (only_free) {
            seen &= target.free;
            expected &= target.free;
        }
        ASSERT_EQ(seen, expected) << "candidate " << i << ": " << seen.count() << " instead of "
                                  << expected.count();
        some += seen.empty() ? 0 : 1;
    }
    EXPECT_GT(some, 0U);
}

TEST(CandidateViews, SeeWhatCoverageMeasures) {
    Random random(30);
    for (int trial = 0; trial < 3; ++trial) {
        const Scene scene = sceneOf(randomRoom(random));
        const std::vector<Mounted> all = devices();
        for (std::size_t i = 0; i < all.size(); ++i) {
            const bool scans_slice = i < 6;
            const std::vector<Site> sites = randomSites(random, scans_slice ? 40 : 6);
            ASSERT_NO_FATAL_FAILURE(expectSame(scene, all[i], sites, (i + trial) % 2 == 0))
                << "room " << trial << " device " << i;
        }
    }
}

TEST(CandidateViews, OddHeadings) {
    const Scene scene = sceneOf("ispace size=8,6\ncube at=1,1 size=1,1,1\n");
    std::vector<Site> sites = {{{-1.1, 0.1}, {}}, {{2.1, 2.9}, {}}};
    // Limits that meet but for rounding, around 0 as well.
    for (const double heading :
         {90.0, -90.0, -90 - 1e-12, 270.0, 90 + 1e-12, 90 - 1e-12, 450.0, -1e-13, 180.0})
        sites[0].headings.push_back(Angle::degrees(heading));
    for (int k = 0; k < 24; ++k) sites[1].headings.push_back(Angle::degrees(k * 360.0 / 24 - 0.1));
    for (const double fov : {0, 90, 180, 240, 358})
        ASSERT_NO_FATAL_FAILURE(expectSame(
            scene, {laserWith(4, -fov / 2, fov), poseAt({0, 0, 0.15}, 0, 0)}, sites, false))
            << fov;
}

/// A sector of just this width.
Laser laserOfSpan(double range, double first, double span) {
    Laser laser = laserWith(range, first, 1);
    laser.step = Angle::degrees(span);
    return laser;
}

TEST(CandidateViews, HeadingsTooNearToBeTold) {
    Random random(32);
    const Scene scene = sceneOf("ispace size=8,6\ncube at=1,1 size=1,1,1\n");
    const Grid grid = makeTarget(scene.environment, CellCount{40, 30}, kScanHeight).grid;
    for (int trial = 0; trial < 60; ++trial) {
        const double fov = std::vector<double>{0, 1, 90, 180, 270, 359, 102.8571429}[random() % 7];
        const double first = trial % 2 == 0 ? -fov / 2 : uniform(random, -180, 180);
        std::vector<Site> sites(12);
        for (Site& site : sites) {
            site.place = grid.center(random() % grid.size());
            switch (random() % 4) {
                case 0:  // hardly off a row
                    site.place.y = std::nextafter(site.place.y, random() % 2 == 0 ? 9 : -9);
                    break;
                case 1:
                    site.place = {uniform(random, -4, 4), uniform(random, -3, 3)};
                    break;
                default:
                    break;
            }
            const Point2 aim = grid.center(random() % grid.size());
            const double about =
                random() % 2 == 0
                    ? 90 * static_cast<double>(random() % 4)
                    : directionOf(aim.x - site.place.x, aim.y - site.place.y).degrees();
            const double apart = random() % 2 == 0 ? 1e-10 : 1e-14;
            for (int k = 0; k < 5; ++k)
                site.headings.push_back(
                    Angle::degrees(about - first + apart * static_cast<double>(random() % 40)));
        }
        ASSERT_NO_FATAL_FAILURE(expectSame(
            scene, {laserOfSpan(4, first, fov), poseAt({0, 0, kScanHeight}, 0, 0)}, sites, false))
            << trial;
    }
}

TEST(CandidateViews, SevenFansThatMeetBetweenCells) {
    const Scene scene = sceneOf("ispace size=8,6\n");
    // Sides of the fans, 360 / 3.5 degrees wide, lie 2e-8 degrees on this side and on the other of
    // the row through the site.
    std::vector<Site> sites = {{{0.1, 0.1}, {}}};
    for (int k = 0; k < 7; ++k) sites[0].headings.push_back(Angle::degrees(360.0 / 7 * k));
    ASSERT_NO_FATAL_FAILURE(expectSame(
        scene, {laserOfSpan(3, -102.8571429 / 2, 102.8571429), poseAt({0, 0, kScanHeight}, 0, 0)},
        sites, false));
}

TEST(CandidateViews, FansThatRoundingsTear) {
    const Scene scene = sceneOf("ispace size=8,6\n");
    const Grid grid = makeTarget(scene.environment, CellCount{40, 30}, kScanHeight).grid;
    std::vector<Site> sites(6, {grid.center(grid.cell(30, 12)), {}});
    for (std::size_t i = 1; i < sites.size(); ++i)
        sites[i].place.y = std::nextafter(sites[i - 1].place.y, 9);
    // The first heading looks to -180 degrees and a little further, but not to 180.
    for (Site& site : sites)
        for (const double heading : {171.89986331761804, 0.0, 90.0, -171.8})
            site.headings.push_back(Angle::degrees(heading));
    ASSERT_NO_FATAL_FAILURE(expectSame(scene,
                                       {laserOfSpan(9, -101.20355280257412, 109.30368948395606),
                                        poseAt({0, 0, kScanHeight}, 0, 0)},
                                       sites, false));
}

TEST(CandidateViews, ManyHeadingsOfAReceiver) {
    const Scene scene = sceneOf("ispace size=8,6\ncube at=1,1 size=1,1,1\n");
    std::vector<Site> sites = {{{-1.1, 0.1}, {}}, {{2.1, 2.9}, {Angle()}}};
    for (int k = 0; k < 70; ++k) sites[0].headings.push_back(Angle::degrees(5 * k + 3));
    const Receiver receiver = receiverAt({}, 60, 4).as<Receiver>();
    for (const double tilt : {-40.0, -90.0, -89.0})
        ASSERT_NO_FATAL_FAILURE(
            expectSame(scene, {receiver, poseAt({0, 0, 2}, 0, tilt), tilt == -90}, sites, false));
}

TEST(CandidateViews, SeeNothingFromWithinSolids) {
    const Scene scene = sceneOf("ispace size=8,6\ncube at=0,0 size=2,2,2\n");
    RayScenes worlds(scene.environment);
    const Grid grid{scene.environment.limits(), 40, 30};
    SilentProgress quiet;
    for (const Mounted& mounted : devices()) {
        if (mounted.mount.position.z > 1.9) continue;
        const VisibleArea sight(scene.environment, 0, &worlds);
        const CandidateViews views(sight, grid, mounted.model, mounted.mount);
        PosedCandidates set(grid.size());
        const std::vector<Site> sites = {{{0.1, 0.2}, {Angle(), Angle::degrees(-90)}}};
        ASSERT_TRUE(addCandidates(set, views, sites, kPlenty, quiet));
        for (std::size_t i = 0; i < set.size(); ++i) EXPECT_TRUE(set.cellsOf(i).empty());
    }
}

/// With 8 headings each.
std::vector<Site> manySites(int count) {
    Random random(31);
    std::vector<Angle> headings;
    for (int k = 0; k < 8; ++k) headings.push_back(Angle::degrees(45 * k));
    std::vector<Site> sites;
    for (int i = 0; i < count; ++i)
        sites.push_back({{uniform(random, -4, 4), uniform(random, -3, 3)}, headings});
    return sites;
}

TEST(CandidateViews, TheSameForAnyNumberOfThreads) {
    const Scene scene = sceneOf("ispace size=8,6\ncube at=1,1 size=1,1,1\n");
    RayScenes worlds(scene.environment);
    const Grid grid{scene.environment.limits(), 40, 30};
    const std::vector<Site> sites = manySites(1200);
    const VisibleArea sight(scene.environment, 0, &worlds);
    const CandidateViews views(sight, grid, laserWith(3, -90, 180),
                               poseAt({0, 0, kScanHeight}, 0, 0));
    std::vector<std::vector<CellRun>> runs;
    for (const std::size_t threads : {1, 2, 4}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        PosedCandidates set(grid.size());
        SilentProgress quiet;
        ASSERT_TRUE(addCandidates(set, views, sites, kPlenty, quiet));
        ASSERT_EQ(set.size(), 8 * sites.size());
        std::vector<CellRun> all;
        for (std::size_t i = 0; i < set.size(); ++i)
            set.forEachRun(i, [&all](const CellRun& run) { all.push_back(run); });
        runs.push_back(std::move(all));
    }
    EXPECT_EQ(runs[0], runs[1]);
    EXPECT_EQ(runs[0], runs[2]);
}

/// Says stop after some advances.
class ShortProgress final : public Progress {
  public:
    explicit ShortProgress(std::int64_t most) : most_(most) {}
    void begin(std::string_view phase, std::int64_t total) override {
        phase_ = phase;
        total_ = total;
    }
    void advance(std::int64_t count) override { done_ += count; }
    void end() override { ++ends_; }
    [[nodiscard]] bool stopped() const override { return done_ >= most_; }
    std::string phase_;
    std::int64_t most_, total_ = 0, done_ = 0;
    int ends_ = 0;
};

TEST(CandidateViews, StopEarlyAndWithinMemory) {
    const Scene scene = sceneOf("ispace size=8,6\n");
    RayScenes worlds(scene.environment);
    const Grid grid{scene.environment.limits(), 40, 30};
    const std::vector<Site> sites = manySites(2000);
    const VisibleArea sight(scene.environment, 0, &worlds);
    const CandidateViews views(sight, grid, laserWith(3, -90, 180),
                               poseAt({0, 0, kScanHeight}, 0, 0));
    PosedCandidates set(grid.size());
    ShortProgress progress(600);
    EXPECT_FALSE(addCandidates(set, views, sites, kPlenty, progress));
    EXPECT_EQ(progress.phase_, "scanning candidates");
    EXPECT_EQ(progress.total_, 2000);
    EXPECT_EQ(progress.ends_, 1);
    EXPECT_EQ(set.sites(), static_cast<std::size_t>(progress.done_));
    EXPECT_GE(set.sites(), 600U);
    EXPECT_LT(set.sites(), 2000U);

    PosedCandidates large(grid.size());
    SilentProgress quiet;
    try {
        addCandidates(large, views, sites, 200'000, quiet);
        FAIL() << "200 kB are not enough";
    } catch (const UsageError& error) {
        EXPECT_STREQ(error.what(),
                     "the candidates take more than 195.3 kB: use fewer places, headings or cells, "
                     "or --max-memory");
    }
    EXPECT_GT(large.bytes(), 200'000U);
    EXPECT_LT(large.bytes(), 210'000U);
}

/// Fails unless both have the same candidates.
void expectEqual(const PosedCandidates& set, const PosedCandidates& expected) {
    ASSERT_EQ(set.sites(), expected.sites());
    ASSERT_EQ(set.size(), expected.size());
    EXPECT_EQ(set.runs(), expected.runs());
    EXPECT_EQ(set.bytes(), expected.bytes());
    for (std::size_t i = 0; i < set.size(); ++i) {
        ASSERT_EQ(set.siteOf(i), expected.siteOf(i));
        ASSERT_EQ(set.pose(i), expected.pose(i));
        std::vector<CellRun> runs, expected_runs;
        set.forEachRun(i, [&](const CellRun& run) { runs.push_back(run); });
        expected.forEachRun(i, [&](const CellRun& run) { expected_runs.push_back(run); });
        ASSERT_EQ(runs, expected_runs) << i;
    }
}

TEST(CandidateViews, TheOrderInWhichSitesAreLookedAtDoesNotShow) {
    const Scene scene = sceneOf("ispace size=8,6\ncube at=1,1 size=1,1,1\n");
    RayScenes worlds(scene.environment);
    const Grid grid{scene.environment.limits(), 40, 30};
    SilentProgress quiet;
    const std::vector<Mounted> all = devices();
    for (const std::size_t device : {0U, 3U, 9U}) {
        const VisibleArea sight(scene.environment, 0.1, &worlds);
        const CandidateViews views(sight, grid, all[device].model, all[device].mount);
        for (const int count : {0, 1, 63, 64, 65, 700, 20000}) {
            if ((device == 9 && count > 70) || (device == 0 && count > 700)) continue;
            const std::vector<Site> sites = manySites(count);
            for (const std::size_t least : {0U, 1U, 50U}) {
                PosedCandidates set(grid.size()), expected(grid.size());
                ASSERT_TRUE(addCandidates(set, views, sites, kPlenty, quiet, least));
                for (const Site& site : sites)
                    ASSERT_TRUE(addCandidates(expected, views, {&site, 1}, kPlenty, quiet));
                ASSERT_NO_FATAL_FAILURE(expectEqual(set, expected)) << device << ' ' << count;
            }
        }
    }
}

}  // namespace candidate_views_test
}  // namespace ispace
