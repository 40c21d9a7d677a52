// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/kernel/env: finds the walls in which doors and windows are, for openings.h. Offsets
// and ends count along the drawn line of a wall, in metres. Decisions depend on the records alone;
// those that fail are findings at the key at fault.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "env/environment.h"
#include "env/walls.h"
#include "geom/spatial_index.h"
#include "record/record.h"

namespace ispace {

/// The position given for an opening lies on a wall if it is at most this far from its line, or
/// from the faces of a thick wall.
constexpr double kNearWall = 0.3, kNearFace = 0.1;

/// The wall line of an opening, and its ends along the line; they may exceed the line's.
struct OpeningSite {
    std::size_t line = 0;
    double from = 0, to = 0;
};

/// Finds the wall lines that `door` and `window` records name: by the wall's id and an offset, by a
/// point, or by both ends. A point must lie within kNearWall of a line or kNearFace of a face, else
/// the finding names the nearest wall. Of lines equally near, within kWeldDistance, the one counts
/// that the opening fits best, then the first. The grid of lines is built at the first use: not
/// thread-safe.
class OpeningSites {
  public:
    /// Stores its arguments by reference.
    OpeningSites(std::span<const Element> elements, const WallPlan& plan, Diagnostics& findings);

    /// Finds the line of an opening. Empty, with a finding, if the record gives no position on a
    /// wall or several; empty, without one, if its wall has no lines. O(log n) if lines do not
    /// crowd.
    [[nodiscard]] std::optional<OpeningSite> find(const Element& opening) const;

  private:
    /// The candidate lines of a record.
    struct Lines {
        std::size_t first = 0, last = 0;
        const Element* wall = nullptr;  ///< owner of the lines, if `wall` names it
    };

    [[nodiscard]] const SegmentGrid& grid() const;
    /// Returns the id of an element, for the table of ids.
    struct IdOfElement {
        std::span<const Element> elements;
        std::string_view operator()(std::size_t i) const { return elements[i].id; }
    };

    void fail(const Element& opening, std::string_view key, std::string message) const;
    [[nodiscard]] bool hasOnePlace(const Record& record) const;
    [[nodiscard]] std::optional<Lines> linesOf(const Element& opening) const;
    [[nodiscard]] std::string hintFor(const std::string& id) const;
    [[nodiscard]] std::optional<OpeningSite> byOffset(const Element& opening,
                                                      const Lines& lines) const;
    [[nodiscard]] std::optional<OpeningSite> byPoint(const Element& opening,
                                                     const Lines& lines) const;
    [[nodiscard]] std::optional<OpeningSite> byEnds(const Element& opening,
                                                    const Lines& lines) const;
    [[nodiscard]] double along(std::size_t line, Point2 p) const;
    [[nodiscard]] double excess(const OpeningSite& site) const;
    [[nodiscard]] double reach(std::size_t line) const;
    [[nodiscard]] bool isParallel(std::size_t line, Vec2 direction, double within) const;
    template <typename Allowed, typename Off, typename SiteOn>
    [[nodiscard]] std::optional<OpeningSite> nearest(Point2 p, Allowed allowed, Off off,
                                                     SiteOn site_on) const;
    template <typename Allowed>
    void reportNearest(const Element& opening, std::string_view key, Point2 p, const Lines& lines,
                       Allowed allowed) const;

    std::span<const Element> elements_;
    const WallPlan& plan_;
    Diagnostics& findings_;
    mutable std::optional<SegmentGrid> grid_;  // built at the first use
    std::vector<double> starts_;  // sums of the lengths of all lines before each; then the total
    IdTable<IdOfElement> by_id_;
};

}  // namespace ispace
