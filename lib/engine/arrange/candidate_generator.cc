// SPDX-License-Identifier: GPL-3.0-or-later
// Heights, tilts and sites of a kind of sensor; candidate.cc computes their views.
//
// Candidates are made level by level and tilt by tilt, so that views of one height share sight.
// Hierarchical Random (the thesis, section 4.4.3) differs: it draws sites, takes the best, draws
// more about it, and counts the floor in view as covered before the next sensor.
#include "arrange/candidate_generator.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <utility>

#include "arrange/candidate.h"
#include "arrange/case_room.h"
#include "arrange/strategy.h"
#include "base/error.h"
#include "base/number.h"
#include "env/zone.h"
#include "scene/sensor/camera.h"

namespace ispace {

namespace {

/// Sites are rounded to whole nanometres: people read layouts, and rounding residues are noise.
double onNanometres(double metres) {
    constexpr double kPerMetre = 1e9;
    return std::round(metres * kPerMetre) / kPerMetre;
}
Point2 onNanometres(Point2 place) { return {onNanometres(place.x), onNanometres(place.y)}; }

std::vector<Site> onNanometres(std::vector<Site> sites) {
    for (Site& site : sites) {
        site.place = onNanometres(site.place);
        for (Angle& heading : site.headings) heading = wrapped(heading);
    }
    return sites;
}

std::vector<Angle> degrees(std::initializer_list<double> angles) {
    std::vector<Angle> all;
    all.reserve(angles.size());
    for (const double angle : angles) all.push_back(Angle::degrees(angle));
    return all;
}

/// Sensors that scan a plane stay level. Sensors with an axis look down from above; an aimed sensor
/// has some tilts to choose from, unless it sees all around from there.
std::vector<Angle> usualTilts(const SensorModel& model, MountOn mount) {
    const bool is_aimed = kindOf(model).is_overhead;
    if (mount == MountOn::Wall && is_aimed) return degrees({-30, -15, -45});
    const bool hangs = mount == MountOn::Frame || mount == MountOn::Ceiling;
    if (!hangs || !fieldOfView(Sensor{{}, model, {}})) return {Angle()};
    const Pose3 down{{}, {}, Angle::degrees(-90), {}};
    return is_aimed && !isOmnidirectional(model, down) ? degrees({-90, -60, -30}) : degrees({-90});
}

/// Sites at one height.
struct SitesAtHeight {
    double height = kScanHeight;
    std::vector<Site> sites;
};

}  // namespace

CellSet unseenCells(const UnseenFloor& floor, const Target& target) {
    CellSet cells(target.grid.size());
    for (const NamedZone& zone : floor.zones) {
        const std::vector<double> inside =
            weightsOfCells(target, {.targets = {zone}, .weights = {}});
        for (std::size_t i = 0; i < inside.size(); ++i)
            if (inside[i] > 0) cells.set(i);
    }
    return cells;
}

struct CandidatePool::Data {
    const Environment& environment;
    RayScenes& worlds;
    const Target& target;
    CandidateWeights weights;
    const ArrangeOptions& options;
    Progress& progress;
    CaseRooms rooms;
    const CoverRule* rule;
    const Demand* demand;
    VisibleArea sight;
    std::map<double, std::unique_ptr<SiteValidity>> validities = {};
    std::map<double, std::vector<std::unique_ptr<SiteValidity>>> other_validities = {};
    std::size_t bytes = 0;  // of the sets built so far
    StopGrace grace = {};

    const SiteValidity& validityAt(double height) {
        std::unique_ptr<SiteValidity>& validity = validities[height];
        if (validity == nullptr)
            validity = std::make_unique<SiteValidity>(environment, rulesAt(height));
        return *validity;
    }

    /// Returns true for sites that are valid in all rooms but the first, too.
    bool isValidElsewhere(double height, Point2 place) {
        if (rooms.empty() || !options.cases->needsFreeFloorInAll()) return true;
        auto& others = other_validities[height];
        for (std::size_t i = others.size() + 1; i < rooms.size(); ++i)
            others.push_back(
                std::make_unique<SiteValidity>(rooms[i]->scene.environment, rulesAt(height)));
        return std::all_of(others.begin(), others.end(),
                           [&](const auto& validity) { return validity->isValid(place); });
    }

    [[nodiscard]] SiteRules rulesAt(double height) const {
        const MountRules& mount = options.mount;
        SiteRules rules;
        rules.height = height;
        rules.clearance = mount.clearance;
        rules.indoor_only = options.indoor_only;
        for (const NamedZone& zone : mount.keep_out) rules.keep_out.push_back(zone.outline);
        for (const NamedZone& zone : mount.keep_in) rules.keep_in.push_back(zone.outline);
        if (mount.on == MountOn::Wall) rules.wall_within = std::max(options.dist, kOffWall) + 1e-6;
        return rules;
    }

