// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <utility>

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

}  // namespace ispace
