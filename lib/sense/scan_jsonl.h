// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "base/history.h"
#include "sense/scan.h"

namespace ispace {

/// The header line of a scan stream, with newline.
std::string scanHeaderLine(const History& history, std::uint64_t seed);

/// Appends one scan as a line of JSON: angles in radians, ranges as shortest float32, null for no
/// return.
void appendScanLine(std::string& out, const PlacedLaser& sensor, const Scan& scan);

}  // namespace ispace
