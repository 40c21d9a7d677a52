// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/info.h"

#include <algorithm>
#include <cmath>

#include "base/json_writer.h"
#include "base/number.h"
#include "base/program.h"
#include "env/level.h"
#include "env/mesh.h"
#include "env/walls.h"
#include "geom/boolean.h"

namespace ispace {

EnvironmentInfo describe(const Environment& environment, std::span<const Record> records,
                         const std::string& digest) {
    EnvironmentInfo info;
    info.digest = digest;
    info.limits = environment.limits();
    info.indoor_area = environment.indoor().area();
    info.free_area = totalArea(environment.level(kScanHeight)->freeFloor());
    info.height = environment.height();
    info.perimeter = environment.indoor().boundaryLength();
    for (const Record& record : records) ++info.counts[record.keyword()];
    info.triangles = environment.floor().triangles.size();
    for (const Element& element : environment.elements())
        for (const Mesh& mesh : meshesOf(element.body, Surfaces::Solid))
            info.triangles += mesh.triangles.size();
    return info;
}

std::string infoJson(const EnvironmentInfo& info) {
    const Box2& b = info.limits;
    JsonWriter json;
    beginReport(json, "ispace-info/1", "envc");
    json.key("digest").value(info.digest);
    json.key("limits").beginArray();
    for (const double limit : {b.low.x, b.low.y, b.high.x, b.high.y})
        json.value(roundSignificant(limit));
    json.endArray();
    json.key("indoor_area").value(roundSignificant(info.indoor_area));
    json.key("free_area").value(roundSignificant(info.free_area));
    json.key("height").value(roundSignificant(info.height));
    json.key("perimeter").value(roundSignificant(info.perimeter));
    json.key("counts").beginObject();
    for (const auto& [keyword, count] : info.counts) json.key(keyword).value(count);
    json.endObject();
    json.key("triangles").value(info.triangles);
    json.endObject();
    return json.take() + '\n';
}

std::string infoText(const EnvironmentInfo& info) {
    const Box2& b = info.limits;
    std::string out = "digest       " + info.digest + '\n';
    out += "limits       " + formatFixed(b.low.x, 3) + ' ' + formatFixed(b.low.y, 3) + " to " +
           formatFixed(b.high.x, 3) + ' ' + formatFixed(b.high.y, 3) + " m (" +
           formatFixed(b.width(), 3) + " x " + formatFixed(b.depth(), 3) + ")\n";
    out += "indoor area  " + formatFixed(info.indoor_area, 3) + " m2\n";
    out += "free area    " + formatFixed(info.free_area, 3) + " m2 at " +
           formatDouble(kScanHeight) + " m\n";
    out += "height       " + formatFixed(info.height, 3) + " m\n";
    out += "perimeter    " + formatFixed(info.perimeter, 3) + " m\n";
    out += "records     ";
    for (const auto& [keyword, count] : info.counts)
        out += ' ' + keyword + ' ' + std::to_string(count) + ',';
    if (out.ends_with(',')) out.pop_back();
    out += "\ntriangles    " + std::to_string(info.triangles) + '\n';
    return out;
}

namespace {

std::string centimetres(double value) {
    std::string text = formatFixed(value, 2);
    if (text.back() == '0') text.pop_back();
    return text;
}

void checkCrossing(const Record& record, const Polygon& outline, Diagnostics& findings) {
    if (const auto place = selfCrossing(outline))
        findings.add(
            record.finding("path", record.keyword() + " crosses itself near " + placeText(*place)));
}

void checkZone(const Record& record, Diagnostics& findings) {
    if (!record.has("path")) {
        if (!record.has("size"))
            findings.add(record.finding("zone has no extent: give `path`, or `at` and `size`"));
        return;
    }
    for (const char* key : {"at", "heading", "size"})
        if (record.has(key))
            findings.add(record.finding(key, std::string("zone has `path` and also `") + key +
                                                 "`: give its place one way only"));
    const Polygon outline = zoneOutline(record);
    if (outline.size() < 3)
        findings.add(record.finding(
            "path", "zone has " + std::to_string(outline.size()) + " points, wanted at least 3"));
    else if (signedArea(outline) == 0 && !selfCrossing(outline))
        findings.add(record.finding("path", "zone has no area"));
    else
        checkCrossing(record, outline, findings);
}

/// Far from the origin doubles are coarse: what is smaller than their step has no footprint left.
bool hasExtent(const Body& body) {
    return std::all_of(body.prisms.begin(), body.prisms.end(), [](const Prism& prism) {
        return signedArea(prism.footprint) > 0 && prism.top > prism.bottom;
    });
}

}  // namespace

std::string placeText(Point2 p) { return "(" + centimetres(p.x) + ", " + centimetres(p.y) + ")"; }

void checkShape(const Record& record, const Body& body, Diagnostics& findings) {
    if (record.keyword() == "zone") return checkZone(record, findings);
    if (record.keyword() == "mesh") return checkMesh(record, body, findings);
    if (record.keyword() == "fence" && record.has("path") && record.flag("closed")) {
        Polygon outline;
        for (const Tuple& tuple : record.list("path")) outline.push_back({tuple[0], tuple[1]});
        checkCrossing(record, outline, findings);
    }
    if (!hasExtent(body))
        findings.add(record.finding(record.keyword() + " is too small for its distance from the "
                                                       "origin: no area is left of it"));
}

std::string nameOf(const Element& element) { return element.record.keyword() + ' ' + element.id; }

std::string lengthText(double length) {
    int decimals = 3;
    while (decimals < 12 && length * std::pow(10, decimals) < 10) ++decimals;
    std::string text = formatFixed(length, decimals);
    while (text.back() == '0' && text[text.size() - 2] != '.') text.pop_back();
    return text;
}

}  // namespace ispace
