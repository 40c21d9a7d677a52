// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json_writer.h"
#include "base/number.h"
#include "base/program.h"
#include "cover/coverage.h"

namespace ispace {

namespace {

/// Null for what is not known.
void write(JsonWriter& json, const char* key, const std::optional<double>& figure) {
    json.key(key);
    if (figure)
        json.value(tidy(*figure));
    else
        json.null();
}

void write(JsonWriter& json, const char* key, std::vector<double> figures) {
    for (double& figure : figures) figure = tidy(figure);
    json.key(key).value(figures);
}

void write(JsonWriter& json, const char* key, const Figure& figure) {
    json.key(key).beginObject();
    write(json, "grid", figure.grid);
    write(json, "exact", figure.exact);
    json.endObject();
}

void write(JsonWriter& json, const SensorFigures& sensor) {
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
    json.endObject();
}

void write(JsonWriter& json, const ZoneFigures& zone) {
    json.beginObject();
    json.key("id").value(zone.id);
    write(json, "area", zone.area);
    write(json, "coverage", zone.coverage);
    json.endObject();
}

void write(JsonWriter& json, const UnseenSpot& spot) {
    json.beginObject();
    write(json, "x", spot.place.x);
    write(json, "y", spot.place.y);
    write(json, "area", spot.area);
    json.endObject();
}

void write(JsonWriter& json, const Comparison& comparison) {
    json.key("comparison").beginObject();
    json.key("with").value(comparison.name);
    write(json, "coverage", comparison.coverage);
    write(json, "gained_area", comparison.gained);
    write(json, "lost_area", comparison.lost);
    json.endObject();
}

template <typename Item>
void writeList(JsonWriter& json, const char* key, const std::vector<Item>& items) {
    json.key(key).beginArray();
    for (const Item& item : items) write(json, item);
    json.endArray();
}

}  // namespace

std::string coverageJson(const CoverageReport& report) {
    const Box2& limits = report.limits;
    JsonWriter json;
    beginReport(json, "ispace-coverage/1", "coverage");
    json.key("digest").value(report.digest);
    write(json, "limits", {limits.low.x, limits.low.y, limits.high.x, limits.high.y});
    json.key("grid").value(std::vector<int>{report.grid.columns, report.grid.rows});
    json.key("height").value(report.height);
    json.key("plane").value(report.plane);
    write(json, "indoor_area", report.indoor_area);
    write(json, "free_area", report.free_area);
    writeList(json, "sensors", report.sensors);
    write(json, "total_effective_area", report.total_effective_area);
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
    if (report.comparison) write(json, *report.comparison);
    json.endObject();
    return json.take() + "\n";
}

}  // namespace ispace
