// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a plane that cameras see, against sampling by independent code.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <random>
#include <string>

#include "coverage/plane_cells.h"
#include "coverage/shadow_footprint.h"
#include "coverage/visible_area.h"
#include "geom/predicates.h"
#include "scene/sensor/sensor_keys.h"
#include "support/test_covering_sensors.h"
#include "support/test_scenes.h"
#include "support/test_sensors.h"

namespace ispace {
namespace camera_region_test {

constexpr double kPi = std::numbers::pi;

Camera cameraFrom(const std::string& keys) {
    return parametersOf<Camera>(testing::sensorRecord("camera id=c " + keys), nullptr);
}

Sensor at(const Camera& camera, const Pose3& pose) { return {"c", camera, pose}; }

/// A region as polygons, queried by points.
class Outline {
  public:
    explicit Outline(const std::vector<Curve>& curves) : area_(signedArea(curves)) {
        for (const Curve& curve : curves) polygons_.push_back(chords(curve, 1e-6));
    }
    [[nodiscard]] double area() const { return area_; }
    [[nodiscard]] bool holds(Point2 p) const {
        bool inside = false;
        for (const Polygon& polygon : polygons_)
            inside = inside != (locate(polygon, p) == Side::Inside);
        return inside;
    }
    [[nodiscard]] double distanceFrom(Point2 p) const {
        double nearest = 1e9;
        for (const Polygon& polygon : polygons_)
            forEachEdge(polygon,
                        [&](const Segment2& s) { nearest = std::min(nearest, distance(p, s)); });
        return nearest;
    }

