// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/check.h"

#include <algorithm>
#include <cmath>

#include "base/number.h"
#include "env/crossing.h"
#include "env/mesh_body.h"

namespace ispace {

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

}  // namespace ispace
