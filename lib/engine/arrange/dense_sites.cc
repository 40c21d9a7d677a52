// SPDX-License-Identifier: GPL-3.0-or-later
// Finds candidate sites on a lattice, along all walls, under frames and along the medial axis.
//
// The medial axis comes from the Voronoi diagram of samples of the boundary (T. K. Dey, W. Zhao,
// Approximating the medial axis from the Voronoi diagram with a convergence guarantee, 2004):
// CGAL's Delaunay triangulation, with exact predicates. A vertex counts if two of its samples are
// seen from it at nearly a right angle or more, which leaves out vertices between neighbouring
// samples of one wall. Coordinates are snapped to 2^-20 m first, so that cocircular samples, which
// straight walls have by the dozen, do not depend on where the plan lies.
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "arrange/dense_sites.h"
#include "arrange/placement_rules.h"
#include "base/error.h"
#include "base/number.h"
#include "env/point_location.h"
#include "geom/planar_map.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

/// `number` is the step in --candidates.
void mustBeFew(double places, double step, const char* where, const char* number) {
    if (places <= kMaxSites) return;
    throw UsageError("a step of " + formatDouble(step) + " m makes " + formatFixed(places, 0) +
                     " places " + where + ": more than a million are too many, use a larger " +
                     number + " in --candidates GRID,WALL,HEADINGS");
}

/// Returns the number of lattice lines below `extent`, the first at half a step.
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

/// Returns the number of sites over a length, the same for a moved plan in spite of rounding.
double placesOver(double length, double step) {
    return std::max(1.0, std::round((length + kWeldDistance) / step));
}

/// Consecutive edges of a curve over which sites are spread evenly.
struct Stretch {
    std::size_t first = 0, count = 0;
    double length = 0;
};

/// Splits a curve into stretches: a long edge is one stretch; the edges between two long ones are
/// one stretch, so that the many small edges of round and ragged objects do not get a site each.
/// Edges count from a long one on, if there is any.
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

/// Returns the mid-line of a bar along its length.
/// \pre the footprint is a rectangle
Segment2 midLine(const Polygon& bar) {
    const bool is_along = distance(bar[0], bar[1]) >= distance(bar[1], bar[2]);
    return is_along ? Segment2{middleOf(bar[3], bar[0]), middleOf(bar[1], bar[2])}
                    : Segment2{middleOf(bar[0], bar[1]), middleOf(bar[2], bar[3])};
}

}  // namespace

