// SPDX-License-Identifier: GPL-3.0-or-later
// Tables in text, for terminals and fixed-width files. Widths are counted in bytes: cells of ASCII
// align.
#pragma once

#include <string>
#include <vector>

namespace ispace {

/// A row of a table in text.
using TextRow = std::vector<std::string>;

/// Aligns columns to their longest cell, two blanks apart; `sides` has an r for each column that is
/// aligned right, its last letter applies to all further columns.
std::string aligned(const std::vector<TextRow>& rows, const std::string& sides);

/// Formats a share with so many decimals: 0.974 is "97.40%" with two.
std::string percentText(double share, int decimals = 2);

}  // namespace ispace
