// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/at_once.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_pipeline.h>
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

void makeInOrder(std::size_t blocks, const std::function<void(std::size_t)>& make,
                 const std::function<void(std::size_t)>& take) {
    using tbb::filter_mode;
    std::size_t next = 0;
    const auto begin = [&](tbb::flow_control& control) {
        if (next == blocks) control.stop();
        return next++;
    };
    const auto make_one = [&make](std::size_t block) {
        make(block);
        return block;
    };
    tbb::this_task_arena::isolate([&] {
        tbb::parallel_pipeline(
            kBlocksAtOnce,
            tbb::make_filter<void, std::size_t>(filter_mode::serial_in_order, begin) &
                tbb::make_filter<std::size_t, std::size_t>(filter_mode::parallel, make_one) &
                tbb::make_filter<std::size_t, void>(filter_mode::serial_in_order, take));
    });
}

void doInParts(bool at_once, std::size_t count,
               const std::function<void(std::size_t, std::size_t)>& work) {
    if (!at_once) return work(0, count);
    constexpr std::size_t kPart = 1024;
    tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kPart),
                          [&work](const auto& part) { work(part.begin(), part.end()); });
    });
}

}  // namespace ispace
