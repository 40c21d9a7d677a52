// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/extensions/proofs/gallery: covers of the floor by candidates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/error.h"
#include "extensions/proofs/gallery/star_view.h"
#include "extensions/proofs/gallery/view_cells.h"
#include "extensions/proofs/gallery/witness_sets.h"

namespace ispace::proofs::gallery {

/// A point that may become a guard, in scaled units.
struct GuardCandidate {
    StarView view;
    double error;  ///< bounds the distance from the point of which witnesses are known
};

/// The fewest guards among candidates.
class GuardSearch {
  public:
    explicit GuardSearch(const Floor& floor) : floor_(floor), witnesses_(floor) {}

    /// Adds candidates that are not known yet; views are computed in parallel.
    /// \param progress if it says stop, adds no more of them; null: adds all
    void addCandidates(std::span<const WindowVertex> points, const Progress* progress);
    /// Adds a point that guards must see; \pre in the interior of what earlier covers missed
    void addRow(Point2 p);
    /// Adds a witness: seen by the candidates within rounding of its view.
    void addRow(const StarView& witness);

    /// A cover of the floor, or of all rows alone.
    struct Found {
        std::vector<std::uint32_t> guards;  ///< candidates; empty: some row is seen by none
        std::vector<Region> missed;         ///< regions of the floor, larger than slivers
        double missed_area = 0;             ///< with slivers
    };
    /// Finds few candidates that see all rows, and the floor that these leave unseen.
    /// \param enough guards: fewer are not searched for
    [[nodiscard]] Found coverRows(std::size_t enough, Progress& progress) const;
    /// Adds guards until the floor is covered: greedily, candidates that see most points of missed
    /// regions, and these points themselves.
    void complete(Found& found);

    [[nodiscard]] Point2 pointOf(std::uint32_t candidate) const {
        return candidates_[candidate].view.viewpoint();
    }
    [[nodiscard]] std::size_t candidates() const { return candidates_.size(); }
    /// True if the area is within the measure of a cover.
    [[nodiscard]] bool isCovered(const Found& found) const;

  private:
    struct Row {
        Point2 at;
        std::optional<StarView> witness;
    };
    void add(Row row);
    static bool sees(const GuardCandidate& candidate, const Row& row);
    /// Returns the rows that a candidate sees, ascending.
    [[nodiscard]] std::vector<std::uint32_t> rowsOf(const GuardCandidate& candidate) const;
    /// Adds candidates that see these points, those that see most first.
    void addGreedily(const std::vector<Point2>& points, Found& found) const;
    void measure(Found& found) const;

    const Floor& floor_;
    std::vector<GuardCandidate> candidates_;
    std::vector<Row> rows_;
    ViewCells witnesses_;
    std::vector<std::uint32_t> witness_rows_, point_rows_;
    std::vector<std::vector<std::uint32_t>> seen_;  // rows, by candidate; ascending
};

}  // namespace ispace::proofs::gallery
