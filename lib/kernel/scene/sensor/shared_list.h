// SPDX-License-Identifier: GPL-3.0-or-later
// Lists that sensors of one kind share: a scene of a thousand light meters stores its lamps once.
//
//     const SharedList<Light> lights(std::move(found));  // of the scene
//     for (LightMeter& meter : all) meter.lights = lights;  // one counter each
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace ispace {

/// A constant list that copies share, as those of a scene's lamps that all its light meters hold.
/// O(1) to copy; thread-safe as const objects are.
template <typename T>
class SharedList {
  public:
    SharedList() = default;
    explicit SharedList(std::vector<T> items)
        : items_(std::make_shared<const std::vector<T>>(std::move(items))) {}

    [[nodiscard]] std::size_t size() const { return items_ ? items_->size() : 0; }
    [[nodiscard]] const T* begin() const { return items_ ? items_->data() : nullptr; }
    [[nodiscard]] const T* end() const { return begin() + size(); }
    /// O(1) for copies of one list, else O(size)
    friend bool operator==(const SharedList& a, const SharedList& b) {
        if (a.items_ == b.items_) return true;
        return a.items_ && b.items_ ? *a.items_ == *b.items_ : a.size() == b.size();
    }

  private:
    std::shared_ptr<const std::vector<T>> items_;
};

}  // namespace ispace
