// SPDX-License-Identifier: GPL-3.0-or-later
// Plans drawn as lines: welds ends that nearly meet, finds the rooms between walls, and the gaps
// that keep walls from enclosing a room.
//
// Lines come as drawn: given by length and heading, rounded to the micrometre, crossing, doubled,
// dangling. Results depend on the lines alone. Pure functions: thread-safe. Errors name no line of
// a file; callers that know the file add it.
//
//     const WeldedLines walls = weld(drawn);
//     const std::vector<Region> rooms = boundedFaces(walls);
//     if (rooms.empty())
//         if (const auto gap = findGap(drawn, std::nullopt)) report(gap->place, gap->width);
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geom/polygon.h"
#include "geom/tolerance.h"

namespace ispace {

/// End points nearer than this are one point, and an end point this near to another line lies
/// on it: walls given by length and heading meet as drawn in spite of rounding.
constexpr double kWeldDistance = kCornerTolerance;

/// The lines with nearby end points merged, split where an end point of another line touches them
/// (within kWeldDistance); zero-length pieces are dropped. `source[i]` is the index of the line
/// that piece i comes from; the pieces of a line keep its order.
///
/// Ends are taken from left to right; each joins the nearest representative in reach or becomes
/// one, so no end moves by more than kWeldDistance, however long a chain of near points is.
/// Crossings away from ends are not cut: boundedFaces() does that. Deterministic; O((n + touches)
/// log n) for lines that are short or mostly run in two directions at right angles. \throws
/// FormatError (without a line number) if lines overlap by the million, or if very many long lines
/// run in all directions
struct WeldedLines {
    std::vector<Segment2> pieces;
    std::vector<std::size_t> source;
};
WeldedLines weld(std::span<const Segment2> lines);

/// The bounded faces into which lines divide the floor: exact where lines meet at common ends only,
/// else with crossings rounded to doubles.
///
/// Lines may cross, overlap and dangle. A face's outline is the outer boundary of an open connected
/// piece of the floor; its holes enclose the lines within. Dangling and isolated lines bound no
/// face and are skipped. The order of faces depends only on the lines. O((n + crossings) log n).
/// See noded() in arrangement.h for the rounding of crossings.
/// \throws FormatError (without a line number) for lines that cross by the million
std::vector<Region> boundedFaces(const WeldedLines& lines);

/// Builds faces likewise, but merges the faces on the two sides of a passage if both are bounded
/// and no line lies on the passage. A passage cuts lines and is cut like a wall, but separates no
/// faces. \throws FormatError as boundedFaces(lines)
std::vector<Region> boundedFaces(std::span<const Segment2> lines,
                                 std::span<const Segment2> passages);

/// A line that closes a gap between two lines.
struct Closing {
    Segment2 line;     ///< from the lexically smaller end on
    double width;      ///< its length
    std::size_t a, b;  ///< indices of the two lines that do not meet, a <= b
};

/// Ways to close gaps: from each loose end of a line, and from each of the `corners` (points on
/// lines), to the nearest points of other lines; up to four each, none longer than `widest`.
/// Shortest first, in an order that depends only on the input; at most 10 000. Lengths are metres,
/// above 2 kWeldDistance: nearer ends are welded. \throws FormatError as weld()
/// O(n log n) for gaps that are narrow against the plan.
std::vector<Closing> closings(std::span<const Segment2> lines, std::span<const Point2> corners,
                              double widest);

/// The gap that keeps lines from enclosing a point.
struct Gap {
    double width;      ///< metres
    Point2 place;      ///< middle of the gap
    std::size_t a, b;  ///< indices of the two lines that do not meet
};

/// Closes gaps, narrowest first, until `inside` (or, without it, any point) is enclosed, and
/// returns the last one closed; nullopt if it is enclosed already, or if joining every dangling end
/// to its nearest lines does not enclose it. It is the widest of the gaps that must be closed.
/// Enclosed areas stay enclosed as more gaps close, so it bisects: boundedFaces() 16 times at most.
/// \throws FormatError as closings(), noded()
std::optional<Gap> findGap(std::span<const Segment2> lines, std::optional<Point2> inside);

/// A vertex position in single precision, as mesh files store it.
using FloatPlace = std::array<float, 3>;

/// Maps each position to the index of the first equal one (0 and -0 are equal). A position with a
/// NaN equals no other and maps to itself. Linear expected time for adversarial input, too, since
/// hash keys are random (O. Kaser, D. Lemire, Strongly universal string hashing is fast, 2014); the
/// result does not depend on them. \pre fewer than 2^32 - 1 positions
std::vector<std::uint32_t> firstAtPlace(std::span<const FloatPlace> places);

}  // namespace ispace
