// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/extensions/ifc/reader: coordinates, units and placements of IFC, and the relations
// of its elements. Frames are in metres and radians, whatever the units of the file.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "extensions/ifc/reader/building.h"
#include "extensions/ifc/reader/step_file.h"
#include "geom/point.h"

namespace ispace::ifc {

/// Reports geometry that is not read, by the name of its type.
class UnreadGeometry : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Maximum depth of references; UnreadGeometry is thrown for deeper ones and loops.
constexpr int kMaxIfcDepth = 300;

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 v) { return {-v.x, -v.y, -v.z}; }
/// Returns the unit vector; null for the null vector.
Vec3 unitOf(Vec3 v);

/// An affine map from local to enclosing coordinates, in metres. Axes are unit vectors except for
/// scaled and mirrored maps.
struct IfcFrame {
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    Point3 origin;

    [[nodiscard]] Vec3 turned(Vec3 v) const { return v.x * x + v.y * y + v.z * z; }
    [[nodiscard]] Point3 at(Point3 p) const { return origin + turned({p.x, p.y, p.z}); }
    /// Composes two frames: maps inner coordinates to those around this frame.
    [[nodiscard]] IfcFrame operator*(const IfcFrame& inner) const {
        return {turned(inner.x), turned(inner.y), turned(inner.z), at(inner.origin)};
    }
};

/// Factors of the units that the project assigns; 1 for unassigned ones.
struct IfcUnits {
    double length = 1;  ///< metres
    double area = 1;    ///< square metres
    double angle = 1;   ///< radians
};

/// Reads IfcUnitAssignment of the first project. Malformed units count as 1.
IfcUnits readIfcUnits(const StepFile& file);

/// Reads points, directions, axes and placements of an IFC file, in metres and radians.
///
/// All throw UnreadGeometry for chains and loops deeper than kMaxIfcDepth and for missing numbers;
/// missing placements are the identity.
class IfcFrames {
  public:
    explicit IfcFrames(const StepFile& file) : file_(file), units_(readIfcUnits(file)) {}

    [[nodiscard]] const StepFile& file() const { return file_; }
    [[nodiscard]] const IfcUnits& units() const { return units_; }
    /// Converts a length of the file to metres. \throws UnreadGeometry if it is no finite number
    [[nodiscard]] double length(const StepValue& value) const;
    /// Converts a length; a missing value means `standard`.
    [[nodiscard]] double length(const StepValue& value, double standard) const;
    /// Reads an IfcCartesianPoint of two or three coordinates.
    [[nodiscard]] Point3 point(StepId id) const;
    /// Reads a list of two or three coordinates.
    [[nodiscard]] Point3 coordinates(const StepValue& list) const;
    /// Reads an IfcDirection, not normalised. \param standard returned if the id is 0
    [[nodiscard]] Vec3 direction(StepId id, Vec3 standard) const;
    /// Reads an IfcAxis2Placement2D or 3D; id 0: the identity.
    [[nodiscard]] IfcFrame axes(StepId id) const;
    /// Reads an IfcCartesianTransformationOperator2D or 3D, also non-uniform.
    [[nodiscard]] IfcFrame transformation(StepId id) const;
    /// Computes an IfcLocalPlacement from the chain it is relative to. O(1) on average: each is
    /// stored.
    [[nodiscard]] IfcFrame placement(StepId id, int depth = 0);

  private:
    const StepFile& file_;
    IfcUnits units_;
    std::unordered_map<StepId, IfcFrame> placements_;
};

/// The relations between a building's elements, from its IfcRel… instances.
class IfcTree {
  public:
    explicit IfcTree(const StepFile& file);

    /// Finds the nearest ancestor of this type, by aggregation, containment, holes and fillings; 0
    /// without one, also in loops.
    [[nodiscard]] StepId above(StepId id, std::string_view type) const;
    /// Returns the ancestor's name, or "".
    [[nodiscard]] std::string nameAbove(StepId id, std::string_view type) const;
    /// Returns the parts of aggregates, in the order of the file.
    [[nodiscard]] const std::vector<StepId>& parts() const { return parts_; }
    /// Returns true for a part of a decomposed wall or curtain wall, also of a part of one.
    [[nodiscard]] bool isPartOfWall(StepId id) const;
    /// Returns true if it has parts.
    [[nodiscard]] bool isWhole(StepId id) const { return wholes_.contains(id); }
    /// Returns the element with this hole; 0 if the file does not say.
    [[nodiscard]] StepId hostOf(StepId hole) const;
    /// Returns the door or window in a hole, or 0.
    [[nodiscard]] StepId fillerOf(StepId hole) const;
    [[nodiscard]] bool fillsHole(StepId door) const { return filled_.contains(door); }
    /// Reads the areas of a space in quantities and properties, in the file's unit: floor areas
    /// first.
    [[nodiscard]] std::vector<StatedArea> areasOf(StepId space) const;

  private:
    void addAreas(StepId definition, std::vector<StatedArea>& areas) const;

    const StepFile& file_;
    std::unordered_map<StepId, StepId> parent_;
    std::unordered_map<StepId, StepId> whole_;  // by part
    std::unordered_set<StepId> wholes_;
    std::vector<StepId> parts_;
    std::unordered_map<StepId, StepId> host_, filler_, filled_;
    std::unordered_map<StepId, std::vector<StepId>> definitions_;  // of spaces
};

}  // namespace ispace::ifc
