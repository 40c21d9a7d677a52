// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers in JSON are rounded to significant digits (roundSignificant()), unknown ones are null;
// members have one order. Schemas grow by members only, see the manual of formats.
#include "report/coverage_report.h"

#include <algorithm>

#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"
#include "scene/sensor/density_classes.h"

namespace ispace {

namespace {

/// Writes a metric, null if it is unknown.
void write(JsonWriter& json, const char* key, const std::optional<double>& metric) {
    json.key(key);
    if (metric)
        json.value(roundSignificant(*metric));
    else
        json.null();
}

void write(JsonWriter& json, const char* key, std::vector<double> metrics) {
    for (double& metric : metrics) metric = roundSignificant(metric);
    json.key(key).value(metrics);
}

void write(JsonWriter& json, const char* key, const Metric& metric) {
    json.key(key).beginObject();
    write(json, "grid", metric.grid);
    write(json, "exact", metric.exact);
    json.endObject();
}

/// Writes a metric for each density class, or skips the member without classes.
void writeClasses(JsonWriter& json, const char* key, const char* figure,
                  const std::vector<Metric>& metrics) {
    if (metrics.empty()) return;
    json.key(key).beginArray();
    for (std::size_t i = 0; i < metrics.size(); ++i) {
        const DensityClass& one = densityClasses()[i];
        json.beginObject();
        json.key("class").value(std::string(one.name));
        if (!one.level.empty()) json.key("level").value(std::string(one.level));
        write(json, "pixels_per_metre", one.pixels_per_metre);
        write(json, figure, metrics[i]);
        json.endObject();
    }
    json.endArray();
}

void write(JsonWriter& json, const PictureMetrics& picture) {
    json.key("picture").beginObject();
    writeClasses(json, "areas", "area", picture.areas);
    write(json, "nearest", picture.nearest);
    write(json, "farthest", picture.farthest);
    write(json, "mean_density", picture.mean_density);
    json.endObject();
}

void write(JsonWriter& json, const SensorMetrics& sensor) {
    json.beginObject();
    json.key("id").value(sensor.id);
    json.key("model");
    if (sensor.model.empty())
        json.null();
    else
        json.value(sensor.model);
    write(json, "slice_area", sensor.slice_area);
    write(json, "exact_area", sensor.area.exact);
    write(json, "marginal_area", sensor.marginal.grid);
    json.key("kind").value(sensor.kind->keyword);
    write(json, "area", sensor.area);
    write(json, "marginal", sensor.marginal);
    write(json, "overlap", sensor.overlap);
    write(json, "outside_area", sensor.outside);
    if (sensor.picture) write(json, *sensor.picture);
    json.endObject();
}

void write(JsonWriter& json, const ZoneMetrics& zone) {
    json.beginObject();
    json.key("id").value(zone.id);
    write(json, "area", zone.area);
    write(json, "coverage", zone.coverage);
    writeClasses(json, "densities", "coverage", zone.densities);
    json.endObject();
}

void write(JsonWriter& json, const UncoveredSpot& spot) {
    json.beginObject();
    if (!spot.room.empty()) json.key("room").value(spot.room);
    write(json, "x", spot.place.x);
    write(json, "y", spot.place.y);
    write(json, "area", spot.area);
    json.endObject();
}

template <typename Item>
void writeList(JsonWriter& json, const char* key, const std::vector<Item>& items) {
    json.key(key).beginArray();
    for (const Item& item : items) write(json, item);
    json.endArray();
}

}  // namespace

void writeComparison(JsonWriter& json, const Comparison& comparison) {
    json.key("comparison").beginObject();
    json.key("with").value(comparison.name);
    write(json, "coverage", comparison.coverage);
    write(json, "gained_area", comparison.gained);
    write(json, "lost_area", comparison.lost);
    json.endObject();
}

void writeParts(JsonWriter& json, const ReportParts& parts) {
    for (const auto& section : parts) section->writeJson(json);
}

namespace {

void writeExtent(JsonWriter& json, const CoverageReport& report) {
    const Box2& limits = report.limits;
    write(json, "limits", {limits.low.x, limits.low.y, limits.high.x, limits.high.y});
    json.key("grid").value(std::vector<int>{report.grid.columns, report.grid.rows});
}

/// Writes the report of a room, which is `rooms` if it is alone.
std::string roomJson(const CoverageReport& report, const ReportParts& parts, bool is_alone) {
    JsonWriter json;
    beginReport(json, "ispace-coverage/1", "coverage");
    json.key("digest").value(report.digest);
    if (is_alone) writeRooms(json, std::vector<ReportedRoom>{{"", &report}});
    writeExtent(json, report);
    writeFloor(json, report);
    writeParts(json, parts);
    json.endObject();
    return json.take() + "\n";
}

}  // namespace

void writeRooms(JsonWriter& json, std::span<const ReportedRoom> rooms) {
    json.key("rooms").beginArray();
    for (const auto& [id, report] : rooms) {
        json.beginObject().key("id").value(id).key("digest").value(report->digest);
        writeExtent(json, *report);
        write(json, "indoor_area", report->indoor_area);
        write(json, "free_area", report->free_area);
        write(json, "total_effective_area", report->total_effective_area);
        write(json, "outside_area", report->outside);
        write(json, "coverage", report->coverage);
        write(json, "free_coverage", report->free_coverage);
        json.endObject();
    }
    json.endArray();
}

void writeFloor(JsonWriter& json, const CoverageReport& report) {
    json.key("height").value(report.height);
    json.key("plane").value(report.plane);
    if (report.density > 0) write(json, "density", report.density);
    write(json, "indoor_area", report.indoor_area);
    write(json, "free_area", report.free_area);
    writeList(json, "sensors", report.sensors);
    write(json, "total_effective_area", report.total_effective_area);
    write(json, "outside_area", report.outside);
    write(json, "overlap_area", report.overlap);
    write(json, "coverage", report.coverage);
    write(json, "free_coverage", report.free_coverage);
    if (report.coverage.grid)
        write(json, "redundancy", report.redundancy);
    else
        json.key("redundancy").null();
    if (report.redundancy_exact)
        write(json, "redundancy_exact", *report.redundancy_exact);
    else
        json.key("redundancy_exact").null();
    writeList(json, "zones", report.zones);
    json.key("pieces").beginObject();
    json.key("count").value(report.pieces);
    write(json, "largest_share", report.largest_piece);
    json.endObject();
    writeList(json, "unseen", report.unseen);
    json.key("exact_missing");
    if (report.exact_missing.empty())
        json.null();
    else
        json.value(report.exact_missing);
    if (!report.densities.indoor.empty()) {
        write(json, "camera_coverage", report.densities.seen);
        writeClasses(json, "densities", "coverage", report.densities.indoor);
    }
    if (report.parallax) {
        json.key("parallax").beginObject();
        write(json, "angle", report.parallax->least.degrees());
        json.key("cameras").value(report.parallax->cameras);
        write(json, "coverage", report.parallax_coverage);
        json.endObject();
    }
    if (report.comparison) writeComparison(json, *report.comparison);
}

std::string coverageJson(const CoverageReport& report, const ReportParts& parts) {
    return roomJson(report, parts, true);
}

std::string storeyJson(const CoverageReport& report, const ReportParts& parts) {
    return roomJson(report, parts, false);
}

namespace {

constexpr std::size_t kSpotsListed = 5;

std::string twoDecimals(double value) { return formatFixed(value, 2); }
std::string area(double value) { return formatFixed(value, 2) + " m2"; }
std::string percent(double share) { return percentText(share); }

template <typename Format>
std::string withSign(double value, Format format) {
    const std::string text = format(value);
    return text.front() == '-' || text.front() == '+' ? text : "+" + text;
}

/// True for floor beyond the limits that is more than rounding.
bool isShown(const std::optional<double>& outside) { return outside.value_or(0) >= kMinPiece; }

/// Formats a metric by cells, exact, and the error of the cells.
template <typename Format>
TextRow row(std::string name, const Metric& metric, Format format) {
    TextRow row = {std::move(name), metric.grid ? format(*metric.grid) : "-",
                   metric.exact ? format(*metric.exact) : "-"};
    if (!metric.grid || !metric.exact) {
        row.emplace_back("-");
        return row;
    }
    row.push_back(withSign(*metric.grid - *metric.exact, format));
    return row;
}

std::string seenBy(std::size_t first, std::size_t last) {
    if (last == 0) return "seen by no sensor";
    if (last == 1) return "seen by 1 sensor";
    std::string text = "seen by ";
    if (first != last) text += std::to_string(first) + " to ";
    return text + std::to_string(last) + " sensors";
}

/// Adds a row for each number of sensors, and one for all greater numbers if there are many.
void addRedundancy(const CoverageReport& report, std::vector<TextRow>& rows) {
    constexpr std::size_t kMaxRows = 8;
    const auto exact = [&report](std::size_t k) { return (*report.redundancy_exact)[k]; };
    std::size_t end = report.redundancy.size();
    while (end > 1 && report.redundancy[end - 1] == 0 &&
           (!report.redundancy_exact || exact(end - 1) < 1e-9))
        --end;
    for (std::size_t k = 0; k < end; ++k) {
        const std::size_t last = k + 1 == kMaxRows ? end - 1 : k;
        Metric share;
        if (report.coverage.grid) share.grid = 0;
        if (report.redundancy_exact) share.exact = 0;
        for (std::size_t i = k; i <= last; ++i) {
            if (share.grid) *share.grid += report.redundancy[i];
            if (share.exact) *share.exact += exact(i);
        }
        rows.push_back(row(seenBy(k, last), share, percent));
        k = last;
    }
}

/// Classes include finer ones.
std::string classText(std::size_t index) {
    return classNames(index) + ", from " + formatDouble(densityClasses()[index].pixels_per_metre) +
           " px/m up";
}

std::string metricTable(const CoverageReport& report) {
    std::vector<TextRow> rows = {{"", "by cells", "exact", "difference"},
                                 row("total effective area", report.total_effective_area, area)};
    if (isShown(report.outside))
        rows.push_back({"outside of the limits", "-", area(*report.outside), "-"});
    rows.push_back(row("seen by several", report.overlap, area));
    rows.push_back(row("coverage", report.coverage, percent));
    rows.push_back(row("free coverage", report.free_coverage, percent));
    addRedundancy(report, rows);
    if (!report.densities.indoor.empty())
        for (const std::size_t i : classesByDensity())
            rows.push_back(row(classText(i), report.densities.indoor[i], percent));
    if (report.parallax)
        rows.push_back(row(
            "by " + std::to_string(report.parallax->cameras) + " cameras, axes at least " +
                formatDouble(roundSignificant(report.parallax->least.degrees())) + " degrees apart",
            report.parallax_coverage, percent));
    for (const ZoneMetrics& zone : report.zones) {
        if (zone.area > 0)
            rows.push_back(row("zone " + printable(zone.id), zone.coverage, percent));
        else
            rows.push_back({"zone " + printable(zone.id), "outside the room"});
    }
    return aligned(rows, "lr");
}

std::string sensorTable(const std::vector<SensorMetrics>& sensors) {
    const auto cell = [](const std::optional<double>& value) { return value ? area(*value) : "-"; };
    std::vector<TextRow> rows = {{"sensor", "model", "slice area", "by cells", "exact",
                                  "difference", "marginal", "exact", "difference", "overlap"}};
    const bool is_outside = std::any_of(sensors.begin(), sensors.end(),
                                        [](const auto& sensor) { return isShown(sensor.outside); });
    if (is_outside) rows.front().emplace_back("outside");
    for (const SensorMetrics& sensor : sensors) {
        const TextRow region = row("", sensor.area, area), alone = row("", sensor.marginal, area);
        rows.push_back(
            {printable(sensor.id),
             sensor.model.empty() ? std::string(sensor.kind->keyword) : printable(sensor.model),
             cell(sensor.slice_area), region[1], region[2], region[3], alone[1], alone[2], alone[3],
             cell(sensor.overlap.exact ? sensor.overlap.exact : sensor.overlap.grid)});
        if (is_outside) rows.back().push_back(cell(sensor.outside));
    }
    return aligned(rows, "llr");
}

/// Returns a table of the cameras' distances and pixel densities, then one of the areas by the
/// levels of 2025; "" without cameras. Areas are exact if known.
std::string cameraTable(const std::vector<SensorMetrics>& sensors) {
    const auto best = [](const Metric& metric) {
        return metric.exact ? metric.exact : metric.grid;
    };
    const auto text = [](const std::optional<double>& value, const char* unit, int decimals) {
        return value ? formatFixed(*value, decimals) + unit : "-";
    };
    std::vector<TextRow> rows = {{"camera", "nearest", "farthest", "mean density"}};
    std::vector<TextRow> levels = {{"camera"}};
    using enum DensityStandard;
    for (const std::size_t i : classesOf(Classes2015))
        rows.front().emplace_back(className(i, Classes2015));
    for (const std::size_t i : classesOf(Levels2025))
        levels.front().emplace_back(className(i, Levels2025));
    for (const SensorMetrics& sensor : sensors) {
        if (!sensor.picture) continue;
        const PictureMetrics& picture = *sensor.picture;
        TextRow row = {printable(sensor.id), text(picture.nearest, " m", 2),
                       text(picture.farthest, " m", 2),
                       text(best(picture.mean_density), " px/m", 1)};
        levels.push_back({row.front()});
        for (const std::size_t i : classesOf(Classes2015))
            row.push_back(text(best(picture.areas[i]), " m2", 2));
        for (const std::size_t i : classesOf(Levels2025))
            levels.back().push_back(text(best(picture.areas[i]), " m2", 2));
        rows.push_back(std::move(row));
    }
    if (rows.size() == 1) return "";
    return "\n" + aligned(rows, "lr") + '\n' + aligned(levels, "lr");
}

std::string piecesText(const CoverageReport& report) {
    constexpr double kAlmostAll = 0.9999;  // above it 100.00% may be printed
    std::string text;
    if (report.pieces == 1) {
        text += "covered floor is in one piece\n";
    } else if (report.pieces > 1) {
        text += "covered floor is in " + std::to_string(report.pieces) +
                " pieces, the largest has " +
                (report.largest_piece > kAlmostAll ? "more than " + percent(kAlmostAll)
                                                   : percent(report.largest_piece)) +
                " of it\n";
    }
    if (report.unseen.empty()) return text;
    constexpr double kMinArea = 0.005;  // square metres: below it 0.00 is printed
    std::vector<TextRow> rows;
    for (const UncoveredSpot& spot : report.unseen) {
        if (rows.size() == kSpotsListed || spot.area < kMinArea) break;
        rows.push_back({" ", area(spot.area), "around",
                        "(" + twoDecimals(spot.place.x) + ", " + twoDecimals(spot.place.y) + ")"});
    }
    if (rows.empty()) return text + "no spot of free floor of 0.01 m2 or more is unseen\n";
    text += "largest spots of free floor that no sensor sees:\n" + aligned(rows, "lrl");
    if (report.unseen.size() > rows.size())
        text += "   and " + std::to_string(report.unseen.size() - rows.size()) + " smaller\n";
    return text;
}

}  // namespace

std::string comparisonText(const Comparison& other, const Metric& now) {
    const auto square = [](double metres2) { return area(metres2); };
    const auto gain = [](const std::optional<double>& mine, const std::optional<double>& theirs) {
        return mine && theirs ? std::optional(*mine - *theirs) : std::nullopt;
    };
    const Metric change{.grid = gain(now.grid, other.coverage.grid),
                        .exact = gain(now.exact, other.coverage.exact)};
    return "\n" + aligned({{"beside " + printable(other.name), "by cells", "exact", "difference"},
                           row("its coverage", other.coverage, percent),
                           row("change of coverage", change,
                               [](double share) { return withSign(share, percent); }),
                           row("gained", other.gained, square),
                           row("lost", other.lost, square)},
                          "lr");
}

std::string partsText(const ReportParts& parts) {
    std::string text;
    for (const auto& section : parts) text += section->text();
    return text;
}

std::string coverageText(const CoverageReport& report) {
    const Box2& limits = report.limits;
    std::string text = aligned(
        {{"environment", printable(report.digest)},
         {"limits", "x " + twoDecimals(limits.low.x) + " to " + twoDecimals(limits.high.x) +
                        " m, y " + twoDecimals(limits.low.y) + " to " + twoDecimals(limits.high.y) +
                        " m"},
         {"grid", cellsText(report.grid)},
         {"indoor area", area(report.indoor_area)},
         {"free floor", area(report.free_area) + " at " + twoDecimals(report.height) + " m"}},
        "l");
    if (report.density > 0)
        text +=
            "cameras cover where they have " + formatDouble(report.density) + " pixels a metre\n";
    text += "\n" + metricTable(report);
    if (!report.exact_missing.empty())
        text += "no exact figures of all together: " + printable(report.exact_missing) + "\n";
    if (report.comparison) text += comparisonText(*report.comparison, report.coverage);
    text += "\n";
    if (report.sensors.empty())
        text += "no sensor that covers floor is placed\n";
    else
        text +=
            sensorTable(report.sensors) + cameraTable(report.sensors) + "\n" + piecesText(report);
    return text;
}

}  // namespace ispace
