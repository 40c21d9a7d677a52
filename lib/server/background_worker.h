// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/server.
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

/// A thread for what takes so long that clients would notice: jobs are done one after another, in
/// the order they were given. It begins with the first job. It is there however many threads may
/// compute (TBB's limit, which holds for what a job does): clients are served meanwhile. Where the
/// system refuses another thread, the owner's does each job as it is given.
class BackgroundWorker {
  public:
    /// \param wake is called by that thread when a job is done
    explicit BackgroundWorker(std::function<void()> wake);
    /// Waits for the job that is being done, and drops the others.
    ~BackgroundWorker();
    BackgroundWorker(const BackgroundWorker&) = delete;
    BackgroundWorker& operator=(const BackgroundWorker&) = delete;

    struct Job {
        /// In the thread of the workshop, where what it holds also ends.
        std::function<void()> work;
        /// In that of the owner, with what `work` threw, or null. It may throw that again.
        std::function<void(const std::exception_ptr& failure)> deliver;
    };
    void give(Job job);
    /// Does a job without a workshop, and delivers it.
    static void doNow(Job job);
    /// Jobs that were given and not delivered.
    [[nodiscard]] std::size_t open() const { return open_; }
    /// Delivers those that are done. \returns false if there were none
    bool collect();
    /// Waits for one at least, but not for longer, and delivers those that are done.
    void collectWithin(std::chrono::nanoseconds patience);
    /// Waits for all, and delivers them.
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
    std::size_t open_ = 0;  // of the owner alone
    std::mutex mutex_;      // of what follows
    std::condition_variable changed_;
    std::deque<Job> waiting_;
    std::vector<Done> done_;
    bool ends_ = false;
    bool is_refused_ = false;  // of the owner alone
    std::thread thread_;       // the last: it uses the others
};

}  // namespace ispace
