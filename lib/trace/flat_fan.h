// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geom/point.h"
#include "trace/flat_tree.h"

namespace ispace {

/// Beams from one origin at equal steps counter-clockwise, at most a full turn, and what they have
/// met so far.
struct alignas(64) FlatFan {
    static constexpr int kBlock = 8;  ///< beams whose least nearness is kept
    static constexpr int kMost = 2048;
    /// Least number of beams, and most of the step in radians: the middle of a fan is that of its
    /// middle beams.
    static constexpr int kLeast = 3;
    static constexpr double kWidestStep = 3, kFinestStep = 1e-10;

    double x[kMost], y[kMost];  ///< unit vectors, as the ranges shall be for
    double nearness[kMost];     ///< one over the range
    double cosine[kMost];       ///< only if wanted
    double least[kMost / kBlock];
    int count;
    double cos, sin;  ///< a vector along the middle
    double rate;      ///< beams a radian

    /// Readies it for drawing, once count, x and y are set.
    void begin(double step_radians, double least_nearness);
    [[nodiscard]] int blocks() const { return (count + kBlock - 1) / kBlock; }
};

/// What lines are seen from.
struct FlatView {
    double x, y;
    double contact;
};

/// Draws all lines into the fan, front to back.
void drawLines(const FlatTree& tree, const FlatView& view, FlatFan& fan);
/// The same with cosines: the largest among lines met at the same place.
void drawLinesAndCosines(const FlatTree& tree, const FlatView& view, FlatFan& fan);

}  // namespace ispace
