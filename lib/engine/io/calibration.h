// SPDX-License-Identifier: GPL-3.0-or-later
// Calibrations of cameras from files of ROS and OpenCV. Untrusted: a file has at most 1 MiB, 1000
// keys a map and 14 coefficients. Skew and more coefficients than a lens of ours has are errors,
// never ignored, since a picture with a wrong lens looks right.
//
//     applyCalibration(camera, readAll("left.yaml"), "left.yaml");  // a `camera` record
#pragma once

#include <string>
#include <string_view>

#include "record/record.h"

namespace ispace {

/// Reads the calibration of a camera in YAML or JSON: ROS' camera_info, as camera_calibration
/// writes it (`camera_matrix`, `distortion_coefficients`) or as a message (`K`, `D`), and OpenCV's
/// FileStorage. Sets `pixels`, `fx fy cx cy`, `projection`, `distortion` and `coefficients` of a
/// camera's record. If the record has `pixels`, the values are scaled to that size. If the file
/// names no distortion model, the record's `distortion` applies, by default plumb_bob. \param name
/// the file, for messages
/// \throws FormatError with its line: malformed YAML, no matrix, a model that cameras do not have,
/// skewed axes; XML of OpenCV; coefficients that are not 0 beyond 5 (pinhole), 4 (fisheye) or 0
/// (omni)
void applyCalibration(Record& camera, std::string_view yaml, const std::string& name);

/// Replaces the key `calibration` of each `camera` record by the values that its file holds, and
/// adds the file's path to Document::sources. Paths are relative to the operand's folder (for "-"
/// to the current one). \throws FormatError with findings at the records
void loadCalibrations(Document& document, const std::string& operand);

}  // namespace ispace
