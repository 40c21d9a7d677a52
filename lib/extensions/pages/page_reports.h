// SPDX-License-Identifier: GPL-3.0-or-later
// Reports as HTML and PDF, and their options in coverage and arrange: cover, paper, prices, and the
// list of material.
#pragma once

#include <memory>

#include "cli/report_group.h"

namespace ispace::pages {

std::unique_ptr<ReportGroup> makePageReports();

}  // namespace ispace::pages
