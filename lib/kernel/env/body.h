// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes of elements: upright prisms, sheets and plates without thickness, meshes. From them follow
// slices (slice.h), meshes (mesh.h) and shadows. World frame, metres, z up. Prisms are closed sets:
// top and bottom belong to them. Round prisms keep their ellipse, so rays meet the true curve.
// Bodies depend on their record alone, but for those of walls, which need the welded lines of all
// (walls.h), and of doors and windows, which fill openings in these (openings.h).
//
//     const Body table = bodyOf(readRecord("table at=2,3 size=1.2", "-", schemas));
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

/// A closed upright prism: its footprint (simple, counter-clockwise, world frame) extruded from
/// bottom to top.
struct Prism {
    Polygon footprint;
    double bottom = 0, top = 0;
    Material material = Material::Wood;
    /// Ellipse of a round prism, in which the footprint is inscribed; null for other prisms.
    std::shared_ptr<const Ellipse> curve = {};
};

/// Builds an upright prism on an ellipse.
Prism roundPrism(const Ellipse& curve, double bottom, double top, Material material);

/// An upright sheet without thickness, as of thin walls and fences.
struct Sheet {
    Segment2 line;
    double bottom = 0, top = 0;
    Material material = Material::Wall;
    bool clear = false;  ///< glass: light passes, sound and robots do not; not part of slices
};

/// A level sheet without thickness at height z: floors, ceilings. Never part of a slice.
struct Plate {
    Polygon outline;
    double z = 0;
    Material material = Material::Floor;
    bool visual_only = false;  ///< a pattern on the floor: drawn, but no ray hits it
};

/// The shape of one element in the world frame.
struct Body {
    std::vector<Prism> prisms;
    std::vector<Sheet> sheets;
    std::vector<Plate> plates;
    std::vector<Mesh> meshes;  ///< loaded from files, in the world frame
};

/// Returns the height of the highest prism, sheet or mesh; 0 without any.
double topOf(const Body& body);

/// Returns the polygon inscribed in the ellipse with these full axes about `center`, the first
/// along `heading`, see geom/curve.h. Counter-clockwise.
Polygon ellipse(Point2 center, double length, double width, Angle heading);

/// Returns the rectangle of this length (along heading) and width about `center`,
/// counter-clockwise.
Polygon rectangle(Point2 center, double length, double width, Angle heading);

/// Returns the mid-lines of the walls of a wall, fence or ispace record; empty for other records.
/// Reports zero-length lines as findings.
std::vector<Segment2> wallLines(const Record& record, Diagnostics& findings);

/// Builds the body of an environment record; empty for `inside` and `zone`, and for a `mesh`
/// before its file is loaded.
///
/// A wall or fence has one sheet per line, or with a thickness one box per line plus joints that
/// close the cracks at corners. A table is a round top on a stem and a foot; a desk is a top on
/// four legs, or with kind=closed on panels down to the floor at both ends of its length and on its
/// left, so that it is open to its right; a chair is a seat on four legs with a back behind.
/// Barriers, cubes and pillars are boxes (pillar kind=round: a cylinder). Stacked boxes differ a
/// little in size; a screen is a board on two posts with feet as deep as its width. The bars of an
/// infra frame, 5 cm square, are evenly spaced from edge to edge; the frame hangs at its height
/// without posts. A mesh keeps the triangles of its file. A floor is a pattern of plates.
Body bodyOf(const Record& record);

/// Returns the area of a `zone` record.
Polygon zoneOutline(const Record& record);

}  // namespace ispace
