// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/expect/expectations.h"

namespace ispace::extension {

Extension expect() { return {.name = "expect", .judge = expect::makeExpectations}; }

}  // namespace ispace::extension
