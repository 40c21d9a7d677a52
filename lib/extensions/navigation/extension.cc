// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/navigation/navigation.h"

namespace ispace::extension {

Extension navigation() {
    return {.name = "navigation", .options = {{"coverage", navigation::makeNavigationJudge}}};
}

}  // namespace ispace::extension
