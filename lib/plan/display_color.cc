// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/display_color.h"

#include <cmath>

namespace ispace {

namespace {

/// IEC 61966-2-1.
double encoded(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace

Color displayColor(Material material) {
    const Look& look = lookOf(material);
    return {encoded(look.color[0]), encoded(look.color[1]), encoded(look.color[2]), look.opacity};
}

}  // namespace ispace
