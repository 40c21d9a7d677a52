// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/extensions/ifc/reader: the bodies of products as faces, with volumes to subtract.
// Metres. Mapped shapes are read once and kept, up to a number of corners.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/budget.h"
#include "extensions/ifc/reader/ifc_curves.h"

namespace ispace::ifc {

/// Plane faces in space, each of one or more loops (even-odd), not necessarily closed.
struct IfcFaces {
    std::vector<Point3> corners;
    std::vector<std::uint32_t> loop_ends;  ///< index behind the last corner of each loop
    std::vector<std::uint32_t> face_ends;  ///< index behind the last loop of each face

    void addLoop(std::span<const Point3> loop);
    void endFace() { face_ends.push_back(static_cast<std::uint32_t>(loop_ends.size())); }
    void move(const IfcFrame& frame);
};

/// A volume subtracted from a solid: a half-space, the inside of a closed surface, or their
/// intersection.
struct IfcCut {
    struct HalfSpace {
        Point3 at;    ///< on its plane
        Vec3 normal;  ///< out of the subtracted half
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
    /// \param work pays for shapes that are read, mapped and cut; outlives this object
    IfcShapes(const IfcFrames& frames, Budget& work)
        : frames_(frames), work_(work), curves_(frames, work) {}

    /// Reads the body of a product in its own frame: from its IfcProductDefinitionShape the
    /// representation `Body`, else another one with solids; if there is none, its footprint, 2.5 m
    /// high, or its box. Counts unsupported parts. \param is_hole the representation `Reference`,
    /// in which openings of tessellated walls have their volume, serves, too
    /// \throws std::runtime_error for more than kMaxCorners, and if shapes require more work
    /// than is left
    IfcShape shapeOf(StepId definition, bool is_hole = false);
    /// Takes the work for solids that are read, copied or cut again.
    /// \throws std::runtime_error, which begins with the cause, if it is more than is left
    void pay(std::span<const IfcSolid> part, const char* cause);
    /// Returns the numbers of unsupported parts, by type.
    [[nodiscard]] const std::map<std::string, std::size_t>& unread() const { return unread_; }
    /// Returns these, and forgets them.
    std::map<std::string, std::size_t> takeUnread() { return std::exchange(unread_, {}); }

    static constexpr std::size_t kMaxCorners = 20'000'000;  ///< of a shape

  private:
    /// A shape and the number of its corners, those of its cuts included.
    struct Growing {
        IfcShape solids;
        std::size_t corners = 0;
    };

    void addItems(const StepInstance& representation, Growing& shape, int depth);
    void addItem(StepId id, Growing& shape, int depth);
    void addMapped(const StepInstance& item, Growing& shape, int depth);
    void addBoolean(const StepInstance& result, Growing& shape, int depth);
    [[nodiscard]] IfcCut cutBy(StepId operand, bool keeps_inside, int depth);

    void append(Growing& shape, const Growing& part, const IfcFrame& frame);
    void pay(std::size_t solids, std::size_t corners, const char* cause);

    const IfcFrames& frames_;
    Budget& work_;
    IfcCurves curves_;
    std::map<std::string, std::size_t> unread_;
    std::unordered_map<StepId, std::shared_ptr<const Growing>> mapped_;  // null: being read
    std::size_t kept_ = 0;                                               // corners in mapped_
};

/// Reads the faces of an item that is no boolean result and not mapped, and pays for them.
/// \throws UnreadGeometry
IfcFaces ifcFaces(IfcCurves& curves, const StepInstance& item);

}  // namespace ispace::ifc
