// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/dxf_drawing.h"
#include "io/plan_lines.h"

namespace ispace {

/// From one end of a straight piece or an arc to the other; an arc has its centre, about which a
/// door turns.
struct PlanChord {
    Segment2 line;
    std::optional<Point2> center;
};

/// An entity as it lies in the plan, in metres.
struct PlanShape {
    PlanPath path;  ///< arcs as straight pieces, a millimetre off at most (radii to 10 km)
    std::vector<PlanChord> chords;
    std::string layer;
};

/// Blocks that are in no file (an outside reference that was not bound), and how often.
using MissingBlocks = std::map<std::string, std::size_t>;

/// Whether what is on a layer is used.
using LayerFilter = std::function<bool(const std::string&)>;

/// The drawing with all blocks put where they are inserted, entities on layer 0 of a block on the
/// layer of its insert. Points, plus blocks inserted, are limited to `most`, and to a number that
/// grows with the file, so that no small file becomes a large plan.
/// Shapes on layers that are not `wanted` have no points, and count only where blocks repeat them.
/// \throws FormatError with the entity's line: blocks that contain themselves, too many points,
///         places beyond 900 km
std::vector<PlanShape> shapesOf(const DxfDrawing& drawing, double metres_per_unit,
                                const std::string& name, std::size_t most, MissingBlocks& missing,
                                const LayerFilter& wanted = {});

}  // namespace ispace
