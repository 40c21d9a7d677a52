// SPDX-License-Identifier: GPL-3.0-or-later
// Cells vote: a scan counts once for each kind in a cell, so a robot that stands still does not
// outvote the others. Regions of cells with more disagreement than agreement are errors; pairs of a
// gone and a new one are moves.
#include "extensions/reality/plan_errors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>

#include "base/number.h"
#include "extensions/reality/beam_model.h"

namespace ispace::reality {

namespace {

/// Counts of scans in a cell. A scan counts once for each kind.
struct CellVotes {
    std::uint32_t ends = 0, end_beams = 0;   // beams end here, far from any surface of the plan
    std::uint32_t passed = 0;                // beams pass through
    std::uint32_t gone = 0, gone_beams = 0;  // beams pass the surface that the plan has here
    std::uint32_t agreed = 0;                // beams end at the surface that the plan has here
    std::uint32_t last_end = 0, last_pass = 0, last_gone = 0, last_agreed = 0;  // scan, from 1
    float height = 0;
    Vec2 end_sum, gone_sum;  // of the beams' ends
    std::map<std::int32_t, std::uint32_t> elements = {};
};

void vote(std::uint32_t& count, std::uint32_t& last, std::uint32_t scan) {
    if (last == scan) return;
    last = scan;
    ++count;
}

class VoteGrid {
  public:
    explicit VoteGrid(double cell) : cell_(cell) {}

    using Key = std::int64_t;
    static constexpr std::int64_t kRows = std::int64_t{1} << 31U;
    [[nodiscard]] Key keyOf(Point2 p) const {
        return static_cast<Key>(std::floor(p.x / cell_)) * kRows +
               static_cast<Key>(std::floor(p.y / cell_)) + kRows / 2;
    }
    [[nodiscard]] Point2 centerOf(Key key) const {
        const Key column = key >= 0 ? key / kRows : -((-key + kRows - 1) / kRows);
        const Key row = key - column * kRows - kRows / 2;
        return {(static_cast<double>(column) + 0.5) * cell_,
                (static_cast<double>(row) + 0.5) * cell_};
    }
    CellVotes& operator[](Key key) { return cells_[key]; }
    [[nodiscard]] const std::unordered_map<Key, CellVotes>& cells() const { return cells_; }

