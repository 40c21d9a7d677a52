// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/strategy.h"

#include <algorithm>
#include <iterator>
#include <string>

#include "base/error.h"
#include "env/level.h"

namespace ispace {

namespace {

constexpr double kMaxLines = 10000, kMaxPlaces = 100000;
constexpr double kMaxLength = 1e6, kMaxDist = 1000, kMinLength = 0.001;  // metres

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
constexpr StrategyOption kListOptions[] = {kDensity,
                                           {.name = "--places",
                                            .field = &ArrangeOptions::list,
                                            .help = "lines X,Y[,HEADING] (CSV), - is stdin",
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

}  // namespace ispace