/// Places are even along each bar and half a step from its ends, at least one for each bar.
std::vector<Point3> framePlaces(const Environment& environment, double step) {
    assert(step > 0);
    std::vector<Point3> places;
    for (const Element& element : environment.elements()) {
        if (element.record.keyword() != "infra") continue;
        for (const Prism& bar : element.body.prisms) {
            const auto [a, b] = midLine(bar.footprint);
            const double count = std::max(1.0, std::round((distance(a, b) + kWeldDistance) / step));
            if (static_cast<double>(places.size()) + count > kMaxSites)
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

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Delaunay = CGAL::Delaunay_triangulation_2<Kernel>;

/// Coordinates are relative to a corner of the floor and in whole steps of about a micrometre, so
/// that a moved plan gets the same sites: samples of straight walls lie on common circles by the
/// dozen, and rounding would decide between them.
constexpr double kStep = 0x1p-20;
double snapped(double value) { return std::round(value / kStep) * kStep; }
Vec2 snapped(Vec2 v) { return {snapped(v.x), snapped(v.y)}; }

/// Minimum distance between two samples, as a share of the step between sites.
constexpr double kSampleShare = 1.0 / 3;

std::vector<Kernel::Point_2> samplesOf(const std::vector<Polygon>& curves, Point2 origin,
                                       double apart) {
    constexpr double kMaxSamples = 4e6;
    double wanted = 0;
    for (const Polygon& curve : curves)
        wanted += perimeter(curve) / apart + static_cast<double>(curve.size());
    if (!(wanted <= kMaxSamples))
        throw UsageError("a step of " + formatDouble(apart / kSampleShare) +
                         " m is too small for a floor of this size: use a larger GRID in "
                         "--candidates GRID,WALL,HEADINGS");
    std::vector<Kernel::Point_2> samples;
    samples.reserve(static_cast<std::size_t>(wanted) + curves.size());
    for (const Polygon& curve : curves)
        forEachEdge(curve, [&](const Segment2& edge) {
            const Vec2 from = snapped(edge.a - origin), along = snapped(edge.b - origin) - from;
            const double count = std::max(1.0, std::ceil(length(along) / apart));
            for (int i = 0; i < static_cast<int>(count); ++i) {
                const Vec2 sample = snapped(from + (i / count) * along);
                samples.emplace_back(sample.x, sample.y);
            }
        });
    return samples;
}

/// A point of the medial axis, relative to the origin, with its distance to the nearest walls.
struct AxisPlace {
    Vec2 place;
    double clearance = 0;
};

/// Returns true if two of the samples on the circle are seen from its centre at nearly a right
/// angle or more: samples lie beside the points where walls touch, and in a square corner the walls
/// are seen at exactly a right angle.
bool isBetweenWalls(const Delaunay::Face& face, Kernel::Point_2 center, double squared_radius) {
    constexpr double kCosine = 0.1;
    for (int i = 0; i < 3; ++i) {
        const auto a = face.vertex(i)->point() - center,
                   b = face.vertex((i + 1) % 3)->point() - center;
        if (a * b <= kCosine * squared_radius) return true;
    }
    return false;
}

/// Keeps one point in each square of a lattice: the farthest from all walls, then the nearest to
/// the middle of the square.
std::vector<AxisPlace> thinned(std::vector<AxisPlace> places, double step) {
    const auto cell = [step](double x) { return std::floor(x / step); };
    const auto offset = [&](Vec2 p) {
        return snapped(std::hypot(p.x - (cell(p.x) + 0.5) * step, p.y - (cell(p.y) + 0.5) * step));
    };
    const auto key = [&](const AxisPlace& p) {
        return std::tuple(cell(p.place.y), cell(p.place.x), -p.clearance, offset(p.place),
                          p.place.y, p.place.x);
    };
    std::sort(places.begin(), places.end(),
              [&](const AxisPlace& a, const AxisPlace& b) { return key(a) < key(b); });
    const auto in_one = [&](const AxisPlace& a, const AxisPlace& b) {
        return cell(a.place.x) == cell(b.place.x) && cell(a.place.y) == cell(b.place.y);
    };
    places.erase(std::unique(places.begin(), places.end(), in_one), places.end());
    return places;
}

}  // namespace

std::vector<Point2> medialPlaces(const std::vector<Region>& free_floor, double step,
                                 std::span<const Segment2> sheets) {
    assert(step > 0);
    const Box2 box = bounds(free_floor);
    if (box.empty()) return {};
    const Point2 origin = box.low;

    const double apart = step * kSampleShare;
    const auto samples = samplesOf(wallCurves(free_floor, sheets), origin, apart);
    const Delaunay delaunay(samples.begin(), samples.end());
    const RegionIndex floor(free_floor);
    std::vector<AxisPlace> found;
    found.reserve(delaunay.number_of_faces());
    for (auto face = delaunay.finite_faces_begin(); face != delaunay.finite_faces_end(); ++face) {
        const Kernel::Point_2 center = delaunay.circumcenter(face);
        const double squared = CGAL::squared_distance(center, face->vertex(0)->point());
        // Circles smaller than the distance between samples touch walls at random.
        if (!(squared >= apart * apart)) continue;
        if (!isBetweenWalls(*face, center, squared)) continue;
        const Vec2 place = snapped(Vec2{center.x(), center.y()});
        if (floor.locate(origin + place) == Side::Inside)
            found.push_back({place, snapped(std::sqrt(squared))});
    }
    std::vector<Point2> places;
    for (const AxisPlace& kept : thinned(std::move(found), step))
        places.push_back(origin + kept.place);
    return places;
}

}  // namespace ispace
