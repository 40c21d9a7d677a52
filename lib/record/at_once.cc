// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/at_once.h"

#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

namespace ispace {

void doBoth(bool at_once, const std::function<void()>& first, const std::function<void()>& second) {
    if (at_once) {
        tbb::this_task_arena::isolate([&] { tbb::parallel_invoke(first, second); });
    } else {
        first();
        second();
    }
}

}  // namespace ispace
