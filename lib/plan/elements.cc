// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/elements.h"

#include <algorithm>
#include <cmath>

#include "env/openings.h"
#include "env/walls.h"

namespace ispace {

namespace {

/// IEC 61966-2-1.
double encoded(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace

Color displayColor(Material material) {
    const Look& look = lookOf(material);
    return {encoded(look.color[0]), encoded(look.color[1]), encoded(look.color[2]), look.opacity};
}

std::vector<std::vector<Point2>> chained(const std::vector<Segment2>& segments) {
    std::vector<std::vector<Point2>> chains;
    for (const Segment2& segment : segments) {
        if (chains.empty() || !(chains.back().back() == segment.a)) chains.push_back({segment.a});
        chains.back().push_back(segment.b);
    }
    return chains;
}

std::vector<ElementLines> elementLinesOf(const Environment& environment) {
    const std::vector<Element>& elements = environment.elements();
    Diagnostics findings;  // stays empty: the environment would not be there
    std::vector<ElementLines> result(elements.size());
    WallPlan plan;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        std::vector<Segment2> segments;
        for (const WallLine& wall : wallLinesOf(elements[i].record, findings)) {
            segments.push_back(wall.line);
            result[i].thickness = wall.thickness;
            plan.add(wall, i);
        }
        result[i].chains = chained(segments);
    }
    const auto is_opening = [](const Element& element) {
        return element.record.keyword() == "door" || element.record.keyword() == "window";
    };
    if (std::none_of(elements.begin(), elements.end(), is_opening)) return result;
    for (const Opening& opening : placeOpenings(elements, plan, findings)) {
        const Segment2 wall = plan.lines[opening.line];
        const Vec2 along = 1 / distance(wall.a, wall.b) * (wall.b - wall.a);
        result[opening.element] = {{{wall.a + opening.from * along, wall.a + opening.to * along}},
                                   plan.walls[opening.line].thickness,
                                   opening.bottom,
                                   opening.top};
    }
    return result;
}

Polygon floorOutline(const Record& record) {
    const Tuple& at = record.tuple("at");
    const Tuple& size = record.tuple("size");
    return rectangle({at[0], at[1]}, size[0], size[1], record.angle("heading"));
}

std::vector<Polygon> inscribedSolids(const Slice& slice) {
    std::vector<Polygon> solids = slice.solids;
    for (const Slice::Round& round : slice.rounds) solids[round.solid] = inscribedIn(round.curve);
    return solids;
}

}  // namespace ispace
