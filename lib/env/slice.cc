// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/slice.h"

#include <algorithm>

namespace ispace {

bool Slice::blocked(Point2 p) const {
    return std::any_of(solids.begin(), solids.end(),
                       [p](const Polygon& solid) { return locate(solid, p) != Side::Outside; });
}

}  // namespace ispace
