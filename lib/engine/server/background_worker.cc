// SPDX-License-Identifier: GPL-3.0-or-later
// One thread, made at the first job; a system that refuses it gets the jobs done in the caller's
// thread. Work is done without locks, deliveries in the thread that collects. The destructor waits
// for the job at work and drops the others.
#include "server/background_worker.h"

#include <iterator>
#include <system_error>
#include <utility>

namespace ispace {

BackgroundWorker::BackgroundWorker(std::function<void()> wake) : wake_(std::move(wake)) {}

BackgroundWorker::~BackgroundWorker() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
        waiting_.clear();
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

/// Starts the thread if necessary.
bool BackgroundWorker::hasThread() {
    if (thread_.joinable() || is_refused_) return !is_refused_;
    try {
        thread_ = std::thread([this] { run(); });
    } catch (const std::system_error&) {
        is_refused_ = true;
    }
    return !is_refused_;
}

void BackgroundWorker::give(Job job) {
    ++open_;
    if (!hasThread()) {
        Done done = doneNow(std::move(job));
        {
            const std::lock_guard lock(mutex_);
            done_.push_back(std::move(done));
        }
        wake_();
        return;
    }
    {
        const std::lock_guard lock(mutex_);
        waiting_.push_back(std::move(job));
    }
    changed_.notify_all();
}

void BackgroundWorker::doNow(Job job) {
    const Done done = doneNow(std::move(job));
    done.job.deliver(done.failure);
}

bool BackgroundWorker::collect() {
    std::vector<Done> done;
    {
        const std::lock_guard lock(mutex_);
        done.swap(done_);
    }
    open_ -= done.size();
    for (auto each = done.begin(); each != done.end(); ++each) {
        try {
            each->job.deliver(each->failure);
        } catch (...) {
            if (++each == done.end()) throw;
            // The others stay for the next call.
            open_ += static_cast<std::size_t>(done.end() - each);
            {
                const std::lock_guard lock(mutex_);
                done_.insert(done_.begin(), std::make_move_iterator(each),
                             std::make_move_iterator(done.end()));
            }
            wake_();
            throw;
        }
    }
    return !done.empty();
}

void BackgroundWorker::collectWithin(std::chrono::nanoseconds patience) {
    if (open_ > 0) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, patience, [this] { return !done_.empty(); });
    }
    collect();
}

void BackgroundWorker::collectAll() {
    while (open_ > 0) collectWithin(std::chrono::seconds(1));
}

BackgroundWorker::Done BackgroundWorker::doneNow(Job job) {
    Done done{std::move(job), nullptr};
    try {
        done.job.work();
    } catch (...) {
        done.failure = std::current_exception();
    }
    done.job.work = nullptr;
    return done;
}

void BackgroundWorker::run() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
        if (ends_) return;
        Job job = std::move(waiting_.front());
        waiting_.pop_front();
        lock.unlock();
        Done done = doneNow(std::move(job));
        lock.lock();
        done_.push_back(std::move(done));
        changed_.notify_all();
        lock.unlock();
        wake_();
        lock.lock();
    }
}

}  // namespace ispace
