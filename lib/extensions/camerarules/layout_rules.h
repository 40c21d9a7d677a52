// SPDX-License-Identifier: GPL-3.0-or-later
// `arrange --facing` and `--privacy`.
#pragma once

#include <memory>

#include "cli/arrange_group.h"

namespace ispace::camerarules {

std::unique_ptr<ArrangeGroup> makeLayoutRules();

}  // namespace ispace::camerarules
