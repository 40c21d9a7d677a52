// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/zone.h"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "env/body.h"
#include "env/walls.h"
#include "record/schema.h"

namespace ispace {

namespace {

constexpr std::string_view kRectangle = "rect:", kPolygon = "poly:";

/// As the coordinates of records: with units, and within 1000 km.
KeySpec coordinates(std::string_view prefix) {
    constexpr double kFarthest = 1e6;
    KeySpec key{.name = std::string(prefix),
                .type = KeyType::Tuple,
                .unit = Unit::Length,
                .help = "",
                .min_count = 4,
                .max_count = 4,
                .lower = -kFarthest,
                .upper = kFarthest};
    if (prefix == kPolygon) {
        key.type = KeyType::TupleList;
        key.min_count = key.max_count = 2;
    }
    return key;
}

Polygon rectangleOf(const Tuple& corners) {
    const auto [left, right] = std::minmax({corners[0], corners[2]});
    const auto [low, high] = std::minmax({corners[1], corners[3]});
    return {{left, low}, {right, low}, {right, high}, {left, high}};
}

Polygon polygonOf(const TupleList& corners) {
    Polygon polygon;
    polygon.reserve(corners.size());
    for (const Tuple& corner : corners) polygon.push_back({corner[0], corner[1]});
    if (signedArea(polygon) < 0) std::reverse(polygon.begin(), polygon.end());
    return polygon;
}

/// \throws UsageError
Polygon parsedOutline(std::string_view text) {
    try {
        if (text.starts_with(kRectangle))
            return rectangleOf(std::get<Tuple>(
                parseValue(coordinates(kRectangle), text.substr(kRectangle.size()))));
        return polygonOf(
            std::get<TupleList>(parseValue(coordinates(kPolygon), text.substr(kPolygon.size()))));
    } catch (const FormatError& error) {
        throw UsageError(excerpt(text) + " is no zone: " + error.diagnostics().front().message);
    }
}

/// \throws UsageError for what encloses nothing, or not one thing
void mustEnclose(const Polygon& outline, std::string_view text) {
    const auto refuse = [text](const std::string& what) {
        throw UsageError("zone " + excerpt(text) + ' ' + what);
    };
    if (outline.size() < 3)
        refuse("has " + std::to_string(outline.size()) + " corners, wanted at least 3");
    if (const auto crossing = selfCrossing(outline))
        refuse("crosses itself near (" + formatFixed(crossing->x, 2) + ", " +
               formatFixed(crossing->y, 2) + ')');
    if (!(signedArea(outline) > 0)) refuse("has no area");
}

/// Centre of gravity of the area. \pre the area is above 0
Point2 centerOfGravity(const Polygon& polygon) {
    // Relative to the first vertex, so that a small polygon far from the origin keeps its digits.
    double twice = 0;
    Vec2 sum{0, 0};
    for (std::size_t i = 2; i < polygon.size(); ++i) {
        const Vec2 a = polygon[i - 1] - polygon[0], b = polygon[i] - polygon[0];
        const double part = cross(a, b);
        twice += part;
        sum = sum + (part / 3) * (a + b);
    }
    return polygon[0] + (1 / twice) * sum;
}

const Element* zoneRecord(std::string_view id, const Environment& environment) {
    for (const Element& element : environment.elements())
        if (element.record.keyword() == "zone" && element.id == id) return &element;
    return nullptr;
}

UsageError unknownZone(std::string_view text, const Environment& environment) {
    std::vector<std::string> known;
    for (const Element& element : environment.elements())
        if (element.record.keyword() == "zone") known.push_back(element.id);
    return UsageError("the room has no zone " + excerpt(text) + didYouMean(text, known) +
                      "; write the id of a zone, rect:X,Y,X,Y, poly:X,Y;X,Y;X,Y or door:GLOB,M");
}

}  // namespace

NamedZone readZone(std::string_view text, const Environment& environment) {
    NamedZone zone;
    zone.name = text;
    if (const Element* const element = zoneRecord(text, environment))
        zone.outline = zoneOutline(element->record);
    else if (text.starts_with(kRectangle) || text.starts_with(kPolygon))
        zone.outline = parsedOutline(text);
    else
        throw unknownZone(text, environment);
    mustEnclose(zone.outline, text);

    zone.inside = centerOfGravity(zone.outline);
    zone.is_center_outside = locate(zone.outline, zone.inside) != Side::Inside;
    if (!zone.is_center_outside) return zone;
    try {
        zone.inside = interiorPoint({zone.outline, {}});
    } catch (const std::invalid_argument& /*too thin*/) {
        throw UsageError("zone " + excerpt(text) + " is too thin: no point lies between its edges");
    }
    return zone;
}

}  // namespace ispace
