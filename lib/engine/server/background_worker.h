// SPDX-License-Identifier: GPL-3.0-or-later
// One thread that runs slow jobs beside the server's. For lib/engine/server and its bridges.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace ispace {

/// A thread for slow jobs that would delay clients. Runs jobs one after another, in the order they
/// were given; starts with the first job. The thread exists regardless of TBB's limit on computing
/// threads, which still applies inside a job, so clients are served meanwhile. If the system
/// refuses to create a thread, the owner's thread runs each job at once.
///
/// All members are for one thread, the owner's. Results reach it only by collect() and its kin, in
/// the order of jobs, so `deliver` needs no locks. If a delivery throws, the deliveries of jobs
/// that had ended with it are dropped: rethrow only what ends the owner.
///
///     BackgroundWorker worker([&io] { asio::post(io, [] {}); });
///     worker.give({[=] { *picture = render(scene); },
///                  [=](const std::exception_ptr& failure) { if (!failure) send(*picture); }});
///     worker.collect();  // later, once woken
class BackgroundWorker {
  public:
    /// \param wake called when a job is finished, by the worker thread (by give() without one)
    explicit BackgroundWorker(std::function<void()> wake);
    /// Waits for the running job and drops the others.
    ~BackgroundWorker();
    BackgroundWorker(const BackgroundWorker&) = delete;
    BackgroundWorker& operator=(const BackgroundWorker&) = delete;

    struct Job {
        /// Runs in the worker thread, which also destroys the captures of `work`.
        std::function<void()> work;
        /// Runs in the owner's thread with the exception that `work` threw, or null; may rethrow
        /// it.
        std::function<void(const std::exception_ptr& failure)> deliver;
    };
    /// Queues a job; unbounded.
    void give(Job job);
    /// Runs and delivers a job in the calling thread.
    static void doNow(Job job);
    /// Number of jobs not delivered yet.
    [[nodiscard]] std::size_t open() const { return open_; }
    /// Delivers the finished jobs. If a delivery throws, the later ones wait for the next call.
    /// \returns false if there were none
    bool collect();
    /// Waits up to `patience` for a finished job, then delivers all finished jobs.
    void collectWithin(std::chrono::nanoseconds patience);
    /// Waits for all jobs and delivers them.
    void collectAll();

  private:
    struct Done {
        Job job;
        std::exception_ptr failure;
    };
    [[nodiscard]] static Done doneNow(Job job);
    [[nodiscard]] bool hasThread();
    void run();

    std::function<void()> wake_;
    std::size_t open_ = 0;  // used by the owner only
    std::mutex mutex_;      // guards the members below
    std::condition_variable changed_;
    std::deque<Job> waiting_;
    std::vector<Done> done_;
    bool ends_ = false;
    bool is_refused_ = false;  // used by the owner only
    std::thread thread_;       // declared last: it uses the other members
};

}  // namespace ispace
