// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/cli: the loop that works off many jobs in one process. Lists (cli/batch.h)
// and sweeps (cli/job_server.h) differ in their source of jobs and in the form of results alone.
//
// With all threads it is a pipeline of TBB: jobs are taken in order, run in parallel and delivered
// in order, so the output of a list does not depend on the number of threads.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace ispace {

/// A job of the loop.
struct LoopJob {
    /// Operands of the job. The rooms among them are kept for later jobs (see keepRooms()); leave
    /// out those that no other job names.
    std::vector<std::string> rooms = {};
    /// Does the job and returns the delivery of its result.
    std::function<std::function<void()>()> work = {};
};

/// Threads of the loop.
enum class LoopThreads {
    All,  ///< jobs run at the same time; parallel loops of a job stay within it
    One,  ///< a job begins after the delivery before it, and the loop starts no thread: jobs may
          ///< fork
};

/// Takes jobs from `next` until it returns none, reads their rooms, does them, and calls their
/// deliveries one after the other in the order of jobs. `next` is never called twice at a time.
/// Each thread holds at most two results that wait, so that memory does not grow with the number of
/// jobs. An exception of a job or a delivery ends the loop and is rethrown, while jobs that run
/// finish; with one thread, an empty delivery ends it, too.
void runJobs(LoopThreads threads, const std::function<std::optional<LoopJob>()>& next);

}  // namespace ispace
