// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/friction.h"

#include <cmath>

namespace ispace {

FrictionMap::FrictionMap(const Environment& environment) {
    for (const Element& element : environment.elements()) {
        const Record& record = element.record;
        // Below the first rough one a smooth floor is as good as none.
        const bool tells =
            record.keyword() == "floor" && (!floors_.empty() || record.number("friction") != 0);
        if (!tells) continue;
        const Tuple& at = record.tuple("at");
        const Tuple& size = record.tuple("size");
        floors_.push_back({{at[0], at[1]},
                           unitVector(record.angle("heading")),
                           size[0] / 2,
                           size[1] / 2,
                           record.number("friction")});
    }
}

double FrictionMap::at(Point2 p) const {
    for (auto floor = floors_.rbegin(); floor != floors_.rend(); ++floor) {
        const Vec2 offset = p - floor->center;
        if (std::abs(dot(offset, floor->along)) <= floor->half_length &&
            std::abs(cross(floor->along, offset)) <= floor->half_width)
            return floor->friction;
    }
    return 0;
}

}  // namespace ispace
