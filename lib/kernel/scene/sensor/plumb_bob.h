// SPDX-License-Identifier: GPL-3.0-or-later
// Lens distortion of pinholes by radial and tangential terms (D. C. Brown, Decentering distortion
// of lenses, 1966), in units of the focal length. Closed forms, for doubles and for intervals
// (geom/interval.h); bounds over a box are wider than the values in it, as each coordinate occurs
// several times.
#pragma once

#include <array>

#include "geom/interval.h"
#include "geom/point.h"

namespace ispace {

/// Distorts the point (x, y) of the plane at depth 1 by `plumb_bob` of OpenCV and ROS, with the
/// coefficients k1 k2 p1 p2 k3; of intervals, returns bounds over the box.
template <typename Number>
std::array<Number, 2> plumbBob(const std::array<double, 5>& d, Number x, Number y) {
    const Number xx = squareOf(x), yy = squareOf(y), s = xx + yy;
    const Number radial = 1 + s * (d[0] + s * (d[1] + d[4] * s)), xy = x * y;
    return {x * radial + 2 * d[2] * xy + d[3] * (s + 2 * xx),
            y * radial + d[2] * (s + 2 * yy) + 2 * d[3] * xy};
}

/// The derivatives of plumbBob(); the matrix is symmetric.
struct PlumbBobSlope {
    double xx = 1, xy = 0, yy = 1;

    PlumbBobSlope(const std::array<double, 5>& d, Vec2 p) {
        const double s = dot(p, p), radial = 1 + s * (d[0] + s * (d[1] + s * d[4]));
        const double slope = 2 * (d[0] + s * (2 * d[1] + s * 3 * d[4]));  // 2 d radial / d s
        xx = radial + slope * p.x * p.x + 2 * d[2] * p.y + 6 * d[3] * p.x;
        xy = slope * p.x * p.y + 2 * d[2] * p.x + 2 * d[3] * p.y;
        yy = radial + slope * p.y * p.y + 6 * d[2] * p.y + 2 * d[3] * p.x;
    }
};

}  // namespace ispace
