// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace ispace {

/// A value made when it is first asked for, once, by the first thread that asks; the others wait
/// for it. Afterwards get() costs one atomic load.
template <typename T>
class Lazy {
  public:
    Lazy() = default;
    explicit Lazy(T value) : value_(std::move(value)), is_made_(true) {}

    /// The value; `make()` returns it. If `make` throws, the next caller tries again. `make` must
    /// not ask for the same value, nor wait for tasks that do.
    template <typename Make>
    const T& get(Make make) const {
        if (!is_made_.load(std::memory_order_acquire)) {
            const std::scoped_lock lock(mutex_);
            if (!value_) {
                value_.emplace(make());
                is_made_.store(true, std::memory_order_release);
            }
        }
        return *value_;
    }
    /// The value if it is made, else null.
    [[nodiscard]] const T* peek() const {
        return is_made_.load(std::memory_order_acquire) ? &*value_ : nullptr;
    }

  private:
    mutable std::mutex mutex_;
    mutable std::optional<T> value_;
    mutable std::atomic<bool> is_made_ = false;
};

/// Processors that this process may use by the quota of its control group (version 1 or 2) and of
/// those above it, rounded up: what containers and batch systems grant. Nothing without a quota.
/// \param root where `/proc` and `/sys` are; "" is the machine's
std::optional<int> cpuQuota(const std::string& root = "");

/// Moves a value to where it stays until the process ends and is never destroyed: to free all that
/// is known of a large room takes long. For main functions, once for each type: a second value
/// would be a leak. (`used`: a compiler may leave out a pointer that nobody reads, and then the
/// first is one, too.)
template <typename T>
const T& leftToExit(T value) {
    [[gnu::used]] static const T* pointer = nullptr;
    pointer = new T(std::move(value));
    return *pointer;
}

/// Calls functions that come from several threads in the order of their numbers, each as soon as
/// all before it are there, one at a time. Whoever adds the one that the others wait for calls
/// them. After one has thrown none is called any more.
class OrderedCalls {
  public:
    explicit OrderedCalls(std::size_t count) : waiting_(count) {}

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

/// Fewer records than this are dealt with before another thread would begin.
constexpr std::size_t kManyRecords = 2000;

/// Does both: in two threads, if there are so many, or one after the other. Whoever waits takes up
/// nothing else meanwhile. \throws what one of them throws
void parallelInvoke(bool at_once, const std::function<void()>& first,
                    const std::function<void()>& second);

/// Blocks that may be in the making at a time, see orderedPipeline().
constexpr std::size_t kBlocksAtOnce = 8;

/// Calls make(block) for each of these blocks, several in different threads, and take(block) for
/// one after another, in order. A block is taken before the one kBlocksAtOnce behind it is begun,
/// so that the two can use the same memory. \throws what one of them throws
void orderedPipeline(std::size_t blocks, const std::function<void(std::size_t)>& make,
                     const std::function<void(std::size_t)>& take);

/// Calls work(first, last) for consecutive parts of 0 to count - 1, in several threads if there are
/// so many. \throws what one of them throws
void parallelChunks(bool at_once, std::size_t count,
                    const std::function<void(std::size_t, std::size_t)>& work);

}  // namespace ispace