  private:
    double cell_;
    std::unordered_map<Key, CellVotes> cells_;
};

/// Least distance in metres that counts as a difference, for a spread.
double thresholdOf(double sigma) {
    constexpr double kLeast = 0.15, kSpreads = 4;
    return std::max(kLeast, kSpreads * sigma);
}

void addBeam(VoteGrid& grid, const MeasuredBeam& beam, const MeasuredRays& rays, std::size_t ray,
             std::uint32_t scan, double threshold, double cell) {
    const Vec3 direction = rays.directions[ray];
    const Point3 origin = rays.end(ray, 0);
    const double level = std::hypot(direction.x, direction.y);
    constexpr double kUpright = 0.5;
    if (!(beam.measured < kNoReturn) || level < kUpright) return;
    const double residual = beam.residual();
    const auto at = [&](double range) { return (origin + range * direction).onFloor(); };
    const double measured = double{beam.measured};
    if (residual < -threshold) {
        CellVotes& cell_votes = grid[grid.keyOf(at(measured))];
        vote(cell_votes.ends, cell_votes.last_end, scan);
        ++cell_votes.end_beams;
        cell_votes.end_sum = cell_votes.end_sum + (at(measured) - Point2());
        cell_votes.height = static_cast<float>(origin.z);
    } else if (beam.expected < kNoReturn) {
        CellVotes& cell_votes = grid[grid.keyOf(at(double{beam.expected}))];
        if (residual > threshold) {
            vote(cell_votes.gone, cell_votes.last_gone, scan);
            ++cell_votes.gone_beams;
            cell_votes.gone_sum = cell_votes.gone_sum + (at(double{beam.expected}) - Point2());
            cell_votes.height = static_cast<float>(origin.z);
            ++cell_votes.elements[beam.surface];
        } else {
            vote(cell_votes.agreed, cell_votes.last_agreed, scan);
        }
    }
    // Cells before the end are free: where somebody stood they outvote the ends.
    for (double range = cell; range < measured - 2 * cell; range += cell) {
        CellVotes& cell_votes = grid[grid.keyOf(at(range))];
        vote(cell_votes.passed, cell_votes.last_pass, scan);
    }
}

/// Fits a rectangle about the cells, along their main axis.
void frame(PlanError& error, double cell) {
    Vec2 mean;
    for (const Point2& p : error.cells) mean = mean + (p - Point2());
    const double count = static_cast<double>(error.cells.size());
    mean = (1 / count) * mean;
    double xx = 0, xy = 0, yy = 0;
    for (const Point2& p : error.cells) {
        const Vec2 way = (p - Point2()) - mean;
        xx += way.x * way.x;
        xy += way.x * way.y;
        yy += way.y * way.y;
    }
    const Angle axis = Angle::radians(0.5 * std::atan2(2 * xy, xx - yy));
    const Vec2 along = unitVector(axis), across = perpendicular(along);
    double low = 0, high = 0, right = 0, left = 0;
    for (const Point2& p : error.cells) {
        const Vec2 way = (p - Point2()) - mean;
        low = std::min(low, dot(way, along));
        high = std::max(high, dot(way, along));
        right = std::min(right, dot(way, across));
        left = std::max(left, dot(way, across));
    }
    error.heading = axis;
    error.center = Point2() + mean + (0.5 * (low + high)) * along + (0.5 * (right + left)) * across;
    error.length = high - low + cell;
    error.width = left - right + cell;
}

/// Joins cells beside each other, by corners too, to regions.
std::vector<PlanError> regionsOf(const VoteGrid& grid, std::vector<VoteGrid::Key> keys,
                                 PlanError::Kind kind, double cell) {
    std::sort(keys.begin(), keys.end());
    std::vector<bool> done(keys.size(), false);
    std::vector<PlanError> regions;
    for (std::size_t first = 0; first < keys.size(); ++first) {
        if (done[first]) continue;
        PlanError region{.kind = kind};
        std::map<std::int32_t, std::size_t> elements;
        std::vector<std::size_t> open{first};
        done[first] = true;
        double passed = 0, agreed = 0;
        Vec2 sum;
        while (!open.empty()) {
            const VoteGrid::Key key = keys[open.back()];
            open.pop_back();
            const CellVotes& votes = grid.cells().at(key);
            region.cells.push_back(grid.centerOf(key));
            const bool is_new = kind == PlanError::Kind::New;
            region.scans = std::max<std::size_t>(region.scans, is_new ? votes.ends : votes.gone);
            region.beams += is_new ? votes.end_beams : votes.gone_beams;
            region.height = double{votes.height};
            sum = sum + (is_new ? votes.end_sum : votes.gone_sum);
            for (const auto& [element, beams] : votes.elements) elements[element] += beams;
            passed += votes.gone;
            agreed += votes.agreed;
            for (const VoteGrid::Key column : {-VoteGrid::kRows, VoteGrid::Key{0}, VoteGrid::kRows})
                for (const VoteGrid::Key row : {-1, 0, 1}) {
                    const VoteGrid::Key beside = key + column + row;
                    const auto found = std::lower_bound(keys.begin(), keys.end(), beside);
                    if (found == keys.end() || *found != beside) continue;
                    const auto index = static_cast<std::size_t>(found - keys.begin());
                    if (!done[index]) open.push_back(index);
                    done[index] = true;
                }
        }
        constexpr std::size_t kLeastCells = 3;
        if (region.cells.size() < kLeastCells) continue;
        std::sort(region.cells.begin(), region.cells.end(), lexLess);
        if (kind == PlanError::Kind::Gone) {
            const auto most =
                std::max_element(elements.begin(), elements.end(),
                                 [](const auto& a, const auto& b) { return a.second < b.second; });
            if (most != elements.end()) region.element = most->first;
            region.share = passed / std::max(passed + agreed, 1.0);
        }
        frame(region, cell);
        region.mean = Point2() + (1 / static_cast<double>(region.beams)) * sum;
        regions.push_back(std::move(region));
    }
    return regions;
}

/// A region as a piece of a wall.
struct WallPiece {
    Point2 middle, mean;
    Vec2 axis;
    double half = 0;  ///< of its length
};

/// Returns nullopt for a region that is no piece of a wall.
std::optional<WallPiece> pieceOf(const PlanError& error) {
    constexpr double kLeastLength = 0.5, kThin = 0.5;
    const bool is_long = error.length >= error.width;
    const double length = is_long ? error.length : error.width;
    if (length < kLeastLength || std::min(error.length, error.width) > kThin * length)
        return std::nullopt;
    const Vec2 axis = unitVector(error.heading);
    return WallPiece{error.center, error.mean, is_long ? axis : perpendicular(axis), 0.5 * length};
}

/// Returns the move from a gone piece to a new one; nullopt if they are no pair.
std::optional<PlanMove> moveOf(const WallPiece& gone, const WallPiece& found) {
    const double parallel = std::cos(Angle::degrees(15).radians());
    if (std::abs(dot(gone.axis, found.axis)) < parallel) return std::nullopt;
    const Vec2 across = perpendicular(gone.axis);
    // Across the surface, beams tell more than cells; along it, its ends do.
    const double off = dot(found.mean - gone.mean, across);
    constexpr double kFarthest = 1.5;
    if (std::abs(off) > kFarthest) return std::nullopt;
    const double along = dot(found.middle - gone.middle, gone.axis);
    const double overlap =
        std::min(gone.half, along + found.half) - std::max(-gone.half, along - found.half);
    if (overlap < std::min(gone.half, found.half)) return std::nullopt;
    constexpr double kAlike = 0.1;  // of the length: both ends were seen
    PlanMove move;
    move.is_across = std::abs(gone.half - found.half) > kAlike * gone.half;
    move.shift = off * across + (move.is_across ? 0 : along) * gone.axis;
    return move;
}

/// Pairs gone regions with new ones, the nearest first.
std::vector<PlanMove> movesOf(std::span<const PlanError> errors) {
    std::vector<PlanMove> candidates;
    std::vector<std::optional<WallPiece>> pieces;
    pieces.reserve(errors.size());
    for (const PlanError& error : errors) pieces.push_back(pieceOf(error));
    for (std::size_t g = 0; g < errors.size(); ++g) {
        if (errors[g].kind != PlanError::Kind::Gone || !pieces[g]) continue;
        for (std::size_t n = 0; n < errors.size(); ++n) {
            if (errors[n].kind != PlanError::Kind::New || !pieces[n]) continue;
            auto move = moveOf(*pieces[g], *pieces[n]);
            if (!move) continue;
            move->gone = g;
            move->found = n;
            move->element = errors[g].element;
            candidates.push_back(*move);
        }
    }
    std::stable_sort(
        candidates.begin(), candidates.end(),
        [](const PlanMove& a, const PlanMove& b) { return length(a.shift) < length(b.shift); });
    std::vector<bool> used(errors.size(), false);
    std::vector<PlanMove> moves;
    for (const PlanMove& one : candidates) {
        if (used[one.gone] || used[one.found]) continue;
        used[one.gone] = used[one.found] = true;
        moves.push_back(one);
    }
    std::sort(moves.begin(), moves.end(),
              [](const PlanMove& a, const PlanMove& b) { return a.gone < b.gone; });
    return moves;
}

std::vector<SurfaceOffset> offsetsOf(const LoggedRun& run) {
    struct Sum {
        std::vector<double> offsets;
        std::size_t scans = 0, last = 0;
    };
    std::map<std::int32_t, Sum> sums;
    for (std::size_t i = 0; i < run.scans.size(); ++i)
        for (const MeasuredBeam& beam : run.beamsOf(run.scans[i])) {
            constexpr double kNear = 0.5, kGrazing = 0.3;
            if (!beam.hasBoth() || beam.surface < 0 || double{beam.cosine} < kGrazing ||
                std::abs(beam.residual()) > kNear)
                continue;
            Sum& sum = sums[beam.surface];
            sum.offsets.push_back(beam.residual() * double{beam.cosine});
            if (sum.last != i + 1) ++sum.scans;
            sum.last = i + 1;
        }
    std::vector<SurfaceOffset> offsets;
    for (auto& [element, sum] : sums) {
        constexpr std::size_t kLeastScans = 3, kLeastBeams = 20;
        if (sum.scans < kLeastScans || sum.offsets.size() < kLeastBeams) continue;
        const RobustSpread spread = robustSpread(sum.offsets);
        offsets.push_back({element, spread.count, sum.scans, spread.median, spread.sigma});
    }
    std::stable_sort(offsets.begin(), offsets.end(), [](const auto& a, const auto& b) {
        return std::abs(a.offset) * static_cast<double>(a.beams) >
               std::abs(b.offset) * static_cast<double>(b.beams);
    });
    return offsets;
}

}  // namespace

PlanErrors findPlanErrors(const LoggedRun& run, double sigma, double cell) {
    PlanErrors found;
    found.cell = cell;
    VoteGrid grid(cell);
    const double threshold = thresholdOf(sigma);
    for (std::size_t i = 0; i < run.scans.size(); ++i) {
        const MeasuredScan& scan = run.scans[i];
        const MeasuredRays rays = scan.rays(scan.pose);
        const std::span<const MeasuredBeam> beams = run.beamsOf(scan);
        for (std::size_t k = 0; k < beams.size(); ++k)
            addBeam(grid, beams[k], rays, k, static_cast<std::uint32_t>(i + 1), threshold, cell);
    }
    constexpr std::uint32_t kLeastScans = 3;
    std::vector<VoteGrid::Key> added, gone;
    for (const auto& [key, votes] : grid.cells()) {
        if (votes.ends >= kLeastScans && votes.ends > votes.passed) added.push_back(key);
        if (votes.gone >= kLeastScans && votes.gone > votes.agreed) gone.push_back(key);
    }
    found.errors = regionsOf(grid, std::move(added), PlanError::Kind::New, cell);
    std::vector<PlanError> lost = regionsOf(grid, std::move(gone), PlanError::Kind::Gone, cell);
    found.errors.insert(found.errors.end(), std::make_move_iterator(lost.begin()),
                        std::make_move_iterator(lost.end()));
    std::stable_sort(found.errors.begin(), found.errors.end(),
                     [](const PlanError& a, const PlanError& b) { return a.beams > b.beams; });
    found.moves = movesOf(found.errors);
    found.offsets = offsetsOf(run);
    return found;
}

std::vector<std::string> recordsOf(const PlanErrors& errors, const Environment& environment) {
    std::vector<std::string> lines;
    const auto metres = [](double value) { return formatDouble(std::round(value * 100) / 100); };
    std::size_t number = 0;
    std::vector<const PlanMove*> of_region(errors.errors.size(), nullptr);
    for (const PlanMove& move : errors.moves) of_region[move.gone] = of_region[move.found] = &move;
    for (std::size_t i = 0; i < errors.errors.size(); ++i) {
        const PlanError& error = errors.errors[i];
        if (const PlanMove* const move = of_region[i]; move != nullptr && move->element >= 0) {
            if (move->gone != i) continue;
            const std::string& id =
                environment.elements()[static_cast<std::size_t>(move->element)].id;
            std::string line = "# " + id;
            line.append(" stands ").append(metres(length(move->shift)));
            line.append(" m beside its position in the plan: envc --move ").append(id);
            line.append(":").append(metres(move->shift.x));
            line.append(",").append(metres(move->shift.y));
            lines.push_back(std::move(line));
            continue;
        }
        if (error.kind == PlanError::Kind::New) {
            // Its height is unknown above the sensor.
            const double height = std::max(0.1, std::ceil(error.height * 10 + 1) / 10);
            lines.push_back("cube id=new" + std::to_string(++number) +
                            " at=" + metres(error.center.x) + ',' + metres(error.center.y) +
                            " heading=" + formatDouble(std::round(error.heading.degrees())) +
                            " size=" + metres(error.length) + ',' + metres(error.width) + ',' +
                            metres(height));
            continue;
        }
        constexpr double kWhole = 0.8;
        if (error.element < 0 || error.share < kWhole) continue;
        const Element& element = environment.elements()[static_cast<std::size_t>(error.element)];
        lines.push_back("# " + element.id + " is gone at " + metres(error.center.x) + ',' +
                        metres(error.center.y) + ": envc --delete " + element.id +
                        " if it is the whole");
    }
    return lines;
}

}  // namespace ispace::reality
