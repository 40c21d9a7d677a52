// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/advice/advice.h"

namespace ispace::extension {

Extension advice() {
    return {.name = "advice", .coverage = advice::makeAdvice, .record = advice::makeRunAdvice};
}

}  // namespace ispace::extension