    [[nodiscard]] MountOn mountOf(const SensorClass& kind) const {
        if (options.mount.on) return *options.mount.on;
        if (!kindOf(kind.model).is_overhead) return MountOn::Floor;
        return options.strategy == Strategy::Wall ? MountOn::Wall : MountOn::Ceiling;
    }

    [[nodiscard]] std::vector<double> heightsOf(const SensorClass& kind) const {
        if (!options.mount.heights.empty()) return options.mount.heights;
        const MountOn mount = mountOf(kind);
        const double top = environment.height();
        if (mount == MountOn::Ceiling) return {onNanometres(top - kBelowCeiling)};
        if (mount == MountOn::Wall && kindOf(kind.model).is_overhead)
            return {onNanometres(std::min(kOnWall, top - kBelowWallTop))};
        return {kScanHeight};
    }

    [[nodiscard]] std::vector<Angle> tiltsOf(const SensorClass& kind) const {
        if (kind.record.has("tilt")) return {kind.record.angle("tilt")};
        if (!options.mount.tilts.empty()) return options.mount.tilts;
        return usualTilts(kind.model, mountOf(kind));
    }

    /// Returns the length by which strategies space their sites: the maximum range, but for
    /// overhead sensors no more than the width of their view.
    [[nodiscard]] double reachOf(const SensorClass& kind, double height) const {
        constexpr double kOverHeight = 3;
        const double range = maxRange(kind.model);
        const bool hangs = kindOf(kind.model).is_overhead && mountOf(kind) != MountOn::Floor;
        return hangs ? std::min(range, kOverHeight * height) : range;
    }

    /// Returns the strategy's proposals at one height; Random is handled separately.
    [[nodiscard]] std::vector<Site> proposals(const SensorClass& kind, double height) const {
        return onNanometres(
            rowOf(options.strategy).propose({environment, height, reachOf(kind, height), options}));
    }

    [[nodiscard]] std::vector<SitesAtHeight> frameLevels() const {
        std::map<double, std::vector<Point2>> by_height;
        for (const Point3& place : framePlaces(environment, options.density.lattice_step))
            by_height[onNanometres(place.z)].push_back(place.onFloor());
        std::vector<SitesAtHeight> levels;
        levels.reserve(by_height.size());
        for (const auto& [height, places] : by_height)
            levels.push_back({height, onNanometres(sitesAt(places, headingsPerPlace(options)))});
        return levels;
    }

    /// Returns the valid sites at all heights; a sample of them, and `is_complete` false, once
    /// progress says stop.
    std::vector<SitesAtHeight> levelsFor(const SensorClass& kind, bool& is_complete) {
        std::vector<SitesAtHeight> levels;
        if (options.mount.on == MountOn::Frame)
            levels = frameLevels();
        else
            for (const double height : heightsOf(kind))
                levels.push_back({height, proposals(kind, height)});
        std::size_t proposed = 0, valid = 0;
        for (SitesAtHeight& level : levels) {
            proposed += level.sites.size();
            level.sites =
                validSites(validityAt(level.height), std::move(level.sites), progress, is_complete);
            std::erase_if(level.sites, [&](const Site& site) {
                return !isValidElsewhere(level.height, site.place);
            });
            valid += level.sites.size();
        }
        if (valid == 0)
            throw UnmetError(is_complete ? noPlaceText(kind, proposed)
                                         : "stopped before a valid place was found for " + kind.id);
        return levels;
    }

    [[nodiscard]] std::string noPlaceText(const SensorClass& kind, std::size_t proposed) const {
        const MountRules& mount = options.mount;
        const bool on_frame = mount.on == MountOn::Frame;
        std::string text = "no place for " + kind.id + ": ";
        if (on_frame && proposed == 0)
            return text + "the room has no frame to mount it on (a record `infra`)";
        if (options.strategy == Strategy::List && proposed == 0)
            return text + "the list of places is empty";
        text +=
            "of the places " +
            (on_frame ? "under the frame"
                      : "that strategy " + std::string(nameOf(options.strategy)) + " proposes") +
            " (" + std::to_string(proposed) + ") none lies indoors and clear of objects";
        if (!on_frame) {
            text += " at ";
            const std::vector<double> all = heightsOf(kind);
            for (std::size_t i = 0; i < all.size(); ++i)
                text.append(i == 0 ? "" : ", ").append(formatDouble(all[i]));
            text += " m";
        }
        if (!mount.keep_out.empty() || !mount.keep_in.empty() || mount.clearance > 0 ||
            mount.on == MountOn::Wall)
            text += " within the rules for places (--keep-out, --keep-in, --clearance, --mount)";
        if (const std::string_view hint = rowOf(options.strategy).hint; !hint.empty() && !on_frame)
            text.append("; ").append(hint);
        return text;
    }