  private:
    std::vector<Polygon> polygons_;
    double area_;
};

/// Asks `is_seen` about places of a box at random: all agree with the region but for those within
/// `rim` of its boundary, and the area is met within four standard deviations.
template <typename IsSeen>
double compare(const Outline& region, const Box2& box, int samples, double rim, unsigned seed,
               const std::string& what, IsSeen is_seen) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> x(box.low.x, box.high.x), y(box.low.y, box.high.y);
    int wrong = 0, seen = 0;
    for (int i = 0; i < samples; ++i) {
        const double px = x(random);
        const Point2 p{px, y(random)};
        const bool expected = is_seen(p);
        seen += expected ? 1 : 0;
        if (region.holds(p) == expected || region.distanceFrom(p) < rim) continue;
        if (++wrong <= 3)
            ADD_FAILURE() << what << ": " << p.x << ", " << p.y << " is "
                          << (expected ? "seen" : "not seen") << ", " << region.distanceFrom(p)
                          << " m from the boundary";
    }
    EXPECT_EQ(wrong, 0) << what;
    const double whole = box.width() * box.depth(), share = static_cast<double>(seen) / samples;
    const double sigma = whole * std::sqrt(std::max(share * (1 - share), 10.0 / samples) / samples);
    EXPECT_NEAR(region.area(), share * whole, 4 * sigma + 1e-3) << what;
    return share;
}

// An independent model of occlusion, which clips the segment of sight.

bool passes(const Prism& prism, Point3 a, Vec3 way) {
    double first = 0, last = 1;
    const auto clip = [&](double from, double slope) {  // inside where from + t slope >= 0
        if (slope == 0) {
            if (from < 0) first = 2;
        } else if (slope > 0) {
            first = std::max(first, -from / slope);
        } else {
            last = std::min(last, -from / slope);
        }
    };
    clip(a.z - prism.bottom, way.z);
    clip(prism.top - a.z, -way.z);
    const std::size_t corners = prism.footprint.size();
    for (std::size_t i = 0; i < corners; ++i) {
        const Point2 p = prism.footprint[i], q = prism.footprint[(i + 1) % corners];
        const double ex = q.x - p.x, ey = q.y - p.y, size = std::hypot(ex, ey);
        clip((ex * (a.y - p.y) - ey * (a.x - p.x)) / size, (ex * way.y - ey * way.x) / size);
    }
    return last - first > 1e-9;
}

bool passes(const Sheet& sheet, Point3 a, Vec3 way) {
    const Point2 p = sheet.line.a, q = sheet.line.b;
    const double ex = q.x - p.x, ey = q.y - p.y;
    const double det = ex * way.y - ey * way.x;
    if (det == 0) return false;
    const double t = (ey * (a.x - p.x) - ex * (a.y - p.y)) / det;
    const double s = (way.y * (a.x - p.x) - way.x * (a.y - p.y)) / det;
    const double z = a.z + t * way.z;
    return t > 1e-6 && t < 1 - 1e-6 && s >= 0 && s <= 1 && z >= sheet.bottom && z <= sheet.top;
}

bool isHidden(const Environment& environment, Point3 from, Point3 to) {
    const Vec3 way = to - from;
    for (const Element& element : environment.elements()) {
        for (const Prism& prism : element.body.prisms)
            if (passes(prism, from, way)) return true;
        for (const Sheet& sheet : element.body.sheets)
            if (!sheet.clear && passes(sheet, from, way)) return true;
    }
    return false;
}

/// A scene with tables; faces are at 1.6 m, and people do not hide each other.
constexpr const char* kFurnished =
    "ispace size=12,8,3\ntable at=2,1 size=1.4,1.4 height=0.75\ndesk at=-2,1.5 heading=20\n"
    "desk at=-3,-2 heading=70 kind=closed\ncube at=1,-2 heading=30 size=0.8,0.6,1.9\n"
    "pillar at=4,-1.5 size=0.4,0.4,3\nscreen at=0.2,2.6 heading=15\nhuman at=0,0\n"
    "human at=2.5,-0.5\ncube at=-4.4,2.7 size=0.6,0.6,2.4\n";

struct Shot {
    const char* keys;
    Pose3 pose;
};

TEST(CameraRegion, PinholesMeetBruteForce) {
    const Scene scene = sceneOf(kFurnished);
    const ShadowCaster caster(scene.environment);
    const Shot shots[] = {
        {"fov=80 range=9", poseAt({-5.5, -3.5, 2.6}, 35, -30)},
        {"fov=100 pixels=1920,1080", poseAt({5.9, 3.9, 2.9}, -140, -35, 8)},
        {"fx=500 fy=520 cx=100 cy=420 range=8", poseAt({-5, 0, 2.2}, -10, -25)},
        {"fx=420 fy=420 cx=-60 cy=240 range=12", poseAt({0, 3.8, 2.8}, -80, -20, -5)},
        {"fov=110,90 range=6", poseAt({0.5, 0.3, 2.9}, 60, -90, 20)},
        {"fov=70 range=15", poseAt({-5.5, 3.2, 1.2}, -20, 5)}};
    unsigned seed = 1;
    for (const Shot& shot : shots)
        for (const double plane : {0.0, 1.6}) {
            const Camera camera = cameraFrom(shot.keys);
            const Outline region(caster.regionSeen(at(camera, shot.pose), plane).value());
            const Frame3 frame(shot.pose);
            const auto is_seen = [&](Point2 p) {
                const Point3 place{p.x, p.y, plane};
                const Vec3 way = frame.toLocal(place);
                if (way.x <= 0 || way.x > camera.max_range) return false;
                const double column = camera.cx - camera.fx * way.y / way.x;
                const double row = camera.cy - camera.fy * way.z / way.x;
                return column >= -0.5 && column <= camera.columns - 0.5 && row >= -0.5 &&
                       row <= camera.rows - 0.5 &&
                       !isHidden(scene.environment, shot.pose.position, place);
            };
            // Round tops are polygons here, 0.05 mm inside their curves.
            constexpr double kRim = 1e-3;
            compare(region, {{-6, -4}, {6, 4}}, plane == 0 ? 100'000 : 20'000, kRim, ++seed,
                    std::string(shot.keys) + " at " + std::to_string(plane), is_seen);
        }
}

TEST(CameraRegion, BentPicturesMeetTheirProjection) {
    const ShadowCaster caster(sceneOf("ispace size=60,60,20").environment);
    const char* const lenses[] = {
        "fov=70 coefficients=-0.28,0.09,0.0012,-0.0007,-0.01 range=9",
        "fov=90 coefficients=-0.3,0.05 range=8",  // its corners are beyond the lens
        "fov=60 coefficients=0.1,0.02,0.001,0.002 range=12",
        "projection=fisheye fov=150 coefficients=0.02,-0.01,0.003,-0.0005 range=7",
        "projection=fisheye fov=170 pixels=1280,960 range=10",
        "projection=fisheye fx=150 cx=120 cy=-40 range=6",
        "projection=omni fov=185 pixels=600,600 range=6",
        "projection=omni fov=250 pixels=500,480 range=5",
        "projection=omni fov=360 pixels=512,512 range=5",
        "projection=omni fov=220 mirror=0.9 pixels=480,480 range=6",
        "projection=omni mirror=0.6 fx=300 pixels=640,480 range=7"};
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> turn(-180, 180), height(0.3, 4);
    double seen = 0;
    for (const char* const lens : lenses) {
        const Camera camera = cameraFrom(lens);
        for (int trial = 0; trial < 14; ++trial) {
            const double tilt = trial == 0 ? -90 : trial == 1 ? 0 : trial == 2 ? 90 : turn(random);
            const Pose3 pose = poseAt({turn(random) / 100, turn(random) / 100, height(random)},
                                      turn(random), tilt, trial < 3 ? 0 : turn(random));
            const double plane = trial % 7 == 3   ? pose.position.z
                                 : trial % 5 == 4 ? pose.position.z + 2
                                                  : 0;
            const Outline region(caster.regionSeen(at(camera, pose), plane).value());
            const Frame3 frame(pose);
            const auto is_seen = [&](Point2 p) {
                const Vec3 way = frame.toLocal({p.x, p.y, plane});
                const double far = camera.lens == Lens::Pinhole ? way.x : length(way);
                const auto pixel = camera.project(way);
                return far <= camera.max_range && pixel && camera.holds(*pixel);
            };
            seen += compare(region, {{-15, -15}, {15, 15}}, 3000, 1e-4,
                            static_cast<unsigned>(trial) + 7,
                            std::string(lens) + " trial " + std::to_string(trial), is_seen);
        }
    }
    EXPECT_GT(seen, 5);
}

TEST(CameraRegion, FullCirclesThatLookDownSeeDiscs) {
    const ShadowCaster caster(sceneOf("ispace size=60,60,20").environment);
    const auto area = [&](const std::string& keys, double tilt) {
        return signedArea(
            caster.regionSeen(at(cameraFrom(keys), poseAt({1, 2, 3}, 40, tilt)), 0).value());
    };
    EXPECT_NEAR(area("projection=omni fov=90 pixels=500,500 range=20", -90), 9 * kPi, 1e-5);
    EXPECT_NEAR(area("projection=omni fov=220 pixels=500,500 range=5", -90), 16 * kPi, 1e-6);
    EXPECT_NEAR(area("projection=omni fov=360 pixels=500,500 range=5", 33), 16 * kPi, 1e-6);
    EXPECT_NEAR(area("projection=omni fov=120 mirror=1 pixels=500,500 range=20", -90), 27 * kPi,
                1e-5);
    // All but a cone upwards that looks down past the horizon: a ring.
    EXPECT_NEAR(area("projection=omni fov=300 pixels=500,500 range=5", 90),
                (16 - 9 * std::pow(tanOf(30), 2)) * kPi, 1e-5);
    EXPECT_EQ(area("projection=omni fov=170 pixels=500,500 range=5", 90), 0);
}

TEST(CameraRegion, DistortionThatIsNoneChangesNothing) {
    const ShadowCaster caster(sceneOf(kFurnished).environment);
    const Pose3 pose = poseAt({-5.5, -3.5, 2.6}, 35, -30, 4);
    const Camera straight = cameraFrom("fov=80 range=9");
    Camera bent = straight;
    bent.distortion[0] = 1e-13;
    ASSERT_FALSE(bent.isStraight());
    EXPECT_NEAR(signedArea(caster.regionSeen(at(bent, pose), 0).value()),
                signedArea(caster.regionSeen(at(straight, pose), 0).value()), 1e-5);
}

TEST(CameraRegion, CellsAreThoseInTheRegion) {
    const Scene scene = sceneOf(kFurnished);
    RayScenes worlds(scene.environment);
    const VisibleArea sight(scene.environment, 0, &worlds);
    const Grid grid{scene.environment.limits(), 120, 80};
    for (const char* const lens :
         {"fov=90 coefficients=-0.3,0.05 range=8", "projection=fisheye fov=170 range=7",
          "projection=omni fov=220 mirror=0.9 pixels=480,480 range=6"}) {
        const Sensor sensor = at(cameraFrom(lens), poseAt({-1, -0.5, 2.5}, 30, -50, 5));
        sight.prepare(sensor);
        const CellSet cells = sight.cellsOf(grid, sensor);
        const Outline region(sight.regionOf(sensor).value());
        for (std::size_t cell = 0; cell < grid.size(); ++cell) {
            if (cells.test(cell) == region.holds(grid.center(cell))) continue;
            EXPECT_LT(region.distanceFrom(grid.center(cell)), 1e-3) << lens << ' ' << cell;
        }
        EXPECT_GT(cells.count(), 300U) << lens;
    }
}

TEST(CameraRegion, OddPlaces) {
    const Scene scene = sceneOf(std::string(kFurnished) +
                                "wall from=-2,-4 to=-2,-2.5 thickness=0.3\nfence path=3,2;5,2\n");
    const VisibleArea sight(scene.environment, 0);
    const auto area = [&](const Pose3& pose, const std::string& keys = "fov=80 range=9") {
        return signedArea(sight.regionOf(at(cameraFrom(keys), pose)).value());
    };
    EXPECT_EQ(area(poseAt({1, -2, 0.5}, 0, -30)), 0);     // inside a solid
    EXPECT_EQ(area(poseAt({-2, -3.2, 1.5}, 0, -30)), 0);  // inside a wall
    EXPECT_EQ(area(poseAt({-5, -3, 2}, 0, 40)), 0);       // looking up
    EXPECT_GT(area(poseAt({-5, 0, 0}, 0, 0)), 5);         // on the plane
    EXPECT_EQ(area(poseAt({-5, 0, 0}, 0, 60)), 0);        // and up from there
    EXPECT_GT(area(poseAt({-5, 0, 0}, 0, 60), "projection=omni fov=200 pixels=200,200"), 5);
    // On a sheet it sees both sides, on the face of a solid the outer one.
    const double ahead = area(poseAt({4, 2, 2}, 90, -60)),
                 behind = area(poseAt({4, 2, 2}, -90, -60));
    EXPECT_GT(ahead, 1);
    EXPECT_GT(behind, 1);
    EXPECT_GT(area(poseAt({-1.85, -3.2, 1.5}, 0, -40)), 0.3);
}

TEST(CameraRegion, DensityIsThatOfProjectedPlaces) {
    const ShadowCaster caster(sceneOf("ispace size=60,60,9").environment);
    const Camera camera = cameraFrom("fx=900 cx=600 cy=380 pixels=1280,720");
    const Pose3 pose = poseAt({0, 0, 2.5}, 20, -25, 6);
    const Frame3 frame(pose);
    const cv::Matx33d matrix(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
    // A centimetre across the axis, in pixels a metre.
    const auto density = [&](Point2 p) {
        const Vec3 way = frame.toLocal({p.x, p.y, 0});
        const std::vector<cv::Point3d> places = {{-way.y - 0.005, -way.z, way.x},
                                                 {-way.y + 0.005, -way.z, way.x}};
        std::vector<cv::Point2d> pixels;
        cv::projectPoints(places, cv::Vec3d(), cv::Vec3d(), matrix, cv::noArray(), pixels);
        const bool is_in = way.x > 0 && pixels[0].x >= -0.5 + 1e-6 && pixels[1].x <= 1279.5 &&
                           pixels[0].y >= -0.5 && pixels[0].y <= 719.5;
        return is_in ? std::hypot(pixels[1].x - pixels[0].x, pixels[1].y - pixels[0].y) * 100 : 0;
    };
    unsigned seed = 3;
    for (const PixelDensity& one : pixelDensities()) {
        const Sensor sensor = at(withDensity(camera, one.pixels_per_metre), pose);
        const Outline region(caster.regionSeen(sensor, 0).value());
        // Points within a centimetre of the picture's edge are near it.
        compare(region, {{-30, -30}, {30, 30}}, 20'000, 0.02, ++seed, std::string(one.name),
                [&](Point2 p) { return density(p) >= one.pixels_per_metre; });
    }
}

}  // namespace camera_region_test
}  // namespace ispace
