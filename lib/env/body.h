// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "env/mesh.h"
#include "geom/curve.h"
#include "geom/polygon.h"
#include "record/record.h"

namespace ispace {

/// A closed upright prism: footprint (simple, counter-clockwise, world frame) from bottom to top.
struct Prism {
    Polygon footprint;
    double bottom = 0, top = 0;
    Material material = Material::Wood;
    /// The ellipse of a round prism, in which the footprint is inscribed; else null.
    std::shared_ptr<const Ellipse> curve = {};
};

/// An upright prism on an ellipse.
Prism roundPrism(const Ellipse& curve, double bottom, double top, Material material);

/// An upright sheet without thickness: walls and fences as lines.
struct Sheet {
    Segment2 line;
    double bottom = 0, top = 0;
    Material material = Material::Wall;
    bool clear = false;  ///< glass: light passes it, sound and robots do not; in no slice
};

/// A level sheet without thickness at height z: floors, ceilings. Never part of a slice.
struct Plate {
    Polygon outline;
    double z = 0;
    Material material = Material::Floor;
    bool visual_only = false;  ///< a pattern on the floor: drawn, not met by rays
};

/// The shape of one element in the world frame.
struct Body {
    std::vector<Prism> prisms;
    std::vector<Sheet> sheets;
    std::vector<Plate> plates;
    std::vector<Mesh> meshes;  ///< of files, in the world frame
};

/// Returns the height of the highest prism, sheet or mesh; 0 without any.
double topOf(const Body& body);

/// The polygon inscribed in the ellipse with these full axes about `center`, the first along
/// `heading`, see geom/curve.h. Counter-clockwise.
Polygon ellipse(Point2 center, double length, double width, Angle heading);

/// Rectangle of this length (along heading) and width about `center`, counter-clockwise.
Polygon rectangle(Point2 center, double length, double width, Angle heading);

/// The wall lines of a wall, fence or ispace record: what encloses the room, at its mid-line.
/// Zero-length lines are findings. Other records have none.
std::vector<Segment2> wallLines(const Record& record, Diagnostics& findings);

/// Builds the body of an environment record; empty for `inside` and `zone`, and for a `mesh` whose
/// file is not loaded.
///
/// A wall or fence is one sheet per line, or with a thickness one box per line plus joints that
/// leave no crack at corners. A table is a round top on a stem and a foot; a desk a top on four
/// legs, or with kind=closed on panels down to the floor on both ends of its length and on its
/// left, so that it is open to its right; a chair a seat on four legs with a back behind; barrier,
/// cube, pillar boxes (pillar kind=round a cylinder). Boxes stand upon each other, each a little
/// different; a screen is a board on two posts with feet as deep as its width. The bars of an infra
/// frame, 5 cm square, run from edge to edge, evenly; it hangs at its height without posts. A mesh
/// is as its file has it. A floor is a pattern of plates.
Body bodyOf(const Record& record);

/// Area named by a `zone` record.
Polygon zoneOutline(const Record& record);

}  // namespace ispace
