// SPDX-License-Identifier: GPL-3.0-or-later
// Points that every pose of a box sees. The box is cut along triangles; from each part sight
// expands through portals between the innermost lines of its corners (the opposite of weak
// visibility). What all parts see is kept. Rounded down.
#include "extensions/proofs/poses/inner_bound.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "extensions/proofs/poses/convex.h"
#include "geom/predicates.h"

namespace ispace::proofs::poses {

namespace {

/// A part of a triangle of the floor.
struct Piece {
    std::size_t triangle;
    Outline outline;
};

/// Expands the views of the parts of a rectangle in single triangles, from triangle to triangle.
/// Beyond a portal lie those points that are to the right of the lines from all corners of the part
/// through the portal's left end, and so mirrored.
class InnerBound {
  public:
    InnerBound(const PoseFloor& floor, const Sector& sector, const PoseBox& box)
        : floor_(floor), sector_(sector), box_(box) {
        box_.at = box.at.expanded(kWiden);
    }

    std::vector<std::uint8_t> compute();

  private:
    /// Sets the convex parts of the field of view that all poses share; false: there are none.
    bool setField();
    void setRange();
    void expandFrom(std::size_t triangle);
    void expand(std::size_t triangle, std::uint32_t right, std::uint32_t left);
    /// Adds the lines of sight through a portal's end. \param side 1: it is on the left, -1: right
    void addLimits(Point2 end, double side);
    void intersect();

