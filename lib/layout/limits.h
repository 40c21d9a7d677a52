// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "record/record.h"

namespace ispace {

/// Puts the `range` of a record, if it has one, in the place of two limits: least and greatest, or
/// the greatest alone. Adds what is wrong with it to the findings.
void applyRange(const Record& record, double& min_range, double& max_range, Diagnostics& findings);

}  // namespace ispace
