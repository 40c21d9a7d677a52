// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "draw/color.h"
#include "env/material.h"

namespace ispace {

/// The colour of a material as screens and paper have it: sRGB of its linear RGB, with its opacity.
Color displayColor(Material material);

}  // namespace ispace
