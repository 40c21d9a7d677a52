// SPDX-License-Identifier: GPL-3.0-or-later
// Records of runs as pictures and films: simrun --replay DIR -o FILE, and its options.
#pragma once

#include <memory>

#include "cli/drawing_group.h"

namespace ispace::films {

std::unique_ptr<DrawingGroup> makeFilmOptions();

}  // namespace ispace::films
