// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace ispace {

/// A row of a table in text.
using TextRow = std::vector<std::string>;

/// Columns as wide as their longest cell, two blanks apart; `sides` has an r for those of numbers,
/// whose last letter counts on.
std::string aligned(const std::vector<TextRow>& rows, const std::string& sides);

/// A share with so many decimals: 0.974 is "97.40%" with two.
std::string percentText(double share, int decimals = 2);

}  // namespace ispace
