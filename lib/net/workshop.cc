// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/workshop.h"

#include <utility>

namespace ispace {

Workshop::Workshop(std::function<void()> wake)
    : wake_(std::move(wake)), thread_([this] { run(); }) {}

Workshop::~Workshop() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
        waiting_.clear();
    }
    changed_.notify_all();
    thread_.join();
}

void Workshop::give(Job job) {
    ++open_;
    {
        const std::lock_guard lock(mutex_);
        waiting_.push_back(std::move(job));
    }
    changed_.notify_all();
}

bool Workshop::collect() {
    std::vector<Done> done;
    {
        const std::lock_guard lock(mutex_);
        done.swap(done_);
    }
    open_ -= done.size();
    for (const Done& each : done) each.job.deliver(each.failure);
    return !done.empty();
}

void Workshop::collectAll() {
    while (open_ > 0) {
        {
            std::unique_lock lock(mutex_);
            changed_.wait(lock, [this] { return !done_.empty(); });
        }
        collect();
    }
}

void Workshop::run() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
        if (ends_) return;
        Done done{std::move(waiting_.front()), nullptr};
        waiting_.pop_front();
        lock.unlock();
        try {
            done.job.work();
        } catch (...) {
            done.failure = std::current_exception();
        }
        lock.lock();
        done_.push_back(std::move(done));
        changed_.notify_all();
        lock.unlock();
        wake_();
        lock.lock();
    }
}

}  // namespace ispace
