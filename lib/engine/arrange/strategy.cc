// SPDX-License-Identifier: GPL-3.0-or-later
// The strategies of the thesis: Ordinary Grid, Along Wall, Hierarchical Random; the strategy table.
// Sections 4.4.2, 4.4.5 and 4.4.3; equations (4.1) and (4.2) give the lines of the grid.
#include "arrange/strategy.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <iterator>
#include <string>

#include "arrange/dense_sites.h"
#include "arrange/placement_rules.h"
#include "base/error.h"
#include "base/number.h"
#include "base/random.h"
#include "env/level.h"
#include "geom/arrangement.h"
#include "geom/tolerance.h"

namespace ispace {

namespace {

constexpr double kMaxLines = 10000, kMaxPlaces = 100000;
constexpr double kMaxLength = 1e6, kMaxDist = 1000, kMinLength = 0.001;  // metres

/// A lattice over the limits, then points along walls and objects at the height.
std::vector<Site> proposeAll(const ProposalRequest& request) {
    const auto& [environment, height, max_range, options] = request;
    const CandidateDensity& density = options.density;
    std::vector<Point2> places = latticePlaces(environment.limits(), density.lattice_step);
    const auto level = environment.level(height);
    const std::vector<Point2> along =
        placesAlong(level->freeFloor(), density.wall_step, kOffWall, level->slice().sheets);
    places.insert(places.end(), along.begin(), along.end());
    return sitesAt(places, headingsPerPlace(options));
}

std::vector<Site> proposeGrid(const ProposalRequest& request) {
    const Box2& limits = request.environment.limits();
    GridSearch search = defaultGridSearch(limits, request.max_range);
    search.x = request.options.x.value_or(search.x);
    search.y = request.options.y.value_or(search.y);
    if (static_cast<double>(search.x) * search.y > kMaxSites)
        throw UsageError("a grid of " + std::to_string(search.x) + " x " +
                         std::to_string(search.y) +
                         " places is more than a million: use fewer lines (-X, -Y)");
    return sitesAt(gridPlaces(limits, search), headingsPerPlace(request.options));
}

std::vector<Site> proposeNone(const ProposalRequest& /*request*/) { return {}; }

/// The thesis' Along Wall; with --deg its headings turn with the normals.
std::vector<Site> proposeAlongWalls(const ProposalRequest& request) {
    const ArrangeOptions& options = request.options;
    std::vector<Site> sites =
        wallSites(request.environment, request.height, options.dist, options.times);
    if (!options.headings) return sites;
    for (Site& site : sites) {
        const Angle normal = site.headings.front();
        site.headings = headingsAround(*options.headings);
        for (Angle& heading : site.headings) heading = normal + heading;
    }
    return sites;
}

std::vector<Site> proposeMedialAxis(const ProposalRequest& request) {
    const auto& [environment, height, max_range, options] = request;
    const auto level = environment.level(height);
    return sitesAt(
        medialPlaces(level->freeFloor(), options.density.lattice_step, level->slice().sheets),
        headingsPerPlace(options));
}

std::vector<Site> proposeListed(const ProposalRequest& request) { return request.options.list; }

constexpr StrategyOption kDensity = {
    .name = "--candidates",
    .field = &ArrangeOptions::density,
    .lowest = kMinLength,
    .highest = kMaxLength,
    .help = "steps of the lattice and along walls, headings per site (default 0.25,0.25,16)",
    .refusal = "the thesis' strategies have their own numbers"};
constexpr StrategyOption kDensityOptions[] = {kDensity};
constexpr StrategyOption kListOptions[] = {
    kDensity,
    {.name = "--places",
     .field = &ArrangeOptions::list,
     .help = "lines X,Y[,HEADING] (CSV), of a building STOREY/X,Y[,HEADING]; - is "
             "stdin",
     .is_needed = true}};
constexpr StrategyOption kGridOptions[] = {
    {"-X", &ArrangeOptions::x, 1, kMaxLines,
     "interior lines across x (default: 5 per maximum range)"},
    {"-Y", &ArrangeOptions::y, 1, kMaxLines,
     "interior lines across y (default: 5 per maximum range)"}};
constexpr StrategyOption kRandomOptions[] = {
    {"--r1", &ArrangeOptions::first_places, 1, kMaxPlaces, "sites tried first, for each sensor"},
    {"--r2", &ArrangeOptions::more_places, 0, kMaxPlaces, "sites tried about the best of them"},
    {"--scope", &ArrangeOptions::scope, kMinLength, kMaxLength,
     "radius in which these lie (default: maximum range / 5)"}};
constexpr StrategyOption kWallOptions[] = {
    {"--dist", &ArrangeOptions::dist, kMinLength, kMaxDist, "distance from the wall",
     MountOn::Wall},
    {"--times", &ArrangeOptions::times, 1, kMaxPlaces, "sites per wall"}};

constexpr StrategyRow kRows[] = {
    {Strategy::All, "all", "default: a lattice and along walls", false, 0, kDensityOptions,
     proposeAll},
    {Strategy::Grid, "grid", "Ordinary Grid of the thesis", true, 8, kGridOptions, proposeGrid,
     "use more grid lines (-X, -Y)"},
    {Strategy::Random, "random", "its Hierarchical Random", true, 8, kRandomOptions, proposeNone},
    {Strategy::Wall, "wall", "its Along Wall", true, 0, kWallOptions, proposeAlongWalls},
    {Strategy::Medial, "medial", "axis of the free floor", false, 0, kDensityOptions,
     proposeMedialAxis},
    {Strategy::List, "list", "the sites of --places", false, 0, kListOptions, proposeListed}};

}  // namespace

std::span<const StrategyRow> strategies() { return kRows; }

const StrategyRow& rowOf(Strategy strategy) {
    return *std::find_if(std::begin(kRows), std::end(kRows),
                         [strategy](const StrategyRow& row) { return row.strategy == strategy; });
}

const StrategyRow* strategyNamed(std::string_view name) {
    const auto row = std::find_if(std::begin(kRows), std::end(kRows),
                                  [name](const StrategyRow& one) { return one.name == name; });
    return row == std::end(kRows) ? nullptr : row;
}

bool takes(Strategy strategy, std::optional<MountOn> mount, const StrategyOption& option) {
    const auto options = rowOf(strategy).options;
    return (mount && option.or_mount == mount) ||
           std::any_of(options.begin(), options.end(), [&option](const StrategyOption& own) {
               return own.name == std::string_view(option.name);
           });
}

std::vector<Angle> headingsPerPlace(const ArrangeOptions& options) {
    const int usual = rowOf(options.strategy).headings;
    return headingsAround(options.headings.value_or(usual > 0 ? usual : options.density.headings));
}

std::string_view nameOf(Strategy strategy) { return rowOf(strategy).name; }

std::string_view nameOf(MountOn mount) {
    switch (mount) {
        case MountOn::Floor:
            return "floor";
        case MountOn::Wall:
            return "wall";
        case MountOn::Frame:
            return "frame";
        case MountOn::Ceiling:
            break;
    }
    return "ceiling";
}

bool isOfThesis(Strategy strategy) { return rowOf(strategy).is_of_thesis; }

bool drawsForEach(const ArrangeOptions& options) {
    return options.strategy == Strategy::Random && options.mount.on != MountOn::Frame &&
           !options.target && !options.budget;
}

CellChoice searchCells(const ArrangeOptions& options) {
    constexpr int kMaxSearched = 40'000;
    if (options.cells) return *options.cells;
    if (isOfThesis(options.strategy)) return CellCount{100, 100};
    return RoomCells{kMaxSearched};
}

namespace {

int linesAlong(double extent, double max_range) {
    constexpr double kMax = 10000;
    // A room that is moved is no smaller because its corners round.
    const double lines = std::floor(extent / max_range * kSegments - 1 + kStepTolerance);
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

/// One in this many of a wall's sites is at one end, and as many at the other.
constexpr int kWallEnds = 3;

/// Adds the headings at an end of a wall, for sensors that look around the corner. `turn` leads
/// from the wall's normal to the neighbour's, on the side of the room.
void addTurned(Site& site, Angle normal, Angle turn) {
    for (const Angle heading : {wrapped(normal + 0.5 * turn), wrapped(normal + turn)})
        if (std::find(site.headings.begin(), site.headings.end(), heading) == site.headings.end())
            site.headings.push_back(heading);
}

/// Computes the turn from one normal to the next of a curve; at the end of a sheet, around that
/// end.
Angle turnBetween(Angle normal, Angle next) {
    // Degrees by which rounding and welding may turn a side of a sheet. Walls at such an angle have
    // hardly any floor between them.
    constexpr double kSlack = 1e-3;
    const Angle turn = wrapped(next - normal);
    return turn >= Angle::degrees(180 - kSlack) ? turn - Angle::degrees(360) : turn;
}

/// Adds sites along the walls between the corners of a closed curve.
/// \pre there are at least two corners
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

/// The count is checked before any site is made. Curves that are no wall, of fewer than two
/// corners, have no places.
std::vector<Site> wallSites(const Environment& environment, double height, double dist, int times) {
    assert(times >= 0);
    const Slice slice = wallSlice(environment, height);
    std::vector<Region> floor = environment.indoor().parts;
    if (!slice.solids.empty()) floor = difference(environment.indoor(), slice.solids);
    // The left side of each curve is free.
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

/// Purpose of a draw: a first site or one around the best.
enum class Draws : std::uint64_t { Anywhere, AboutTheBest };

/// Computes two numbers in [0, 1), unique to each draw of a sequence.
std::array<double, 2> drawPair(const RandomSequence& sequence, Draws draws, std::uint64_t k) {
    // A draw takes four elements of 24 bits. Higher bits of its number select further sequences.
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
