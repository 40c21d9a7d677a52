// SPDX-License-Identifier: GPL-3.0-or-later
// Buildings in zip archives, as .ifczip.
#pragma once

#include <string>
#include <string_view>

#include "base/budget.h"

namespace ispace::ifc {

/// Returns true for a zip archive that names a file ending in `.ifc`.
bool isIfcZip(std::string_view bytes);

/// Unpacks the first file of an archive that ends in `.ifc`.
/// \param operand for messages \param work pays for the unpacked text before memory is allocated,
/// so that few bytes cannot become many
/// \throws FormatError: damaged, encrypted, no such file, more than `work` has
std::string unzippedIfc(std::string_view bytes, const std::string& operand, Budget& work);

}  // namespace ispace::ifc
