// SPDX-License-Identifier: GPL-3.0-or-later
// The candidates of the thesis: Ordinary Grid, Along Wall, Hierarchical Random.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/number.h"
#include "base/random.h"
#include "geom/boolean.h"
#include "place/sites.h"
#include "place/wall_curves.h"

namespace ispace {

namespace {

int linesAlong(double extent, double max_range) {
    constexpr double kMax = 10000;
    // A room that is moved is no smaller because its corners round.
    constexpr double kSlack = 1e-9;
    const double lines = std::floor(extent / max_range * kSegments - 1 + kSlack);
    return static_cast<int>(std::clamp(lines, 1.0, kMax));
}

}  // namespace

std::vector<Angle> headingsAround(int count) {
    std::vector<Angle> headings;
    headings.reserve(static_cast<std::size_t>(std::max(0, count)));
    for (int i = 0; i < count; ++i) headings.push_back(Angle::degrees(360.0 * i / count));
    return headings;
}

GridSearch defaultGridSearch(const Box2& limits, double max_range) {
    return {linesAlong(limits.width(), max_range), linesAlong(limits.depth(), max_range)};
}

std::vector<Point2> gridPlaces(const Box2& limits, const GridSearch& search) {
    std::vector<Point2> places;
    places.reserve(static_cast<std::size_t>(search.x) * static_cast<std::size_t>(search.y));
    for (int j = 1; j <= search.y; ++j)
        for (int i = 1; i <= search.x; ++i)
            places.push_back({limits.low.x + i * limits.width() / (search.x + 1),
                              limits.low.y + j * limits.depth() / (search.y + 1)});
    return places;
}

namespace {

/// One in so many of a wall's places is at its one end, and as many at the other.
constexpr int kWallEnds = 3;

/// Adds the headings at an end of a wall, for the sensor that shall see around the corner.
/// `turn` leads from the wall's normal to the neighbour's, on the side of the room.
void addTurned(Site& site, Angle normal, Angle turn) {
    for (const Angle heading : {wrapped(normal + 0.5 * turn), wrapped(normal + turn)})
        if (std::find(site.headings.begin(), site.headings.end(), heading) == site.headings.end())
            site.headings.push_back(heading);
}

/// From one normal to the next of a curve; where a sheet ends, around that end.
Angle turnBetween(Angle normal, Angle next) {
    // Degrees by which rounding and welding may turn a side of a sheet. To the left lies no floor
    // to speak of between walls at such an angle.
    constexpr double kSlack = 1e-3;
    const Angle turn = wrapped(next - normal);
    return turn >= Angle::degrees(180 - kSlack) ? turn - Angle::degrees(360) : turn;
}

/// Along the walls between the corners of a closed curve. \pre there are at least two corners
void addWallSites(const Polygon& corners, double dist, int times, std::vector<Site>& sites) {
    const std::size_t n = corners.size();
    std::vector<Angle> normals;
    normals.reserve(n);
    forEachEdge(corners, [&](const Segment2& wall) {
        const Vec2 inner = perpendicular(wall.b - wall.a);
        normals.push_back(directionOf(inner.x, inner.y));
    });
    const int ends = std::max(1, times / kWallEnds);
    for (std::size_t i = 0; i < n; ++i) {
        const Point2 from = corners[i];
        const Vec2 along = corners[(i + 1) % n] - from;
        const Vec2 off = (dist / length(along)) * perpendicular(along);
        const Angle normal = normals[i];
        const Angle to_last = -turnBetween(normals[(i + n - 1) % n], normal);
        const Angle to_next = turnBetween(normal, normals[(i + 1) % n]);
        for (int k = 1; k <= times; ++k) {
            const double share = static_cast<double>(k) / (times + 1);
            Site site{from + share * along + off, {normal}};
            if (k <= ends) addTurned(site, normal, to_last);
            if (times - k < ends) addTurned(site, normal, to_next);
            sites.push_back(std::move(site));
        }
    }
}

void mustBeFew(std::size_t walls, int times) {
    const double places = static_cast<double>(walls) * times;
    if (places <= kMaxSites) return;
    throw UsageError(std::to_string(times) + " places along each of " + std::to_string(walls) +
                     " walls make " + formatFixed(places, 0) +
                     ": more than a million are too many, use fewer (--times)");
}

}  // namespace

std::vector<Site> wallSites(const Environment& environment, double height, double dist, int times) {
    assert(times >= 0);
    const Slice slice = wallSlice(environment, height);
    std::vector<Region> floor = environment.indoor().parts;
    if (!slice.solids.empty()) floor = difference(environment.indoor(), slice.solids);
    // What lies on the left of each is free.
    std::vector<Polygon> curves = wallCurves(floor, slice.sheets);
    std::size_t walls = 0;
    for (Polygon& curve : curves) {
        curve = wallCorners(curve);
        if (curve.size() < 2) curve.clear();
        walls += curve.size();
    }
    mustBeFew(walls, times);
    std::vector<Site> sites;
    sites.reserve(walls * static_cast<std::size_t>(times));
    for (const Polygon& corners : curves)
        if (!corners.empty()) addWallSites(corners, dist, times, sites);
    return sites;
}

namespace {

/// Which places of a sensor are drawn.
enum class Draws : std::uint64_t { Anywhere, AboutTheBest };

/// Two numbers in [0, 1) of their own for each place of a sequence.
std::array<double, 2> drawPair(const RandomSequence& sequence, Draws draws, std::uint64_t k) {
    // A place takes four elements of 24 bits. What does not fit into their number goes on in
    // further sequences.
    constexpr unsigned kPlaceBits = 30, kSequenceBits = 32;
    const std::uint64_t number = 2 * sequence.sensor + static_cast<std::uint64_t>(draws);
    const RandomKey key{.seed = sequence.seed,
                        .purpose = Purpose::Candidates,
                        .sensor = hashOf(sequence.id),
                        .frame = (k >> kPlaceBits) << kSequenceBits | number};
    std::array<float, 4> parts{};
    draw(key, static_cast<std::uint32_t>(k << 2U), {.uniform = parts});
    const auto joined = [](float high, float low) {
        return static_cast<double>(high) + 0x1p-24 * static_cast<double>(low);
    };
    return {joined(parts[0], parts[1]), joined(parts[2], parts[3])};
}

}  // namespace

Point2 randomPlace(const Box2& limits, const RandomSequence& sequence, std::uint64_t k) {
    const auto [x, y] = drawPair(sequence, Draws::Anywhere, k);
    return {limits.low.x + x * limits.width(), limits.low.y + y * limits.depth()};
}

Point2 randomPlaceAbout(Point2 center, double scope, const RandomSequence& sequence,
                        std::uint64_t k) {
    const auto [share, turn] = drawPair(sequence, Draws::AboutTheBest, k);
    // The disc within a share of its radius has the square of that share of its area.
    return center + scope * std::sqrt(share) * unitVector(Angle::degrees(360 * turn));
}

}  // namespace ispace
