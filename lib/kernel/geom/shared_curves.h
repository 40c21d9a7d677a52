// SPDX-License-Identifier: GPL-3.0-or-later
// Outlines that many results share without copies: views, what they cover together, and overlays.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

#include "geom/curve.h"

namespace ispace {

/// Curves that do not change: copies share one memory. A view, the covered set made of it and the
/// layers of overlays hold the same outline. Thread-safe as const objects are; O(1) to copy, one
/// atomic counter; comparison is O(1) for copies of one object, else by value.
///
///     const SharedCurves view = outlines;     // a std::vector<Curve>, copied once
///     const Layer layer{view, true, 7};       // shares it
class SharedCurves {
  public:
    SharedCurves() : SharedCurves(std::vector<Curve>()) {}
    /// Implicit: as a vector, wherever one is expected.
    SharedCurves(std::vector<Curve> curves)
        : curves_(std::make_shared<const std::vector<Curve>>(std::move(curves))) {}
    SharedCurves(std::initializer_list<Curve> curves) : SharedCurves(std::vector<Curve>(curves)) {}

    /// Implicit likewise.
    operator const std::vector<Curve>&() const { return *curves_; }
    [[nodiscard]] auto begin() const { return curves_->begin(); }
    [[nodiscard]] auto end() const { return curves_->end(); }
    [[nodiscard]] std::size_t size() const { return curves_->size(); }
    [[nodiscard]] bool empty() const { return curves_->empty(); }
    [[nodiscard]] const Curve& operator[](std::size_t i) const { return (*curves_)[i]; }
    friend bool operator==(const SharedCurves& a, const SharedCurves& b) {
        return a.curves_ == b.curves_ || *a.curves_ == *b.curves_;
    }

  private:
    std::shared_ptr<const std::vector<Curve>> curves_;  // never null
};

}  // namespace ispace
