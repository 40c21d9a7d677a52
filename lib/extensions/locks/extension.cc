// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/locks/lock.h"
#include "extensions/locks/lock_role.h"

namespace ispace::extension {

Extension locks() { return {.name = "locks", .add = locks::addLocks, .role = locks::makeLocks}; }

}  // namespace ispace::extension
