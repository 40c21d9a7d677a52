// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "record/record.h"

namespace ispace {

/// Reads the calibration of a camera: ROS' camera_info, as camera_calibration writes it
/// (`camera_matrix`, `distortion_coefficients`) or as a message (`K`, `D`), and OpenCV's
/// FileStorage, in YAML or JSON. Sets `pixels`, `fx fy cx cy`, `projection`, `distortion` and
/// `coefficients` of a camera's record. With `pixels` in the record the figures are scaled to it.
/// Without a model in the file, the record's `distortion` says what the coefficients are, else
/// they are plumb_bob's. \param name the file, for messages \throws FormatError with its line: no
/// YAML, no matrix, a model that cameras do not have, skewed axes
void applyCalibration(Record& camera, std::string_view yaml, const std::string& name);

/// Puts what the file of each `camera` record with `calibration` says in place of that key, and
/// adds the file's path to Document::sources. Paths are relative to the operand's folder (for "-"
/// to the current one). \throws FormatError with findings at the records
void loadCalibrations(Document& document, const std::string& operand);

}  // namespace ispace
