// SPDX-License-Identifier: GPL-3.0-or-later
// A room as a level laser sees it: lines and solids at one height. The cut of a mesh is exact up to
// one rounding of each point: the plane passes vertices at its height by an infinitesimal, so
// curves of closed surfaces close, and triangles that share an edge share the point (H.
// Edelsbrunner, E. P. Mücke, Simulation of simplicity, 1990, is the general method).
//
//     const Slice slice = environment.slice(0.3);
//     slice.forEachLine([&](const Segment2& line) { lines.push_back(line); });
#pragma once

#include <cstddef>
#include <vector>

#include "geom/curve.h"
#include "geom/polygon.h"

namespace ispace {

struct Body;

/// The cut through all bodies at one height, or the band between two heights, as seen from above.
struct Slice {
    std::vector<Segment2> sheets;  ///< walls without thickness
    std::vector<Polygon> solids;   ///< closed sets, counter-clockwise; may overlap
    /// The ellipse of a solid; the solid is outlineOf() the ellipse, a polygon of the same area.
    struct Round {
        Ellipse curve;
        std::size_t solid = 0;  ///< index in `solids`
        friend bool operator==(const Round&, const Round&) = default;
    };
    std::vector<Round> rounds = {};  ///< ascending by solid; empty in a band
    /// Indices in Environment::elements(); empty in a slice without an environment.
    std::vector<std::size_t> sheet_owners = {}, solid_owners = {};

    /// Calls visit(Segment2) for every line that stops a beam: sheets, then edges of solids.
    template <typename Visit>
    void forEachLine(Visit visit) const;
    /// Calls visit as forEachLine() does, but skips the edges of round solids.
    template <typename Visit>
    void forEachStraightLine(Visit visit) const;
    [[nodiscard]] std::vector<Segment2> lines() const;
    [[nodiscard]] std::vector<Segment2> straightLines() const;
    [[nodiscard]] std::vector<Ellipse> curves() const;
    /// Returns true if p lies in a solid or on its edge. O(n); Level answers faster.
    [[nodiscard]] bool blocked(Point2 p) const;
    friend bool operator==(const Slice&, const Slice&) = default;
};

template <typename Visit>
void Slice::forEachLine(Visit visit) const {
    for (const Segment2& sheet : sheets) visit(sheet);
    for (const Polygon& solid : solids) forEachEdge(solid, visit);
}

template <typename Visit>
void Slice::forEachStraightLine(Visit visit) const {
    for (const Segment2& sheet : sheets) visit(sheet);
    auto round = rounds.begin();
    for (std::size_t i = 0; i < solids.size(); ++i) {
        if (round != rounds.end() && round->solid == i)
            ++round;
        else
            forEachEdge(solids[i], visit);
    }
}

/// Adds the exact cut of the body's meshes (`Body::meshes`, not its prisms) by the plane z = height
/// to `out`; stores `owner` for each piece.
///
/// Joins loops along the edges that triangles share, never by distance. The interior of a closed
/// mesh becomes solids; a cavity is a loop within the polygon, reached by a seam of no width (there
/// and back along the same line, inside the solid), which keeps blocked(), difference() and beams
/// correct. The curve of an open surface becomes sheets. Meshes are closed sets, as prisms are: a
/// level face counts at its height, whichever side of it is solid; a level face of an open mesh
/// does not, like a plate. O(triangles + k log k) for k triangles that are cut.
void cutMeshes(const Body& body, double height, Slice& out, std::size_t owner = 0);

/// Adds the projection of the body's meshes between two heights, ends included: the cut at
/// `bottom`, and each triangle clipped to the heights, as a solid, or as a sheet if it is upright.
/// Stores `owner` for each piece. O(triangles). \pre bottom <= top
void bandOfMeshes(const Body& body, double bottom, double top, Slice& out, std::size_t owner);

}  // namespace ispace
