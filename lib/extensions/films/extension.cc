// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/films/film_options.h"

namespace ispace::extension {

Extension films() { return {.name = "films", .drawing = films::makeFilmOptions}; }

}  // namespace ispace::extension
