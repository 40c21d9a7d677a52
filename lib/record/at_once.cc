// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/at_once.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <utility>

namespace ispace {

namespace {

/// True on a thread that is at work for a function of this file.
thread_local bool is_inside = false;

struct Inside {
    bool before = std::exchange(is_inside, true);
    ~Inside() { is_inside = before; }
};

/// Whoever waits for part of the work takes up other parts of it, but nothing else: what calls
/// from outside may hold a lock that something else wants. Calls within the work belong to it.
template <typename Work>
void isolated(Work work) {
    if (is_inside)
        work();
    else
        tbb::this_task_arena::isolate([&work] {
            const Inside inside;
            work();
        });
}

}  // namespace

void doBoth(bool at_once, const std::function<void()>& first, const std::function<void()>& second) {
    if (!at_once) {
        first();
        second();
        return;
    }
    const auto part = [](const std::function<void()>& work) {
        return [&work] {
            const Inside inside;
            work();
        };
    };
    isolated([&] { tbb::parallel_invoke(part(first), part(second)); });
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
        const Inside inside;
        make(block);
        return block;
    };
    const auto take_one = [&take](std::size_t block) {
        const Inside inside;
        take(block);
    };
    isolated([&] {
        tbb::parallel_pipeline(
            kBlocksAtOnce,
            tbb::make_filter<void, std::size_t>(filter_mode::serial_in_order, begin) &
                tbb::make_filter<std::size_t, std::size_t>(filter_mode::parallel, make_one) &
                tbb::make_filter<std::size_t, void>(filter_mode::serial_in_order, take_one));
    });
}

void doInParts(bool at_once, std::size_t count,
               const std::function<void(std::size_t, std::size_t)>& work) {
    if (!at_once) return work(0, count);
    constexpr std::size_t kPart = 1024;
    isolated([&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kPart),
                          [&work](const auto& part) {
                              const Inside inside;
                              work(part.begin(), part.end());
                          });
    });
}

}  // namespace ispace
