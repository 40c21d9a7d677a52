// SPDX-License-Identifier: GPL-3.0-or-later
// Rooms that were found in a plan, as a table, JSON and marks of a drawing: each with a point for
// --inside, of as few decimals as keep 2 cm to the walls.
#include "drawing/plan/found_rooms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"
#include "drawing/plan/plan.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

using namespace palette;

/// Minimum distance of an option's point from the room's edges, in metres, if possible.
constexpr double kClear = 0.02;

/// Sorts the rooms by storey, in the order of storeys, and by area, the largest first.
std::vector<const FoundRoom*> inOrder(const FoundRooms& found) {
    std::vector<std::string> storeys;
    for (const FoundRoom& room : found.rooms)
        if (std::find(storeys.begin(), storeys.end(), room.storey) == storeys.end())
            storeys.push_back(room.storey);
    std::vector<const FoundRoom*> rooms;
    for (const std::string& storey : storeys) {
        const auto first = static_cast<std::ptrdiff_t>(rooms.size());
        for (const FoundRoom& room : found.rooms)
            if (room.storey == storey) rooms.push_back(&room);
        std::stable_sort(rooms.begin() + first, rooms.end(),
                         [](const auto* a, const auto* b) { return a->area > b->area; });
    }
    return rooms;
}

std::string optionText(Point2 p) { return formatDouble(p.x) + ',' + formatDouble(p.y); }

double clearance(const Region& region, Point2 p) {
    double nearest = std::numeric_limits<double>::infinity();
    region.forEachEdge(
        [&](const Segment2& edge) { nearest = std::min(nearest, distance(p, edge)); });
    return nearest;
}

std::string padded(const std::string& text, std::size_t width) {
    return text + std::string(width > text.size() ? width - text.size() : 0, ' ');
}

}  // namespace

std::string roomsText(const FoundRooms& found) {
    if (found.rooms.empty()) return "no room of the plan is enclosed\n";
    const bool has_storeys =
        std::any_of(found.rooms.begin(), found.rooms.end(),
                    [](const FoundRoom& room) { return !room.storey.empty(); });
    std::vector<std::array<std::string, 5>> rows = {
        {"area m2", "--inside", "--storey", "border", "kept"}};
    for (const FoundRoom* room : inOrder(found))
        rows.push_back({formatFixed(room->area, 2), optionText(room->inside), room->storey,
                        room->touches_border ? "touches" : "-", room->is_kept ? "yes" : "no"});
    std::array<std::size_t, 5> widths{};
    for (const auto& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    std::string text;
    for (const auto& row : rows) {
        text += std::string(widths[0] - row[0].size(), ' ') + row[0];
        for (std::size_t i = 1; i < row.size(); ++i)
            if (i != 2 || has_storeys) text += "  " + padded(row[i], widths[i]);
        while (text.back() == ' ') text.pop_back();
        text += '\n';
    }
    return text;
}

std::string roomsJson(const FoundRooms& found) {
    JsonWriter json;
    beginReport(json, "ispace-rooms/1", "envc");
    json.key("rooms").beginArray();
    for (const FoundRoom* room : inOrder(found)) {
        json.beginObject();
        json.key("area").value(roundSignificant(room->area));
        json.key("inside").beginArray().value(room->inside.x).value(room->inside.y).endArray();
        if (!room->storey.empty()) json.key("storey").value(room->storey);
        json.key("touches_border").value(room->touches_border);
        json.key("kept").value(room->is_kept);
        json.endObject();
    }
    json.endArray();
    json.key("closed_gaps").beginArray();
    for (const Segment2& gap : found.closed_gaps)
        json.beginArray()
            .value(roundSignificant(gap.a.x))
            .value(roundSignificant(gap.a.y))
            .value(roundSignificant(gap.b.x))
            .value(roundSignificant(gap.b.y))
            .endArray();
    json.endArray();
    json.endObject();
    return json.take() + '\n';
}

Point2 shortPointIn(const Region& region, Point2 p) {
    const double clear = std::min(kClear, clearance(region, p) / 2);
    for (const double unit : {100.0, 1000.0, 1e4, 1e5}) {
        const Point2 rounded{std::round(p.x * unit) / unit, std::round(p.y * unit) / unit};
        if (region.locate(rounded) == Side::Inside && clearance(region, rounded) >= clear)
            return rounded;
    }
    return p;
}

void PlanDrawing::drawOtherRooms(const FoundRooms& found) {
    const PlanLayer layer(*this, "rooms not kept");
    for (const FoundRoom& room : found.rooms) {
        if (room.is_kept) continue;
        picture_.pushGroup("", formatFixed(room.area, 1) + " m2, not kept");
        for (const Region& floor : room.floor)
            picture_.area(curvesOf(floor), {kOutside.faded(0.5), pen(kOutsideHatch, 0.06)});
        picture_.pop();
    }
}

void PlanDrawing::drawOtherRoomsWords(const FoundRooms& found) {
    const PlanLayer layer(*this, "choice of rooms");
    const double em = style_.em;
    LabelPlacer places({{0, 0}, {picture_.width(), picture_.height()}}, em);
    const TextStyle style{0.75 * em, false, Align::Center, kFaintInk, kWhite.faded(0.85)};
    for (const FoundRoom* room : inOrder(found)) {
        if (room->is_kept || room->floor.empty()) continue;
        const std::string area = formatFixed(room->area, 1) + " m²";
        const std::string inside = "--inside " + optionText(room->inside);
        const Point2 middle = picture_.toPage(room->inside);
        const double half =
            std::max(textWidth(area, style), textWidth(inside, style)) / 2 + 0.3 * em;
        const bool has_space = places.take(
            {{middle.x - half, middle.y - 1.4 * em}, {middle.x + half, middle.y + 1.2 * em}});
        picture_.circle(room->inside, metres(0.15), {kFaintInk});
        if (!has_space) continue;
        picture_.text({room->inside.x, room->inside.y + metres(0.4)}, area, style);
        picture_.text({room->inside.x, room->inside.y - metres(0.95)}, inside, style);
    }
    const TextStyle gap_style{0.75 * em, true, Align::Center, kSensor, kWhite.faded(0.85)};
    for (const Segment2& gap : found.closed_gaps) {
        const Point2 middle = gap.a + 0.5 * (gap.b - gap.a);
        const std::string text = "gap " + formatFixed(distance(gap.a, gap.b), 2) + " m closed";
        picture_.pushGroup("", text);
        picture_.line(gap.a, gap.b, pen(kSensor, 0.3));
        picture_.circle(middle, std::max(metres(0.6), distance(gap.a, gap.b) / 2),
                        {pen(kSensor, 0.1, {0.4, 0.3})});
        const Point2 page = picture_.toPage(middle);
        const double half = textWidth(text, gap_style) / 2;
        if (places.take({{page.x - half, page.y - 2 * em}, {page.x + half, page.y - em}}))
            picture_.text({middle.x, middle.y + metres(1.1)}, text, gap_style);
        picture_.pop();
    }
}

}  // namespace ispace
