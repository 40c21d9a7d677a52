// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <utility>

#include "geom/boolean.h"
#include "geom/predicates.h"
#include "io/ifc/storey_plan.h"

namespace ispace {

namespace {

constexpr double kParallel = 0.017;  // sine of a degree
constexpr double kLeastShare = 0.6;  // of an opening's width that a face has to bear
constexpr double kNarrowest = 0.3;   // metres, of openings
/// From boxes to the faces that they go through, in metres: those of holes, and of doors
/// themselves.
constexpr double kHoleReach = 0.05, kDoorReach = 0.5;
constexpr double kThickestPane = 0.5;      // metres
constexpr double kJambReach = 0.4;         // beyond a door to the ends of walls beside it
constexpr double kFarthestThrough = 0.99;  // openings reach through no thicker walls

std::vector<Segment2> linesOf(std::span<const Region> solids) {
    std::vector<Segment2> lines;
    for (const Region& solid : solids)
        solid.forEachEdge([&](const Segment2& edge) { lines.push_back(edge); });
    return lines;
}

}  // namespace

std::vector<Segment2> StoreyOpening::reveals() const {
    std::vector<Segment2> reveals;
    for (const Segment2& other : others)
        for (const Point2 end : {other.a, other.b})
            reveals.push_back({nearestPoint(line, end), end});
    return reveals;
}

WallFaces::WallFaces(const StoreyWalls& walls) : walls_(walls), search_(linesOf(walls.solids)) {
    std::size_t curve = 0;
    const auto add = [&](const Polygon& polygon) {
        forEachEdge(polygon, [&](const Segment2& edge) { faces_.push_back({edge, curve}); });
        ++curve;
    };
    for (const Region& solid : walls.solids) {
        add(solid.outline);
        for (const Polygon& hole : solid.holes) add(hole);
    }
}

std::vector<WallFaces::Beside> WallFaces::facesBeside(const BuildingBox& box, double reach) const {
    const Vec2 u = box.along, v = perpendicular(u);
    const double half = box.length / 2, beyond = box.width / 2 + reach;
    Box2 window;
    for (const double x : {-half, half})
        for (const double y : {-beyond, beyond}) window.add(box.center + x * u + y * v);
    std::vector<Beside> beside;
    for (const std::size_t i : search_.near(window, 0)) {
        const Segment2& line = faces_[i].line;
        const Vec2 along = line.b - line.a;
        if (std::abs(cross(u, along)) > kParallel * length(along)) continue;
        const double a = dot(line.a - box.center, u), b = dot(line.b - box.center, u);
        const double from = std::max(std::min(a, b), -half), to = std::min(std::max(a, b), half);
        if (to - from < std::max(kNarrowest, kLeastShare * box.length)) continue;
        const double aside = (dot(line.a - box.center, v) + dot(line.b - box.center, v)) / 2;
        if (std::abs(aside) <= beyond) beside.push_back({&faces_[i], from, to, aside, b > a});
    }
    return beside;
}

std::optional<StoreyOpening> WallFaces::through(const BuildingBox& box, bool is_hole) const {
    const std::vector<Beside> beside = facesBeside(box, is_hole ? kHoleReach : kDoorReach);
    const Beside *lower = nullptr, *upper = nullptr;
    const double half = box.width / 2;
    for (const Beside& face : beside) {
        if (face.is_lower && face.aside <= half &&
            (lower == nullptr || (face.aside < lower->aside) == is_hole))
            lower = &face;
        if (!face.is_lower && face.aside >= -half &&
            (upper == nullptr || (face.aside > upper->aside) == is_hole))
            upper = &face;
    }
    if (lower == nullptr || upper == nullptr) return std::nullopt;
    const double depth = upper->aside - lower->aside;
    if (!(depth > 0) || depth > kFarthestThrough) return std::nullopt;
    const bool host_is_lower = lower->to - lower->from >= upper->to - upper->from;
    const Beside& host = host_is_lower ? *lower : *upper;
    const auto clipped = [&](const Beside& face, double from, double to) {
        const Segment2& line = face.face->line;
        const auto at = [&](double x) {
            return wholeMicrometres(nearestPoint(
                line, box.center + x * box.along + face.aside * perpendicular(box.along)));
        };
        return Segment2{at(from), at(to)};
    };
    StoreyOpening opening;
    opening.line = clipped(host, host.from, host.to);
    opening.curve = host.face->curve;
    opening.depth = depth;
    for (const Beside& face : beside)
        if (&face != &host && face.aside >= lower->aside && face.aside <= upper->aside)
            opening.others.push_back(
                clipped(face, std::max(face.from, host.from), std::min(face.to, host.to)));
    return opening;
}

std::optional<StoreyOpening> WallFaces::across(const BuildingBox& box) const {
    const double half = box.length / 2;
    Point2 jambs[2];
    for (const int side : {0, 1}) {
        const Vec2 out = (side == 0 ? -1 : 1) * box.along;
        const Segment2 ray{box.center, box.center + (half + kJambReach) * out};
        double nearest = HUGE_VAL;
        for (const std::size_t i : search_.near(bounds(ray), 0)) {
            const Segment2& line = faces_[i].line;
            const double turn = cross(line.b - line.a, out);
            if (std::abs(turn) < 1e-12 || !intersects(line, ray)) continue;
            nearest = std::min(nearest, cross(line.b - line.a, line.a - box.center) / turn);
        }
        if (nearest > half + kJambReach || nearest < half / 2) return std::nullopt;
        jambs[side] = wholeMicrometres(box.center + nearest * out);
    }
    if (isInWall(box.center) || distance(jambs[0], jambs[1]) < kNarrowest) return std::nullopt;
    StoreyOpening opening;
    opening.line = {jambs[0], jambs[1]};
    return opening;
}

std::optional<StoreyOpening> WallFaces::find(const BuildingBox& box, bool is_hole) const {
    BuildingBox turned = box;
    turned.along = perpendicular(box.along);
    std::swap(turned.length, turned.width);
    for (const BuildingBox* const one : {&box, static_cast<const BuildingBox*>(&turned)})
        if (auto opening = through(*one, is_hole)) return opening;
    for (const BuildingBox* const one : {&box, static_cast<const BuildingBox*>(&turned)})
        if (auto opening = across(*one)) return opening;
    // A window or door that is a wall itself, as panes from floor to ceiling.
    const BuildingBox& longer = box.length >= box.width ? box : turned;
    if (is_hole || longer.length < kNarrowest || longer.width > kThickestPane ||
        isInWall(box.center))
        return std::nullopt;
    const Vec2 half = longer.length / 2 * longer.along;
    StoreyOpening opening;
    opening.line = {wholeMicrometres(longer.center - half), wholeMicrometres(longer.center + half)};
    return opening;
}

bool WallFaces::isInWall(Point2 p) const {
    return std::any_of(walls_.solids.begin(), walls_.solids.end(),
                       [p](const Region& solid) { return solid.locate(p) != Side::Outside; });
}

void carve(StoreyWalls& walls, std::span<const BuildingBox> holes) {
    constexpr double kBeyond = 0.02;
    std::vector<Polygon> boxes;
    for (const BuildingBox& hole : holes) {
        const Vec2 u = hole.length / 2 * hole.along;
        const Vec2 v = (hole.width / 2 + kBeyond) * perpendicular(hole.along);
        boxes.push_back(
            {hole.center - u - v, hole.center + u - v, hole.center + u + v, hole.center - u + v});
    }
    walls.solids = difference(Regions{walls.solids}, boxes);
}

}  // namespace ispace
