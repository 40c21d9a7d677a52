// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/uncancelled.h"

#include <tbb/task_group.h>

namespace ispace {

void runUncancelled(const std::function<void()>& work) {
    tbb::task_group_context context(tbb::task_group_context::isolated);
    tbb::task_group group(context);
    group.run_and_wait(work);
}

}  // namespace ispace
