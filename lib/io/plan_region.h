// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// The part of a plan that is imported: one face of its lines, or several that doors join.
struct PlanRegion {
    std::vector<Region> rooms;  ///< the largest first
    Point2 inside;              ///< a point of the first, clear of its walls

    [[nodiscard]] double area() const;
};

/// The faces of a plan's lines, those that doors join taken together.
class PlanFaces {
  public:
    /// Welded pieces: of walls, and of closings where no wall lies on them, in the order of these.
    struct Pieces {
        std::vector<Segment2> walls, closings;
        std::vector<std::size_t> closing_of;  ///< index of the closing that a piece comes from
    };
    static Pieces weldedPieces(std::span<const Segment2> walls, std::span<const Segment2> closings);

    /// Faces that hang together: indices of faces(), the largest first.
    struct Group {
        std::vector<std::size_t> faces;
        double area = 0;
    };

    /// \param doors lines across which one can pass: among the walls, or on them
    /// \param closings lines across gaps between walls: they bound what they separate from the
    ///        outside of everything, and nothing else
    explicit PlanFaces(std::span<const Segment2> walls, std::span<const Segment2> doors = {},
                       std::span<const Segment2> closings = {});
    /// The same of pieces, with the first so many pieces of closings.
    PlanFaces(const Pieces& pieces, std::span<const Segment2> doors, std::size_t closing_pieces);

    [[nodiscard]] const std::vector<Region>& faces() const { return faces_; }
    /// By falling area.
    [[nodiscard]] const std::vector<Group>& groups() const { return groups_; }
    /// The group that holds the point strictly inside one of its faces.
    [[nodiscard]] const Group* groupAt(Point2 p) const;
    /// True if nothing wider than a wall fits into any of its faces: what lies between the two
    /// lines of a wall, and never a room.
    [[nodiscard]] bool isHollow(const Group& group) const;
    /// Corners of the solid between the two lines of a wall, as seen from the floor.
    [[nodiscard]] std::vector<Point2> wallCorners() const;
    [[nodiscard]] PlanRegion region(const Group& group) const;
    /// The part of the region's boundary that lies on closings alone.
    [[nodiscard]] std::vector<Segment2> closedBy(const PlanRegion& region) const;

  private:
    void takeFaces(std::span<const Segment2> doors);
    void makeGroups(std::span<const Segment2> doors);
    [[nodiscard]] std::optional<std::size_t> faceAt(Point2 p) const;

    std::vector<Segment2> walls_;
    std::vector<Segment2> closings_;  // pieces of them that lie on no wall
    std::vector<Region> faces_;
    std::vector<Box2> boxes_;
    std::vector<Group> groups_;
    double thinnest_ = 0;  // radius of the disc that fits into a room
};

/// For each line, whether it bounds one of the regions' rooms or lies in it, with its middle or an
/// end.
std::vector<bool> belongsTo(std::span<const PlanRegion> regions, std::span<const Segment2> lines);

/// True if the lines cross each other so often that their faces would take hours: no plan does.
/// Judged by a sample, the same one at every call.
bool crossTooOften(std::span<const Segment2> lines);

}  // namespace ispace
