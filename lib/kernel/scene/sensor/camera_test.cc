// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <random>
#include <string>
#include <vector>

#include "scene/sensor/lens_resolution.h"
#include "scene/sensor/sensor_keys.h"
#include "support/test_sensors.h"

namespace ispace {

namespace camera_test {

Camera cameraFrom(const std::string& keys) {
    return parametersOf<Camera>(testing::sensorRecord("camera id=c " + keys), nullptr);
}

std::string findingsOf(const std::string& keys) {
    return testing::findings([&] { return cameraFrom(keys); });
}

/// Where OpenCV has a place of the camera's frame.
cv::Point2d byOpenCv(const Camera& camera, Vec3 place) {
    const std::vector<cv::Point3d> points = {{-place.y, -place.z, place.x}};
    const cv::Matx33d matrix(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
    std::vector<cv::Point2d> pixels;
    if (camera.lens == Lens::Fisheye) {
        const cv::Vec4d k(camera.distortion[0], camera.distortion[1], camera.distortion[2],
                          camera.distortion[3]);
        cv::fisheye::projectPoints(points, pixels, cv::Vec3d(), cv::Vec3d(), matrix, k);
    } else {
        cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), matrix,
                          std::vector<double>(camera.distortion.begin(), camera.distortion.end()),
                          pixels);
    }
    return pixels.front();
}

TEST(Camera, ProjectsAsOpenCvDoes) {
    const Camera cameras[] = {
        cameraFrom("fov=60"),
        cameraFrom("fx=500 fy=520 cx=300 cy=250"),
        cameraFrom("fov=70 coefficients=-0.28,0.09,0.0012,-0.0007,-0.01"),
        cameraFrom("fov=70 distortion=plumb_bob coefficients=0.1,0.02,0.001,0.002"),
        cameraFrom("projection=fisheye fov=170"),
        cameraFrom("projection=fisheye fov=150 coefficients=0.02,-0.01,0.003,-0.0005")};
    for (const Camera& camera : cameras)
        for (int row = 0; row < camera.rows; row += 37)
            for (int column = 0; column < camera.columns; column += 41) {
                const PixelPoint place{column + 0.25, row - 0.25};
                const auto ray = camera.ray(place);
                ASSERT_TRUE(ray) << column << ' ' << row;
                EXPECT_NEAR(length(*ray), 1, 1e-12);
                if (ray->x > 0.01) {  // OpenCV divides by it
                    const cv::Point2d theirs = byOpenCv(camera, 3.0 * *ray);
                    EXPECT_NEAR(theirs.x, place.column, 1e-8);
                    EXPECT_NEAR(theirs.y, place.row, 1e-8);
                }
                const auto ours = camera.project(2.0 * *ray);
                ASSERT_TRUE(ours);
                EXPECT_NEAR(ours->column, place.column, 1e-8);
                EXPECT_NEAR(ours->row, place.row, 1e-8);
            }
}

TEST(Camera, MirrorsGoThereAndBack) {
    for (const char* keys :
         {"projection=omni mirror=1 fov=200 pixels=800,800 tilt=-90",
          "projection=omni mirror=0.8 fov=210 pixels=800,600", "projection=omni mirror=0.1 fov=170",
          "projection=omni fov=360 pixels=500,500"}) {
        const Camera camera = cameraFrom(keys);
        const double middle = camera.cx, radius = 0.49 * std::min(camera.columns, camera.rows);
        for (int i = 0; i < 360; i += 7)
            for (const double share : {0.01, 0.5, 0.99}) {
                const double angle = i * 0.0174532925;
                const PixelPoint place{middle + share * radius * std::cos(angle),
                                       camera.cy + share * radius * std::sin(angle)};
                const auto ray = camera.ray(place);
                ASSERT_TRUE(ray) << keys;
                const auto back = camera.project(*ray);
                ASSERT_TRUE(back) << keys;
                EXPECT_NEAR(back->column, place.column, 1e-7) << keys;
                EXPECT_NEAR(back->row, place.row, 1e-7) << keys;
            }
        EXPECT_FALSE(camera.ray({-0.5, -0.5})) << "beyond the circle";
    }
    const Camera around = cameraFrom("projection=omni fov=360 pixels=500,500");
    EXPECT_TRUE(around.isOmnidirectional({{}, {}, Angle::degrees(-90), {}}));
    EXPECT_FALSE(around.isOmnidirectional({}));
}

TEST(Camera, OfAnyMirrorGoesThereAndBackUpToItsEnd) {
    for (int i = 1; i <= 20; ++i)
        for (const double focal : {50.0, 152.8, 400.0}) {
            const std::string keys = "projection=omni mirror=" + std::to_string(i * 0.05) +
                                     " fx=" + std::to_string(focal) + " cx=352.1 cy=241.5";
            const Camera camera = cameraFrom(keys);
            for (const double angle : {0.0, 0.3, 1.0, 1.5, 1.7, 1.9, 2.4, 3.0})
                for (const double around : {0.0, 1.0, 2.5, 4.0}) {
                    const Vec3 way{std::cos(angle), std::sin(angle) * std::cos(around),
                                   std::sin(angle) * std::sin(around)};
                    const auto place = camera.project(way);
                    EXPECT_EQ(place.has_value(), angle <= camera.widest.radians()) << keys;
                    if (!place) continue;
                    const auto back = camera.ray(*place);
                    ASSERT_TRUE(back) << keys << ' ' << angle;
                    EXPECT_NEAR(dot(*back, way), 1, 1e-13) << keys << ' ' << angle;
                }
        }
}

TEST(Camera, OfTheUnifiedModelIsThatOfMei) {
    const Camera camera = cameraFrom("projection=omni mirror=0.7 fov=180 pixels=600,600");
    // On the sphere, then from the point `mirror` behind its centre.
    const Vec3 way{0.5, 0.3, -0.2};
    const double size = length(way), depth = way.x / size + 0.7;
    const auto place = camera.project(way);
    ASSERT_TRUE(place);
    EXPECT_NEAR(place->column, camera.cx - camera.fx * way.y / size / depth, 1e-9);
    EXPECT_NEAR(place->row, camera.cy - camera.fy * way.z / size / depth, 1e-9);
}

TEST(Camera, TakesItsFocalLengthFromWhatThereIs) {
    const Camera bare = cameraFrom("");
    EXPECT_NEAR(bare.fovX().degrees(), 45, 1e-9);
    EXPECT_EQ(bare.fx, bare.fy);
    EXPECT_NEAR(cameraFrom("fov=90,60").fovY().degrees(), 60, 1e-9);
    const Camera sheet = cameraFrom("pixels=1920,1080 focal=2.8mm sensor=5.37,3.02mm");
    EXPECT_NEAR(sheet.fx, 2.8 / 5.37 * 1920, 1e-9);
    EXPECT_EQ(sheet.fy, sheet.fx) << "pixels are square";
    EXPECT_DOUBLE_EQ(cameraFrom("focal=2.8mm sensor=5.37,3.02mm").fy, 2.8 / 5.37 * 640);
    const Camera wide = cameraFrom("pixels=1920,1080");
    EXPECT_NEAR(wide.fovX().degrees(), 45, 1e-9);
    EXPECT_EQ(wide.fy, wide.fx);
    EXPECT_EQ(wide.cy, 539.5);
    // 18 mm an inch: 6.43 mm across.
    const Camera format = cameraFrom("pixels=1920,1080 focal=2.8mm sensor=1/2.8\"");
    EXPECT_NEAR(format.fx, 2.8 / (18 / 2.8 * 1920 / std::hypot(1920, 1080)) * 1920, 1e-9);
    EXPECT_EQ(format.fx, format.fy);
    EXPECT_EQ(cameraFrom("pixels=1920,1080 focal=2.8mm sensor=\"1/2.8\\\"\""), format);
    EXPECT_EQ(cameraFrom("pixels=1920,1080 focal=2.8mm sensor=1/2.8in"), format);
    const Camera calibrated = cameraFrom("fx=400 cx=310.5");
    EXPECT_EQ(calibrated.fy, 400);
    EXPECT_EQ(calibrated.cx, 310.5);
    EXPECT_EQ(calibrated.cy, 239.5);
}

TEST(Camera, SeesAsFarAsThereArePixelsAMetre) {
    EXPECT_EQ(pixelDensityOf("recognise"), 125);
    EXPECT_EQ(pixelDensityOf("recognize"), 125);
    EXPECT_EQ(pixelDensityOf("overview"), 20);
    EXPECT_EQ(pixelDensityOf("outline"), 40);
    EXPECT_EQ(pixelDensityOf("discern"), 80);
    EXPECT_EQ(pixelDensityOf("perceive"), 125);
    EXPECT_EQ(pixelDensityOf("characterise"), 250);
    EXPECT_EQ(pixelDensityOf("characterize"), 250);
    EXPECT_EQ(pixelDensityOf("validate"), 500);
    EXPECT_EQ(pixelDensityOf("scrutinize"), 1500);
    EXPECT_EQ(pixelDensityOf("40.5"), 40.5);
    for (const char* wrong : {"", "0", "-3", "inf", "nan", "identity", "25px", "ize"})
        EXPECT_EQ(pixelDensityOf(wrong), std::nullopt) << wrong;
    Camera camera;
    camera.fx = camera.fy = 500;
    EXPECT_EQ(withDensity(camera, 0).max_range, Camera::kMaxSeen);
    EXPECT_EQ(withDensity(camera, 125).max_range, 4);
    EXPECT_EQ(withDensity(camera, 1).max_range, Camera::kMaxSeen);
    // A pixel at the end of that range is a 125th of a metre wide there.
    const auto a = camera.project({4, 0, 0}), b = camera.project({4, 1, 0});
    EXPECT_NEAR(std::fabs(a->column - b->column), 125, 1e-9);
}

TEST(Camera, LimitsTheViewOfALensByDirection) {
    // Under a parabola pixels a radian are f / (1 + cos), at 90 degrees twice those on the axis.
    const Camera mirror = cameraFrom("projection=omni mirror=1 fx=500 pixels=1200,1200");
    const Camera dense = withDensity(mirror, 125);
    EXPECT_GE(dense.max_range, 4);
    EXPECT_EQ(dense.least_density, 125);
    const FieldOfView view = fieldOfView(dense, Pose3{});
    EXPECT_TRUE(view.holds({1.999, 0, 0}));
    EXPECT_FALSE(view.holds({2.001, 0, 0}));
    EXPECT_TRUE(view.holds({0.001, 3.99, 0}));
    EXPECT_FALSE(view.holds({0.001, 4.01, 0}));
    // A barrel: fewer pixels towards the edge than a pinhole has at this depth.
    const Camera barrel = withDensity(cameraFrom("fx=500 coefficients=-0.1"), 125);
    const double r = 0.6, least = 500 * (1 - 0.1 * r * r) / 125;
    EXPECT_TRUE(fieldOfView(barrel, Pose3{}).holds({3.99, 0, 0}));
    EXPECT_TRUE(fieldOfView(barrel, Pose3{}).holds({least - 0.01, r * (least - 0.01), 0}));
    EXPECT_FALSE(fieldOfView(barrel, Pose3{}).holds({least + 0.01, r * (least + 0.01), 0}));
}

/// Pixels between the pictures of two points a centimetre apart, in a direction across the line of
/// sight.
double pixelsAcross(const Camera& camera, Point3 place, double bearing, double apart) {
    const Vec3 way = place - Point3{};
    Vec3 a = cross(way, std::fabs(way.x) < std::fabs(way.y) ? Vec3{1, 0, 0} : Vec3{0, 1, 0});
    a = (1 / length(a)) * a;
    const Vec3 b = (1 / length(way)) * cross(way, a);
    const double c = apart / 2 * std::cos(bearing), s = apart / 2 * std::sin(bearing);
    const Vec3 half{c * a.x + s * b.x, c * a.y + s * b.y, c * a.z + s * b.z};
    const Vec3 first = place + half - Point3{}, second = place + -1 * half - Point3{};
    if (camera.lens == Lens::Mirror) {
        const auto p = camera.project(first), q = camera.project(second);
        return std::hypot(p->column - q->column, p->row - q->row);
    }
    const cv::Point2d p = byOpenCv(camera, first), q = byOpenCv(camera, second);
    return std::hypot(p.x - q.x, p.y - q.y);
}

TEST(LensResolution, IsThatOfPointsACentimetreApart) {
    constexpr double kApart = 0.01;
    const char* const lenses[] = {
        "fx=700 pixels=1400,1000",
        "fx=600 coefficients=-0.28,0.09,0.0012,-0.0007,-0.01",
        "fx=500 coefficients=0.1,0.02,0.01,0.02",
        "fx=500 coefficients=-0.15,0.01,-0.02,0.03 pixels=900,700",
        "projection=fisheye fov=170 pixels=1280,960",
        "projection=fisheye fov=150 coefficients=0.02,-0.01,0.003,-0.0005",
        "projection=fisheye fov=140 coefficients=-0.06,-0.01",
        "projection=omni fov=220 mirror=0.9 pixels=480,480",
        "projection=omni mirror=0.6 fx=300 pixels=640,480"};
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> share(0, 1);
    for (const char* lens : lenses) {
        const Camera camera = cameraFrom(lens);
        const LensResolution resolution(camera);
        const double most = resolution.most(), farthest = resolution.farthest(1);
        for (int i = 0; i < 300; ++i) {
            const double column = share(random) * (camera.columns - 1);
            const auto ray = camera.ray({column, share(random) * (camera.rows - 1)});
            // Not at the end of the lens, beyond which one of the points may lie.
            if (!ray || ray->x < cos(camera.widest) + 0.05) continue;
            if (camera.lens != Lens::Mirror && ray->x < 0.05) continue;
            const Point3 place = Point3{} + (1 + 9 * share(random)) * *ray;
            double least = HUGE_VAL;
            for (double bearing = 0; bearing < 180; bearing += 1)
                least = std::min(
                    least, pixelsAcross(camera, place, bearing * std::acos(-1) / 180, kApart));
            const double density = resolution.densityAt(place - Point3{});
            EXPECT_NEAR(density, least / kApart, 2e-3 * density) << lens << ' ' << ray->x;
            EXPECT_LE(density * length(place - Point3{}), most);
            const double far = camera.lens == Lens::Pinhole ? place.x : length(place - Point3{});
            EXPECT_LE(far * density, farthest);
        }
    }
}

TEST(LensResolution, HasClosedForms) {
    const LensResolution pinhole(cameraFrom("fx=700 pixels=1400,1000"));
    const LensResolution fisheye(cameraFrom("projection=fisheye fx=400 pixels=1000,1000"));
    const LensResolution mirror(cameraFrom("projection=omni mirror=0.6 fx=300 pixels=640,480"));
    for (const double angle : {0.0, 0.1, 0.4, 0.7}) {
        const Vec3 way{3 * std::cos(angle), 3 * std::sin(angle), 0};
        EXPECT_NEAR(pinhole.densityAt(way), 700 / way.x, 1e-9);
        EXPECT_NEAR(fisheye.densityAt(way), 400 / 3.0, 1e-9);
        EXPECT_NEAR(mirror.densityAt(way), 300 / (way.x + 0.6 * 3), 1e-9);
        // Towards the edge of a pinhole's picture pixels a radian grow by 1 / cos^2.
        const Camera camera = cameraFrom("fx=700 pixels=1400,1000");
        const auto at = [&](double turn) {
            return *camera.project({std::cos(turn), std::sin(turn), 0});
        };
        EXPECT_NEAR((at(angle - 1e-4).column - at(angle + 1e-4).column) / 2e-4,
                    700 / (std::cos(angle) * std::cos(angle)), 1e-3);
    }
    EXPECT_TRUE(std::isinf(pinhole.densityAt({})));
    // Beyond the picture the density is that of its rim.
    EXPECT_NEAR(mirror.densityAt({-1, 0, 0}), mirror.densityAt({-1, 1e-9, 0}), 1e-6);
}

TEST(Camera, SaysWhatIsWrong) {
    EXPECT_NE(findingsOf("fov=180").find("less than 180 degrees"), std::string::npos);
    EXPECT_NE(findingsOf("focal=2.8mm").find("without the size of the image sensor"),
              std::string::npos);
    EXPECT_NE(findingsOf("focal=2.8 sensor=5.37,3.02mm").find("is it 2.8mm?"), std::string::npos);
    EXPECT_NE(findingsOf("sensor=1/3\"").find("add `focal`"), std::string::npos);
    EXPECT_NE(findingsOf("focal=3mm sensor=big").find("wanted a format"), std::string::npos);
    EXPECT_NE(findingsOf("focal=3mm sensor=1/0\"").find("wanted a format"), std::string::npos);
    EXPECT_NE(findingsOf("focal=2.8 sensor=1/3\""), "") << "metres";
    EXPECT_NE(findingsOf("focal=3mm sensor=5.37,3.02").find("wanted a format"), std::string::npos);
    EXPECT_NE(findingsOf("pixels=0,480"), "");
    EXPECT_NE(findingsOf("pixels=16384,16384").find("at most"), std::string::npos);
    EXPECT_NE(findingsOf("fov=60 fx=500").find("twice"), std::string::npos);
    EXPECT_NE(findingsOf("mirror=1").find("projection=omni"), std::string::npos);
    EXPECT_NE(findingsOf("projection=pinhole distortion=fisheye"), "");
    EXPECT_NE(findingsOf("projection=fisheye distortion=plumb_bob"), "");
    for (const char* keys :
         {"fx=1e-19", "fx=500 fy=1e-300", "fov=1e-300", "focal=1e-300 sensor=1/3\""})
        EXPECT_NE(findingsOf(keys).find("pixels, wanted 0.00001 to"), std::string::npos) << keys;
    // r - r^3 is greatest at 30 degrees.
    EXPECT_NE(
        findingsOf("coefficients=-1 fov=80").find("this lens sees at most 60 degrees, not 80"),
        std::string::npos);
}

TEST(Camera, OfAFullCircleSeesHalfOfAllDirections) {
    const Camera camera = cameraFrom("projection=omni pixels=600,400");
    EXPECT_NEAR(camera.widest.degrees(), 90, 1e-9);
    EXPECT_TRUE(camera.isOmnidirectional({{}, {}, Angle::degrees(-90), {}}));
    EXPECT_NEAR(cameraFrom("projection=omni mirror=1").widest.degrees(), 90, 1e-9);
}

TEST(Camera, OfAStrongLensHasNoRayBeyondItsTurningPoint) {
    const Camera camera = cameraFrom("fx=300 coefficients=-0.4 pixels=1200,800");
    EXPECT_FALSE(camera.ray({0, 0}));
    EXPECT_TRUE(camera.ray({600, 400}));
    const Angle beyond = camera.widest + Angle::degrees(1);
    EXPECT_FALSE(camera.project({cos(beyond), sin(beyond), 0}));
}

}  // namespace camera_test
}  // namespace ispace
