// SPDX-License-Identifier: GPL-3.0-or-later
// What all poses of a box see, for the check: the intersection of what its corners see through the
// same edges, less what lies beyond the range of any corner or outside of the field of view at any
// heading. A subset is enough, so doubtful parts are left out.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "extensions/proofs/poses/box_views.h"

namespace ispace::proofs::poses {

/// The common view of all poses of one box.
class CommonSight {
  public:
    CommonSight(const BoxViews& floor, const PoseBox& box)
        : floor_(floor), sector_(floor.sector_), box_(box) {
        source_ = cornersOf(box.at.expanded(kWiden));
    }

    BoxCore core();

  private:
    /// What a corner of the box sees through the edges so far: between two points.
    struct Wedge {
        Point2 corner, right, left;
        bool is_open = false;  // it lies on the last edge
    };
    using Pieces = std::vector<std::pair<std::size_t, Convex>>;  // by face

    void follow(std::size_t face, std::size_t edge, std::vector<Wedge> wedges, Pieces& pieces);
    /// Adds the area within reach of all poses, in cells.
    void add(Convex polygon, std::vector<double>& areas) const;
    [[nodiscard]] Side2 sideAround(Vec2 outwards, bool holds_all) const;

    const BoxViews& floor_;
    const Sector& sector_;
    PoseBox box_;
    Convex source_;
};

/// The half-plane through a corner of the box that holds all of the box, or no more than the
/// corner.
Side2 CommonSight::sideAround(Vec2 outwards, bool holds_all) const {
    const auto less = [outwards](Point2 a, Point2 b) { return dot(outwards, a - b) < 0; };
    const auto [low, high] = std::minmax_element(source_.begin(), source_.end(), less);
    return {holds_all ? *high : *low, outwards};
}

void CommonSight::follow(std::size_t face, std::size_t edge, std::vector<Wedge> wedges,
                         Pieces& pieces) {
    const BoxViews::Face& near = floor_.faces_[face];
    if (near.beyond[edge] < 0) return;
    const auto beyond = static_cast<std::size_t>(near.beyond[edge]);
    const Point2 right = near.at[edge], left = near.at[(edge + 1) % 3];
    const BoxViews::Face& far = floor_.faces_[beyond];
    Convex piece(far.at.begin(), far.at.end());
    for (Wedge& wedge : wedges) {
        const Vec2 to_right = right - wedge.corner, to_left = left - wedge.corner;
        if (wedge.is_open) {
            wedge.right = right;
            wedge.left = left;
        } else {
            if (cross(wedge.right - wedge.corner, to_right) > 0) wedge.right = right;
            if (cross(wedge.left - wedge.corner, to_left) < 0) wedge.left = left;
            // Nothing lies between: what both sides bound would be behind the corner.
            if (cross(wedge.right - wedge.corner, wedge.left - wedge.corner) < 0) return;
        }
        // An edge that begins or ends in the corner bounds no point beyond it.
        wedge.is_open = std::min(length(to_right), length(to_left)) <= kAtCorner;
        if (wedge.is_open) continue;
        keepInside(piece, {wedge.corner, -perpendicular(wedge.right - wedge.corner)});
        if (!piece.empty())
            keepInside(piece, {wedge.corner, perpendicular(wedge.left - wedge.corner)});
        if (piece.empty()) return;
    }
    pieces.emplace_back(beyond, std::move(piece));
    for (std::size_t next = 0; next < 3; ++next)
        if (far.beyond[next] != static_cast<std::int32_t>(face))
            follow(beyond, next, wedges, pieces);
}

void CommonSight::add(Convex polygon, std::vector<double>& areas) const {
    constexpr int kSides = 96;       // of a polygon in the range: its vertices are at its end
    constexpr int kNearSides = 192;  // of one around what is too near
    constexpr double kTurn = 1e-9;   // more than rounding
    const double half = std::numbers::pi / kSides, turn = 2 * std::numbers::pi / kNearSides;
    std::vector<std::vector<Side2>> hidden;  // convex sets that not all poses see
    for (int i = 0; i < kSides; ++i) {
        Side2 side = sideAround(wayAt(2 * i * half), false);
        side.at = side.at + sector_.range * std::cos(half) * side.outwards;
        keepInside(polygon, side);
    }
    if (sector_.near > 0) {
        hidden.emplace_back();
        for (int i = 0; i < kNearSides; ++i) {
            Side2 side = sideAround(wayAt(i * turn), true);
            side.at = side.at + sector_.near * side.outwards;
            hidden.back().push_back(side);
        }
    }
    if (!sector_.isRound()) {
        double field = sector_.field - box_.span - 2 * kTurn;
        if (std::abs(field - std::numbers::pi) < kStraight) field = std::numbers::pi - kStraight;
        const double from = box_.from + box_.span + sector_.first + kTurn;
        const Vec2 first = wayAt(from), last = wayAt(from + field);
        if (field <= std::numbers::pi) {
            keepInside(polygon, sideAround(-perpendicular(first), false));
            keepInside(polygon, sideAround(perpendicular(last), false));
        } else {
            hidden.push_back(
                {sideAround(-perpendicular(last), true), sideAround(perpendicular(first), true)});
            for (const Vec2 axis : {Vec2{1, 0}, Vec2{-1, 0}, Vec2{0, 1}, Vec2{0, -1}})
                if (dot(axis, first) <= 0 && dot(axis, last) <= 0)
                    hidden.back().push_back(sideAround(axis, true));
        }
    }
    // Parts hidden by one set or the other: inclusion and exclusion.
    std::vector<std::pair<Convex, double>> counted;
    if (!polygon.empty()) counted.emplace_back(std::move(polygon), 1.0);
    for (const auto& set : hidden)
        for (std::size_t i = counted.size(); i-- > 0;) {
            Convex part = counted[i].first;
            for (const Side2& side : set) keepInside(part, side);
            if (!part.empty()) counted.emplace_back(std::move(part), -counted[i].second);
        }
    for (const auto& [part, sign] : counted) floor_.addArea(part, sign, areas);
}

BoxCore CommonSight::core() {
    constexpr int kMaxFaces = 8;
    BoxCore core;
    if (!sector_.isRound() && sector_.field - box_.span <= 2e-9) return core;
    Pieces common;
    int count = 0;
    for (std::size_t i = 0; i < floor_.faces_.size(); ++i) {
        const auto& at = floor_.faces_[i].at;
        Convex shared = source_;
        for (std::size_t k = 0; k < 3 && !shared.empty(); ++k)
            keepInside(shared, {at[k], -perpendicular(at[(k + 1) % 3] - at[k])});
        if (shared.empty()) continue;
        if (++count > kMaxFaces) return core;
        std::vector<Wedge> wedges;
        for (const Point2 corner : shared) wedges.push_back({corner, {}, {}, true});
        Pieces pieces = {{i, {at.begin(), at.end()}}};
        for (std::size_t edge = 0; edge < 3; ++edge) follow(i, edge, wedges, pieces);
        if (count == 1) {
            common = std::move(pieces);
            continue;
        }
        Pieces both;
        for (const auto& [face, before] : common)
            for (const auto& [other, piece] : pieces) {
                Convex part = face == other ? before : Convex();
                for (std::size_t k = 0; k < piece.size() && !part.empty(); ++k) {
                    const Vec2 edge = piece[(k + 1) % piece.size()] - piece[k];
                    if (length(edge) > kAtCorner)
                        keepInside(part, {piece[k], -perpendicular(edge)});
                }
                if (!part.empty()) both.emplace_back(face, std::move(part));
            }
        common = std::move(both);
    }
    std::vector<double> areas(floor_.most_.size());
    for (auto& [face, piece] : common) add(std::move(piece), areas);
    const std::vector<std::uint16_t> parts = floor_.partsOf(areas, false);
    const auto is_some = [](std::uint16_t part) { return part != 0; };
    const auto begin = std::find_if(parts.begin(), parts.end(), is_some);
    const auto end = std::find_if(parts.rbegin(), parts.rend(), is_some).base();
    if (begin >= end) return core;
    core.first = static_cast<std::size_t>(begin - parts.begin());
    core.parts.assign(begin, end);
    return core;
}

BoxCore BoxViews::coreOf(const PoseBox& box) const { return CommonSight(*this, box).core(); }

}  // namespace ispace::proofs::poses
