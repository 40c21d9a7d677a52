// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "base/simd.h"
#include "trace/flat_line.h"
#include "trace/flat_tree.h"

namespace ispace {

/// A round body as seen from an origin: rays meet the curve itself, from outside where they enter,
/// from inside where they leave. From an origin in contact with the curve they go out freely, and
/// those that go in meet its far side.
///
/// All in the frame where the body is the unit disc. There the ray q + t d meets the curve where
/// a t^2 + 2 b t + c = 0; written so that neither root cancels.
class RoundFrom {
  public:
    ISPACE_INLINE RoundFrom(const FlatTree::Round& round, double ox, double oy, double contact)
        : round_(round), contact_(contact) {
        const double x = ox - round.cx, y = oy - round.cy;
        qx_ = round.xx * x + round.xy * y;
        qy_ = round.yx * x + round.yy * y;
        c_ = qx_ * qx_ + qy_ * qy_ - 1;
        // c is, near the curve, the distance from it times the length of its gradient.
        touches_ = std::fabs(c_) <= 2 * contact * gradientAt(qx_, qy_);
    }

    /// One over the distance along the unit vector (x, y), and the |cosine| there; nearness is not
    /// positive if the ray does not meet it.
    struct Hit {
        double nearness, cosine;
    };
    template <bool kCosine>
    [[nodiscard]] ISPACE_INLINE Hit meet(double x, double y) const {
        const double dx = round_.xx * x + round_.xy * y, dy = round_.yx * x + round_.yy * y;
        const double a = dx * dx + dy * dy, b = qx_ * dx + qy_ * dy;
        const double side = qx_ * dy - qy_ * dx;
        const double square = a - side * side;
        if (square < 0) return {0, 0};
        const double root = std::sqrt(square), far = root - b;
        double nearness = 0;
        if (touches_)
            nearness = b < 0 && far > contact_ * a ? a / far : 0;
        else
            nearness = (std::copysign(root, c_) - b) / c_;
        if constexpr (!kCosine) return {nearness, 0};
        if (!(nearness > 0)) return {0, 0};
        const double t = 1 / nearness;
        return {nearness, root / gradientAt(qx_ + t * dx, qy_ + t * dy)};
    }

  private:
    /// Half of the length, in the world, of the gradient of c.
    [[nodiscard]] ISPACE_INLINE double gradientAt(double ux, double uy) const {
        const double x = round_.xx * ux + round_.yx * uy, y = round_.xy * ux + round_.yy * uy;
        return std::sqrt(x * x + y * y);
    }

    const FlatTree::Round& round_;
    double contact_;
    double qx_, qy_, c_;
    bool touches_;
};

}  // namespace ispace
