// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "sim/world.h"

namespace ispace {

/// Appends a range as replies have it: three decimals as formatFixed writes them, `-` for no
/// return.
void appendRange(std::string& out, float range);

/// A reading as a SCAN line with its newline; `stream` says that it comes unasked. Binary: the line
/// with bytes=N in place of r=, then N bytes of float32, little-endian, +inf for no return.
std::string scanText(const SensorReading& reading, bool stream, bool binary);

}  // namespace ispace
