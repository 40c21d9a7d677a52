// SPDX-License-Identifier: GPL-3.0-or-later
// The faces of a plan's lines, from the arrangement of geom/arrangement.h: which are rooms, which
// the space between the two lines of a wall, and which of them doors join.
#include "io/plan/plan_rooms.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "geom/arrangement.h"
#include "geom/planar_map.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"
#include "io/plan/plan_lines.h"

namespace ispace {

namespace {

/// Rooms beside a door are found at this distance: less than any wall is thick.
constexpr double kBesideDoor = 0.005;

/// No disc of this diameter fits between the two lines of a wall, nor one of this share of the
/// plan's extent, whatever its scale.
constexpr double kMaxWall = 0.5, kWallShare = 12;

/// An inside point closer than this to a free-standing line is replaced by the clearest of a grid.
constexpr double kClear = 0.05;
constexpr int kClearSteps = 12;

/// Points at which lines within a face are tested: not the ends, which often lie on walls.
constexpr std::array<double, 3> kSharesInside{0.01, 0.501, 0.99};

/// Walls cross a few others; hatching and terrain cross hundreds.
constexpr double kManyCrossings = 20;
constexpr double kFewCrossings = 200'000;

constexpr double kFreeCrossings = 2;      // of each line: walls meet at both ends
constexpr double kUnitsPerCrossing = 24;  // of Budget
constexpr double kUnitsPerRoom = 8;       // that a crossing makes

Point2 middleOf(const Segment2& s) { return s.a + 0.5 * (s.b - s.a); }

/// The part of `line` that lies on `other`, if it is longer than a point.
std::optional<Segment2> commonPart(const Segment2& line, const Segment2& other) {
    const Vec2 along = line.b - line.a;
    if (line.a == line.b) return std::nullopt;
    const auto share = [&](Point2 p) {
        return std::clamp(dot(p - line.a, along) / dot(along, along), 0.0, 1.0);
    };
    const auto [first, last] = std::minmax({share(other.a), share(other.b)});
    const auto at = [&](double s) { return s == 1 ? line.b : line.a + s * along; };
    const Segment2 part{at(first), at(last)};
    if (distance(part.a, part.b) <= kOnLine || distance(part.a, other) > kOnLine ||
        distance(part.b, other) > kOnLine)
        return std::nullopt;
    return part;
}

/// Finds for many points which of several disjoint regions holds them: the one above the nearest
/// edge below. O(n) to build; the time for a point grows with its distance from that edge.
class RegionLocator {
  public:
    explicit RegionLocator(const std::vector<Region>& regions)
        : edges_(edgesOf(regions, owners_)), grid_(edges_, kOnLine) {}

    /// The index of the region. \pre p is off the edges
    [[nodiscard]] std::optional<std::size_t> at(Point2 p) const {
        std::optional<Below> nearest;
        grid_.searchBelow(p, [&](std::span<const std::uint32_t> cell, double bottom) {
            for (const std::uint32_t i : cell)
                if (const auto edge = below(p, i); edge && (!nearest || *nearest < *edge))
                    nearest = edge;
            return nearest && nearest->y >= bottom;
        });
        // The region that an edge bounds lies to its left.
        if (!nearest || !nearest->heads_right) return std::nullopt;
        return owners_[nearest->index];
    }

    /// Returns true if a part of the line lies on an edge of a region.
    [[nodiscard]] bool isOnEdge(const Segment2& line) const {
        bool is_on = false;
        grid_.searchAlong(line, [&](std::span<const std::uint32_t> cell) {
            is_on = is_on || std::any_of(cell.begin(), cell.end(), [&](std::uint32_t i) {
                        return commonPart(line, edges_[i]).has_value();
                    });
        });
        return is_on;
    }

  private:
    /// An edge below a point. Of those that meet there the steepest is the nearest, and of two that
    /// are one line the one with its region above.
    struct Below {
        double y = 0, slope = 0;
        bool heads_right = false;
        std::uint32_t index = 0;

        bool operator<(const Below& other) const {
            return std::tuple(y, slope, heads_right) <
                   std::tuple(other.y, other.slope, other.heads_right);
        }
    };

    [[nodiscard]] std::optional<Below> below(Point2 p, std::uint32_t index) const {
        auto [left, right] = edges_[index];
        const bool heads_right = left.x < right.x;
        if (!heads_right) std::swap(left, right);
        if (!(left.x <= p.x && p.x < right.x) || orientation(left, right, p) != Turn::Left)
            return std::nullopt;
        const double slope = (right.y - left.y) / (right.x - left.x);
        return Below{left.y + (p.x - left.x) * slope, slope, heads_right, index};
    }

    static std::vector<Segment2> edgesOf(const std::vector<Region>& regions,
                                         std::vector<std::size_t>& owners) {
        std::vector<Segment2> edges;
        for (std::size_t i = 0; i < regions.size(); ++i)
            regions[i].forEachEdge([&](const Segment2& edge) {
                edges.push_back(edge);
                owners.push_back(i);
            });
        return edges;
    }

