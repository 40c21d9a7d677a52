// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/walls.h"

#include <optional>
#include <string>
#include <utility>

#include "base/number.h"
#include "env/standing.h"

namespace ispace {

namespace {

Point2 pointOf(const Tuple& tuple) { return {tuple[0], tuple[1]}; }

Material materialOf(const std::string& kind) {
    if (kind == "brick") return Material::Brick;
    if (kind == "wood") return Material::Wood;
    if (kind == "concrete") return Material::Concrete;
    return Material::Wall;
}

/// What the weld would make one point of is no line.
bool isZeroLength(const Segment2& line) { return distance(line.a, line.b) <= kWeldDistance; }

bool hasAnEnd(const Record& record) { return record.has("from") || record.has("to"); }

/// The line from `from` to `to`; findings for half of it, or if another key gives the place too.
/// \pre hasAnEnd(record)
std::optional<Segment2> lineByEnds(const Record& record,
                                   std::initializer_list<std::string_view> others,
                                   Diagnostics& findings) {
    for (const std::string_view other : others)
        if (record.has(other))
            findings.add(record.finding(other, record.keyword() + " has `from`/`to` and also `" +
                                                   std::string(other) +
                                                   "`: give its place one way only"));
    if (record.has("from") && record.has("to"))
        return Segment2{pointOf(record.tuple("from")), pointOf(record.tuple("to"))};
    const bool from = record.has("from");
    findings.add(record.finding(
        from ? "from" : "to",
        "`from` and `to` belong together: `" + std::string(from ? "to" : "from") + "` is missing"));
    return std::nullopt;
}

/// Lays a wall by `at`, `heading` and `size`. False, with a finding, if that gives no wall.
bool layAlong(const Record& record, WallLine& wall, Diagnostics& findings) {
    if (!record.has("size")) {
        findings.add(record.finding("wall has no extent: give `from` and `to`, or `size`"));
        return false;
    }
    const Tuple& at = record.tuple("at");
    const Tuple& size = record.tuple("size");
    const Vec2 half = size[0] / 2 * unitVector(record.angle("heading"));
    wall.line = {pointOf(at) - half, pointOf(at) + half};
    if (size.size() > 1) wall.thickness = size[1];
    if (size.size() > 2) wall.top = size[2];
    if (at.size() > 2) wall.bottom = at[2];
    wall.top += wall.bottom;
    if (wall.top > wall.bottom) return true;
    findings.add(record.finding("size", "wall has zero height"));
    return false;
}

std::vector<WallLine> wallLine(const Record& record, Diagnostics& findings) {
    WallLine wall;
    wall.thickness = record.number("thickness");
    wall.top = record.number("height");
    wall.material = materialOf(record.text("kind"));
    const bool by_ends = hasAnEnd(record);
    if (by_ends) {
        const auto line = lineByEnds(record, {"at", "heading", "size"}, findings);
        if (!line) return {};
        wall.line = *line;
    } else if (!layAlong(record, wall, findings)) {
        return {};
    }
    if (!isZeroLength(wall.line)) return {wall};
    findings.add(record.finding(by_ends ? "to" : "size", "wall has zero length"));
    return {};
}

/// Points of a fence as written; none, with a finding, if it has no extent.
std::vector<Point2> fencePoints(const Record& record, Diagnostics& findings) {
    std::vector<Point2> points;
    if (hasAnEnd(record)) {
        if (const auto line = lineByEnds(record, {"path"}, findings)) points = {line->a, line->b};
    } else if (record.has("path")) {
        for (const Tuple& tuple : record.list("path")) points.push_back(pointOf(tuple));
    } else {
        findings.add(record.finding("fence has no extent: give `path`, or `from` and `to`"));
    }
    return points;
}

std::vector<WallLine> fenceLines(const Record& record, Diagnostics& findings) {
    std::vector<Point2> points = fencePoints(record, findings);
    if (points.empty()) return {};
    const std::string_view extent = record.has("path") ? "path" : "to";
    const bool closed = record.flag("closed");
    // A closed path that repeats its first point is closed all the same.
    if (closed && points.size() > 1 && points.front() == points.back()) points.pop_back();
    const std::size_t least = closed ? 3 : 2;
    if (points.size() < least) {
        findings.add(record.finding(extent, std::string(closed ? "closed fence" : "fence") +
                                                " has " + std::to_string(points.size()) +
                                                " points, wanted at least " +
                                                std::to_string(least)));
        return {};
    }
    if (closed) points.push_back(points.front());
    std::vector<WallLine> out;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const Segment2 line{points[i], points[i + 1]};
        if (isZeroLength(line))
            findings.add(record.finding(
                extent, "fence has a piece of zero length at (" + formatDouble(line.a.x) + ", " +
                            formatDouble(line.a.y) + "): leave out the repeated point"));
        else
            out.push_back(
                {line, 0, record.number("height"), record.number("thickness"), Material::Wall});
    }
    return out;
}

std::vector<WallLine> roomLines(const Record& record, Diagnostics& findings) {
    const Standing room = standingOf(record);
    std::vector<WallLine> out;
    bool zero = false;
    forEachEdge(room.rectangle(), [&](const Segment2& line) {
        zero = zero || isZeroLength(line);
        out.push_back({line, room.bottom, room.top, 0, Material::Wall});
    });
    if (!zero) return out;
    findings.add(record.finding("size", "ispace has a wall of zero length"));
    return {};
}

}  // namespace

bool isWall(const Record& record) {
    const std::string& keyword = record.keyword();
    return keyword == "wall" || keyword == "fence" || keyword == "ispace";
}

void WallPlan::add(const WallLine& wall, std::size_t element) {
    walls.push_back(wall);
    lines.push_back(wall.line);
    owner.push_back(element);
}

std::vector<WallLine> wallLinesOf(const Record& record, Diagnostics& findings) {
    if (record.keyword() == "wall") return wallLine(record, findings);
    if (record.keyword() == "fence") return fenceLines(record, findings);
    if (record.keyword() == "ispace") return roomLines(record, findings);
    return {};
}

std::vector<Segment2> wallLines(const Record& record, Diagnostics& findings) {
    std::vector<Segment2> out;
    for (const WallLine& wall : wallLinesOf(record, findings)) out.push_back(wall.line);
    return out;
}

}  // namespace ispace
