// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "cover/map_parts.h"

namespace ispace {

namespace {

bool standsAt(const Prism& prism, double height) {
    return prism.bottom <= height && height <= prism.top;
}

/// A room's own walls count as walls, not as things in it.
bool isWall(const Element& element) {
    const RecordType type = element.record.schema().type;
    return type == RecordType::Wall || type == RecordType::Space;
}

void drawObjects(Picture& picture, const Scene& scene, double height, double em) {
    for (const bool at_height : {false, true}) {
        const Color inner = at_height ? palette::kSolid : palette::kObject;
        const Stroke edge{at_height ? palette::kSolidEdge : palette::kObjectEdge, em / 16};
        for (const Element& element : scene.environment.elements()) {
            if (isWall(element)) continue;
            for (const Prism& prism : element.body.prisms) {
                if (standsAt(prism, height) != at_height) continue;
                // What does not stand in the way lets the floor's colour through.
                picture.area(prism.footprint, {at_height ? inner : inner.faded(0.6)});
                picture.area(prism.footprint, {edge});
            }
        }
    }
}

/// Width of wall lines: finer where walls are made of short pieces, as in ragged maps.
double wallWidth(const Environment& environment, double scale, double em) {
    double sum = 0;
    for (const Segment2& wall : environment.wallLines()) sum += distance(wall.a, wall.b);
    const double mean = sum / static_cast<double>(environment.wallLines().size());
    return std::clamp(0.1 * scale * mean, em / 14, em / 7);
}

/// What of a wall stops sight at this height; the rest is an open door's lintel, a sill, glass.
bool stopsAt(const Sheet& sheet, double height) {
    return !sheet.clear && sheet.bottom <= height && height <= sheet.top;
}

/// Lines and bodies of walls: those that let sight pass first, pale, so that the others' ends show.
void drawWalls(Picture& picture, const Scene& scene, double height, double scale, double em) {
    const double width = wallWidth(scene.environment, scale, em);
    for (const bool stopping : {false, true}) {
        const Color color = stopping ? palette::kWall : palette::kOpening;
        for (const Element& element : scene.environment.elements()) {
            std::vector<Segment2> lines;
            for (const Sheet& sheet : element.body.sheets)
                if (stopsAt(sheet, height) == stopping) lines.push_back(sheet.line);
            if (!lines.empty()) picture.lines(lines, {Stroke{color, stopping ? width : width / 2}});
            if (!isWall(element)) continue;
            for (const Prism& prism : element.body.prisms) {
                if (standsAt(prism, height) != stopping) continue;
                if (stopping) picture.area(prism.footprint, {color});
                picture.area(prism.footprint, {Stroke{color, em / 16}});
            }
        }
    }
}

void drawZones(Picture& picture, const MapPicture& map) {
    for (const Element& element : map.scene.environment.elements())
        if (element.record.keyword() == "zone")
            picture.area(zoneOutline(element.record),
                         {Stroke{palette::kZone, map.em / 10, {map.em / 2, map.em / 3}}});
}

}  // namespace

MapContents contentsOf(const Scene& scene, const Coverage& coverage) {
    MapContents contents;
    contents.outside = !outsideOf(scene.environment.indoor()).empty();
    for (const Element& element : scene.environment.elements()) {
        if (element.record.keyword() == "zone") contents.zones = true;
        const double height = coverage.target.height;
        for (const Sheet& sheet : element.body.sheets)
            (stopsAt(sheet, height) ? contents.walls : contents.openings) = true;
        for (const Prism& prism : element.body.prisms) {
            const bool solid = standsAt(prism, height);
            if (isWall(element) && !standsAt(prism, height)) {
                contents.openings = true;
                continue;
            }
            (isWall(element) ? contents.walls : solid ? contents.solids : contents.objects) = true;
        }
    }
    return contents;
}

void drawPlan(Picture& picture, const MapPicture& map) {
    const Box2& limits = map.limits();
    const double rim = map.em / 4 / map.view.scale;  // walls on the limits are drawn whole
    const Polygon frame = {{limits.low.x - rim, limits.low.y - rim},
                           {limits.high.x + rim, limits.low.y - rim},
                           {limits.high.x + rim, limits.high.y + rim},
                           {limits.low.x - rim, limits.high.y + rim}};
    picture.pushView(map.view);
    picture.pushClip(frame);
    drawFloor(picture, map);
    drawViews(picture, map);
    drawObjects(picture, map.scene, map.coverage.target.height, map.em);
    drawWalls(picture, map.scene, map.coverage.target.height, map.view.scale, map.em);
    drawZones(picture, map);
    picture.pop();
    picture.pop();
}

}  // namespace ispace
