// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "env/enclosure.h"
#include "env/known_order.h"
#include "env/openings.h"
#include "env/walls.h"
#include "geom/planar_map.h"

namespace ispace {

/// Everything that DerivedWalls follow from, as a hash (XXH3, 128 bits) with the version of the
/// derivation. It tells plans apart; it does not keep anybody from making one that fits.
struct WallsKey {
    std::uint64_t low = 0, high = 0;
    friend bool operator==(const WallsKey&, const WallsKey&) = default;
};

/// Of the lines and heights of walls, which of them are one closed fence, openings and inside
/// points: bit by bit, so that equal keys mean equal results. O(walls)
WallsKey keyOf(const WallPlan& plan, std::span<const Element> elements,
               std::span<const Opening> openings, std::span<const Record* const> inside);

/// What takes longest to find about walls, and is quickly read again: how their lines are welded,
/// what they enclose, the triangles of its floor, and how rays find lines.
struct DerivedWalls {
    using Triangles = std::vector<std::array<std::uint32_t, 3>>;

    WeldedLines welded;
    Enclosure enclosure;
    /// Of each part of the region, as triangulate() numbers its vertices; empty: not known.
    std::vector<Triangles> floor;
    /// Of the lines at the usual height, walls and things; null: not known.
    std::shared_ptr<const KnownOrder> order;
};

/// The same where an environment has it.
struct DerivedView {
    std::span<const Segment2> pieces;     ///< of the welded lines
    std::span<const std::size_t> source;  ///< of each piece
    const Regions& indoor;
    Point2 inside;
    std::span<const Triangulation> floor;
    const KnownOrder& order;
};

/// Results as they are kept in a file, little-endian: a checksum of all that follows, the key,
/// then of welding what it changed. \pre they follow from the plan that the key is of
std::string storedWalls(const WallsKey& key, std::span<const Segment2> lines,
                        const DerivedView& derived);

/// What storedWalls() wrote; nothing if it was written for another plan or by another version, or
/// is damaged. Whatever the bytes are, each index is within its list, each curve has an area, lies
/// within the plan and on the side it should, and no line is farther off than welding moves it.
/// O(bytes + lines)
std::optional<DerivedWalls> restoredWalls(std::string_view bytes, const WallsKey& key,
                                          std::span<const Segment2> lines);

/// Puts the right checksum in front of stored bytes that somebody changed: for tests.
void seal(std::string& stored);

}  // namespace ispace
