// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "cli/option_group.h"

namespace ispace::projection {

/// Returns the options of `coverage --projection PIXELS`.
std::unique_ptr<OptionGroup> makeProjectionOptions();

}  // namespace ispace::projection
