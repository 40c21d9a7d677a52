// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/photo.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numeric>
#include <sstream>

#include "sense/formats/camera_info.h"
#include "sense/formats/reading_format.h"
#include "support/test_readings.h"

namespace ispace {
namespace photo_test {

const std::string kRoom = "ispace id=room size=6,4 height=2.5\ncube id=crate at=2,0 size=0.8\n";
const std::string kEye = "camera id=c1 at=-2,0,1.2 tilt=-10 fov=70 pixels=64,48";

Photo photoOf(const Scene& scene, const PhotoOptions& options = {}, int frame = 0) {
    const Sensor& sensor = scene.sensors.front();
    return Photographer(scene, options).take(sensor, sensor.pose, frame);
}

TEST(Photo, IsTheSameForAnyNumberOfThreads) {
    const Scene scene = testing::scene(kRoom, kEye + "\nhuman at=0,0.5\n");
    PhotoOptions options;
    options.with_noise = true;
    std::vector<Photo> photos;
    for (const std::size_t threads : {1, 2}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        photos.push_back(photoOf(scene, options, 3));
    }
    EXPECT_EQ(photos[0].rgb, photos[1].rgb);
    EXPECT_EQ(photos[0].rgb.size(), 3U * 64 * 48);
    EXPECT_NE(photos[0].rgb, photoOf(scene, options, 4).rgb) << "noise depends on the frame";
    options.with_noise = false;
    EXPECT_EQ(photoOf(scene, options, 3).rgb, photoOf(scene, options, 4).rgb);
}

TEST(Photo, CarriersAreNotInTheirPictures) {
    PhotoOptions options;
    options.labels = true;
    const auto seen = [&](const std::string& layout, const std::string& id) {
        const Scene scene = testing::scene(kRoom, layout);
        const std::string table = labelTable(scene, photoOf(scene, options));
        return table.find("," + id + ",") != std::string::npos;
    };
    const std::string down = " tilt=-70 fov=100 pixels=64,48\n";
    EXPECT_TRUE(seen("camera at=0,0,1.598" + down + "human id=h at=0,0.01\n", "h"));
    EXPECT_FALSE(seen("camera on=h" + down + "human id=h at=0,0.01\n", "h"));
    EXPECT_TRUE(seen("camera on=h" + down + "human id=h at=0,0\nhuman id=g at=0.5,0\n", "g"));
    EXPECT_FALSE(seen("camera on=r at=0,0,0.6" + down + "robot id=r at=0,0\n", "r"));
    EXPECT_FALSE(seen("camera at=0,0,1" + down + "laser id=l at=0.2,0,0.5\n", "l"));
    options.sensor_bodies = true;
    EXPECT_TRUE(seen("camera at=0,0,1" + down + "laser id=l at=0.2,0,0.5\n", "l"));
}

TEST(Photo, DepthsAreWithinTheRange) {
    PhotoOptions options;
    options.depths = true;
    const Scene near = testing::scene(kRoom, kEye + " range=0.5,4.2\n");
    const Scene far = testing::scene(kRoom, kEye + "\n");
    const std::vector<float> cut = photoOf(near, options).depths,
                             all = photoOf(far, options).depths;
    std::size_t lost = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(cut[i], all[i] <= 4.2F ? all[i] : std::numeric_limits<float>::infinity());
        lost += cut[i] != all[i] ? 1 : 0;
    }
    EXPECT_GT(lost, 0U);
    EXPECT_LT(lost, all.size());
}

TEST(Photo, LabelsHaveATable) {
    const Scene scene = testing::scene(kRoom, kEye);
    PhotoOptions options;
    options.labels = true;
    const Photo photo = photoOf(scene, options);
    std::istringstream table(labelTable(scene, photo));
    std::string line;
    std::getline(table, line);
    EXPECT_EQ(line, "label,id,keyword,pixels");
    std::size_t pixels = 0;
    std::vector<std::string> names;
    while (std::getline(table, line)) {
        pixels += std::stoul(line.substr(line.rfind(',') + 1));
        names.push_back(line.substr(0, line.rfind(',')));
    }
    EXPECT_EQ(names, (std::vector<std::string>{"0,,", "1,room,ispace", "2,crate,cube"}));
    EXPECT_EQ(pixels, 64U * 48);
}

TEST(ExposureNoise, HasTheSpreadOfElectrons) {
    Camera camera;
    camera.full_well = 2500;
    camera.read_noise = 10;
    const auto spread = [&](float radiance, double exposure) {
        std::vector<Rgb> picture(20'000, Rgb{radiance, radiance, radiance});
        addExposureNoise(camera, exposure, 5, "c1", 2, picture);
        double sum = 0, squares = 0;
        for (const Rgb& pixel : picture)
            for (const float value : pixel) {
                sum += double{value};
                squares += double{value} * double{value};
            }
        const double mean = sum / 60'000;
        EXPECT_NEAR(mean, radiance, 1e-3);
        return std::sqrt(squares / 60'000 - mean * mean);
    };
    // Electrons: 1250 and 5000; shot noise is their square root, 100 more are of reading out.
    EXPECT_NEAR(spread(0.5F, 1), std::sqrt(1250 + 100) / 2500, 2e-4);
    EXPECT_NEAR(spread(0.5F, 4), std::sqrt(5000 + 100) / 10'000, 1e-4);
    EXPECT_NEAR(spread(1, 1), std::sqrt(2500 + 100) / 2500, 3e-4);
}

TEST(Y4m, HasAHeaderAndLimitedRange) {
    Camera camera;
    camera.columns = 4;
    camera.rows = 1;
    camera.rate = 29.97;
    EXPECT_EQ(y4mHeader(camera), "YUV4MPEG2 W4 H1 F2997:100 Ip A1:1 C444 XCOLORRANGE=LIMITED\n");
    Photo photo;
    photo.rgb = {0, 0, 0, 255, 255, 255, 255, 0, 0, 0, 0, 255};
    std::string out;
    appendY4mFrame(out, photo);
    ASSERT_EQ(out.substr(0, 6), "FRAME\n");
    const std::vector<int> wanted = {16, 235, 81, 41, 128, 128, 90, 240, 128, 128, 240, 110};
    for (std::size_t i = 0; i < wanted.size(); ++i)
        EXPECT_EQ(static_cast<unsigned char>(out[6 + i]), wanted[i]) << i;
}

TEST(CameraInfo, OfAllLenses) {
    Camera camera;
    camera.distortion = {-0.3, 0.1, 0.001, -0.002, 0.5};
    std::string yaml = cameraInfoYaml(cameraInfoOf(camera), "c1");
    EXPECT_NE(yaml.find("distortion_model: plumb_bob\n"), std::string::npos);
    EXPECT_NE(yaml.find("cols: 5\n  data: [-0.3, 0.1, 0.001, -0.002, 0.5]\n"), std::string::npos);
    camera.lens = Lens::Fisheye;
    yaml = cameraInfoYaml(cameraInfoOf(camera), "c1");
    EXPECT_NE(yaml.find("distortion_model: equidistant\n"), std::string::npos);
    EXPECT_NE(yaml.find("cols: 4\n  data: [-0.3, 0.1, 0.001, -0.002]\n"), std::string::npos);
    camera.lens = Lens::Mirror;
    camera.mirror = 0.9;
    camera.distortion = {};
    EXPECT_NE(
        cameraInfoYaml(cameraInfoOf(camera), "c1").find("distortion_model: omnidir\nxi: 0.9\n"),
        std::string::npos);
}

TEST(CameraFormats, RefuseWhatTheyCannotHold) {
    const Scene scene = testing::scene(kRoom, kEye + "\ncamera at=0,0\nlaser at=1,1\n");
    Sensors both = sensorsOf(scene, {});
    Sensors cameras = sensorsOf(scene, {"c*"}), one = sensorsOf(scene, {"c1"});
    for (const char* name : {"csv", "raw", "pcd", "ply", "carmen"})
        EXPECT_THROW(makeFormat(name, one, {}), UsageError) << name;
    for (const char* name : {"jpeg", "rgb24", "y4m"}) {
        EXPECT_THROW(makeFormat(name, both, {}), UsageError) << name;
        EXPECT_NO_THROW(makeFormat(name, one, {})) << name;
    }
    for (const char* name : {"rgb24", "y4m"}) {
        EXPECT_THROW(makeFormat(name, cameras, {})->checkStream(), UsageError);
        EXPECT_NO_THROW(makeFormat(name, one, {})->checkStream());
    }
    EXPECT_NO_THROW(makeFormat("jsonl", both, {}));
    FormatOptions layers;
    layers.labels = layers.depths = true;
    EXPECT_EQ(
        makeFormat("jpeg", one, layers)->endings(),
        (std::vector<std::string>{".jpg", "-labels.png", "-labels.csv", "-depth.png", ".yaml"}));
}

}  // namespace photo_test
}  // namespace ispace