    /// Removes candidates that see a cell of unseen floor, and those that are forbidden.
    [[nodiscard]] std::vector<Site> allowedSites(const SensorClass& kind, const Pose3& mount,
                                                 const std::vector<Site>& sites) const {
        const SensorModel& whole = kind.whole ? *kind.whole : kind.model;
        const auto* camera = std::get_if<Camera>(&whole);
        if (camera == nullptr || (options.unseen.empty() && options.mount.forbidden.empty()))
            return sites;
        std::vector<Site> allowed = sites;
        for (Site& site : allowed)
            for (const Pose3& pose : options.mount.forbidden)
                if (pose.position == Point3{site.place.x, site.place.y, mount.position.z} &&
                    pose.tilt == mount.tilt)
                    std::erase(site.headings, pose.heading);
        std::erase_if(allowed, [](const Site& site) { return site.headings.empty(); });
        for (const UnseenFloor& floor : options.unseen) {
            const CellSet cells = unseenCells(floor, target);
            if (cells.empty()) continue;
            const CandidateViews views(sight, target.grid, withDensity(*camera, floor.density),
                                       mount, &cells);
            allowed = sitesOutOfSight(views, allowed);
        }
        return allowed;
    }

    /// Adds candidates with views in the room, or in the room in all cases.
    bool look(PosedCandidates& set, const CandidateViews& views, const SensorClass& kind,
              const Pose3& mount, std::span<const Site> sites, std::size_t least) {
        if (rooms.empty())
            return addCandidates(set, views, sites, options.max_bytes - bytes, progress, least,
                                 options.search.share, &grace);
        std::vector<std::unique_ptr<CandidateViews>> all;
        std::vector<StackedViews> stack;
        for (const auto& room : rooms) {
            room->worlds.prepare(mount);
            all.push_back(std::make_unique<CandidateViews>(room->sight, room->target.grid,
                                                           kind.model, mount, &room->counted,
                                                           std::nullopt, room->errors.get()));
            stack.push_back({all.back().get(), room->first});
        }
        return addCandidates(set, stack, sites, options.max_bytes - bytes, progress, least,
                             options.search.share, &grace);
    }

    /// Adds candidates at these sites for each tilt. Returns false if progress says stop: then adds
    /// about `least` sites, shared out over all levels and tilts.
    bool addLevels(PosedCandidates& set, const SensorClass& kind,
                   const std::vector<SitesAtHeight>& levels, std::size_t least) {
        const std::vector<Angle> tilts = tiltsOf(kind);
        std::size_t places = 0;
        for (const SitesAtHeight& level : levels) places += level.sites.size() * tilts.size();
        bool is_complete = true;
        for (const SitesAtHeight& level : levels) {
            std::optional<SiteSights> sights;
            if (tilts.size() > 1 && SiteSights::isWorthwhile(level.sites, target.grid))
                sights.emplace(level.sites, target.grid);
            for (const Angle tilt : tilts) {
                if (level.sites.empty()) continue;
                if (!is_complete && least == 0) return false;
                const Pose3 mount{{0, 0, level.height}, {}, tilt, kind.record.angle("roll")};
                worlds.prepare(mount);
                std::optional<CandidateViews::ByBeams> by_beams;
                if (options.beam_step)
                    by_beams.emplace(CandidateViews::ByBeams{worlds, *options.beam_step});
                CandidateViews views(sight, target.grid, kind.model, mount,
                                     demand == nullptr ? &weights.counted : nullptr, by_beams,
                                     nullptr, rule);
                if (demand != nullptr) views.serve(*demand, worlds);
                if (sights) views.share(*sights);
                const std::size_t share = (least * level.sites.size() + places - 1) / places;
                const std::vector<Site> sites = allowedSites(kind, mount, level.sites);
                if (sites.empty()) continue;
                if (!look(set, views, kind, mount, sites, share)) is_complete = false;
            }
        }
        return is_complete;
    }

    /// Random sites at all heights.
    struct Drawn {
        std::vector<SitesAtHeight> levels;
        std::size_t places = 0;
        bool is_complete = true;  ///< false: progress said to stop before
    };

