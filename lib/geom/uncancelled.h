// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <tbb/task_group.h>

#include <optional>
#include <utility>

namespace ispace {

/// The value of work(), for values that outlive the parallel loop in which they are first asked
/// for. Once a task of that loop throws, oneTBB leaves out all loops within its other tasks without
/// a word, and a value made by them would be kept half made. Loops within work() run to their end.
/// \throws what work() throws
template <typename Work>
auto uncancelled(Work work) {
    tbb::task_group_context context(tbb::task_group_context::isolated);
    tbb::task_group group(context);
    std::optional<decltype(work())> value;
    group.run_and_wait([&] { value.emplace(work()); });
    return *std::move(value);
}

}  // namespace ispace
