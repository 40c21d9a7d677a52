// SPDX-License-Identifier: GPL-3.0-or-later
// Blocks of the legend tell shares with the figures of the report, exact ones if known; classes
// without floor are left out, and the last class of redundancy is open.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/number.h"
#include "report/coverage_report.h"
#include "report/map/map_layer.h"
#include "report/map/map_parts.h"

namespace ispace {

namespace {

using Sign = LegendItem::Sign;

// Decimals are those of coverageText() and of pages, so that a figure reads alike everywhere.
std::string percent(double share) { return percentText(share); }
std::string area(double value) { return formatFixed(value, 2) + " m²"; }

using Format = std::string (*)(double);

/// Creates a block with columns of exact metrics and of metrics by cells, if any metric is exact.
LegendBlock metricBlock(std::string title, bool exact) {
    LegendBlock block{std::move(title), {}};
    if (exact) block.columns = {"exact", "cells"};
    return block;
}

/// Sets the values of an item in such a block.
void setMetric(LegendItem& item, const LegendBlock& block, const Metric& metric, Format format) {
    const bool columns = !block.columns[0].empty();
    const auto text = [format](const std::optional<double>& value) {
        return value ? format(*value) : std::string("–");
    };
    item.value = text(columns || !metric.grid ? metric.exact : metric.grid);
    if (columns) item.second = text(metric.grid);
}

LegendBlock metricsBlock(const CoverageReport& report, bool terse) {
    LegendBlock block = metricBlock(report.coverage.exact ? "Figures" : "Figures by cells",
                                    report.coverage.exact.has_value());
    const auto add = [&block](std::string text, const Metric& metric, Format format) {
        LegendItem item{Sign::None, {}, {}, std::move(text), ""};
        setMetric(item, block, metric, format);
        block.items.push_back(std::move(item));
    };
    const auto add_area = [&block](std::string text, double value) {
        block.items.push_back({Sign::None, {}, {}, std::move(text), area(value)});
    };
    add("Coverage", report.coverage, percent);
    if (!terse) add("Free coverage", report.free_coverage, percent);
    add_area("Indoor area", report.indoor_area);
    if (!terse) add_area("Free floor", report.free_area);
    add("Effective area", report.total_effective_area, area);
    if (!terse && report.outside.value_or(0) >= kMinPiece)
        add_area("Outside limits", *report.outside);
    if (report.redundancy.size() > 2 && !terse) add("Overlap", report.overlap, area);
    if (!terse)
        block.items.push_back(
            {Sign::None,
             {},
             {},
             "Grid",
             std::to_string(report.grid.columns) + " × " + std::to_string(report.grid.rows)});
    return block;
}

/// Sums `shares` from `first` to before `end`.
double shareOf(const std::vector<double>& shares, std::size_t first, std::size_t end) {
    double sum = 0;
    for (std::size_t k = first; k < std::min(end, shares.size()); ++k) sum += shares[k];
    return sum;
}

/// Returns the share of the indoor floor seen by first .. end - 1 sensors.
Metric shareSeenBy(const CoverageReport& report, std::size_t first, std::size_t end) {
    Metric metric;
    if (report.coverage.grid) metric.grid = shareOf(report.redundancy, first, end);
    if (report.redundancy_exact) metric.exact = shareOf(*report.redundancy_exact, first, end);
    return metric;
}

LegendBlock shadesBlock(const CoverageReport& report, std::uint32_t scale) {
    LegendBlock block = metricBlock("Floor seen by", report.redundancy_exact.has_value());
    const auto add = [&](Color color, std::string text, std::size_t first, std::size_t end) {
        LegendItem item{Sign::Patch, color, palette::kObjectEdge, std::move(text), ""};
        setMetric(item, block, shareSeenBy(report, first, end), percent);
        block.items.push_back(std::move(item));
    };
    add(palette::kFloor, "no sensor", 0, 1);
    if (report.redundancy.size() < 2) return block;
    const Shades shades = shadesFor(report, scale);
    const int used = shades.of(redundancyScale(report));
    for (int shade = 1; shade <= used; ++shade) {
        const std::uint32_t first = shades.least(shade), last = first + shades.width - 1;
        std::string text;
        if (shades.width > 1) text = std::to_string(first).append("–");
        text.append(std::to_string(last)).append(last == 1 ? " sensor" : " sensors");
        // The last class is open: it includes numbers too rare for a class.
        const std::size_t end = shade == used ? report.redundancy.size() : last + 1;
        add(shades.color(shade), std::move(text), first, end);
    }
    return block;
}

LegendBlock bySensorBlock(const CoverageReport& report, std::size_t sets) {
    LegendBlock block = metricBlock("Floor seen by", report.redundancy_exact.has_value());
    const std::size_t all = report.redundancy.size();
    const auto add = [&](LegendItem item, std::size_t first, std::size_t end) {
        setMetric(item, block, shareSeenBy(report, first, end), percent);
        block.items.push_back(std::move(item));
    };
    using namespace palette;
    add({Sign::Patch, kFloor, kObjectEdge, "no sensor", ""}, 0, 1);
    if (sets > 0) add({Sign::None, {}, {}, "one (in its colour)", ""}, 1, 2);
    if (sets < 2) return block;
    const bool striped = sets <= kMaxStriped;
    add({Sign::Hatched, kShared, kSharedHatch, striped ? "more (striped)" : "more", ""}, 2, all);
    return block;
}

/// Lists the classes of a standard, each without the finer ones; skips those without floor.
LegendBlock densityBlock(const CoverageReport& report, DensityStandard standard) {
    const Metric& seen = report.densities.seen;
    LegendBlock block =
        metricBlock(standard == DensityStandard::Levels2025 ? "Pixels/m, 2025" : "Pixels/m, 2015",
                    seen.exact.has_value());
    const auto add = [&](Color color, std::string text, const Metric& share) {
        LegendItem item{Sign::Patch, color, palette::kObjectEdge, std::move(text), ""};
        setMetric(item, block, share, percent);
        block.items.push_back(std::move(item));
    };
    const auto rest = [](const std::optional<double>& share) {
        return share ? std::optional(1 - *share) : std::nullopt;
    };
    add(palette::kFloor, "no camera", {rest(seen.grid), rest(seen.exact)});
    constexpr double kMinShare = 1e-6;
    const auto classes = classesOf(standard);
    for (std::size_t i = 0; i <= classes.size(); ++i) {
        const Metric share = shareOfDensity(report, i, standard);
        if (share.grid.value_or(0) <= kMinShare && share.exact.value_or(0) <= kMinShare) continue;
        // The number first: long names are cut.
        const std::string pixels =
            formatDouble(densityClasses()[classes[i == 0 ? 0 : i - 1]].pixels_per_metre);
        add(densityColor(i, standard),
            i == 0 ? "fewer than " + pixels
                   : pixels + ' ' + std::string(className(classes[i - 1], standard)),
            share);
    }
    return block;
}

Metric sum(const Metric& a, const Metric& b, double factor) {
    const auto add = [factor](std::optional<double> x, std::optional<double> y) {
        return x && y ? std::optional(std::max(0.0, *x + factor * *y)) : std::nullopt;
    };
    return {add(a.grid, b.grid), add(a.exact, b.exact)};
}

Metric areaOf(const Metric& share, double whole) {
    const auto times = [whole](std::optional<double> x) {
        return x ? std::optional(whole * *x) : std::nullopt;
    };
    return {times(share.grid), times(share.exact)};
}

/// Lists the four kinds of floor of a comparison, m2.
LegendBlock comparisonBlock(const CoverageReport& report) {
    const Comparison comparison = report.comparison.value_or(Comparison{});
    LegendBlock block = metricBlock("Indoor floor", comparison.gained.exact.has_value());
    const auto add = [&](Sign sign, Color color, Color edge, std::string text, Metric metric) {
        LegendItem item{sign, color, edge, std::move(text), ""};
        setMetric(item, block, metric, area);
        block.items.push_back(std::move(item));
    };
    const Metric now = areaOf(report.coverage, report.indoor_area);
    const Metric any = sum(now, comparison.lost, 1);
    using namespace palette;
    add(Sign::Patch, kBoth, kObjectEdge, "kept", sum(now, comparison.gained, -1));
    add(Sign::Patch, kGained, kObjectEdge, "gained", comparison.gained);
    add(Sign::Hatched, kLost, kLostHatch, "lost", comparison.lost);
    const Metric whole{report.indoor_area, report.indoor_area};
    add(Sign::Patch, kFloor, kObjectEdge, "unseen", sum(whole, any, -1));
    return block;
}

/// Returns e.g. "2 lasers, 1 ranger".
std::string countsOf(const std::vector<SensorView>& sensors) {
    std::string text;
    for (const SensorKind* kind : sensorKinds()) {
        const auto count = std::count_if(sensors.begin(), sensors.end(),
                                         [kind](const auto& s) { return s.kind == kind; });
        if (count == 0) continue;
        if (!text.empty()) text += ", ";
        text.append(std::to_string(count)).append(" ").append(kind->noun);
        if (count > 1) text += "s";
    }
    return text.empty() ? "no sensor" : text;
}

/// Adds "… and 3 more" if the list is cut.
void addRest(LegendBlock& block, std::size_t all, std::size_t listed) {
    if (listed < all)
        block.items.push_back(
            {Sign::None, {}, {}, "… and " + std::to_string(all - listed) + " more", ""});
}

/// Returns the number of list items shown on so many lines.
std::size_t listedOf(std::size_t all, std::size_t lines) { return all > lines ? lines - 1 : all; }

LegendBlock sensorsBlock(const MapPicture& map) {
    const std::vector<SensorView>& sensors = map.coverage.sensors;
    LegendBlock block{countsOf(sensors), {}};
    if (sensors.empty()) block = {"Sensors", {{Sign::None, {}, {}, "none is placed", ""}}};
    const bool mixed = std::any_of(sensors.begin(), sensors.end(), [&](const auto& sensor) {
        return sensor.kind != sensors.front().kind;
    });
    const std::size_t listed = listedOf(sensors.size(), map.terse ? 5 : 9);
    const bool colored = map.options.color == MapColor::Sensor && map.other == nullptr;
    for (std::size_t i = 0; i < listed; ++i) {
        LegendItem item{Sign::Sensor, {0, 0, 0, 0}, palette::kObjectEdge, sensors[i].id, ""};
        item.mark = markOf(map, i);
        item.mark.heading = Angle();
        if (colored) item.color = floorColor(map, setOf(map.coverage, i));
        item.value = sensors[i].kind->keyword;
        if (const std::string& model = sensors[i].model; !model.empty())
            item.value = mixed ? item.value + " " + model : model;
        block.items.push_back(std::move(item));
    }
    addRest(block, sensors.size(), listed);
    if (map.other != nullptr) {
        const std::string name =
            map.coverage.report.comparison ? map.coverage.report.comparison->name : "";
        LegendItem item{Sign::Sensor, {0, 0, 0, 0}, {}, name.empty() ? "the other" : name, ""};
        item.mark = {SensorSign::Disc, Angle(), palette::kOtherSensor, true};
        item.value = countsOf(map.other->sensors);
        block.items.push_back(std::move(item));
    }
    return block;
}

LegendBlock spotsBlock(const MapPicture& map) {
    const CoverageReport& report = map.coverage.report;
    LegendBlock block{"Largest unseen spots", {}};
    for (std::size_t i = 0; i < markedSpots(map); ++i) {
        const UncoveredSpot& spot = report.unseen[i];
        LegendItem item{Sign::LineColumn, {}, {}, area(spot.area), "at "};
        item.value.append(formatFixed(spot.place.x, 2)).append(", ");
        item.value.append(formatFixed(spot.place.y, 2));
        item.number = std::to_string(i + 1);
        block.items.push_back(std::move(item));
    }
    return block;
}

LegendBlock zonesBlock(const CoverageReport& report, bool terse) {
    const bool exact = std::any_of(report.zones.begin(), report.zones.end(), [](const auto& zone) {
        return zone.coverage.exact.has_value();
    });
    LegendBlock block = metricBlock("Zones", exact);
    const std::size_t listed = listedOf(report.zones.size(), terse ? 3 : 7);
    for (std::size_t i = 0; i < listed; ++i) {
        LegendItem item{Sign::None, {}, {}, report.zones[i].id, ""};
        if (report.zones[i].area > 0)
            setMetric(item, block, report.zones[i].coverage, percent);
        else
            item.value = "outside";
        block.items.push_back(std::move(item));
    }
    addRest(block, report.zones.size(), listed);
    return block;
}

/// Explains tried positions and the gain of the best sensor there.
LegendBlock triedBlock(const std::vector<TriedPose>& trace) {
    const std::vector<TriedPlace> places = placesTried(trace);
    LegendBlock block{"Places tried", {}};
    const auto add = [&block](Sign sign, std::string text, std::string value) {
        block.items.push_back({sign, {}, {}, std::move(text), std::move(value)});
    };
    std::string ends = percent(places.front().value);
    if (places.back().value > places.front().value)
        ends.append(" – ").append(percent(places.back().value));
    add(Sign::Scale, "adds at best", std::move(ends));
    const auto chosen = std::count_if(trace.begin(), trace.end(),
                                      [](const TriedPose& tried) { return tried.is_chosen; });
    if (chosen > 0) add(Sign::Ring, "chosen", std::to_string(chosen));
    add(Sign::None, "Candidates", std::to_string(trace.size()));
    add(Sign::None, "Places", std::to_string(places.size()));
    return block;
}

/// Explains the elements of the scene on the plan, in the order of the legend.
LegendBlock planBlock(const MapContents& contents, double height) {
    LegendBlock block{"Plan", {}};
    const auto add = [&block](bool shown, Sign sign, Color color, Color edge, std::string text) {
        if (shown) block.items.push_back({sign, color, edge, std::move(text), ""});
    };
    using namespace palette;
    add(contents.walls, Sign::Line, kWall, {}, "wall");
    add(contents.openings, Sign::Line, kOpening, {}, "wall above or below");
    add(contents.doors, Sign::Line, kDoor, {}, "door");
    add(contents.glass, Sign::Line, kGlass, {}, "window or glass");
    add(contents.solids, Sign::Patch, kSolid, kSolidEdge,
        "object at " + formatDouble(std::round(1000 * height) / 1000) + " m");
    add(contents.objects, Sign::Patch, kObject, kObjectEdge, "object above or below");
    add(contents.outside, Sign::Hatched, kOutside, kOutsideHatch, "not indoor");
    add(contents.zones, Sign::Dashes, kZone, {}, "zone");
    return block;
}

}  // namespace

MapContents contentsOf(const Scene& scene, const Coverage& coverage) {
    const double height = coverage.target.height;
    MapContents contents;
    contents.outside = !outsideOf(scene.environment.indoor()).empty();
    for (const Element& element : scene.environment.elements()) {
        const std::string& keyword = element.record.keyword();
        if (keyword == "zone") contents.zones = true;
        if (keyword == "door") contents.doors = true;
        for (const Sheet& sheet : element.body.sheets)
            (!standsAt(sheet.bottom, sheet.top, height) ? contents.openings
             : sheet.clear                              ? contents.glass
                                                        : contents.walls) = true;
        for (const Prism& prism : element.body.prisms) {
            const bool stands = standsAt(prism.bottom, prism.top, height);
            if (isWall(element))
                (stands ? contents.walls : contents.openings) = true;
            else
                (stands ? contents.solids : contents.objects) = true;
        }
        if (!isWall(element) && !element.body.meshes.empty()) contents.objects = true;
    }
    return contents;
}

std::vector<std::string> mainMetrics(const MapPicture& map) {
    const CoverageReport& report = map.coverage.report;
    const auto best = [](const Metric& metric) {
        return metric.exact ? metric.exact : metric.grid;
    };
    std::vector<std::string> parts;
    if (const auto share = best(report.coverage)) {
        parts.push_back("Coverage " + percent(*share));
        if (!report.coverage.exact)
            parts.back() += " by cells";
        else if (report.coverage.grid)
            parts.back().append(" (cells ").append(percent(*report.coverage.grid)).append(")");
    }
    if (const auto& comparison = report.comparison; comparison && map.other != nullptr) {
        if (const auto gained = best(comparison->gained))
            parts.push_back("gained " + area(*gained));
        if (const auto lost = best(comparison->lost)) parts.push_back("lost " + area(*lost));
        if (const auto before = best(comparison->coverage))
            parts.push_back(comparison->name + " " + percent(*before));
        return parts;
    }
    if (const auto share = best(report.coverage))
        parts.push_back(area(*share * report.indoor_area) + " of " + area(report.indoor_area));
    parts.push_back(countsOf(map.coverage.sensors));
    return parts;
}

std::vector<LegendBlock> legendBlocks(const MapPicture& map) {
    const CoverageReport& report = map.coverage.report;
    const MapContents contents = contentsOf(map.scene, map.coverage);
    std::vector<LegendBlock> blocks = {metricsBlock(report, map.terse)};
    if (map.other != nullptr)
        blocks.push_back(comparisonBlock(report));
    else if (map.options.color == MapColor::Sensor)
        blocks.push_back(bySensorBlock(report, map.coverage.sets.size()));
    else if (map.options.color == MapColor::Density || map.options.color == MapColor::Levels)
        blocks.push_back(densityBlock(report, standardOf(map.options.color)));
    else
        blocks.push_back(shadesBlock(report, map.options.redundancy_scale));
    blocks.push_back(sensorsBlock(map));
    if (!map.options.trace.empty()) blocks.push_back(triedBlock(map.options.trace));
    for (const MapLayer* const layer : map.options.layers)
        if (std::optional<LegendBlock> block = layer->legend()) blocks.push_back(*std::move(block));
    if (markedSpots(map) > 0) blocks.push_back(spotsBlock(map));
    if (!report.zones.empty()) blocks.push_back(zonesBlock(report, map.terse));
    if (!map.terse) blocks.push_back(planBlock(contents, map.coverage.target.height));
    return blocks;
}

}  // namespace ispace
