// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/standing.h"

#include <variant>

namespace ispace {

Polygon Standing::box(Point2 low, Point2 high) const {
    return {world_from_body * low, world_from_body * Point2{high.x, low.y}, world_from_body * high,
            world_from_body * Point2{low.x, high.y}};
}

Polygon Standing::rectangle() const {
    return ispace::rectangle(world_from_body.position, length, width, world_from_body.heading);
}

Ellipse Standing::ellipse(double share) const {
    return {world_from_body.position, share * length, share * width, world_from_body.heading};
}

Standing standingOf(const Record& record) {
    const Tuple& at = record.tuple("at");
    const Tuple& size = record.tuple("size");
    Standing out;
    out.world_from_body = {{at[0], at[1]}, record.angle("heading")};
    out.length = size[0];
    out.width = size.size() > 1 ? size[1] : size[0];
    out.bottom = at.size() > 2 ? at[2] : 0;
    const Value* height = record.find("height");
    if (size.size() > 2)
        out.top = out.bottom + size[2];
    else
        out.top = out.bottom + (height != nullptr ? std::get<double>(*height) : out.length);
    return out;
}

}  // namespace ispace