    const PoseFloor& floor_;
    const Sector& sector_;
    PoseBox box_;
    std::vector<HalfPlane> range_, near_;
    std::vector<std::vector<HalfPlane>> fields_;
    Outline source_;                 // the part of the rectangle
    std::vector<HalfPlane> limits_;  // of lines of sight through the portals passed
    std::vector<Piece> seen_;        // from the present part
    std::vector<Piece> shared_;      // by all parts so far
    Outline spare_;
};

constexpr int kSides = 96;

bool InnerBound::setField() {
    if (sector_.isRound()) {
        fields_.emplace_back();
        return true;
    }
    constexpr double kTurn = 1e-9;  // narrows the sector by more than rounding
    double field = sector_.field - box_.span - 2 * kTurn;
    if (field <= 0) return false;
    if (std::abs(field - std::numbers::pi) < kStraight) field = std::numbers::pi - kStraight;
    const double from = box_.from + box_.span + sector_.first + kTurn;
    const Vec2 first = wayAt(from), last = wayAt(from + field);
    if (field <= std::numbers::pi) {
        fields_.push_back(
            {behindBox(box_.at, -perpendicular(first)), behindBox(box_.at, perpendicular(last))});
        return true;
    }
    // The rest: a convex cone behind, moved over the rectangle.
    std::vector<HalfPlane> hidden = {aroundBox(box_.at, -perpendicular(last)),
                                     aroundBox(box_.at, perpendicular(first))};
    for (const Vec2 axis : {Vec2{1, 0}, Vec2{-1, 0}, Vec2{0, 1}, Vec2{0, -1}})
        if (dot(axis, first) <= 0 && dot(axis, last) <= 0)
            hidden.push_back(aroundBox(box_.at, axis));
    std::vector<HalfPlane> part;
    for (const HalfPlane& side : hidden) {
        part.push_back(side.opposite());
        fields_.push_back(part);
        part.back() = side;
    }
    return true;
}

void InnerBound::setRange() {
    for (int i = 0; i < kSides; ++i) {
        HalfPlane side = behindBox(box_.at, wayAt(2 * std::numbers::pi * i / kSides));
        side.reach += sector_.range * std::cos(std::numbers::pi / kSides);
        range_.push_back(side);
    }
    for (int i = 0; i < kSides && sector_.near > 0; ++i) {
        near_.push_back(aroundBox(box_.at, wayAt(2 * std::numbers::pi * i / kSides)));
        near_.back().reach += sector_.near;
    }
}

void InnerBound::addLimits(Point2 end, double side) {
    for (const Point2 s : source_)
        if (distance(s, end) > kAtCorner) limits_.push_back(besideRay(s, end - s, -side));
}

void InnerBound::expandFrom(std::size_t triangle) {
    const PoseFloor::Triangle& from = floor_.triangles()[triangle];
    const PoseFloor::Corners corners = floor_.cornersOf(triangle);
    seen_.push_back({triangle, {corners.begin(), corners.end()}});
    for (std::size_t edge = 0; edge < 3; ++edge) {
        if (from.beyond[edge] < 0) continue;
        const std::uint32_t right = from.corners[edge], left = from.corners[(edge + 1) % 3];
        limits_.clear();
        addLimits(floor_.at(right), -1);
        addLimits(floor_.at(left), 1);
        expand(static_cast<std::size_t>(from.beyond[edge]), right, left);
    }
}

void InnerBound::expand(std::size_t triangle, std::uint32_t right, std::uint32_t left) {
    const PoseFloor::Triangle& own = floor_.triangles()[triangle];
    const PoseFloor::Corners corners = floor_.cornersOf(triangle);
    const Point2 middle = box_.at.center();
    if (distance(middle, Segment2{floor_.at(right), floor_.at(left)}) > sector_.range) return;
    Piece piece{triangle, {corners.begin(), corners.end()}};
    for (const HalfPlane& half : limits_) {
        clip(piece.outline, half, spare_);
        if (piece.outline.empty()) return;
    }
    seen_.push_back(std::move(piece));
    std::size_t apex = 0;
    while (own.corners[apex] == right || own.corners[apex] == left) ++apex;
    const std::uint32_t top = own.corners[apex];
    // Corners counter-clockwise: apex, left, right of the portal seen from inside this triangle.
    const std::int32_t beyond_left = own.beyond[apex], beyond_right = own.beyond[(apex + 2) % 3];
    const std::size_t kept = limits_.size();
    if (beyond_right >= 0) {
        addLimits(floor_.at(top), 1);
        expand(static_cast<std::size_t>(beyond_right), right, top);
        limits_.erase(limits_.begin() + static_cast<std::ptrdiff_t>(kept), limits_.end());
    }
    if (beyond_left >= 0) {
        addLimits(floor_.at(top), -1);
        expand(static_cast<std::size_t>(beyond_left), top, left);
        limits_.erase(limits_.begin() + static_cast<std::ptrdiff_t>(kept), limits_.end());
    }
}

/// Keeps what the present part of the rectangle sees, too.
void InnerBound::intersect() {
    std::vector<Piece> both;
    for (const Piece& a : shared_)
        for (const Piece& b : seen_) {
            if (a.triangle != b.triangle) continue;
            Outline outline = a.outline;
            for (std::size_t i = 0; i < b.outline.size() && !outline.empty(); ++i) {
                const Point2 p = b.outline[i], q = b.outline[(i + 1) % b.outline.size()];
                // The direction of a shorter edge is that of rounding.
                if (distance(p, q) > kAtCorner) clip(outline, besideRay(p, q - p, 1), spare_);
            }
            if (!outline.empty()) both.push_back({a.triangle, std::move(outline)});
        }
    shared_.swap(both);
}

std::vector<std::uint8_t> InnerBound::compute() {
    constexpr int kMaxParts = 8;
    if (!setField()) return {};
    int parts = 0;
    for (std::size_t i = 0; i < floor_.triangles().size(); ++i) {
        const PoseFloor::Corners corners = floor_.cornersOf(i);
        source_ = cornersOf(box_.at);
        for (std::size_t k = 0; k < 3; ++k)
            clip(source_, besideRay(corners[k], corners[(k + 1) % 3] - corners[k], 1), spare_);
        if (source_.empty()) continue;
        if (++parts > kMaxParts) return {};
        seen_.clear();
        expandFrom(i);
        if (parts == 1)
            shared_.swap(seen_);
        else
            intersect();
        if (shared_.empty()) return {};
    }
    setRange();
    PoseFloor::Tally tally(floor_);
    Outline part;
    for (Piece& piece : shared_) {
        for (const HalfPlane& half : range_) clip(piece.outline, half, spare_);
        for (const auto& field : fields_) {
            part = piece.outline;
            for (const HalfPlane& half : field) clip(part, half, spare_);
            if (part.empty()) continue;
            tally.add(part);
            for (const HalfPlane& half : near_) clip(part, half, spare_);
            if (near_.empty() || part.empty()) continue;
            std::reverse(part.begin(), part.end());
            tally.add(part);
        }
    }
    std::vector<std::uint8_t> cells;
    tally.roundDown(cells);
    return cells;
}

}  // namespace

std::vector<std::uint8_t> innerBoundOf(const PoseFloor& floor, const Sector& sector,
                                       const PoseBox& box) {
    return InnerBound(floor, sector, box).compute();
}

}  // namespace ispace::proofs::poses
