// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/extensions/ifc/reader: curves and profiles of IFC as points, arcs as chords.
// Metres.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <unordered_map>
#include <vector>

#include "base/budget.h"
#include "extensions/ifc/reader/ifc_frames.h"
#include "geom/polygon.h"

namespace ispace::ifc {

/// Maximum distance of chords from their arcs, in metres.
constexpr double kIfcChordError = 5e-5;

/// An area by its boundary, even-odd.
using IfcArea = std::vector<Polygon>;

/// Reads lists of points, curves and profiles, each once however many elements share it, and pays
/// for them before the work is done. A curve that consists of others pays for their points again
/// for each use, as it repeats them.
///
/// All throw std::runtime_error, which begins with the cause, for more work than is left.
class IfcCurves {
  public:
    using Points = std::vector<Point3>;

    /// Stores the references.
    IfcCurves(const IfcFrames& frames, Budget& work) : frames_(frames), work_(work) {}

    [[nodiscard]] const IfcFrames& frames() const { return frames_; }
    void pay(std::uint64_t units, const char* cause);

    /// Reads an IfcCartesianPointList.
    std::shared_ptr<const Points> points(StepId list);
    /// Computes the points of a bounded curve, in its own frame; closed ones end at their first
    /// point or one before. Reads polylines, indexed poly-curves, composite curves, circles and
    /// ellipses and their parts, parts of lines. Throws UnreadGeometry for B-splines and for curves
    /// nested too deep.
    std::shared_ptr<const Points> curve(StepId id);
    /// Computes the boundary of a profile (IfcProfileDef), in its own plane. Sections of steel
    /// become their bounding rectangles, rounded corners sharp. Throws UnreadGeometry for others.
    std::shared_ptr<const IfcArea> profile(StepId id);

    /// Points that are copied in the time of one unit of Budget.
    static constexpr std::size_t kPointsPerUnit = 4;

  private:
    /// A result with the units that it takes where it is repeated; null while it is computed.
    template <typename T>
    struct Made {
        std::shared_ptr<const T> result;
        std::uint64_t units = 0;
    };
    template <typename T>
    using Known = std::unordered_map<StepId, Made<T>>;

    template <typename T>
    Made<T> make(Known<T>& known, StepId id, int depth, const char* kind,
                 const std::function<std::uint64_t(T&)>& compute);
    Made<Points> curveAt(StepId id, int depth);
    Made<IfcArea> profileAt(StepId id, int depth);
    std::uint64_t addCurve(StepId id, int depth, Points& points);
    std::uint64_t addProfile(StepId id, int depth, IfcArea& area);
    Points indexedCurve(const StepInstance& curve);

    const IfcFrames& frames_;
    Budget& work_;
    Known<Points> lists_, curves_;
    Known<IfcArea> profiles_;
    std::size_t kept_ = 0;  // points in them
};

/// Computes points of the ellipse with these half axes in the frame's plane, from one angle to
/// another, both included; a decreasing angle runs clockwise. Radians.
std::vector<Point3> ifcArc(const IfcFrame& frame, double half_x, double half_y, double from,
                           double to);

/// Converts a closed curve to a polygon without repeated neighbours; empty for fewer than three
/// corners.
Polygon ifcPolygon(const std::vector<Point3>& points);

}  // namespace ispace::ifc
