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
    json.key("exact_area").value(sensor.exact_area);
    json.key("marginal_area").value(sensor.marginal_area);
    json.endObject();
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
    json.key("indoor_area").value(report.indoor_area);
    json.key("free_area").value(report.free_area);
    json.key("sensors").beginArray();
    for (const SensorFigures& sensor : report.sensors) write(json, sensor);
    json.endArray();
    write(json, "total_effective_area", report.total_effective_area);
    write(json, "coverage", report.coverage);
    write(json, "free_coverage", report.free_coverage);
    json.key("redundancy").value(report.redundancy);
    json.endObject();
    return json.take() + "\n";
}

}  // namespace ispace
