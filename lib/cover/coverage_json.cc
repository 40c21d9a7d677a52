// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json_writer.h"
#include "cover/coverage.h"

namespace ispace {

namespace {

void write(JsonWriter& json, const char* key, const Figure& figure) {
    json.key(key).beginObject();
    json.key("grid").value(figure.grid);
    json.key("exact").value(figure.exact);
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
    json.key("slice_area").value(sensor.slice_area);
    json.key("exact_area").value(sensor.area.exact);
    json.key("marginal_area").value(sensor.marginal.grid);
    json.key("kind").value(nameOf(sensor.kind));
    write(json, "area", sensor.area);
    write(json, "marginal", sensor.marginal);
    write(json, "overlap", sensor.overlap);
    json.endObject();
}

void write(JsonWriter& json, const ZoneFigures& zone) {
    json.beginObject();
    json.key("id").value(zone.id);
    json.key("area").value(zone.area);
    write(json, "coverage", zone.coverage);
    json.endObject();
}

void write(JsonWriter& json, const UnseenSpot& spot) {
    json.beginObject();
    json.key("x").value(spot.place.x);
    json.key("y").value(spot.place.y);
    json.key("area").value(spot.area);
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
    json.beginObject();
    json.key("schema").value("ispace-coverage/1");
    json.key("digest").value(report.digest);
    json.key("limits").value(
        std::vector<double>{limits.low.x, limits.low.y, limits.high.x, limits.high.y});
    json.key("grid").value(std::vector<int>{report.columns, report.rows});
    json.key("height").value(report.height);
    json.key("plane").value(report.plane);
    json.key("indoor_area").value(report.indoor_area);
    json.key("free_area").value(report.free_area);
    writeList(json, "sensors", report.sensors);
    write(json, "total_effective_area", report.total_effective_area);
    write(json, "overlap_area", report.overlap);
    write(json, "coverage", report.coverage);
    write(json, "free_coverage", report.free_coverage);
    json.key("redundancy").value(report.redundancy);
    json.key("redundancy_exact").value(report.redundancy_exact);
    writeList(json, "zones", report.zones);
    json.key("pieces").beginObject();
    json.key("count").value(report.pieces);
    json.key("largest_share").value(report.largest_piece);
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
