// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/views/scan_views.h"

namespace ispace::extension {

Extension views() { return {.name = "views", .options = {{"scan", views::makeViewOptions}}}; }

}  // namespace ispace::extension
