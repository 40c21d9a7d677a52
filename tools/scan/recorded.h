// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scan/options.h"

namespace ispace {

/// Writes the scans that `simrun --record` has recorded (--run without --view) in another format.
/// \throws as the scene's readers, UsageError where the format cannot hold scans in one file
void writeRecorded(const ScanCommand& command);

}  // namespace ispace
