// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/budget.h"
#include "io/ifc/ifc_curves.h"

namespace ispace {

/// Plane faces in space, each of one or more loops (even-odd). Nothing says that they close.
struct IfcFaces {
    std::vector<Point3> corners;
    std::vector<std::uint32_t> loop_ends;  ///< index behind the last corner of each loop
    std::vector<std::uint32_t> face_ends;  ///< index behind the last loop of each face

    void addLoop(std::span<const Point3> loop);
    void endFace() { face_ends.push_back(static_cast<std::uint32_t>(loop_ends.size())); }
    void move(const IfcFrame& frame);
};

/// What is taken away from a solid: a half-space, what a closed surface encloses, or what lies in
/// both.
struct IfcCut {
    struct HalfSpace {
        Point3 at;    ///< on its plane
        Vec3 normal;  ///< away from what is taken away
    };
    std::optional<HalfSpace> half_space;
    std::optional<IfcFaces> limit;
};

struct IfcSolid {
    IfcFaces body;
    std::vector<IfcCut> cuts;
};
using IfcShape = std::vector<IfcSolid>;

/// Reads the bodies of products: extrusions, revolutions, Breps, surfaces, face sets, blocks and
/// cylinders, clipped and mapped. Edges of advanced Breps are straight or arcs.
class IfcShapes {
  public:
    explicit IfcShapes(const IfcFrames& frames) : frames_(frames), budget_(frames.file().bytes()) {}

    /// The body of a product in its own frame: of its IfcProductDefinitionShape the representation
    /// `Body`, else another one with solids; where there is none, its footprint, 2.5 m high, or its
    /// box. Parts that are not read are counted.
    /// \throws std::runtime_error for more than kMaxCorners, and where mapped shapes come to more
    /// work than Budget has for a file of this size
    IfcShape shapeOf(StepId definition);
    /// Parts not read, by type.
    [[nodiscard]] const std::map<std::string, std::size_t>& unread() const { return unread_; }

    static constexpr std::size_t kMaxCorners = 20'000'000;  ///< of a shape

  private:
    void addItems(const StepInstance& representation, IfcShape& shape, int depth);
    void addItem(StepId id, IfcShape& shape, int depth);
    void addMapped(const StepInstance& item, IfcShape& shape, int depth);
    void addBoolean(const StepInstance& result, IfcShape& shape, int depth);
    [[nodiscard]] IfcCut cutBy(StepId operand, bool keeps_inside, int depth);

    void append(IfcShape& shape, const IfcShape& part, const IfcFrame& frame);

    const IfcFrames& frames_;
    Budget budget_;
    std::map<std::string, std::size_t> unread_;
    std::unordered_map<StepId, std::shared_ptr<const IfcShape>> mapped_;
    std::size_t kept_ = 0;  // corners in mapped_
};

/// Faces of an item that is no boolean result and not mapped. \throws UnreadGeometry
IfcFaces ifcFaces(const IfcFrames& frames, const StepInstance& item);

}  // namespace ispace
