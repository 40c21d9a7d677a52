// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/calibration/camera_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/error.h"
#include "geom/rotation.h"
#include "sense/photo.h"
#include "support/test_layout.h"

namespace ispace::calibration {
namespace camera_fit_test {

/// Where a person walks, and where the feet are.
Pose2 walk(int i) {
    const double a = 0.61 * i, b = 0.93 * i + 0.4;
    return {{4 + 2.2 * std::sin(a), 3 + 1.8 * std::sin(b)}, Angle::degrees(47.0 * i)};
}

struct Shots {
    Scene scene;
    std::vector<PictureMoment> moments;
};

/// Pictures of a walk by one camera.
Shots shotsOf(const std::string& camera, int count = 40) {
    Shots shots{testing::scene("ispace at=4,3 size=8,6,2.5\ncube at=7.4,0.5 size=0.8,0.6,0.7\n",
                               camera + "\nhuman at=4,3\n"),
                {}};
    const Scene& scene = shots.scene;
    PhotoOptions options;
    options.samples = 1;
    options.with_noise = true;
    Photographer photographer(scene, options);
    std::vector<Pose3> poses;
    std::size_t person = 0;
    for (std::size_t k = 0; k < scene.placed.size(); ++k) {
        poses.push_back({});
        if (scene.records[scene.placed[k].record].keyword() == "human")
            person = k;
        else
            poses.back() = scene.sensors[scene.placed[k].index].pose;
    }
    const Sensor& sensor = scene.sensors.front();
    std::vector<ColorPicture> pictures;
    for (int i = 0; i < count; ++i) {
        const Pose2 at = walk(i);
        poses[person] = {{at.position.x, at.position.y, 0}, at.heading, {}, {}};
        photographer.moveTo(poses);
        const Photo photo = photographer.take(sensor, sensor.pose, i);
        const auto& model = sensor.as<Camera>();
        ColorPicture picture{model.columns, model.rows, {}};
        for (std::size_t k = 0; k < photo.rgb.size(); k += 3)
            picture.rgba.insert(picture.rgba.end(),
                                {photo.rgb[k], photo.rgb[k + 1], photo.rgb[k + 2], 255});
        pictures.push_back(std::move(picture));
        shots.moments.push_back({{at.position}, {}});
    }
    const auto bodies =
        bodiesInPictures(pictures.size(), [&pictures](std::size_t i) { return pictures[i]; });
    for (std::size_t i = 0; i < bodies.size(); ++i) shots.moments[i].bodies = bodies[i];
    return shots;
}

/// Greatest distance in pixels between the pictures of points of the room by two poses.
double pixelsApart(const Sensor& truth, const Pose3& pose) {
    const auto& camera = truth.as<Camera>();
    double most = 0;
    for (double x = 1; x < 8; x += 1.5)
        for (double y = 1; y < 6; y += 1)
            for (const double z : {0.0, 0.9, 1.8}) {
                const Eigen::Vector3d point(x, y, z);
                const auto a = camera.project(vecOf(isometryOf(truth.pose).inverse() * point));
                const auto b = camera.project(vecOf(isometryOf(pose).inverse() * point));
                if (a && b && camera.holds(*a))
                    most = std::max(most, std::hypot(a->column - b->column, a->row - b->row));
            }
    return most;
}

TEST(CameraFit, PeopleTellWhereACameraIs) {
    // A third of the usual resolution.
    for (const char* camera :
         {"camera at=0.3,5.7,2.3 heading=-45 tilt=-30 pixels=480,360 fov=80",
          "camera at=7.6,0.4,2.0 heading=140 tilt=-20 roll=4 pixels=480,360 fov=90",
          "camera at=4,3,2.5 tilt=-90 pixels=480,480 projection=fisheye fov=180"}) {
        const Shots shots = shotsOf(camera);
        Sensor start = shots.scene.sensors.front();
        const Sensor truth = start;
        start.pose = {{1, 1, 1}, {}, {}, {}};
        const CameraFit fit = fitToPictures(start, shots.moments, {1.7, 0.1});
        EXPECT_LT(pixelsApart(truth, fit.pose), 5) << camera;
        EXPECT_LT(fit.pixels, 3) << camera;
        EXPECT_GT(fit.pictures, 15U) << camera;
        // Errors are as large as their standard deviations say.
        const Vec3 off = fit.pose.position - truth.pose.position;
        EXPECT_LT(length(off), 0.15) << camera;
    }
}

TEST(CameraFit, RefusesPicturesThatTellNothing) {
    Shots shots = shotsOf("camera at=0.3,5.7,2.3 heading=-45 tilt=-30 pixels=160,120 fov=80", 14);
    const Sensor& camera = shots.scene.sensors.front();
    const auto refusal = [&camera](std::span<const PictureMoment> moments) {
        try {
            static_cast<void>(fitToPictures(camera, moments, {}));
        } catch (const FormatError& error) {
            return error.diagnostics().front().message;
        }
        return std::string();
    };
    EXPECT_NE(refusal(std::span(shots.moments).first(5)).find("wanted 12"), std::string::npos);
    // Of another place each: no pose explains them.
    for (std::size_t i = 0; i < shots.moments.size(); ++i)
        shots.moments[i].people = {walk(static_cast<int>(7 * i + 3)).position};
    EXPECT_NE(refusal(shots.moments), "");
}

}  // namespace camera_fit_test
}  // namespace ispace::calibration
