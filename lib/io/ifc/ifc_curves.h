// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geom/polygon.h"
#include "io/ifc/ifc_frames.h"

namespace ispace {

/// Chords of arcs keep this near to them, in metres.
constexpr double kIfcChordError = 0.001;

/// The points of a bounded curve, in its own frame; closed ones end where they begin or one point
/// before. Polylines, indexed poly-curves, composite curves, circles and ellipses and their parts,
/// parts of lines. B-splines and their kin are UnreadGeometry, also curves nested too deep.
std::vector<Point3> ifcCurve(const IfcFrames& frames, StepId id, int depth = 0);

/// Points of the ellipse with these half axes in the frame's plane, from one angle to another, both
/// included; a decreasing angle runs clockwise. Radians.
std::vector<Point3> ifcArc(const IfcFrame& frame, double half_x, double half_y, double from,
                           double to);

/// An area by its boundary, even-odd.
using IfcArea = std::vector<Polygon>;

/// The boundary of a profile (IfcProfileDef), in its own plane. Sections of steel are their
/// bounding rectangles, rounded corners are sharp. Others are UnreadGeometry.
IfcArea ifcProfile(const IfcFrames& frames, StepId id, int depth = 0);

/// A closed curve as a polygon without repeated neighbours; empty for fewer than three corners.
Polygon ifcPolygon(const std::vector<Point3>& points);

}  // namespace ispace
