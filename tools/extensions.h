// SPDX-License-Identifier: GPL-3.0-or-later
// The one list of extensions, which the configuration of the build chooses.
#pragma once

#include "cli/extensions.h"

namespace ispace {

/// Returns the extensions of this build. From the first call on their formats and records are read.
const Extensions& extensions();

}  // namespace ispace
