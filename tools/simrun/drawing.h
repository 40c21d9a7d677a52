// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "layout/scene.h"
#include "simrun/options.h"

namespace ispace {

/// Draws the record of --replay to -o, as a picture or a film.
/// \param title of the picture; "" for none
void drawRecord(const SimrunOptions& options, const Scene& scene, const std::string& title);

}  // namespace ispace
