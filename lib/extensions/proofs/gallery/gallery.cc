// SPDX-License-Identifier: GPL-3.0-or-later
// The art gallery problem, exactly: D. C. Tozoni, P. J. de Rezende, C. C. de Souza, Algorithm 966:
// a practical iterative algorithm for the art gallery problem using integer linear programming,
// 2016. Lower bounds come from witnesses, upper ones from candidates; each round adds as witnesses
// what the last cover left unseen. Here all is in doubles: sets of witnesses may be too large by
// rounding, never too small, so bounds hold; covers may miss kMissedShare of the floor, which is
// reported.
#include "extensions/proofs/gallery/gallery.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "arrange/search/set_cover.h"
#include "extensions/proofs/gallery/guard_search.h"
#include "extensions/proofs/gallery/star_view.h"
#include "extensions/proofs/gallery/witness_sets.h"
#include "geom/predicates.h"

namespace ispace::proofs {

namespace {

using gallery::Floor;
using gallery::GuardSearch;
using gallery::StarView;
using gallery::Witness;
using gallery::WitnessSet;

constexpr std::uint64_t kBoundSteps = 2000;  // of local search, for each lower bound

/// Builds a witness at p; nullopt where its view is not generic.
std::optional<Witness> witnessAt(const Floor& floor, Point2 p) {
    const VisibleRegion region = floor.viewFrom(p);
    if (region.viewpoint != p && !floor.cornerAt(p)) return std::nullopt;  // moved to a wall
    auto windows = floor.windowsOf(region);
    if (!windows) return std::nullopt;
    return Witness{StarView(region, floor.walls()), std::move(*windows)};
}

/// Proposes the convex corners of a curve with the floor on its left, and points close to the
/// middle of edges between reflex ones. Shares are irregular, so that points are generic in regular
/// plans.
void proposeAlong(const Polygon& curve, std::vector<Point2>& points) {
    constexpr double kNear = 0x1.3p-9, kMiddle = 0.48713, kUneven = 0.3719;
    const std::size_t n = curve.size();
    const auto turn_at = [&](std::size_t i) {
        return orientation(curve[(i + n - 1) % n], curve[i % n], curve[(i + 1) % n]);
    };
    for (std::size_t i = 0; i < n; ++i) {
        const Point2 at = curve[i], next = curve[(i + 1) % n];
        if (turn_at(i) == Turn::Left) {
            points.push_back(at);
        } else if (turn_at(i + 1) != Turn::Left) {
            const Vec2 edge = next - at;
            points.push_back(at + kMiddle * edge + kNear * kUneven * perpendicular(edge));
        }
    }
}

class GallerySolver {
  public:
    GallerySolver(std::span<const Region> floor, Progress& progress)
        : floor_(floor), search_(floor_), progress_(progress) {}

    GalleryCover solve();

  private:
    void addWitness(Point2 p);
    [[nodiscard]] bool isInFloor(Point2 p) const {
        return std::any_of(floor_.regions().begin(), floor_.regions().end(),
                           [p](const Region& region) { return region.locate(p) != Side::Outside; });
    }
    void addFirstWitnesses();
    /// Raises the lower bound and adds candidates where most witnesses are seen.
    void raiseBound();
    /// Covers the floor by candidates; returns true if the cover is as small as the bound.
    bool lowerCover();
    void take(const GuardSearch::Found& found);
    [[nodiscard]] bool isDone() const {
        return !cover_.guards.empty() && cover_.guards.size() <= cover_.bound;
    }
    [[nodiscard]] Point2 unscaled(Point2 p) const {
        return {p.x / floor_.scale(), p.y / floor_.scale()};
    }

