// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/imus/imu.h"

namespace ispace::extension {

Extension imus() { return {.name = "imus", .add = imus::addImus}; }

}  // namespace ispace::extension
