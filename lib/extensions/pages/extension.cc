// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/pages/page_reports.h"

namespace ispace::extension {

Extension pages() { return {.name = "pages", .report = pages::makePageReports}; }

}  // namespace ispace::extension
