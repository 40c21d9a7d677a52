// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/thermometers/thermometer.h"

namespace ispace::extension {

Extension thermometers() { return {.name = "thermometers", .add = thermometers::addThermometers}; }

}  // namespace ispace::extension
