// SPDX-License-Identifier: GPL-3.0-or-later
// Values computed once, and loops over TBB that wait safely: a thread that waits for its parts
// takes up no other task, since its caller may hold a lock (as of Lazy) that such a task requests.
// No function makes a result depend on the number of threads: parts are given by the caller, and
// results are taken in order. TBB's own limits (global_control, --threads) hold.
//
//     Lazy<CellSet> seen;                                       // shared by many threads
//     const CellSet& cells = seen.get([&] { return compute(); });
//     orderedPipeline(frames, [&](std::size_t i) { scans[i % kBlocksAtOnce] = scan(i); },
//                     [&](std::size_t i) { write(scans[i % kBlocksAtOnce]); });
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

/// A value computed once, by the first thread that requests it; other threads wait for it.
/// Afterwards get() costs one atomic load.
template <typename T>
class Lazy {
  public:
    Lazy() = default;
    explicit Lazy(T value) : value_(std::move(value)), is_made_(true) {}

    /// Returns the value; `make()` computes it. If `make` throws, the next caller tries again.
    /// `make` must not request the same value, nor wait for tasks that do: loops within it run
    /// isolated (parallelInvoke() and the like, or tbb::this_task_arena::isolate).
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
    /// Returns the value if it is computed, else null.
    [[nodiscard]] const T* peek() const {
        return is_made_.load(std::memory_order_acquire) ? &*value_ : nullptr;
    }

  private:
    mutable std::mutex mutex_;
    mutable std::optional<T> value_;
    mutable std::atomic<bool> is_made_ = false;
};

/// Processors that the quotas of the process's control group (version 1 or 2) and its ancestors
/// allow, rounded up; containers and batch systems set them. Returns nullopt without a quota.
/// \param root folder of `/proc` and `/sys`; "" is the machine's
std::optional<int> cpuQuota(const std::string& root = "");

/// Moves a value to the heap and never destroys it: to free the cached derivations of a large room
/// takes long. For main functions, once for each type: a second value would leak the first.
/// (`used`: a compiler may remove a pointer that is never read, and then the first value leaks,
/// too.)
template <typename T>
const T& leftToExit(T value) {
    [[gnu::used]] static const T* pointer = nullptr;
    pointer = new T(std::move(value));
    return *pointer;
}

/// Calls functions added by several threads in the order of their numbers, one at a time, each as
/// soon as all earlier ones have been added. The thread that adds the missing function calls those
/// that wait for it. After an exception no further function is called. Amortised O(1) a call; a
/// waiting function is kept until its turn.
class OrderedCalls {
  public:
    explicit OrderedCalls(std::size_t count) : waiting_(count) {}

    /// \pre number < count, not added before, and the function is not empty \throws exceptions of
    /// the functions, on the thread that calls them
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

/// Below this number of records the work is done before a second thread starts.
constexpr std::size_t kManyRecords = 2000;

/// Runs both functions, in two threads if `at_once` and threads are free, else one after the other.
/// A waiting thread steals only tasks of this call. \throws the exception of either function
void parallelInvoke(bool at_once, const std::function<void()>& first,
                    const std::function<void()>& second);

/// Most blocks in progress at a time, see orderedPipeline().
constexpr std::size_t kBlocksAtOnce = 8;

/// Calls make(block) for each block, in several threads, and take(block) for one block after
/// another, in order. A block is taken before make() starts on the block kBlocksAtOnce later, so
/// that the two can share memory. \throws the exception of either function
void orderedPipeline(std::size_t blocks, const std::function<void(std::size_t)>& make,
                     const std::function<void(std::size_t)>& take);

/// Calls work(first, last) for consecutive ranges [first, last) that cover 0 to count - 1, in
/// several threads if `at_once` and threads are free, with ranges of some 1024; else once for all.
/// Ranges depend on the machine, so work must treat each index alike. \throws the exception of a
/// call
void parallelChunks(bool at_once, std::size_t count,
                    const std::function<void(std::size_t, std::size_t)>& work);

}  // namespace ispace
