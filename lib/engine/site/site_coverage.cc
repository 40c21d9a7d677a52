// SPDX-License-Identifier: GPL-3.0-or-later
// Measures storeys, and adds up their figures.
//
// Sums carry areas, not shares, so that large storeys weigh more; a sum with an unknown part is
// unknown. Sensors are listed once, with the storeys that they see added to their own.
#include "site/site_coverage.h"

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"
#include "coverage/outside_view.h"
#include "record/text.h"
#include "report/coverage_report.h"
#include "report/map/map.h"
#include "site/site_sight.h"
#include "site/storey_sight.h"
#include "trace/ray_world.h"

namespace ispace {

namespace {

/// Adds up areas that are known for all storeys.
class AreaSum {
  public:
    void add(const std::optional<double>& area) {
        is_known_ = is_known_ && area.has_value();
        sum_ += area.value_or(0);
    }
    [[nodiscard]] std::optional<double> sum() const {
        return is_known_ ? std::optional(sum_) : std::nullopt;
    }
    /// Returns the sum as a share; empty for no area.
    [[nodiscard]] std::optional<double> shareOf(double area) const {
        return is_known_ && area > 0 ? std::optional(sum_ / area) : std::nullopt;
    }

  private:
    double sum_ = 0;
    bool is_known_ = true;
};

std::optional<double> areaOf(const std::optional<double>& share, double area) {
    if (!(area > kNoFloor)) return 0.0;
    return share ? std::optional(*share * area) : std::nullopt;
}

/// Puts the storey before all ids. \param outside the views into the storey
void nameWholly(const SiteScene& building, std::size_t storey, std::span<const StoreyView> outside,
                Coverage& coverage) {
    const std::vector<Storey>& storeys = building.document.storeys;
    const std::size_t own = building.scenes[storey]->sensors.size();
    for (std::size_t i = 0; i < coverage.sensors.size(); ++i) {
        SensorView& view = coverage.sensors[i];
        const std::size_t home = view.index < own ? storey : outside[view.index - own].storey;
        view.id = wholeId(storeys[home], view.id);
        coverage.report.sensors[i].id = view.id;
    }
    for (ZoneMetrics& zone : coverage.report.zones) zone.id = wholeId(storeys[storey], zone.id);
    for (UncoveredSpot& spot : coverage.report.unseen) spot.room = storeys[storey].id;
}

/// Adds areas, and weighs shares by them. A sum is unknown as soon as that of one storey is;
/// figures of a single storey are copied.
void addUp(SiteCoverage& building) {
    if (building.storeys.size() == 1) {
        const CoverageReport& report = building.storeys.front().report;
        building.indoor_area = report.indoor_area;
        building.free_area = report.free_area;
        building.total_effective_area = report.total_effective_area;
        building.outside = report.outside;
        building.coverage = report.coverage;
        building.free_coverage = report.free_coverage;
        building.redundancy = report.redundancy;
        return;
    }
    AreaSum total_grid, total_exact, outside, grid, exact, free_grid, free_exact;
    for (const Coverage& storey : building.storeys) {
        const CoverageReport& report = storey.report;
        building.indoor_area += report.indoor_area;
        building.free_area += report.free_area;
        total_grid.add(report.total_effective_area.grid);
        total_exact.add(report.total_effective_area.exact);
        outside.add(report.outside);
        grid.add(areaOf(report.coverage.grid, report.indoor_area));
        exact.add(areaOf(report.coverage.exact, report.indoor_area));
        free_grid.add(areaOf(report.free_coverage.grid, report.free_area));
        free_exact.add(areaOf(report.free_coverage.exact, report.free_area));
        if (report.redundancy.size() > building.redundancy.size())
            building.redundancy.resize(report.redundancy.size());
        for (std::size_t k = 0; k < report.redundancy.size(); ++k)
            building.redundancy[k] += report.redundancy[k] * report.indoor_area;
    }
    building.total_effective_area = {total_grid.sum(), total_exact.sum()};
    building.outside = outside.sum();
    building.coverage = {grid.shareOf(building.indoor_area), exact.shareOf(building.indoor_area)};
    building.free_coverage = {free_grid.shareOf(building.free_area),
                              free_exact.shareOf(building.free_area)};
    if (building.indoor_area > 0)
        for (double& share : building.redundancy) share /= building.indoor_area;
}

std::string shareText(const std::optional<double>& share) {
    return share ? percentText(*share) : "-";
}

TextRow tableRow(const std::string& name, std::size_t sensors, double indoor,
                 const Metric& coverage, const Metric& free_coverage) {
    return {name,
            std::to_string(sensors),
            formatFixed(indoor, 2),
            shareText(coverage.grid),
            shareText(coverage.exact),
            shareText(free_coverage.grid),
            shareText(free_coverage.exact)};
}

/// Returns a view into a storey with the cells that `arrange` counts. \param sight kept by
/// reference
std::shared_ptr<const OutsideView> withCells(const StoreySight& sight, const SiteScene& building,
                                             const StoreyView& one, std::size_t storey) {
    OutsideView view = *one.view;
    const Sensor& sensor = building.scenes[one.storey]->sensors[one.sensor];
    view.cells = [&sight, &sensor, from = one.storey, storey](const Grid& grid, double density) {
        return sight.cells(from, sensor, storey, grid, density);
    };
    return std::make_shared<const OutsideView>(std::move(view));
}

}  // namespace

SiteCoverage measureSite(const SiteScene& building, const CoverageOptions& options,
                         Progress* progress) {
    const Coupling coupling(building);
    SiteCoverage measured;
    measured.floors = coupling.floors(options.plane);
    const std::vector<std::vector<StoreyView>> outside = viewsBetweenStoreys(coupling, options);
    const StoreySight sight(coupling, options.plane);
    using Views = std::vector<std::shared_ptr<const OutsideView>>;
    std::map<std::pair<const Scene*, Views>, std::size_t> known;
    for (std::size_t i = 0; i < building.scenes.size(); ++i) {
        const Scene& scene = *measured.floors[i];
        Views views;
        for (const StoreyView& one : outside[i]) views.push_back(one.view);
        const auto [first, is_new] = known.try_emplace({&scene, views}, i);
        if (is_new) {
            for (std::size_t k = 0; k < views.size(); ++k)
                views[k] = withCells(sight, building, outside[i][k], i);
            RayScenes worlds(scene.environment);
            measured.storeys.push_back(measureWithOutside(scene, worlds, options, views, progress));
        } else {
            measured.storeys.push_back(measured.storeys[first->second]);
        }
        measured.sensors.push_back(measured.storeys.back().sensors.size() - views.size());
    }
    for (std::size_t i = 0; i < building.scenes.size(); ++i)
        nameWholly(building, i, outside[i], measured.storeys[i]);
    for (std::size_t i = 0; i < building.scenes.size(); ++i)
        measured.storeys[i].report.digest = building.scenes[i]->digest();
    addUp(measured);
    return measured;
}

namespace {

/// Adds up the shares of density classes, of areas.
class DensitySum {
  public:
    void add(const std::vector<Metric>& shares, double area) {
        if (shares.empty()) {
            // Without cameras none of the floor has their pixels.
            empty_ += area;
            return;
        }
        sums_.resize(std::max(sums_.size(), shares.size()));
        for (std::size_t k = 0; k < shares.size(); ++k) {
            sums_[k].first.add(areaOf(shares[k].grid, area));
            sums_[k].second.add(areaOf(shares[k].exact, area));
        }
        area_ += area;
    }
    [[nodiscard]] std::vector<Metric> shares() const {
        std::vector<Metric> shares;
        for (const auto& [grid, exact] : sums_)
            shares.push_back({grid.shareOf(area_ + empty_), exact.shareOf(area_ + empty_)});
        return shares;
    }

