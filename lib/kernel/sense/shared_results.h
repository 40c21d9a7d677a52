// SPDX-License-Identifier: GPL-3.0-or-later
// Objects that all readings of a run share, one of each type, so that a kind of sensor computes
// once what many sensors read. They are caches: readings are the same without them.
//
//     FixesOfTags own;  // of readings that share none
//     FixesOfTags& fixes = now.options.shared ? now.options.shared->of<FixesOfTags>() : own;
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <typeindex>

namespace ispace {

/// Thread-safe; the objects must be, too. A call locks and looks up a type: O(log types).
class SharedResults {
  public:
    /// Returns the object of a type, made by the first call. It lives as long as this.
    template <typename T>
    T& of() {
        const std::lock_guard lock(mutex_);
        std::shared_ptr<void>& known = objects_[typeid(T)];
        if (known == nullptr) known = std::make_shared<T>();
        return *static_cast<T*>(known.get());
    }

  private:
    std::mutex mutex_;
    std::map<std::type_index, std::shared_ptr<void>> objects_;
};

}  // namespace ispace
