// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geom/polygon.h"
#include "io/ifc/ifc_frames.h"

namespace ispace {

/// Maximum distance of chords from their arcs, in metres.
constexpr double kIfcChordError = 5e-5;

/// Computes the points of a bounded curve, in its own frame; closed ones end at their first point
/// or one before. Reads polylines, indexed poly-curves, composite curves, circles and ellipses and
/// their parts, parts of lines. Throws UnreadGeometry for B-splines and for curves nested too deep.
std::vector<Point3> ifcCurve(const IfcFrames& frames, StepId id, int depth = 0);

/// Computes points of the ellipse with these half axes in the frame's plane, from one angle to
/// another, both included; a decreasing angle runs clockwise. Radians.
std::vector<Point3> ifcArc(const IfcFrame& frame, double half_x, double half_y, double from,
                           double to);

/// An area by its boundary, even-odd.
using IfcArea = std::vector<Polygon>;

/// Computes the boundary of a profile (IfcProfileDef), in its own plane. Sections of steel become
/// their bounding rectangles, rounded corners sharp. Throws UnreadGeometry for others.
IfcArea ifcProfile(const IfcFrames& frames, StepId id, int depth = 0);

/// Converts a closed curve to a polygon without repeated neighbours; empty for fewer than three
/// corners.
Polygon ifcPolygon(const std::vector<Point3>& points);

}  // namespace ispace
