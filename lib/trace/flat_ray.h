// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "trace/flat_fan.h"
#include "trace/flat_tree.h"

namespace ispace {

/// What a ray met first.
struct FlatHit {
    double nearness;    ///< one over the range
    double cosine = 0;  ///< the largest among lines met at the same place
};

/// The nearest line along the unit vector (x, y), if it is nearer than `least_nearness`.
FlatHit firstLine(const FlatTree& tree, const FlatView& view, double x, double y,
                  double least_nearness);

}  // namespace ispace