  private:
    std::vector<std::pair<AreaSum, AreaSum>> sums_;
    double area_ = 0, empty_ = 0;
};

/// Adds up shares of the floor of rooms.
class ShareSum {
  public:
    void add(const Metric& share, double area) {
        grid_.add(areaOf(share.grid, area));
        exact_.add(areaOf(share.exact, area));
    }
    [[nodiscard]] Metric of(double area) const {
        return {grid_.shareOf(area), exact_.shareOf(area)};
    }

  private:
    AreaSum grid_, exact_;
};

std::optional<double> added(const std::optional<double>& a, const std::optional<double>& b) {
    return a && b ? std::optional(*a + *b) : std::nullopt;
}

Metric added(const Metric& a, const Metric& b) {
    return {added(a.grid, b.grid), added(a.exact, b.exact)};
}

/// Returns the mean of two values, by areas.
std::optional<double> meanOf(const std::optional<double>& a, const std::optional<double>& area_a,
                             const std::optional<double>& b, const std::optional<double>& area_b) {
    const double wa = a ? area_a.value_or(0) : 0, wb = b ? area_b.value_or(0) : 0;
    if (!(wa + wb > 0)) return a ? a : b;
    return (a.value_or(0) * wa + b.value_or(0) * wb) / (wa + wb);
}

/// Adds what a sensor sees in a further room to its picture.
void addPicture(PictureMetrics& picture, const Metric& area, const PictureMetrics& further,
                const Metric& further_area) {
    for (std::size_t k = 0; k < picture.areas.size() && k < further.areas.size(); ++k)
        picture.areas[k] = added(picture.areas[k], further.areas[k]);
    const auto take = [](std::optional<double>& to, const std::optional<double>& value,
                         const auto& better) {
        if (value && (!to || better(*value, *to))) to = value;
    };
    take(picture.nearest, further.nearest, std::less<>());
    take(picture.farthest, further.farthest, std::greater<>());
    picture.mean_density = {
        meanOf(picture.mean_density.grid, area.grid, further.mean_density.grid, further_area.grid),
        meanOf(picture.mean_density.exact, area.exact, further.mean_density.exact,
               further_area.exact)};
}

/// Returns the sensors of all storeys, each once, with what they see in all of them.
std::vector<SensorMetrics> sensorsOfAll(const SiteCoverage& coverage) {
    std::vector<SensorMetrics> all;
    std::map<std::string, std::size_t> known;
    // Views from outside follow those of a storey's own sensors.
    const auto is_here = [&](std::size_t storey, std::size_t i) {
        return i < coverage.sensors[storey];
    };
    for (const bool home : {true, false})
        for (std::size_t i = 0; i < coverage.storeys.size(); ++i) {
            const std::vector<SensorMetrics>& sensors = coverage.storeys[i].report.sensors;
            for (std::size_t k = 0; k < sensors.size(); ++k) {
                if (is_here(i, k) != home) continue;
                const SensorMetrics& seen = sensors[k];
                const auto [at, is_new] = known.try_emplace(seen.id, all.size());
                if (is_new) {
                    all.push_back(seen);
                    continue;
                }
                SensorMetrics& sum = all[at->second];
                if (sum.picture && seen.picture)
                    addPicture(*sum.picture, sum.area, *seen.picture, seen.area);
                sum.area = added(sum.area, seen.area);
                sum.outside = added(sum.outside, seen.outside);
                sum.marginal = added(sum.marginal, seen.marginal);
                sum.overlap = added(sum.overlap, seen.overlap);
            }
        }
    return all;
}

/// Adds shares of the floor seen by exactly k sensors, as areas.
void addRedundancy(std::vector<double>& sum, std::span<const double> shares, double area) {
    sum.resize(std::max(sum.size(), shares.size()));
    for (std::size_t k = 0; k < shares.size(); ++k) sum[k] += shares[k] * area;
}

}  // namespace

CoverageReport sumOfStoreys(const SiteCoverage& coverage) {
    const CoverageReport& first = coverage.storeys.front().report;
    if (coverage.storeys.size() == 1) return first;
    CoverageReport sum;
    sum.height = first.height;
    sum.plane = first.plane;
    sum.density = first.density;
    sum.parallax = first.parallax;
    sum.indoor_area = coverage.indoor_area;
    sum.free_area = coverage.free_area;
    sum.sensors = sensorsOfAll(coverage);
    sum.total_effective_area = coverage.total_effective_area;
    sum.outside = coverage.outside;
    sum.coverage = coverage.coverage;
    sum.free_coverage = coverage.free_coverage;
    sum.redundancy = coverage.redundancy;
    sum.redundancy_exact.emplace();
    sum.comparison = coverage.comparison;
    sum.overlap = {0.0, 0.0};
    DensitySum indoor, free;
    ShareSum seen, parallax;
    double covered = 0, largest = 0;
    for (const Coverage& storey : coverage.storeys) {
        const CoverageReport& report = storey.report;
        sum.overlap = added(sum.overlap, report.overlap);
        if (report.redundancy_exact && sum.redundancy_exact)
            addRedundancy(*sum.redundancy_exact, *report.redundancy_exact, report.indoor_area);
        else
            sum.redundancy_exact.reset();
        sum.zones.insert(sum.zones.end(), report.zones.begin(), report.zones.end());
        const double own =
            areaOf(report.coverage.exact ? report.coverage.exact : report.coverage.grid,
                   report.indoor_area)
                .value_or(0);
        covered += own;
        largest = std::max(largest, report.largest_piece * own);
        sum.pieces += report.pieces;
        sum.unseen.insert(sum.unseen.end(), report.unseen.begin(), report.unseen.end());
        if (sum.exact_missing.empty()) sum.exact_missing = report.exact_missing;
        parallax.add(report.parallax_coverage, report.indoor_area);
        indoor.add(report.densities.indoor, report.indoor_area);
        free.add(report.densities.free, report.free_area);
        if (!report.densities.indoor.empty()) seen.add(report.densities.seen, report.indoor_area);
    }
    if (covered > 0) sum.largest_piece = largest / covered;
    std::stable_sort(sum.unseen.begin(), sum.unseen.end(),
                     [](const auto& a, const auto& b) { return a.area > b.area; });
    if (sum.redundancy_exact && sum.indoor_area > 0)
        for (double& share : *sum.redundancy_exact) share /= sum.indoor_area;
    if (sum.parallax) sum.parallax_coverage = parallax.of(sum.indoor_area);
    sum.densities.indoor = indoor.shares();
    sum.densities.free = free.shares();
    if (!sum.densities.indoor.empty()) {
        sum.densities.seen = seen.of(sum.indoor_area);
        // A zone where no camera is has none of the classes.
        for (ZoneMetrics& zone : sum.zones)
            if (zone.densities.empty())
                zone.densities.assign(sum.densities.indoor.size(), {0.0, 0.0});
    }
    return sum;
}

namespace {

/// Returns the storey with the zone of a requirement. \throws as mustHaveZone()
std::size_t storeyOfZone(const Requirement& requirement, const SiteScene& building) {
    std::vector<std::string> known;
    for (std::size_t i = 0; i < building.scenes.size(); ++i)
        for (const Element& element : building.scenes[i]->environment.elements()) {
            if (element.record.keyword() != "zone") continue;
            known.push_back(wholeId(building.document.storeys[i], element.id));
            if (known.back() == requirement.zone) return i;
        }
    throw UsageError("the building has no zone `" + printable(requirement.zone) + '`' +
                     didYouMean(requirement.zone, known) + "; the storey comes first, as in " +
                     building.document.storeys.front().id + "/NAME");
}

}  // namespace

void mustHaveZone(const Requirement& requirement, const SiteScene& building) {
    if (building.isRoomAlone())
        mustHaveZone(requirement, building.scenes.front()->environment);
    else if (requirement.of == Requirement::Of::Zone)
        static_cast<void>(storeyOfZone(requirement, building));
}

Verdict checkRequirement(const Requirement& requirement, const SiteScene& building,
                         const SiteCoverage& coverage) {
    if (building.isRoomAlone()) return checkRequirement(requirement, coverage.storeys.front());
    if (requirement.of == Requirement::Of::Zone)
        return checkRequirement(requirement, coverage.storeys[storeyOfZone(requirement, building)]);
    Coverage sum;
    sum.report = sumOfStoreys(coverage);
    return checkRequirement(requirement, sum);
}

void compareStoreys(SiteCoverage& coverage, const SiteCoverage& other, const std::string& name) {
    AreaSum gained_grid, gained_exact, lost_grid, lost_exact;
    for (std::size_t i = 0; i < coverage.storeys.size(); ++i) {
        Coverage& storey = coverage.storeys[i];
        compare(storey, other.storeys[i], coverage.floors[i]->environment.indoor(), name);
        const Comparison& one = *storey.report.comparison;
        gained_grid.add(one.gained.grid);
        gained_exact.add(one.gained.exact);
        lost_grid.add(one.lost.grid);
        lost_exact.add(one.lost.exact);
    }
    coverage.comparison = Comparison{name,
                                     other.coverage,
                                     {gained_grid.sum(), gained_exact.sum()},
                                     {lost_grid.sum(), lost_exact.sum()}};
}

ReportParts partsOfRoom(const SiteParts& parts) {
    ReportParts own;
    own.reserve(parts.sum.size());
    for (const auto& section : parts.sum) own.push_back(section);
    if (parts.storeys.empty()) return own;
    for (auto& section : own)
        for (const auto& of_room : parts.storeys.front())
            if (of_room->name() == section->name()) section = of_room;
    return own;
}

std::string siteCoverageJson(const SiteScene& building, const SiteCoverage& coverage,
                             const SiteParts& parts) {
    if (building.isRoomAlone())
        return coverageJson(coverage.storeys.front().report, partsOfRoom(parts));
    std::vector<ReportedRoom> rooms;
    for (std::size_t i = 0; i < coverage.storeys.size(); ++i)
        rooms.push_back({building.document.storeys[i].id, &coverage.storeys[i].report});
    JsonWriter json;
    beginReport(json, "ispace-coverage/1", "coverage");
    json.key("digest").value(building.document.digest());
    writeRooms(json, rooms);
    json.key("storeys").beginArray();
    std::string text;
    for (std::size_t i = 0; i < coverage.storeys.size(); ++i) {
        json.beginObject().key("id").value(rooms[i].id).key("report");
        text += json.take() + storeyJson(*rooms[i].report,
                                         parts.storeys.empty() ? ReportParts() : parts.storeys[i]);
        text.pop_back();  // its newline
        json.endObject();
    }
    json.endArray();
    writeFloor(json, sumOfStoreys(coverage));
    writeParts(json, parts.sum);
    json.endObject();
    return text + json.take() + '\n';
}

std::vector<TextRow> storeyRows(const SiteScene& building, const SiteCoverage& coverage) {
    std::vector<TextRow> rows = {
        {"storey", "sensors", "indoor m2", "covered", "exactly", "free floor", "exactly"}};
    std::size_t sensors = 0;
    for (std::size_t i = 0; i < coverage.storeys.size(); ++i) {
        const CoverageReport& report = coverage.storeys[i].report;
        rows.push_back(tableRow(building.document.storeys[i].id, coverage.sensors[i],
                                report.indoor_area, report.coverage, report.free_coverage));
        sensors += coverage.sensors[i];
    }
    rows.push_back(tableRow("building", sensors, coverage.indoor_area, coverage.coverage,
                            coverage.free_coverage));
    return rows;
}

std::uint32_t redundancyScale(const SiteCoverage& coverage) {
    std::uint32_t scale = 0;
    for (const Coverage& storey : coverage.storeys)
        scale = std::max(scale, redundancyScale(storey.report));
    return scale;
}

std::string siteCoverageText(const SiteScene& building, const SiteCoverage& coverage,
                             const SiteParts& parts) {
    if (building.isRoomAlone())
        return coverageText(coverage.storeys.front().report) + partsText(partsOfRoom(parts));
    std::string text;
    for (std::size_t i = 0; i < coverage.storeys.size(); ++i) {
        text += "storey " + building.document.storeys[i].id + '\n' +
                coverageText(coverage.storeys[i].report);
        if (!parts.storeys.empty()) text += partsText(parts.storeys[i]);
        text += '\n';
    }
    text += aligned(storeyRows(building, coverage), "lr");
    if (coverage.comparison) text += comparisonText(*coverage.comparison, coverage.coverage);
    return text + partsText(parts.sum);
}

}  // namespace ispace
