// SPDX-License-Identifier: GPL-3.0-or-later
// Worlds of Webots.
#include "extensions/webots/webots.h"
#include "fuzz.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    ImportOptions options;
    options.max_work.max = 4000;
    tryPlan(webots::readWebots, bytes, "w.wbt", options);
}
