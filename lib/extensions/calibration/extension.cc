// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/calibration/calibrate.h"
#include "io/importers.h"

namespace ispace::extension {

Extension calibration() {
    return {.name = "calibration",
            .add = [] { addImporters(calibration::calibrationImporters()); },
            .options = {{"envc", calibration::makeCalibration}}};
}

}  // namespace ispace::extension
