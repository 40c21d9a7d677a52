// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/elements.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "env/openings.h"
#include "env/walls.h"

namespace ispace {

namespace {

/// IEC 61966-2-1.
double encoded(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

/// For each of `wanted` the owner of an equal one among `known`. O(n log n).
template <typename Part, typename Less>
std::vector<std::size_t> match(const std::vector<Part>& wanted, const std::vector<Part>& known,
                               const std::vector<std::size_t>& owners, std::size_t nobody,
                               Less less) {
    std::vector<std::size_t> order(known.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return less(known[a], known[b]); });
    std::vector<std::size_t> result;
    result.reserve(wanted.size());
    for (const Part& part : wanted) {
        const auto at =
            std::lower_bound(order.begin(), order.end(), part,
                             [&](std::size_t i, const Part& p) { return less(known[i], p); });
        const bool found = at != order.end() && !less(part, known[*at]);
        result.push_back(found && *at < owners.size() ? owners[*at] : nobody);
    }
    return result;
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

SliceOwners ownersOf(const Environment& environment, const Slice& slice) {
    const Band band = environment.band(slice.height, slice.height);
    const std::size_t nobody = environment.elements().size();
    const auto line_less = [](const Segment2& a, const Segment2& b) {
        return a.a == b.a ? lexLess(a.b, b.b) : lexLess(a.a, b.a);
    };
    const auto polygon_less = [](const Polygon& a, const Polygon& b) {
        return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), lexLess);
    };
    return {match(slice.sheets, band.sheets, band.sheet_owners, nobody, line_less),
            match(inscribedSolids(slice), band.solids, band.solid_owners, nobody, polygon_less)};
}

}  // namespace ispace