    std::vector<std::size_t> owners_;
    std::vector<Segment2> edges_;
    SegmentGrid grid_;
};

double distanceTo(std::span<const Segment2> lines, Point2 p) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Segment2& line : lines) nearest = std::min(nearest, distance(p, line));
    return nearest;
}

/// \param grid of the lines
bool hasWithin(std::span<const Segment2> lines, const SegmentGrid& grid, Point2 p, double reach) {
    const Vec2 margin{reach, reach};
    bool has = false;
    grid.searchBox({p - margin, p + margin}, [&](std::span<const std::uint32_t> cell) {
        has = has || std::any_of(cell.begin(), cell.end(),
                                 [&](std::uint32_t i) { return distance(p, lines[i]) <= reach; });
    });
    return has;
}

}  // namespace

double widestWall(double extent) { return std::min(kMaxWall, extent / kWallShare); }

bool isNarrow(const Region& face, double widest) {
    const Box2 box = bounds(face.outline);
    if (std::min(box.width(), box.depth()) < widest) return true;
    const Point2 p = interiorPoint(face);
    bool is_narrow = false;
    face.forEachEdge(
        [&](const Segment2& edge) { is_narrow = is_narrow || distance(p, edge) < widest / 2; });
    return is_narrow;
}

Point2 clearPoint(const Region& face, std::span<const Segment2> lines) {
    Point2 best = interiorPoint(face);
    double best_clear = distanceTo(lines, best);
    if (best_clear >= kClear) return best;
    const Box2 box = bounds(face.outline);
    const SegmentGrid grid(lines, 0);
    const auto share = [](int step) { return (step + 0.5) / kClearSteps; };
    for (int i = 0; i < kClearSteps * kClearSteps; ++i) {
        const int row = i / kClearSteps, column = i % kClearSteps;
        const Point2 p{box.low.x + share(column) * box.width(),
                       box.low.y + share(row) * box.depth()};
        if (hasWithin(lines, grid, p, best_clear) || face.locate(p) != Side::Inside) continue;
        best = p;
        best_clear = distanceTo(lines, p);
    }
    return best;
}

double PlanRegion::area() const {
    return std::accumulate(rooms.begin(), rooms.end(), 0.0,
                           [](double sum, const Region& room) { return sum + room.area(); });
}

PlanFaces::PlanFaces(std::span<const Segment2> walls, Budget& work, std::span<const Segment2> doors,
                     std::span<const Segment2> closings)
    : work_(&work), walls_(walls.begin(), walls.end()) {
    if (closings.empty()) {
        faces_ = boundedFaces(weld(walls));
    } else {
        Pieces pieces = weldedPieces(walls, closings, work);
        faces_ = boundedFaces(pieces.walls, pieces.closings);
        closings_ = std::move(pieces.closings);
    }
    takeFaces(doors);
}

PlanFaces::PlanFaces(const Pieces& pieces, Budget& work, std::span<const Segment2> doors,
                     std::size_t closing_pieces)
    : work_(&work),
      walls_(pieces.walls),
      closings_(pieces.closings.begin(),
                pieces.closings.begin() + static_cast<std::ptrdiff_t>(closing_pieces)),
      faces_(boundedFaces(walls_, closings_)) {
    takeFaces(doors);
}

PlanFaces::Pieces PlanFaces::weldedPieces(std::span<const Segment2> walls,
                                          std::span<const Segment2> closings, Budget& work) {
    std::vector<Segment2> all(walls.begin(), walls.end());
    all.insert(all.end(), closings.begin(), closings.end());
    const WeldedLines welded = weld(all);
    Pieces plan;
    for (std::size_t i = 0; i < welded.pieces.size(); ++i)
        if (welded.source[i] < walls.size()) plan.walls.push_back(welded.pieces[i]);
    const NearSegments search(plan.walls, work);
    for (std::size_t i = 0; i < welded.pieces.size(); ++i) {
        if (welded.source[i] < walls.size()) continue;
        const Point2 middle = middleOf(welded.pieces[i]);
        const auto near = search.near(middle, kOnLine);
        if (std::any_of(near.begin(), near.end(),
                        [&](std::size_t k) { return distance(middle, plan.walls[k]) <= kOnLine; }))
            continue;
        plan.closings.push_back(welded.pieces[i]);
        plan.closing_of.push_back(welded.source[i] - walls.size());
    }
    return plan;
}

void PlanFaces::takeFaces(std::span<const Segment2> doors) {
    boxes_.reserve(faces_.size());
    Box2 all;
    for (const Region& face : faces_) {
        boxes_.push_back(bounds(face.outline));
        all.add(boxes_.back().low);
        all.add(boxes_.back().high);
    }
    widest_wall_ = widestWall(std::max(all.width(), all.depth()));
    makeGroups(doors);
}

