// SPDX-License-Identifier: GPL-3.0-or-later
// The instances of an IFC4 file (ISO 16739-1, in the text of ISO 10303-21): arguments, placements,
// bodies, properties.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "env/mesh.h"
#include "geom/polygon.h"
#include "geom/pose.h"
#include "io/sdf/sdf_parts.h"

namespace ispace::ifc {

/// Quotes a string: `'` and `\` doubled, everything beyond ASCII as \X2\ or \X4\.
/// \pre text is UTF-8
std::string stepText(std::string_view text);
/// Writes a real number below 1e12 in size, rounded to 1e-12: "2.5", "6.", "1.E-05".
std::string stepReal(double value);
/// Writes "(a,b,c)".
std::string stepList(std::span<const std::string> items);
/// Computes a GUID as IFC writes it, 22 digits of base 64: the first 128 bits of the seed's sha256.
std::string ifcGuid(std::string_view seed);

/// A typed value of a property: {"Height", "IFCLENGTHMEASURE(2.3)"}.
using IfcProperty = std::pair<std::string_view, std::string>;
/// {"Area", "NetFloorArea", 12.5} is an IfcQuantityArea.
struct IfcQuantity {
    std::string_view type, name;
    double value = 0;
};

/// Collects instances; lengths are in metres, angles in degrees.
class IfcModel {
  public:
    using Id = std::size_t;

    /// Creates a file with units and the context of bodies. \param seed part of all GUIDs
    explicit IfcModel(std::string seed);

    /// Adds an instance. \param arguments as text: see stepText() and the like
    Id add(std::string_view type, std::span<const std::string> arguments);
    Id add(std::string_view type, std::initializer_list<std::string> arguments) {
        return add(type, std::span(arguments.begin(), arguments.size()));
    }
    /// Adds an instance with GlobalId, OwnerHistory, Name and Description. The GUID is the hash of
    /// seed, type and key. \param name may be ""
    Id addRooted(std::string_view type, std::string_view key, std::string_view name,
                 std::initializer_list<std::string> others);

    /// Adds a frame relative to another placement, or to the world.
    Id addPlacement(std::optional<Id> parent, const Pose3& pose);
    /// Adds the shape of meshes and parts, except parts from mesh files; returns "$" if it is
    /// empty.
    std::string addShape(std::span<const SdfPart> parts, std::span<const Mesh> meshes);
    /// Adds the shape of a region from the floor up.
    std::string addShape(const Region& region, double height);

    void addProperties(Id object, std::string_view key, std::string_view set,
                       std::span<const IfcProperty> properties);
    void addQuantities(Id object, std::string_view key, std::string_view set,
                       std::initializer_list<IfcQuantity> quantities);

    /// Returns arguments of the project.
    [[nodiscard]] std::string contexts() const { return stepList({{ref(context_)}}); }
    [[nodiscard]] std::string units() const { return ref(units_); }

    static std::string ref(Id id) { return '#' + std::to_string(id); }
    /// Writes the whole file. \param name of it
    [[nodiscard]] std::string finish(std::string_view name) const;

  private:
    Id addUnits();
    Id addPoint(std::initializer_list<double> coordinates);
    Id addDirection(Vec3 direction);
    Id addAxes(const Pose3& pose);
    Id addOutline(const Polygon& outline);
    Id addExtrusion(Id profile, const Pose3& pose, double height);
    Id addSolid(const SdfPart& part);
    Id addFaces(const Mesh& mesh);
    std::string addShape(std::string_view type, const std::vector<std::string>& items);

    std::string seed_, data_;
    Id last_ = 0;
    Id units_ = 0, context_ = 0, body_ = 0, up_ = 0, flat_ = 0;
};

}  // namespace ispace::ifc
