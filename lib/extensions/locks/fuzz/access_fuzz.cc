// SPDX-License-Identifier: GPL-3.0-or-later
// The tags that open a door: a list that is written as it was read.
#include "extensions/locks/lock.h"
#include "fuzz.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    std::string again;
    for (const std::string& tag : locks::parseAccess(bytes))
        again.append(again.empty() ? "" : ",").append(tag);
    require(again == bytes, "other tags");
}
