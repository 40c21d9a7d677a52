// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/geom.
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

namespace ispace {

/// Calls functions that come from several threads in the order of their numbers, each as soon as
/// all before it are there, one at a time. Whoever adds the one that the others wait for calls
/// them. After one has thrown none is called any more.
class InOrder {
  public:
    explicit InOrder(std::size_t count) : waiting_(count) {}

    void add(std::size_t number, std::function<void()> call) {
        std::unique_lock lock(mutex_);
        waiting_[number] = std::move(call);
        if (is_calling_) return;
        is_calling_ = true;
        while (next_ < waiting_.size() && waiting_[next_]) {
            const std::function<void()> now = std::exchange(waiting_[next_++], {});
            lock.unlock();
            now();
            lock.lock();
        }
        is_calling_ = false;
    }

  private:
    std::mutex mutex_;
    std::vector<std::function<void()>> waiting_;
    std::size_t next_ = 0;
    bool is_calling_ = false;
};

}  // namespace ispace
