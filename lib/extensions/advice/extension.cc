// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/advice/advice.h"

namespace ispace::extension {

Extension advice() { return {.name = "advice", .coverage = makeAdvice, .record = makeRunAdvice}; }

}  // namespace ispace::extension
