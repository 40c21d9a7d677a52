// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coverage/options.h"

namespace ispace {

/// Measures all scenes of a list in this process, and writes their reports in its order.
/// \throws UnmetError if one falls short of what is required, FormatError if one failed; both once
///         all are done
void runBatch(const CoverageToolOptions& options);

}  // namespace ispace
