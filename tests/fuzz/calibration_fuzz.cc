// SPDX-License-Identifier: GPL-3.0-or-later
// Calibrations of cameras in YAML and JSON: ROS' camera_info and OpenCV's FileStorage, for a bare
// camera and for one of another size.
#include "fuzz.h"
#include "io/calibration.h"
#include "record/text.h"
#include "scene/placement_schemas.h"

namespace {

using namespace ispace;

void calibrate(const std::string& record, std::string_view bytes) {
    Document document = readRecordText("#3dm 1\n" + record, "cameras.3dm", sceneSchemas());
    applyCalibration(document.records.front(), bytes, "camera.yaml");
    fuzz::checkText(document);
}

}  // namespace

void ispace::fuzz::tryInput(std::string_view bytes) {
    calibrate("camera id=c1 at=0,0,2\n", bytes);
    calibrate("camera id=c1 at=0,0,2 pixels=320,240 distortion=fisheye\n", bytes);
}
