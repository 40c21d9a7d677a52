// SPDX-License-Identifier: GPL-3.0-or-later
// The device of `projector` records, see elementDevices(). A record with `fov` or `throw` takes
// neither of these from its model.
#pragma once

#include "scene/element_device.h"

namespace ispace {

extern const ElementDevice kProjectorDevice;

}  // namespace ispace
