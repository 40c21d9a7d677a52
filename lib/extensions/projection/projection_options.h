// SPDX-License-Identifier: GPL-3.0-or-later
// The option --projection of coverage: surfaces instead of floor, with `--require ID=M2`.
#pragma once

#include <memory>

#include "cli/option_group.h"

namespace ispace::projection {

/// Returns the options of `coverage --projection PIXELS`.
std::unique_ptr<OptionGroup> makeProjectionOptions();

}  // namespace ispace::projection
