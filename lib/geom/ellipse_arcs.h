// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geom/ellipse.h"

namespace ispace {

// Places on an ellipse by their parameter, in radians: the angle about the centre in the frame that
// makes it the unit disc.

Point2 placeOn(const Ellipse& ellipse, double parameter);

/// Adds places next to the arc from one parameter to another, ascending or descending, neither end
/// among them: between the ends they enclose the area that the arc does. But for the first and the
/// last they are corners of `outline`, which is outlineOf(ellipse).
void addArc(const Ellipse& ellipse, const Polygon& outline, double from, double to,
            Polygon& polygon);

/// Where lines of sight from outside touch an ellipse, on the viewer's right and left; the near
/// side lies between them, left < right < left + pi.
struct TouchedAt {
    double right, left;
};
TouchedAt touchedFrom(const Ellipse& ellipse, Point2 viewpoint);

/// A convex polygon of the same area with corners where lines of sight from outside touch the
/// ellipse; from inside, or as near to the curve as twice kCurveTolerance, outlineOf().
Polygon outlineFrom(const Ellipse& ellipse, Point2 viewpoint);

}  // namespace ispace
