// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/body.h"
#include "geom/pose.h"

namespace ispace {

Prism roundPrism(const Ellipse& curve, double bottom, double top, Material material) {
    return {inscribedIn(curve), bottom, top, material, curve};
}

Polygon ellipse(Point2 center, double length, double width, Angle heading) {
    return inscribedIn(Ellipse(center, length, width, heading));
}

Polygon rectangle(Point2 center, double length, double width, Angle heading) {
    const Pose2 world_from_body{center, heading};
    const double x = length / 2, y = width / 2;
    return {world_from_body * Point2{-x, -y}, world_from_body * Point2{x, -y},
            world_from_body * Point2{x, y}, world_from_body * Point2{-x, y}};
}

}  // namespace ispace