    /// Finds valid random sites; fewer if they are rare or progress says stop. `needs_one`: even
    /// then draws for one site as often as a single site allows.
    template <typename Draw>
    Drawn randomLevels(const SensorClass& kind, int count, bool needs_one, Draw draw) {
        constexpr std::uint64_t kTries = 1000;  // per site
        const std::uint64_t max_tries = kTries * static_cast<std::uint64_t>(count);
        Drawn drawn;
        std::uint64_t k = 0;
        const std::vector<double> heights = heightsOf(kind);
        progress.begin("drawing places", std::int64_t{count} * std::ssize(heights));
        for (const double height : heights) {
            const SiteValidity& validity = validityAt(height);
            std::vector<Point2> places;
            for (std::uint64_t tries = 0;
                 tries < max_tries && places.size() < static_cast<std::size_t>(count); ++tries) {
                const bool must_go_on = needs_one && drawn.places == 0 && k < kTries;
                if (progress.stopped() && !must_go_on) {
                    drawn.is_complete = false;
                    break;
                }
                const Point2 place = onNanometres(draw(k++));
                if (!validity.isValid(place) || !isValidElsewhere(height, place)) continue;
                places.push_back(place);
                ++drawn.places;
                progress.advance(1);
            }
            drawn.levels.push_back(
                {height, onNanometres(sitesAt(places, headingsPerPlace(options)))});
        }
        progress.end();
        return drawn;
    }

    /// The candidate from `first` on with the largest gain over the current coverage, and its gain.
    struct Best {
        std::size_t candidate = 0;
        std::uint32_t value = 0;
    };
    [[nodiscard]] Best bestFrom(const PosedCandidates& set, std::size_t first) const {
        std::vector<std::uint32_t> values(set.size());
        set.weighAll(WeightSums(weights.left), values);
        const auto best =
            std::max_element(values.begin() + static_cast<std::ptrdiff_t>(first), values.end());
        return {static_cast<std::size_t>(best - values.begin()), *best};
    }

    /// Hierarchical Random, for each sensor anew: R1 sites, then R2 more around the best of them.
    /// The view of the best candidate counts as covered for later sensors. Returns false if
    /// progress says stop.
    bool addRandom(PosedCandidates& set, const SensorClass& kind) {
        for (int sensor = 0; sensor < kind.most; ++sensor) {
            const bool is_first = sensor == 0;
            if (!is_first && !isAnythingLeft()) break;
            const RandomSequence sequence{options.seed, kind.id,
                                          static_cast<std::uint64_t>(sensor)};
            const std::size_t own = set.size();
            // A sensor without gain requires just one valid site.
            const int count = isAnythingLeft() ? options.first_places : 1;
            const Drawn first = randomLevels(kind, count, is_first, [&](std::uint64_t k) {
                return randomPlace(environment.limits(), sequence, k);
            });
            if (first.places == 0) {
                if (!first.is_complete) return false;
                if (!is_first) break;
                throw UnmetError(
                    noPlaceText(kind, static_cast<std::size_t>(count) * first.levels.size()));
            }
            if (!addLevels(set, kind, first.levels, is_first ? kMinPlaces : 0) ||
                !first.is_complete)
                return false;
            if (set.size() == own) continue;  // all are forbidden
            const Best start = bestFrom(set, own);
            if (start.value == 0) continue;
            const double scope =
                options.scope.value_or(reachOf(kind, first.levels.front().height) / kSegments);
            const Point2 center = set.pose(start.candidate).position.onFloor();
            const Drawn more = randomLevels(kind, options.more_places, false, [&](std::uint64_t k) {
                return randomPlaceAbout(center, scope, sequence, k);
            });
            if (!more.is_complete || !addLevels(set, kind, more.levels, 0)) return false;
            set.forEachRun(bestFrom(set, own).candidate, [&](const CellRun& run) {
                std::fill(weights.left.begin() + run.first, weights.left.begin() + run.end, 0U);
            });
        }
        return true;
    }
    [[nodiscard]] bool isAnythingLeft() const {
        return std::any_of(weights.left.begin(), weights.left.end(),
                           [](std::uint32_t weight) { return weight > 0; });
    }
};

CandidatePool::CandidatePool(const Environment& environment, RayScenes& worlds,
                             const Target& target, CandidateWeights weights,
                             const ArrangeOptions& options, Progress& progress, CaseRooms rooms,
                             const CoverRule* rule, const Demand* demand)
    : data_(new Data{environment,
                     worlds,
                     target,
                     std::move(weights),
                     options,
                     progress,
                     rooms,
                     rule,
                     demand,
                     {environment, options.plane, &worlds}}) {}

CandidatePool::~CandidatePool() = default;

CandidatePool::Made CandidatePool::make(const SensorClass& kind) {
    Made made{std::make_unique<PosedCandidates>(data_->weights.left.size())};
    const bool is_random =
        data_->options.strategy == Strategy::Random && data_->options.mount.on != MountOn::Frame;
    if (is_random) {
        made.is_complete = data_->addRandom(*made.set, kind);
    } else {
        const std::vector<SitesAtHeight> levels = data_->levelsFor(kind, made.is_complete);
        if (!data_->addLevels(*made.set, kind, levels, kMinPlaces)) made.is_complete = false;
    }
    data_->bytes += made.set->bytes();
    return made;
}

const SiteValidity& CandidatePool::validityAt(double height) { return data_->validityAt(height); }

}  // namespace ispace
