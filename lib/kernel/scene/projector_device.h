// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scene/element_device.h"

namespace ispace {

extern const ElementDevice kProjectorDevice;

}  // namespace ispace
