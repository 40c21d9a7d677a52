// SPDX-License-Identifier: GPL-3.0-or-later
// Candidates in the middle between walls.
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <tuple>

#include "base/error.h"
#include "base/number.h"
#include "geom/predicates.h"
#include "place/inside_index.h"
#include "place/sites.h"
#include "place/wall_curves.h"

namespace ispace {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Delaunay = CGAL::Delaunay_triangulation_2<Kernel>;

/// Everything happens relative to a corner of the floor and in whole steps of a micrometre or so,
/// so that a plan that was moved gets the same places: samples of straight walls lie on common
/// circles by the dozen, and rounding would decide between them.
constexpr double kStep = 0x1p-20;
double snapped(double value) { return std::round(value / kStep) * kStep; }
Vec2 snapped(Vec2 v) { return {snapped(v.x), snapped(v.y)}; }

/// Least distance between two samples, as a share of the step between places.
constexpr double kSampleShare = 1.0 / 3;

std::vector<Kernel::Point_2> samplesOf(const std::vector<Polygon>& curves, Point2 origin,
                                       double apart) {
    constexpr double kMostSamples = 4e6;
    double wanted = 0;
    for (const Polygon& curve : curves)
        wanted += perimeter(curve) / apart + static_cast<double>(curve.size());
    if (!(wanted <= kMostSamples))
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

/// A place of the medial axis, relative to the origin, and how far the nearest walls are.
struct AxisPlace {
    Vec2 place;
    double clearance = 0;
};

/// True if two of the samples that touch the circle are seen from its centre at least this far
/// apart. A right angle, and what samples may lie beside the points where walls touch it: in a
/// square corner both walls are seen at just a right angle.
bool isBetweenWalls(const Delaunay::Face& face, Kernel::Point_2 center, double squared_radius) {
    constexpr double kCosine = 0.1;
    for (int i = 0; i < 3; ++i) {
        const auto a = face.vertex(i)->point() - center,
                   b = face.vertex((i + 1) % 3)->point() - center;
        if (a * b <= kCosine * squared_radius) return true;
    }
    return false;
}

/// Keeps one place of each square of a lattice: that farthest from all walls, then the nearest to
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
    Box2 box;
    for (const Region& region : free_floor)
        for (const Point2 corner : region.outline) box.add(corner);
    if (box.empty()) return {};
    const Point2 origin = box.low;

    const double apart = step * kSampleShare;
    const auto samples = samplesOf(wallCurves(free_floor, sheets), origin, apart);
    const Delaunay delaunay(samples.begin(), samples.end());
    const InsideIndex floor(free_floor);
    std::vector<AxisPlace> found;
    found.reserve(delaunay.number_of_faces());
    for (auto face = delaunay.finite_faces_begin(); face != delaunay.finite_faces_end(); ++face) {
        const Kernel::Point_2 center = delaunay.circumcenter(face);
        const double squared = CGAL::squared_distance(center, face->vertex(0)->point());
        // Nearer to a wall than its samples are to each other, circles touch where they lie by
        // chance.
        if (!(squared >= apart * apart)) continue;
        if (!isBetweenWalls(*face, center, squared)) continue;
        const Vec2 place = snapped(Vec2{center.x(), center.y()});
        if (floor.isInside(origin + place)) found.push_back({place, snapped(std::sqrt(squared))});
    }
    std::vector<Point2> places;
    for (const AxisPlace& kept : thinned(std::move(found), step))
        places.push_back(origin + kept.place);
    return places;
}

}  // namespace ispace
