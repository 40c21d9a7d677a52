// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/extensions/proofs/gallery: the sets of witnesses that single points may see.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/error.h"
#include "extensions/proofs/gallery/star_view.h"

namespace ispace::proofs::gallery {

/// A point whose guard must be seen, in scaled units.
struct Witness {
    StarView view;
    std::vector<Window> windows;
};

/// A vertex of the arrangement of windows, and a bound of its distance from the true one.
struct WindowVertex {
    Point2 at;
    double error = 0;
};

/// A set of witnesses, and points that may see exactly these.
struct WitnessSet {
    std::vector<std::uint32_t> witnesses;  ///< ascending
    std::vector<WindowVertex> points;
};

/// Computes sets of witnesses such that each point of the floor sees a subset of one of them, none
/// a subset of another; in an order that depends only on the input.
///
/// The windows of all witnesses divide the floor into faces whose points see the same witnesses.
/// The region of a witness is closed, so the vertices of a face see all that its points see:
/// ends of walls, ends of windows and crossings of windows suffice. The set of a vertex holds all
/// witnesses whose region comes within the error of the vertex, so it may be too large, never too
/// small. O(windows + crossings * witnesses); nullopt if progress says stop before all are known.
std::optional<std::vector<WitnessSet>> largestWitnessSets(const Floor& floor,
                                                          std::span<const Witness> witnesses,
                                                          const Progress& progress);

/// Finds the vertices of the arrangement of windows and walls; some of them if progress says stop.
std::vector<WindowVertex> windowVertices(const Floor& floor, std::span<const Witness> witnesses,
                                         const Progress& progress);

}  // namespace ispace::proofs::gallery
