// SPDX-License-Identifier: GPL-3.0-or-later
// Jobs run one after another, or as a pipeline that takes in order, works in parallel and delivers
// in order: products and messages come as if there was one thread. At most twice as many jobs as
// threads are under way. A job that waits does not begin another, which could want its locks.
#include "cli/job_loop.h"

#include <tbb/global_control.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <cstddef>
#include <memory>
#include <utility>

#include "cli/kept_rooms.h"

namespace ispace {

namespace {

using Delivery = std::function<void()>;
using NextJob = std::function<std::optional<LoopJob>()>;

void runOneByOne(const NextJob& next) {
    while (const std::optional<LoopJob> job = next()) {
        {
            const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
            keepRooms(job->rooms);
        }
        const Delivery deliver = job->work();
        if (!deliver) return;
        deliver();
    }
}

/// A thread that waits within a job does not begin another one. An error of one job cancels the
/// pipeline, but not the loops of jobs that still run: these would go on with half of a result.
Delivery runApart(const LoopJob& job) {
    return tbb::this_task_arena::isolate([&] {
        tbb::task_group_context apart(tbb::task_group_context::isolated);
        tbb::task_group group(apart);
        Delivery result;
        group.run_and_wait([&] {
            keepRooms(job.rooms);
            result = job.work();
        });
        return result;
    });
}

void runOnAllThreads(const NextJob& next) {
    using Item = std::shared_ptr<const LoopJob>;
    const auto take = [&](tbb::flow_control& control) -> Item {
        if (std::optional<LoopJob> job = next())
            return std::make_shared<const LoopJob>(*std::move(job));
        control.stop();
        return nullptr;
    };
    const auto run = [](const Item& job) { return runApart(*job); };
    const auto deliver = [](const Delivery& result) { result(); };
    const std::size_t threads =
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    tbb::parallel_pipeline(
        2 * threads,
        tbb::make_filter<void, Item>(tbb::filter_mode::serial_in_order, take) &
            tbb::make_filter<Item, Delivery>(tbb::filter_mode::parallel, run) &
            tbb::make_filter<Delivery, void>(tbb::filter_mode::serial_in_order, deliver));
}

}  // namespace

void runJobs(LoopThreads threads, const NextJob& next) {
    threads == LoopThreads::One ? runOneByOne(next) : runOnAllThreads(next);
}

}  // namespace ispace
