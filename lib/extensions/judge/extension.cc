// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/judge/judge.h"

namespace ispace::extension {

Extension judge() { return {.name = "judge", .options = {{"coverage", judge::makeTrackJudge}}}; }

}  // namespace ispace::extension
