// SPDX-License-Identifier: GPL-3.0-or-later
// Compares arranged cameras with brute force over all choices, with views computed by this file.
#include <gtest/gtest.h>

#include <bitset>
#include <cmath>
#include <limits>
#include <set>

#include "arrange/coverage_model.h"
#include "support/test_arrange.h"

namespace ispace {
namespace arrange_cameras_test {

constexpr int kColumns = 20, kRows = 15;
constexpr double kWidth = 8, kDepth = 6;
using Cells = std::bitset<std::size_t{kColumns} * kRows>;

/// A room with one cabinet.
const std::string kRoom =
    "#env 1\nispace id=room size=8,6,2.5\ncube id=c1 at=1.03,0.41 size=1.3,0.9,1.7\n";
constexpr Point3 kCabinetLow{0.38, -0.04, 0}, kCabinetHigh{1.68, 0.86, 1.7};

/// Returns true if the cabinet stands between two points: the slab test.
bool isHidden(Point3 from, Point3 to) {
    double enter = 0, leave = 1;
    const auto cut = [&](double a, double b, double low, double high) {
        if (a == b) {
            if (a < low || a > high) leave = -1;
            return;
        }
        const double first = (low - a) / (b - a), last = (high - a) / (b - a);
        enter = std::max(enter, std::min(first, last));
        leave = std::min(leave, std::max(first, last));
    };
    cut(from.x, to.x, kCabinetLow.x, kCabinetHigh.x);
    cut(from.y, to.y, kCabinetLow.y, kCabinetHigh.y);
    cut(from.z, to.z, kCabinetLow.z, kCabinetHigh.z);
    return enter < leave;
}

/// Returns the cells with centres at a height that satisfy `is_seen`.
template <typename IsSeen>
Cells cellsWhere(double height, IsSeen is_seen) {
    Cells cells;
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column) {
            const Point3 center{((column + 0.5) / kColumns - 0.5) * kWidth,
                                ((row + 0.5) / kRows - 0.5) * kDepth, height};
            if (is_seen(center)) cells.set(static_cast<std::size_t>(row) * kColumns + column);
        }
    return cells;
}

/// By projecting into the picture.
Cells seenBy(const Camera& camera, const Pose3& pose, double pixels_per_metre) {
    const double h = pose.heading.radians(), t = pose.tilt.radians();
    const Point3 at = pose.position;
    const Vec3 forward{std::cos(t) * std::cos(h), std::cos(t) * std::sin(h), std::sin(t)};
    const Vec3 left{-std::sin(h), std::cos(h), 0}, up = cross(forward, left);
    return cellsWhere(0, [&](Point3 place) {
        const Vec3 way = place - at;
        const Vec3 local{dot(way, forward), dot(way, left), dot(way, up)};
        const double far = camera.lens == Lens::Pinhole ? local.x : std::sqrt(dot(way, way));
        const auto pixel = camera.project(local);
        return pixel && camera.holds(*pixel) && far <= camera.max_range &&
               far * pixels_per_metre <= camera.fx && !isHidden(at, place);
    });
}

/// Of a laser that sees all around.
Cells seenBy(const Laser& laser, const Pose3& pose) {
    const Point3 at = pose.position;
    return cellsWhere(at.z, [&](Point3 place) {
        const Vec3 way = place - at;
        return std::sqrt(dot(way, way)) <= laser.max_range && !isHidden(at, place);
    });
}

/// A candidate of the brute force.
struct Offer {
    Cells cells;
    double cost = 1;
};

/// The best that can be chosen of `offers`, `most` of them at most: by trying everything.
class BruteForce {
  public:
    explicit BruteForce(std::vector<Offer> offers) : offers_(std::move(offers)) {}

    /// The greatest number of cells for this many of them, or for this cost.
    std::size_t greatest(int most, double budget) {
        best_ = 0;
        extend(0, most, budget, {});
        return best_;
    }
    /// The least cost of so many cells with at most `most` of them; infinite if it cannot be.
    double cheapest(int most, std::size_t wanted) {
        std::set<double> costs = {0};
        for (int i = 0; i < most; ++i)
            for (const double cost : std::set<double>(costs))
                for (const Offer& offer : offers_) costs.insert(cost + offer.cost);
        for (const double cost : costs)
            if (greatest(most, cost) >= wanted) return cost;
        return std::numeric_limits<double>::infinity();
    }

  private:
    void extend(std::size_t first, int most, double budget, const Cells& seen) {
        best_ = std::max(best_, seen.count());
        if (most == 0) return;
        for (std::size_t i = first; i < offers_.size(); ++i)
            if (offers_[i].cost <= budget)
                extend(i + 1, most - 1, budget - offers_[i].cost, seen | offers_[i].cells);
    }

