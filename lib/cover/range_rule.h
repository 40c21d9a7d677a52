// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/cover only.
#pragma once

namespace ispace {

/// The rule of all range tests of cells: as float32, end included. A place looked at with a longer
/// range, its distances kept as floats, then gives the same fan.
inline bool withinRange(double distance, double max_range) {
    return static_cast<float>(distance) <= static_cast<float>(max_range);
}

}  // namespace ispace