/// Unites the faces on both sides of each door (union-find, the smaller index is the root), then
/// sorts groups and the faces of each by falling area; equal areas keep the order of the faces.
void PlanFaces::makeGroups(std::span<const Segment2> doors) {
    std::vector<std::size_t> group_of(faces_.size());
    std::iota(group_of.begin(), group_of.end(), std::size_t{0});
    const auto root = [&group_of](std::size_t i) {
        while (group_of[i] != i) i = group_of[i] = group_of[group_of[i]];
        return i;
    };
    std::optional<RegionLocator> locator;
    if (!doors.empty()) locator.emplace(faces_);
    for (const Segment2& door : doors) {
        const Vec2 along = door.b - door.a;
        const Vec2 across = kBesideDoor / length(along) * perpendicular(along);
        const auto left = locator->at(middleOf(door) + across);
        const auto right = locator->at(middleOf(door) - across);
        if (!left || !right) continue;
        const std::size_t a = root(*left), b = root(*right);
        group_of[std::max(a, b)] = std::min(a, b);
    }
    std::vector<std::size_t> place(faces_.size(), faces_.size());
    for (std::size_t i = 0; i < faces_.size(); ++i) {
        std::size_t& at = place[root(i)];
        if (at == faces_.size()) {
            at = groups_.size();
            groups_.emplace_back();
        }
        groups_[at].faces.push_back(i);
        groups_[at].area += faces_[i].area();
    }
    for (Group& group : groups_)
        std::stable_sort(group.faces.begin(), group.faces.end(), [&](std::size_t i, std::size_t k) {
            return faces_[i].area() > faces_[k].area();
        });
    std::stable_sort(groups_.begin(), groups_.end(),
                     [](const Group& a, const Group& b) { return a.area > b.area; });
}

std::optional<std::size_t> PlanFaces::faceAt(Point2 p) const {
    for (std::size_t i = 0; i < faces_.size(); ++i)
        if (boxes_[i].contains(p) && faces_[i].locate(p) == Side::Inside) return i;
    return std::nullopt;
}

const PlanFaces::Group* PlanFaces::groupAt(Point2 p) const {
    const auto face = faceAt(p);
    if (!face) return nullptr;
    const auto found = std::find_if(groups_.begin(), groups_.end(), [&face](const Group& group) {
        return std::find(group.faces.begin(), group.faces.end(), *face) != group.faces.end();
    });
    return &*found;
}

bool PlanFaces::isHollow(const Group& group) const {
    return std::all_of(group.faces.begin(), group.faces.end(),
                       [this](std::size_t i) { return isNarrow(faces_[i], widest_wall_); });
}

std::vector<Point2> PlanFaces::wallCorners() const {
    std::vector<Point2> corners;
    for (const Group& group : groups_) {
        if (!isHollow(group)) continue;
        for (const std::size_t face : group.faces)
            for (const Polygon& curve : curvesOf(faces_[face]))
                corners.insert(corners.end(), curve.begin(), curve.end());
    }
    return corners;
}

PlanRegion PlanFaces::region(const Group& group) const {
    PlanRegion region;
    for (const std::size_t i : group.faces) region.rooms.push_back(faces_[i]);
    region.inside = clearPoint(region.rooms.front(), walls_);
    return region;
}

std::vector<Segment2> PlanFaces::closedBy(const PlanRegion& region) const {
    std::vector<Segment2> closed;
    if (closings_.empty()) return closed;
    const NearSegments search(closings_, *work_);
    for (const Region& room : region.rooms)
        room.forEachEdge([&](const Segment2& edge) {
            // An edge may run on from a closing along a wall in its direction.
            for (const std::size_t i : search.near(bounds(edge), kOnLine))
                if (const auto part = commonPart(closings_[i], edge)) closed.push_back(*part);
        });
    return closed;
}

std::vector<bool> belongsTo(std::span<const PlanRegion> regions, std::span<const Segment2> lines) {
    std::vector<Region> rooms;
    for (const PlanRegion& region : regions)
        rooms.insert(rooms.end(), region.rooms.begin(), region.rooms.end());
    const RegionLocator locator(rooms);
    std::vector<bool> belongs;
    for (const Segment2& line : lines)
        belongs.push_back(locator.isOnEdge(line) ||
                          std::any_of(kSharesInside.begin(), kSharesInside.end(), [&](double s) {
                              return locator.at(line.a + s * (line.b - line.a)).has_value();
                          }));
    return belongs;
}

bool crossTooOften(std::span<const Segment2> lines, double crossings) {
    return crossings > std::max(kFewCrossings, kManyCrossings * static_cast<double>(lines.size()));
}

bool payForCrossings(double crossings, std::size_t lines, RoomChoice rooms, Budget& budget) {
    const double each = kUnitsPerCrossing + (rooms == RoomChoice::All ? kUnitsPerRoom : 0);
    const double units = each * (crossings - kFreeCrossings * static_cast<double>(lines));
    return budget.take(static_cast<std::uint64_t>(std::max(0.0, units)));
}

}  // namespace ispace
