// SPDX-License-Identifier: GPL-3.0-or-later
// Covers of rows by candidates, as set covers (arrange/search): few rounds of local search, since
// the next round sees what a cover misses. Views are star-shaped polygons; a candidate sees a row
// unless it is farther from its view than rounding.
#include "extensions/proofs/gallery/guard_search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <set>
#include <utility>

#include "arrange/search/set_cover.h"
#include "extensions/proofs/gallery/gallery.h"
#include "geom/arrangement.h"

namespace ispace::proofs::gallery {

namespace {

// Of local search, for each cover.
constexpr std::uint64_t kSearchSteps = 2000, kLongSearchSteps = 50'000;

/// Regions thinner than this, as area over half of the outline, are slivers: rounding alone leaves
/// them.
constexpr double kSliverWidth = 0x1p-20;

GuardCandidate candidateAt(const Floor& floor, const WindowVertex& vertex) {
    const VisibleRegion region = floor.viewFrom(vertex.at);
    return {StarView(region, floor.walls()), vertex.error};
}

}  // namespace

void GuardSearch::addCandidates(std::span<const WindowVertex> points, const Progress* progress) {
    const auto less = [](Point2 a, Point2 b) { return lexLess(a, b); };
    std::set<Point2, decltype(less)> known(less);
    for (const GuardCandidate& candidate : candidates_) known.insert(candidate.view.viewpoint());
    std::vector<WindowVertex> fresh;
    for (const WindowVertex& vertex : points)
        if (known.insert(vertex.at).second) fresh.push_back(vertex);
    std::vector<std::optional<GuardCandidate>> made(fresh.size());
    std::vector<std::vector<std::uint32_t>> seen(fresh.size());
    tbb::parallel_for(std::size_t{0}, fresh.size(), [&](std::size_t i) {
        if (progress != nullptr && progress->stopped()) return;
        made[i] = candidateAt(floor_, fresh[i]);
        seen[i] = rowsOf(*made[i]);
    });
    for (std::size_t i = 0; i < fresh.size(); ++i) {
        if (!made[i]) continue;
        candidates_.push_back(std::move(*made[i]));
        seen_.push_back(std::move(seen[i]));
    }
}

bool GuardSearch::sees(const GuardCandidate& candidate, const Row& row) {
    return row.witness
               ? row.witness->mayHold(candidate.view.viewpoint(), candidate.error + kOneLine)
               : candidate.view.mayHold(row.at, 0);
}

std::vector<std::uint32_t> GuardSearch::rowsOf(const GuardCandidate& candidate) const {
    std::vector<std::uint32_t> rows;
    const auto add_seen = [&](std::uint32_t row) {
        if (sees(candidate, rows_[row])) rows.push_back(row);
    };
    witnesses_.forEachNear(candidate.view.viewpoint(), candidate.error + kOneLine,
                           [&](std::uint32_t witness) { add_seen(witness_rows_[witness]); });
    for (const std::uint32_t row : point_rows_) add_seen(row);
    std::sort(rows.begin(), rows.end());
    return rows;
}

void GuardSearch::addRow(Point2 p) { add({p, std::nullopt}); }
void GuardSearch::addRow(const StarView& witness) { add({witness.viewpoint(), witness}); }

void GuardSearch::add(Row row) {
    const auto number = static_cast<std::uint32_t>(rows_.size());
    for (std::size_t i = 0; i < candidates_.size(); ++i)
        if (sees(candidates_[i], row)) seen_[i].push_back(number);
    (row.witness ? witness_rows_ : point_rows_).push_back(number);
    if (row.witness) witnesses_.add(*row.witness);
    rows_.push_back(std::move(row));
}

GuardSearch::Found GuardSearch::coverRows(std::size_t enough, Progress& progress) const {
    SetCover cover;
    cover.rows = rows_.size();
    cover.columns = seen_;
    cover.costs.assign(seen_.size(), 1);
    // A cover that is not proven the smallest costs a round at most; proofs would take far longer.
    SetCoverOptions options{.steps = kSearchSteps, .tries = 1, .proves = false};
    SetCoverResult result = minimumSetCover(cover, options, progress);
    options = {.steps = kLongSearchSteps, .tries = 2, .proves = false};
    if (result.cost > std::max<std::uint64_t>(enough, result.bound) && !progress.stopped())
        result = minimumSetCover(cover, options, progress);
    Found found;
    if (!result.is_coverable) return found;
    found.guards = result.chosen;
    measure(found);
    return found;
}

void GuardSearch::measure(Found& found) const {
    std::vector<Polygon> solids;
    solids.reserve(found.guards.size());
    for (const std::uint32_t guard : found.guards)
        solids.push_back(candidates_[guard].view.outline());
    found.missed.clear();
    found.missed_area = 0;
    for (const Region& region : floor_.regions())
        for (Region& missed : difference(region, solids)) {
            const double area = missed.area();
            found.missed_area += area;
            if (area > kSliverWidth * missed.boundaryLength() / 2)
                found.missed.push_back(std::move(missed));
        }
}

bool GuardSearch::isCovered(const Found& found) const {
    return !found.guards.empty() && found.missed_area <= kMissedShare * floor_.area();
}

void GuardSearch::addGreedily(const std::vector<Point2>& points, Found& found) const {
    std::vector<std::vector<std::uint32_t>> seen(candidates_.size()), seen_by(points.size());
    tbb::parallel_for(std::size_t{0}, candidates_.size(), [&](std::size_t i) {
        for (std::uint32_t p = 0; p < points.size(); ++p)
            if (candidates_[i].view.mayHold(points[p], 0)) seen[i].push_back(p);
    });
    std::vector<std::size_t> counts(candidates_.size());
    for (std::uint32_t i = 0; i < candidates_.size(); ++i) {
        counts[i] = seen[i].size();
        for (const std::uint32_t p : seen[i]) seen_by[p].push_back(i);
    }
    std::vector<char> is_seen(points.size());
    for (;;) {
        const auto best = std::max_element(counts.begin(), counts.end());
        if (best == counts.end() || *best == 0) return;
        const auto guard = static_cast<std::uint32_t>(best - counts.begin());
        found.guards.push_back(guard);
        for (const std::uint32_t p : seen[guard]) {
            if (std::exchange(is_seen[p], 1) != 0) continue;
            for (const std::uint32_t other : seen_by[p]) --counts[other];
        }
    }
}

void GuardSearch::complete(Found& found) {
    if (found.guards.empty()) measure(found);
    double before = 2 * floor_.area();
    while (!isCovered(found) && !found.missed.empty() && found.missed_area < before) {
        before = found.missed_area;
        std::vector<Point2> open;
        for (const Region& region : found.missed) open.push_back(interiorPoint(region));
        std::vector<WindowVertex> here;
        here.reserve(open.size());
        for (const Point2 p : open) here.push_back({p, 0});
        addCandidates(here, nullptr);
        addGreedily(open, found);
        measure(found);
    }
    std::sort(found.guards.begin(), found.guards.end());
    found.guards.erase(std::unique(found.guards.begin(), found.guards.end()), found.guards.end());
}

}  // namespace ispace::proofs::gallery
