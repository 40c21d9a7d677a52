// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/microphones/microphone.h"

namespace ispace::extension {

Extension microphones() { return {.name = "microphones", .add = microphones::addMicrophones}; }

}  // namespace ispace::extension
