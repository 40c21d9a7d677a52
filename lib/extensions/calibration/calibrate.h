// SPDX-License-Identifier: GPL-3.0-or-later
// The option --calibrate of envc, and the formats of logs that envc reads as rooms.
#pragma once

#include <memory>
#include <span>

#include "cli/option_group.h"
#include "io/importers.h"

namespace ispace::calibration {

/// `envc ENV LAYOUT --calibrate LOG`: the product is the layout with the poses of the fixed lasers
/// that the log has scans of, or a report of them as JSON (schema ispace-calibration/1). For the
/// drive of a robot, see readDrive(), the product is a text or JSON.
std::unique_ptr<OptionGroup> makeCalibration();

/// Logs as rooms, see readLogRoom().
std::span<const Importer> calibrationImporters();

}  // namespace ispace::calibration
