// SPDX-License-Identifier: GPL-3.0-or-later
// Warnings about kept rooms that are probably not the ones meant: the frame of a sheet, a plot
// around its house, tiles of a floor, the small part of a large drawing. Each names the option that
// chooses otherwise.
#include "io/plan/room_warnings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

#include "base/number.h"
#include "env/environment.h"
#include "io/plan/parallel_lines.h"

namespace ispace {

namespace {

/// A part of the drawing that takes this share of a rectangle around all is no furniture.
constexpr double kFrameShare = 0.2;

/// Square metres: smaller rooms in a frame are no house.
constexpr double kLeastHouseInFrame = 12;

/// A frame encloses this share of its bounds.
constexpr double kFrameFilled = 0.85;

/// Rooms left out are counted up to here.
constexpr std::size_t kMaxGroups = 500;

constexpr std::size_t kMaxPlaces = 6;  // in one message
/// Metres; messages round gaps to the millimetre.
constexpr double kMinListedGap = 0.0005;

double areaOf(const Box2& box) { return box.width() * box.depth(); }

std::string sizeText(const Box2& box) {
    return formatFixed(box.width(), 1) + " x " + formatFixed(box.depth(), 1) + " m";
}

/// Returns the bounds of the lines that ends join.
std::vector<Box2> joinedParts(std::span<const Segment2> lines) {
    std::vector<std::size_t> parent(lines.size());
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto root = [&parent](std::size_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    std::map<std::pair<double, double>, std::size_t> at;
    for (std::size_t i = 0; i < lines.size(); ++i)
        for (const Point2 end : {lines[i].a, lines[i].b}) {
            const Point2 p = wholeMicrometres(end);
            parent[root(i)] = root(at.emplace(std::pair{p.x, p.y}, i).first->second);
        }
    std::map<std::size_t, Box2> boxes;
    for (std::size_t i = 0; i < lines.size(); ++i)
        for (const Point2 end : {lines[i].a, lines[i].b})
            boxes.try_emplace(root(i), Box2{end, end}).first->second.add(end);
    std::vector<Box2> parts;
    parts.reserve(boxes.size());
    for (const auto& [first, box] : boxes) parts.push_back(box);
    return parts;
}

}  // namespace

bool isRoom(const PlanWalls& plan, const PlanFaces& faces, const PlanFaces::Group& group) {
    if (faces.isHollow(group)) return false;
    return !plan.is_floor || plan.is_floor(interiorPoint(faces.faces()[group.faces.front()]));
}

namespace {

/// Returns the largest room in a hole of this one, as a house on its plot; null if there is none.
/// Its front door may join both.
const Region* houseIn(const PlanWalls& plan, const RoomAttempt& taken, const PlanRegion& region,
                      const Region& outer) {
    const auto is_island = [&](const Region& room) {
        return std::any_of(outer.holes.begin(), outer.holes.end(), [&](const Polygon& hole) {
            return locate(hole, room.outline.front()) != Side::Outside;
        });
    };
    const Region* house = nullptr;
    const auto look = [&](const Region& room, double area) {
        if (&room != &outer && area >= kLeastHouseInFrame && is_island(room) &&
            (house == nullptr || area > house->area()))
            house = &room;
    };
    for (const Region& room : region.rooms) look(room, room.area());
    const std::vector<PlanFaces::Group>& groups = taken.faces.groups();
    const auto listed =
        groups.begin() + static_cast<std::ptrdiff_t>(std::min(groups.size(), kMaxGroups));
    for (auto group = groups.begin(); group != listed; ++group)
        if (&*group != taken.groups.front() && isRoom(plan, taken.faces, *group))
            look(taken.faces.faces()[group->faces.front()], group->area);
    return house;
}

/// Warns if a kept room surrounds a house: the house has walls of two lines, the outline of the
/// room is one line, as of a plot, a pavement or a roof. \return true if so
bool warnOfGrounds(const PlanWalls& plan, const RoomAttempt& taken, const PlanRegion& region,
                   Budget& work, ImportRecords& out) {
    constexpr double kWalled = 0.5;  // of an outline
    for (const Region& outer : region.rooms) {
        if (outer.holes.empty()) continue;
        const Region* const house = houseIn(plan, taken, region, outer);
        if (house == nullptr || shareOfWalls(outer.outline, plan.lines, work) >= kWalled ||
            shareOfWalls(house->outline, plan.lines, work) < kWalled)
            continue;
        out.warn("the room surrounds a house of " + areaText(house->area()) + " about " +
                 placeText(interiorPoint(*house)) +
                 ", up to a single line: if that bounds a plot, a pavement or a roof, leave it "
                 "out, for example with --wall-layer");
        return true;
    }
    return false;
}

}  // namespace

bool warnOfFrame(const PlanWalls& plan, std::span<const Segment2> lines, const RoomAttempt& taken,
                 const PlanRegion& region, Budget& work, ImportRecords& out) {
    const Box2 all = boundsOf(plan.lines);
    const Box2 rim{all.low + Vec2{kAtBorder, kAtBorder}, all.high - Vec2{kAtBorder, kAtBorder}};
    const auto is_inside = [&rim](Point2 p) { return rim.contains(p); };
    const auto is_rectangle = [&](const Region& room) {
        // A title block may take a corner.
        const Box2 around = bounds(room.outline);
        return !is_inside(around.low) && !is_inside(around.high) &&
               std::abs(signedArea(room.outline)) > kFrameFilled * areaOf(all);
    };
    const auto frame = std::find_if(region.rooms.begin(), region.rooms.end(), is_rectangle);
    if (frame == region.rooms.end()) return warnOfGrounds(plan, taken, region, work, out);
    std::vector<Segment2> within;
    for (const Segment2& line : lines)
        if (is_inside(line.a) && is_inside(line.b)) within.push_back(line);
    double largest = 0;
    for (const Box2& part : joinedParts(within)) largest = std::max(largest, areaOf(part));
    const bool has_house = houseIn(plan, taken, region, *frame) != nullptr;
    if (largest < kFrameShare * areaOf(all) && !has_house) return false;
    std::string text =
        "the room is the rectangle around the whole drawing: if that is the "
        "frame of a sheet, or a plot around a house, ";
    const auto other = std::find_if(taken.faces.groups().begin(), taken.faces.groups().end(),
                                    [&](const PlanFaces::Group& group) {
                                        return &group != taken.groups.front() &&
                                               group.area > kSmallShare * largest &&
                                               isRoom(plan, taken.faces, group);
                                    });
    if (other == taken.faces.groups().end())
        text += "leave it out, for example with --wall-layer";
    else
        text += "--inside X,Y chooses a room in it, the largest has " + areaText(other->area) +
                " about " + placeText(interiorPoint(taken.faces.faces()[other->faces.front()]));
    out.warn(std::move(text));
    return true;
}

void warnOfTheRest(const PlanWalls& plan, const RoomAttempt& taken, const Box2& kept,
                   ImportRecords& out) {
    const Box2 all = boundsOf(plan.lines);
    const PlanFaces::Group* largest_other = nullptr;
    double others = 0;
    std::size_t looked_at = 0;
    for (const PlanFaces::Group& group : taken.faces.groups()) {
        if (std::find(taken.groups.begin(), taken.groups.end(), &group) != taken.groups.end())
            continue;
        if (++looked_at > kMaxGroups) break;
        if (!isRoom(plan, taken.faces, group)) continue;
        if (largest_other == nullptr) largest_other = &group;
        others += group.area;
    }
    if (areaOf(kept) >= kSmallShare * areaOf(all) && taken.area >= others) return;
    std::string text = "kept " + areaText(taken.area) + " on " + sizeText(kept) +
                       " of a drawing of " + sizeText(all);
    if (largest_other != nullptr)
        text += "; other rooms have " + areaText(others) + ", the largest of them " +
                areaText(largest_other->area) + " about " +
                placeText(interiorPoint(taken.faces.faces()[largest_other->faces.front()])) +
                ": --inside X,Y chooses rooms, --rooms all keeps all";
    out.warn(std::move(text));
}

void warnOfTiles(const RoomAttempt& taken, ImportRecords& out) {
    constexpr double kLargestTile = 1;  // square metres
    constexpr double kCompact = 0.4;    // of 4 pi area / perimeter^2: walls and treads are narrow
    constexpr double kFewTiles = 0.1;   // of the area that is kept
    constexpr std::size_t kLeastTiles = 20;
    std::size_t count = 0;
    double area = 0;
    Point2 first;
    for (const Region& face : taken.faces.faces()) {
        const double own = face.area();
        if (own > kLargestTile) continue;
        double around = 0;
        face.forEachEdge([&](const Segment2& edge) { around += distance(edge.a, edge.b); });
        if (4 * std::numbers::pi * own < kCompact * around * around) continue;
        if (count++ == 0) first = face.outline.front();
        area += own;
    }
    if (count < kLeastTiles || area < kFewTiles * taken.area) return;
    out.warn(std::to_string(count) + " faces of " + areaText(area) +
             " in sum are too small to be rooms, the first at " + placeText(first) +
             ": if they are tiles or hatching, leave their layer out, for example with "
             "--wall-layer");
}

void warnOfGaps(std::span<const Segment2> closing, double width, ImportRecords& out) {
    std::vector<std::pair<double, Point2>> gaps;
    for (const Segment2& line : closing)
        if (const double gap = distance(line.a, line.b); gap >= kMinListedGap)
            gaps.emplace_back(gap, line.a + 0.5 * (line.b - line.a));
    if (gaps.empty()) return;
    std::stable_sort(gaps.begin(), gaps.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::string text = "the walls do not close: closed " + countText(gaps.size(), "gap") +
                       " of up to " + formatDouble(width) + " m (";
    for (std::size_t i = 0; i < std::min(gaps.size(), kMaxPlaces); ++i)
        text += (i == 0 ? "" : ", ") + formatFixed(gaps[i].first, 3) + " m at " +
                placeText(gaps[i].second);
    if (gaps.size() > kMaxPlaces)
        text += " and " + std::to_string(gaps.size() - kMaxPlaces) + " more";
    out.warn(text + "); --close-gaps M sets the widest");
}

}  // namespace ispace
