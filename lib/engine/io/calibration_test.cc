// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/calibration.h"

#include <filesystem>

#include "base/file.h"
#include "io/importers.h"
#include "support/test_import.h"
#include "support/test_paths.h"

namespace ispace {
namespace calibration_test {

/// As ROS' camera_calibration writes it.
const std::string kOst =
    "image_width: 640\nimage_height: 480\ncamera_name: narrow_stereo\n"
    "camera_matrix:\n  rows: 3\n  cols: 3\n"
    "  data: [430.5, 0.0, 320.25, 0.0, 431.5, 240.75, 0.0, 0.0, 1.0]\n"
    "distortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n"
    "  data: [-0.3, 0.1, 0.001, -0.002, 0.0]\n"
    "rectification_matrix:\n  rows: 3\n  cols: 3\n  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n";

/// As cv::FileStorage writes it.
const std::string kOpenCv =
    "%YAML:1.0\n---\nimage_width: 1280\nimage_height: 960\nflags: 0\n"
    "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
    "   data: [ 800., 0., 639.5, 0., 800.,\n       479.5, 0., 0., 1. ]\n"
    "distortion_coefficients: !!opencv-matrix\n   rows: 4\n   cols: 1\n   dt: d\n"
    "   data: [ 1.0e-02, -2.0e-03, 0., 0. ]\n";

/// As `ros2 topic echo` prints the message.
const std::string kMessage =
    "header:\n  frame_id: eye\nheight: 480\nwidth: 640\ndistortion_model: equidistant\n"
    "d: [0.01, 0.02, 0.03, 0.04]\nk: [300, 0, 319.5, 0, 300, 239.5, 0, 0, 1]\n---\nheight: 480\n";

Record cameraRecord(const std::string& keys = "") {
    return readRecordText("#3dm 1\ncamera " + keys + "\n", "eyes.3dm", sceneSchemas())
        .records.front();
}

Record calibrated(const std::string& yaml, const std::string& keys = "") {
    Record camera = cameraRecord(keys);
    applyCalibration(camera, yaml, "ost.yaml");
    return camera;
}

std::string errorOf(const std::string& yaml, const std::string& keys = "") {
    return errorsOf([&] { calibrated(yaml, keys); });
}

TEST(Calibration, OfRos) {
    EXPECT_EQ(calibrated(kOst), cameraRecord("pixels=640,480 fx=430.5 fy=431.5 cx=320.25 cy=240.75 "
                                             "projection=pinhole distortion=plumb_bob "
                                             "coefficients=-0.3,0.1,0.001,-0.002"));
    EXPECT_EQ(calibrated(kMessage),
              cameraRecord("pixels=640,480 fx=300 fy=300 cx=319.5 cy=239.5 projection=fisheye "
                           "distortion=fisheye coefficients=0.01,0.02,0.03,0.04"));
}

TEST(Calibration, OfOpenCv) {
    const std::string size = "pixels=1280,960 fx=800 fy=800 cx=639.5 cy=479.5 ";
    EXPECT_EQ(calibrated(kOpenCv), cameraRecord(size + "projection=pinhole distortion=plumb_bob "
                                                       "coefficients=0.01,-0.002"));
    // Four numbers are a fisheye's only where the file says so.
    const std::string fisheye =
        size + "projection=fisheye distortion=fisheye coefficients=0.01,-0.002";
    EXPECT_EQ(calibrated(kOpenCv, "distortion=fisheye"), cameraRecord(fisheye));
    EXPECT_EQ(calibrated(kOpenCv + "fisheye_model: 1\n"), cameraRecord(fisheye));
    EXPECT_EQ(
        calibrated("{\"image_width\": 2, \"image_height\": 2, \"camera_matrix\": "
                   "{\"type_id\": \"opencv-matrix\", \"data\": [9, 0, 1, 0, 9, 1, 0, 0, 1]}}"),
        cameraRecord("pixels=2,2 fx=9 fy=9 cx=1 cy=1 projection=pinhole"));
}

TEST(Calibration, PicturesOfAnotherSizeAreScaled) {
    EXPECT_EQ(calibrated(kOpenCv, "pixels=640,480"),
              cameraRecord("pixels=640,480 fx=400 fy=400 cx=319.5 cy=239.5 projection=pinhole "
                           "distortion=plumb_bob coefficients=0.01,-0.002"));
}

TEST(Calibration, BadFilesAreRefusedWithTheirLine) {
    const auto without = [](std::string text, const std::string& line) {
        return text.erase(text.find(line), line.size());
    };
    EXPECT_EQ(errorOf(""),
              "ost.yaml: error: no calibration: wanted YAML with `image_width`, "
              "`camera_matrix`, …\n");
    EXPECT_EQ(errorOf(without(kOst, "image_width: 640\n")),
              "ost.yaml:1: error: no `image_width`\n");
    EXPECT_EQ(errorOf("image_width: 9\nimage_height: 9\n"),
              "ost.yaml:1: error: no `camera_matrix`\n");
    EXPECT_EQ(errorOf("image_width: 9\nimage_height: 9\nK: [1, 0, 0]\n"),
              "ost.yaml:3: error: `camera_matrix`: wanted a list of 9 numbers, or a matrix with "
              "`data`\n");
    EXPECT_EQ(errorOf("image_width: 9\nimage_height: 9\nK: [1, 2, 3, 0, 1, 3, 0, 0, 1]\n"),
              "ost.yaml:3: error: the axes are skewed, and cameras' are not\n");
    EXPECT_NE(errorOf("image_width: 9\nimage_height: 1e9\n").find("ost.yaml:2: error: `image_hei"),
              std::string::npos);
    EXPECT_NE(errorOf("image_width: 9\nimage_height: 9\nK: [.nan, 0, 3, 0, 1, 3, 0, 0, 1]\n")
                  .find("found `.nan`, wanted a number"),
              std::string::npos);
    std::string other = kOst;
    other.replace(other.find("plumb_bob"), 9, "kalibr");
    EXPECT_NE(errorOf(other).find("`kalibr` is none of plumb_bob"), std::string::npos);
    EXPECT_NE(errorOf("<?xml version=\"1.0\"?>\n<opencv_storage>\n").find("XML is not read"),
              std::string::npos);
    EXPECT_NE(errorOf("{a: [").find("bad YAML"), std::string::npos);
    EXPECT_NE(errorOf(kMessage, "projection=pinhole").find("a lens of projection=fisheye"),
              std::string::npos);
    EXPECT_NE(errorOf("image_width: 9\nimage_height: 9\nK: [1, 0, 3, 0, 1, 3, 0, 0, 1]\n"
                      "distortion_model: rational_polynomial\nD: [0, 0, 0, 0, 0, 0.5, 0, 0]\n")
                  .find("ost.yaml:4: error: rational_polynomial is not supported beyond"),
              std::string::npos);
}

TEST(Calibration, DamagedFilesDoNoHarm) {
    for (const std::string& good : {kOst, kOpenCv, kMessage})
        surviveDamage(
            good, [](const std::string& damaged) { calibrated(damaged); }, 200);
}

TEST(Calibration, IsFoundBesideTheFileThatNamesIt) {
    const std::filesystem::path folder =
        std::filesystem::path(testing::buildPath("calibration_test"));
    std::filesystem::create_directories(folder / "eyes");
    const std::string ost = (folder / "eyes" / "ost.yaml").string();
    writeAll(ost, kOst);
    const auto read = [&](const std::string& line, bool load = true) {
        ImportOptions options;
        options.load_files = load;
        return parseDocument("#3dm 1\ncamera at=1,1 " + line + "\n", (folder / "a.3dm").string(),
                             options, sceneSchemas());
    };
    const Document document = read("calibration=eyes/ost.yaml");
    EXPECT_FALSE(document.records[0].has("calibration"));
    EXPECT_EQ(document.records[0].number("fx"), 430.5);
    EXPECT_EQ(document.sources, std::vector<std::string>{ost});
    const Document kept = read("calibration=eyes/ost.yaml", false);
    EXPECT_EQ(kept.records[0].text("calibration"), "eyes/ost.yaml");
    EXPECT_TRUE(kept.sources.empty());
    const auto error = [&](const std::string& line) { return errorsOf([&] { read(line); }); };
    EXPECT_NE(error("calibration=none.yaml").find("a.3dm:2:"), std::string::npos);
    EXPECT_NE(error("calibration=none.yaml").find("none.yaml` cannot be opened: No such file"),
              std::string::npos);
    EXPECT_NE(error("calibration=eyes").find("cannot be opened: Is a directory"),
              std::string::npos);
    EXPECT_NE(error("calibration=/dev/zero").find("it is no regular file"), std::string::npos);
    EXPECT_NE(error("calibration=eyes/ost.yaml fov=60")
                  .find("`fov` and `calibration` say the same: leave one out"),
              std::string::npos);
    std::string keys = kOst;
    for (int i = 0; i < 1000; ++i) keys += "k" + std::to_string(i) + ": 0\n";
    writeAll(ost, keys);
    EXPECT_NE(error("calibration=eyes/ost.yaml").find("1007 keys, wanted at most 1000"),
              std::string::npos);
    writeAll(ost, "image_width: 640\n");
    EXPECT_NE(error("calibration=eyes/ost.yaml").find("ost.yaml`, line 1: no `image_height`"),
              std::string::npos);
    std::filesystem::remove_all(folder);
}

}  // namespace calibration_test
}  // namespace ispace