    Floor floor_;
    GuardSearch search_;
    Progress& progress_;
    std::vector<Witness> witnesses_;
    std::set<std::pair<double, double>> known_;  // points tried as witnesses
    std::vector<Point2> fresh_;                  // points of what covers missed, for the next round
    GalleryCover cover_;
};

void GallerySolver::addWitness(Point2 p) {
    if (!known_.insert({p.x, p.y}).second) return;
    auto witness = witnessAt(floor_, p);
    if (!witness) return;
    search_.addRow(witness->view);
    witnesses_.push_back(std::move(*witness));
}

void GallerySolver::addFirstWitnesses() {
    std::vector<Point2> points;
    for (const Region& region : floor_.regions())
        for (const Polygon& curve : curvesOf(region)) proposeAlong(curve, points);
    for (const Point2 p : points) {
        if (isInFloor(p)) addWitness(p);
        if (progress_.stopped()) return;
    }
}

/// What a guard anywhere sees of the witnesses is part of one of the largest sets that a point
/// sees; so the least number of these sets that cover all witnesses bounds the guards from below.
void GallerySolver::raiseBound() {
    const auto known = gallery::largestWitnessSets(floor_, witnesses_, progress_);
    if (!known) {
        // One guard is needed to see any witness.
        if (cover_.bound == 0 && !witnesses_.empty()) {
            cover_.bound = 1;
            cover_.witnesses = {unscaled(witnesses_.front().view.viewpoint())};
            cover_.sets = {{0}};
        }
        return;
    }
    const std::vector<WitnessSet>& sets = *known;
    SetCover problem;
    problem.rows = witnesses_.size();
    for (const WitnessSet& set : sets) problem.columns.push_back(set.witnesses);
    problem.costs.assign(sets.size(), 1);
    const SetCoverResult least =
        minimumSetCover(problem, {.steps = kBoundSteps, .tries = 1}, progress_);
    if (least.is_coverable && least.bound > cover_.bound) {
        cover_.bound = least.bound;
        cover_.witnesses.clear();
        for (const Witness& witness : witnesses_)
            cover_.witnesses.push_back(unscaled(witness.view.viewpoint()));
        cover_.sets = problem.columns;
    }
    ++cover_.rounds;
    std::vector<gallery::WindowVertex> candidates;
    constexpr std::size_t kMaxPoints = 8, kMaxCandidates = 20'000;  // of a set; of a round
    const std::size_t most =
        std::clamp<std::size_t>(kMaxCandidates / (sets.size() + 1), 1, kMaxPoints);
    for (const WitnessSet& set : sets) {
        Vec2 sum;
        for (const auto& vertex : set.points) sum = sum + (vertex.at - Point2());
        const Point2 middle = Point2() + (1.0 / static_cast<double>(set.points.size())) * sum;
        candidates.push_back({middle, 0});
        const std::size_t count = std::min(set.points.size(), most);
        candidates.insert(candidates.end(), set.points.begin(),
                          set.points.begin() + static_cast<std::ptrdiff_t>(count));
    }
    std::erase_if(candidates, [&](const auto& vertex) { return !isInFloor(vertex.at); });
    search_.addCandidates(candidates, &progress_);
}

void GallerySolver::take(const GuardSearch::Found& found) {
    if (!search_.isCovered(found)) return;
    if (!cover_.guards.empty() && cover_.guards.size() <= found.guards.size()) return;
    cover_.guards.clear();
    for (const std::uint32_t guard : found.guards)
        cover_.guards.push_back(unscaled(search_.pointOf(guard)));
    cover_.missed = found.missed_area / (floor_.scale() * floor_.scale());
}

bool GallerySolver::lowerCover() {
    std::vector<std::uint32_t> before;
    while (cover_.guards.empty() || !progress_.stopped()) {
        GuardSearch::Found found = search_.coverRows(cover_.bound, progress_);
        for (const Region& region : found.missed) {
            const Point2 p = interiorPoint(region);
            search_.addRow(p);
            fresh_.push_back(p);
            for (const Polygon& curve : curvesOf(region))
                fresh_.insert(fresh_.end(), curve.begin(), curve.end());
        }
        take(found);
        if (isDone()) return true;
        const bool is_stuck = found.missed.empty() || found.guards == before;
        const bool is_worse = !cover_.guards.empty() && found.guards.size() >= cover_.guards.size();
        if (is_worse) return false;
        if (is_stuck || progress_.stopped()) {
            search_.complete(found);
            take(found);
            return isDone();
        }
        before = std::move(found.guards);
    }
    return isDone();
}

GalleryCover GallerySolver::solve() {
    addFirstWitnesses();
    while (true) {
        const std::size_t before = witnesses_.size();
        raiseBound();
        if (isDone() || lowerCover() || progress_.stopped()) break;
        for (const Point2 p : fresh_) addWitness(p);
        fresh_.clear();
        if (witnesses_.size() == before) break;
    }
    cover_.candidates = search_.candidates();
    cover_.is_complete = isDone();
    return std::move(cover_);
}

}  // namespace

GalleryCover guardGallery(std::span<const Region> floor, Progress& progress) {
    return GallerySolver(floor, progress).solve();
}

}  // namespace ispace::proofs
