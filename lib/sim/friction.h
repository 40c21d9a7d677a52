// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "env/environment.h"

namespace ispace {

/// Friction of the floor from place to place.
class FrictionMap {
  public:
    explicit FrictionMap(const Environment& environment);

    /// That of the last `floor` record, in file order, that holds the point, edges included: later
    /// ones lie on top. 0 if there is none.
    [[nodiscard]] double at(Point2 p) const;
    /// True if it is 0 everywhere.
    [[nodiscard]] bool empty() const { return floors_.empty(); }

  private:
    struct Floor {
        Point2 center;
        Vec2 along;  // unit vector of its length
        double half_length, half_width;
        double friction;
    };
    std::vector<Floor> floors_;
};

}  // namespace ispace