    std::vector<Offer> offers_;
    std::size_t best_ = 0;
};

double shareOf(std::size_t cells) { return static_cast<double>(cells) / (kColumns * kRows); }

/// Returns options with few sites and four headings; all else at its default.
ArrangeOptions fewPlaces(Optimizer optimizer = Optimizer::Exact) {
    ArrangeOptions options;
    options.strategy = Strategy::List;
    for (const Point2 place : {Point2{-3.1, -2.2}, {-0.4, 1.7}, {2.9, -1.6}, {3.3, 2.1}})
        options.list.push_back({place, headingsAround(4)});
    options.search.optimizer = optimizer;
    options.cells = CellCount{kColumns, kRows};
    return options;
}

std::vector<Pose3> posesOf(const ArrangeOptions& options, double height,
                           const std::vector<double>& tilts) {
    std::vector<Pose3> poses;
    for (const double tilt : tilts)
        for (const Site& site : options.list)
            for (const Angle heading : site.headings)
                poses.push_back(
                    {{site.place.x, site.place.y, height}, heading, Angle::degrees(tilt), {}});
    return poses;
}

struct Case {
    const char* name;
    const char* camera;
    std::optional<MountOn> mount;
    double height;
    std::vector<double> tilts;
    double pixel_density;
};

class CamerasOf : public testing::TestWithParam<Case> {};

TEST_P(CamerasOf, AreChosenAsByTryingAll) {
    const Case& row = GetParam();
    const Scene scene = roomScene(kRoom);
    ArrangeOptions options = fewPlaces();
    options.mount.on = row.mount;
    options.pixel_density = row.pixel_density;
    const Camera camera = std::get<Camera>(groupsOf(scene, {row.camera})[0].model);
    std::vector<Offer> offers;
    for (const Pose3& pose : posesOf(options, row.height, row.tilts))
        offers.push_back({seenBy(camera, pose, row.pixel_density), 1});
    BruteForce all(offers);
    for (int count = 1; count <= 3; ++count) {
        const std::string spec = std::string(row.camera) + ':' + std::to_string(count);
        const auto groups = groupsOf(scene, {spec.c_str()});
        const double best = shareOf(all.greatest(count, count));
        const Arrangement exact = arranged(scene, groups, options);
        EXPECT_EQ(exact.candidate_value, best) << count;
        EXPECT_EQ(exact.candidate_bound, best) << count << ", proven";
        for (const Optimizer optimizer : {Optimizer::Greedy, Optimizer::Swap}) {
            options.search.optimizer = optimizer;
            const Arrangement found = arranged(scene, groups, options);
            EXPECT_LE(found.candidate_value, best);
            EXPECT_GE(found.candidate_bound, best) << count;
        }
        options.search.optimizer = Optimizer::Exact;
    }
    const std::size_t most = all.greatest(3, 3);
    options.target = shareOf(most);
    const Arrangement fewest = arranged(scene, groupsOf(scene, {row.camera}, true), options);
    EXPECT_EQ(fewest.cost, all.cheapest(3, most));
    EXPECT_EQ(fewest.least, fewest.cost);
}

INSTANTIATE_TEST_SUITE_P(
    Arrange, CamerasOf,
    testing::Values(Case{"Overhead", "camera,fov=90", {}, 2.45, {-90, -60, -30}, 0},
                    Case{"Narrow", "camera,fov=40", MountOn::Ceiling, 2.45, {-90, -60, -30}, 0},
                    Case{"Dense", "camera,fov=90", {}, 2.45, {-90, -60, -30}, 80},
                    Case{"Owned", "camera,fov=90,tilt=-41", {}, 2.45, {-41}, 0}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(ArrangeCameras, MixWithLasersAtTheirCosts) {
    const Scene scene = roomScene(kRoom);
    constexpr const char* kCamera = "camera,fov=90,cost=2";
    constexpr const char* kLaser = "laser,fov=360,range=2.6,cost=3";
    const auto groups = groupsOf(scene, {kCamera, kLaser}, true);
    ArrangeOptions options = fewPlaces();
    std::vector<Offer> offers;
    const Camera camera = std::get<Camera>(groups[0].model);
    for (const Pose3& pose : posesOf(options, 2.45, {-90, -60, -30}))
        offers.push_back({seenBy(camera, pose, 0), 2});
    for (const Site& site : options.list)
        offers.push_back({seenBy(std::get<Laser>(groups[1].model),
                                 {{site.place.x, site.place.y, kScanHeight}, {}, {}, {}}),
                          3});
    BruteForce all(offers);
    for (const double budget : {1.9, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0}) {
        options.budget = budget;
        if (budget < 2) {
            EXPECT_THROW(arranged(scene, groups, options), UnmetError);
            continue;
        }
        const double best = shareOf(all.greatest(3, budget));
        const Arrangement bought = arranged(scene, groups, options);
        EXPECT_EQ(bought.candidate_value, best) << budget;
        EXPECT_EQ(bought.candidate_bound, best) << budget;
        EXPECT_LE(bought.cost, budget);
    }
    options.budget.reset();
    for (const double share : {0.2, 0.4, 0.6, 0.7, 0.8}) {
        options.target = share;
        const Arrangement cheapest = arranged(scene, groups, options);
        const auto wanted = static_cast<std::size_t>(std::ceil(share * kColumns * kRows - 1e-9));
        EXPECT_EQ(cheapest.cost, all.cheapest(3, wanted)) << share;
        EXPECT_EQ(cheapest.least, cheapest.cost) << share;
        EXPECT_GE(cheapest.candidate_value, share);
    }
}

TEST(ArrangeCameras, HangWhereTheyAreUsual) {
    const Scene scene = roomScene(kRoom);
    ArrangeOptions options = coarse(Optimizer::Greedy);
    options.cells = CellCount{kColumns, kRows};
    const auto groups = groupsOf(scene, {"camera,fov=90", "laser"});
    const auto poses = [&] {
        std::vector<Pose3> found;
        for (const Placement& sensor : arranged(scene, groups, options).sensors)
            found.push_back(sensor.pose);
        return found;
    };
    EXPECT_NEAR(poses()[0].position.z, 2.45, 1e-9) << "a camera from the ceiling";
    EXPECT_EQ(poses()[1].position.z, kScanHeight) << "a laser on the floor";
    options.mount.on = MountOn::Wall;
    EXPECT_NEAR(poses()[0].position.z, 2.4, 1e-9);
    EXPECT_LT(poses()[0].tilt, Angle::degrees(-10));
    EXPECT_EQ(poses()[1].position.z, kScanHeight);
    options.mount.on.reset();
    options.strategy = Strategy::Wall;
    EXPECT_NEAR(poses()[0].position.z, 2.4, 1e-9);
    const Scene low = roomScene("#env 1\nfence path=0,0;5,0;5,4;0,4 closed=yes height=2\n");
    options.mount.on = MountOn::Wall;
    EXPECT_NEAR(arranged(low, groups, options).sensors[0].pose.position.z, 1.9, 1e-9)
        << "below the wall's top";
}

TEST(ArrangeCameras, ThatSeeAllAroundHangStraightDownOnce) {
    const Scene scene = roomScene(kRoom);
    const ArrangeOptions options = fewPlaces();
    const auto groups = groupsOf(scene, {"camera,projection=omni,fov=170"});
    const Arrangement arrangement = arranged(scene, groups, options);
    EXPECT_EQ(arrangement.candidates, options.list.size());
    EXPECT_EQ(arrangement.sensors[0].pose.tilt, Angle::degrees(-90));
}

TEST(ArrangeCameras, AreRefinedByWhatTheyHaveEnoughPixelsOf) {
    const Scene scene = roomScene(kRoom);
    ArrangeOptions options = fewPlaces();
    options.pixel_density = 80;
    options.refine = true;
    for (const char* lens :
         {"", ",coefficients=-0.2,0.03", ",projection=fisheye,coefficients=-0.05,0.01"}) {
        const std::string sensors = "camera,fov=90,tilt=-35" + std::string(lens) + ":2";
        const auto groups = groupsOf(scene, {sensors.c_str()});
        const Arrangement refined = arranged(scene, groups, options);
        EXPECT_GT(refined.refined_after, refined.refined_before) << lens;
        // It is the exact area of cameras that see no farther.
        const auto measured = [&](double pixels_per_metre) {
            Scene whole = withPlaced(scene, groups, refined.sensors);
            for (Sensor& sensor : whole.sensors)
                sensor.model = withDensity(sensor.as<Camera>(), pixels_per_metre);
            RayScenes worlds(whole.environment);
            return measureCoverage(whole, worlds, {}).report;
        };
        const CoverageReport report = measured(options.pixel_density);
        EXPECT_EQ(report.coverage.grid, refined.coverage) << lens;
        EXPECT_NEAR(*report.coverage.exact * report.indoor_area, refined.refined_after, 1e-6)
            << lens;
        EXPECT_GT(measured(0).coverage.grid, refined.coverage) << lens;
    }
}

TEST(ArrangeCameras, WithoutEnoughPixelsAnywhereSeeNothing) {
    const Scene scene = roomScene(kRoom);
    ArrangeOptions options = fewPlaces();
    options.pixel_density = 10'000;
    const Arrangement none = arranged(scene, groupsOf(scene, {"camera,fov=90"}), options);
    EXPECT_EQ(none.candidate_value, 0);
    EXPECT_EQ(none.candidate_bound, 0);
    options.target = 0.5;
    EXPECT_FALSE(arranged(scene, groupsOf(scene, {"camera,fov=90"}, true), options).is_reached);
}

}  // namespace arrange_cameras_test
}  // namespace ispace
