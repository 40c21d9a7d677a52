// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "draw/picture.h"
#include "layout/scene.h"
#include "plan/found_rooms.h"

namespace ispace {

struct PlanOptions {
    PictureFormat format = PictureFormat::Png;
    std::optional<double> slice = {};  ///< only the obstacle map at this height, in metres
    int width = 1200;                  ///< of a PNG, in pixels
    std::string title;                 ///< e.g. base name of ENV; "" for none
    /// Rooms of an import: those not kept are faint, with area and --inside point; gaps that were
    /// closed are marked. Null: none; not used with `slice`.
    const FoundRooms* found = nullptr;
};

/// The scene from above, as a plan: floor, zones, walls (cut as plans are, with their thickness),
/// doors, windows, things in the colours of their materials, sensors with what they face, robots,
/// people, names, a grid of 1 m (coarser where that would be a grey area) and its coordinates, a
/// bar of scale. Walls' lines without thickness are drawn with a pen.
///
/// With `slice` the obstacle map at that height in the same frame: free floor, solids, sheets.
///
/// SVG and PDF: to scale, on paper of A3 or less at the largest usual scale that fits (or smaller
/// scales for plans of a town), in millimetres. SVG has a layer a type, as Inkscape knows them, and
/// every element is a group with its id and a title. Equal scenes give equal bytes. O(n log n).
/// \throws UsageError for a width that cannot be laid out (200 to 12000)
std::string drawPlan(const Scene& scene, const PlanOptions& options);

}  // namespace ispace
