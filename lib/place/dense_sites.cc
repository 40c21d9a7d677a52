// SPDX-License-Identifier: GPL-3.0-or-later
// Candidates on a lattice, along all walls and under frames.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/number.h"
#include "geom/planar_map.h"
#include "place/sites.h"
#include "place/wall_curves.h"

namespace ispace {

namespace {

/// `number` of --candidates is the step.
void mustBeFew(double places, double step, const char* where, const char* number) {
    if (places <= kMostSites) return;
    throw UsageError("a step of " + formatDouble(step) + " m makes " + formatFixed(places, 0) +
                     " places " + where + ": more than a million are too many, use a larger " +
                     number + " in --candidates GRID,WALL,HEADINGS");
}

/// Lattice lines below `extent`, the first at half a step.
double linesBelow(double extent, double step) {
    return std::max(0.0, std::ceil(extent / step - 0.5));
}

}  // namespace

std::vector<Point2> latticePlaces(const Box2& limits, double step) {
    assert(step > 0);
    const double columns = linesBelow(limits.width(), step),
                 rows = linesBelow(limits.depth(), step);
    mustBeFew(columns * rows, step, "of a lattice", "GRID");
    std::vector<Point2> places;
    places.reserve(static_cast<std::size_t>(columns * rows));
    for (int row = 0; row < static_cast<int>(rows); ++row)
        for (int column = 0; column < static_cast<int>(columns); ++column)
            places.push_back(
                {limits.low.x + (column + 0.5) * step, limits.low.y + (row + 0.5) * step});
    return places;
}

namespace {

/// What is half a step too long for a number of places in a plan is so in a moved one, whatever
/// rounds.
double placesOver(double length, double step) {
    return std::max(1.0, std::round((length + kWeldDistance) / step));
}

/// Some edges of a curve that follow each other, over which places are spread evenly.
struct Stretch {
    std::size_t first = 0, count = 0;
    double length = 0;
};

/// A long edge is a stretch of its own, and so are the edges between long ones all together: the
/// many small ones of round and ragged things shall not get a place each. Edges count from a long
/// one on, if there is any.
std::vector<Stretch> stretchesOf(const Polygon& curve, double step) {
    const std::size_t n = curve.size();
    std::vector<double> lengths;
    lengths.reserve(n);
    forEachEdge(curve, [&](const Segment2& edge) { lengths.push_back(distance(edge.a, edge.b)); });
    const auto is_long = [step](double length) { return length + kWeldDistance >= step; };
    const auto first = std::find_if(lengths.begin(), lengths.end(), is_long);
    const auto start = static_cast<std::size_t>(
        std::distance(lengths.begin(), first == lengths.end() ? lengths.begin() : first));
    std::vector<Stretch> stretches;
    bool is_open = false;  // the last stretch takes further short edges
    for (std::size_t i = start; i < start + n; ++i) {
        const double length = lengths[i % n];
        if (is_long(length) || !is_open) stretches.push_back({i, 0, 0});
        stretches.back().count += 1;
        stretches.back().length += length;
        is_open = !is_long(length);
    }
    return stretches;
}

void addPlaces(const Polygon& curve, const Stretch& stretch, double step, double off,
               std::vector<Point2>& places) {
    if (!(stretch.length > 0)) return;
    const double count = placesOver(stretch.length, step);
    mustBeFew(static_cast<double>(places.size()) + count, step, "along the walls", "WALL");
    std::size_t edge = stretch.first;
    double before = 0;  // length of the stretch up to the edge
    for (int i = 0; i < static_cast<int>(count); ++i) {
        const double wanted = (i + 0.5) / count * stretch.length;
        Point2 a = curve[edge % curve.size()], b = curve[(edge + 1) % curve.size()];
        double length = distance(a, b);
        while (edge + 1 < stretch.first + stretch.count &&
               before + length + kWeldDistance <= wanted) {
            before += length;
            ++edge;
            a = std::exchange(b, curve[(edge + 1) % curve.size()]);
            length = distance(a, b);
        }
        if (!(length > 0)) continue;
        const Vec2 along = (1 / length) * (b - a);
        places.push_back(a + std::min(wanted - before, length) * along +
                         off * perpendicular(along));
    }
}

}  // namespace

std::vector<Point2> placesAlong(const std::vector<Region>& free_floor, double step, double off,
                                std::span<const Segment2> sheets) {
    assert(step > 0);
    std::vector<Point2> places;
    for (const Polygon& curve : wallCurves(free_floor, sheets)) {
        const Polygon corners = wallCorners(curve);
        if (corners.size() < 2) continue;
        for (const Stretch& stretch : stretchesOf(corners, step))
            addPlaces(corners, stretch, step, off, places);
    }
    return places;
}

namespace {

Point2 middleOf(Point2 a, Point2 b) { return a + 0.5 * (b - a); }

/// The mid-line of a bar along its length. \pre the footprint is a rectangle
Segment2 midLine(const Polygon& bar) {
    const bool is_along = distance(bar[0], bar[1]) >= distance(bar[1], bar[2]);
    return is_along ? Segment2{middleOf(bar[3], bar[0]), middleOf(bar[1], bar[2])}
                    : Segment2{middleOf(bar[0], bar[1]), middleOf(bar[2], bar[3])};
}

}  // namespace

std::vector<Point3> framePlaces(const Environment& environment, double step) {
    assert(step > 0);
    std::vector<Point3> places;
    for (const Element& element : environment.elements()) {
        if (element.record.keyword() != "infra") continue;
        for (const Prism& bar : element.body.prisms) {
            const auto [a, b] = midLine(bar.footprint);
            const double count = std::max(1.0, std::round((distance(a, b) + kWeldDistance) / step));
            if (static_cast<double>(places.size()) + count > kMostSites)
                throw UsageError("a step of " + formatDouble(step) +
                                 " m makes more than a million places under the frames: those are "
                                 "too many, use a larger GRID in --candidates GRID,WALL,HEADINGS");
            for (int i = 0; i < static_cast<int>(count); ++i) {
                const Point2 place = a + ((i + 0.5) / count) * (b - a);
                places.push_back({place.x, place.y, bar.bottom - kUnderBar});
            }
        }
    }
    return places;
}

}  // namespace ispace
