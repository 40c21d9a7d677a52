// SPDX-License-Identifier: GPL-3.0-or-later
// Writes GeoJSON (RFC 7946). Rooms have no position on Earth, which the standard requires; the
// member "coordinate_system" says so, and `crs` of the draft of 2008 keeps GDAL and QGIS from
// taking metres for degrees.
#include "io/geojson.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "base/json_writer.h"
#include "base/number.h"
#include "drawing/plan/elements.h"
#include "env/level.h"
#include "geom/arrangement.h"
#include "io/exporters.h"

namespace ispace {

namespace {

/// A coordinate system without a position on Earth, in WKT 1 as GDAL reads it.
constexpr std::string_view kRoomFrame =
    R"(LOCAL_CS["room",UNIT["metre",1],AXIS["x",EAST],AXIS["y",NORTH]])";

}  // namespace

FeatureWriter::FeatureWriter() {
    json_.beginObject().key("type").value("FeatureCollection");
    json_.key("coordinate_system").value("local-metres");
    json_.key("crs").beginObject().key("type").value("name").key("properties").beginObject();
    json_.key("name").value(kRoomFrame).endObject().endObject();
}

JsonWriter& FeatureWriter::begin(std::string_view id, std::string_view keyword,
                                 std::string_view type) {
    json_.beginObject().key("type").value("Feature").key("properties").beginObject();
    json_.key("id").value(id).key("keyword").value(keyword);
    return json_.key("type").value(type);
}

void FeatureWriter::endAsPoint(Point2 p) {
    beginGeometry("Point");
    add(p);
    end();
}

void FeatureWriter::endAsLines(const std::vector<std::vector<Point2>>& chains) {
    beginGeometry(chains.size() == 1 ? "LineString" : "MultiLineString");
    if (chains.size() != 1) json_.beginArray();
    for (const std::vector<Point2>& chain : chains) {
        json_.beginArray();
        for (const Point2 p : chain) add(p);
        json_.endArray();
    }
    if (chains.size() != 1) json_.endArray();
    end();
}

void FeatureWriter::endAsArea(const std::vector<Region>& pieces) {
    beginGeometry(pieces.size() == 1 ? "Polygon" : "MultiPolygon");
    if (pieces.size() != 1) json_.beginArray();
    for (const Region& piece : pieces) {
        json_.beginArray();
        addRing(piece.outline, true);
        for (const Polygon& hole : piece.holes) addRing(hole, false);
        json_.endArray();
    }
    if (pieces.size() != 1) json_.endArray();
    end();
}

void FeatureWriter::endAsNothing() { json_.endObject().key("geometry").null().endObject(); }

std::string FeatureWriter::finish() {
    json_.endArray().endObject();
    return json_.take() + '\n';
}

void FeatureWriter::beginGeometry(std::string_view type) {
    json_.endObject().key("geometry").beginObject();
    json_.key("type").value(type).key("coordinates");
}

/// RFC 7946 requires the first position again at the end.
void FeatureWriter::addRing(const Polygon& ring, bool counter_clockwise) {
    const bool turn = (signedArea(ring) > 0) != counter_clockwise;
    json_.beginArray();
    for (std::size_t i = 0; i <= ring.size(); ++i)
        add(ring[turn ? (ring.size() - i) % ring.size() : i % ring.size()]);
    json_.endArray();
}

namespace {

std::string_view typeName(RecordType type) {
    constexpr std::array<std::string_view, 7> kNames{"space", "floor",     "wall", "infra",
                                                     "other", "placement", "meta"};
    return kNames[static_cast<std::size_t>(type)];
}

/// Writes the values of a record, given or default, except its id, its position and `known` keys,
/// which the caller writes; in the units of files (metres, degrees).
void addValues(JsonWriter& json, const Record& record,
               std::initializer_list<std::string_view> known) {
    for (const KeySpec& key : record.schema().keys) {
        const Value* value = record.find(key.name);
        if (value == nullptr || key.name == "id" || key.role == Role::Place ||
            std::find(known.begin(), known.end(), key.name) != known.end())
            continue;
        json.key(key.name);
        std::visit([&json](const auto& content) { json.value(content); }, *value);
    }
}

/// Lowest and highest point of a body; empty for elements without a body.
struct Extent {
    double bottom = std::numeric_limits<double>::infinity(), top = -bottom;
    void add(double low, double high) {
        bottom = std::min(bottom, low);
        top = std::max(top, high);
    }
};
Extent extentOf(const Body& body) {
    Extent extent;
    for (const Prism& prism : body.prisms) extent.add(prism.bottom, prism.top);
    for (const Sheet& sheet : body.sheets) extent.add(sheet.bottom, sheet.top);
    for (const Mesh& mesh : body.meshes)
        for (const Point3& p : mesh.vertices) extent.add(p.z, p.z);
    return extent;
}

void addElement(FeatureWriter& out, const Element& element, const ElementLines& lines) {
    const Record& record = element.record;
    JsonWriter& json = out.begin(element.id, record.keyword(), typeName(record.schema().type));
    const Extent extent = extentOf(element.body);
    const bool has_body = extent.bottom <= extent.top;
    if (has_body) {
        json.key("bottom")
            .value(roundSignificant(extent.bottom))
            .key("top")
            .value(roundSignificant(extent.top));
        json.key("height").value(roundSignificant(extent.top - extent.bottom));
    }
    if (!lines.chains.empty()) json.key("thickness").value(lines.thickness);
    if (has_body)
        addValues(json, record, {"height", "thickness"});
    else
        addValues(json, record, {"thickness"});
    if (record.keyword() == "inside")
        out.endAsPoint({record.tuple("at")[0], record.tuple("at")[1]});
    else if (record.keyword() == "zone")
        out.endAsArea({{zoneOutline(record), {}}});
    else if (record.keyword() == "floor")
        out.endAsArea({{floorOutline(record), {}}});
    else if (!lines.chains.empty())
        out.endAsLines(lines.chains);
    else if (const std::vector<Region> pieces = footprintOf(element.body); !pieces.empty())
        out.endAsArea(pieces);
    else
        out.endAsNothing();
}

void addPlaced(FeatureWriter& out, const Scene& scene, const PlacedRecord& placed) {
    const Record& record = scene.records[placed.record];
    const Point2 place = placed.pose.position.onFloor();
    JsonWriter& json =
        out.begin(scene.ids[placed.record], record.keyword(), typeName(record.schema().type));
    json.key("z").value(placed.pose.position.z);
    json.key("heading").value(wrapped(placed.pose.heading).degrees());
    addValues(json, record, {"heading"});
    const Pose2 pose{place, placed.pose.heading};
    if (record.keyword() == "mat")
        out.endAsArea(
            {{rectangle(place, record.tuple("size")[0], record.tuple("size")[1], pose.heading),
              {}}});
    else if (record.keyword() == "gate")
        out.endAsLines({{pose * Point2{0, record.number("width") / 2},
                         pose * Point2{0, -record.number("width") / 2}}});
    else
        out.endAsPoint(place);
}

void addFree(FeatureWriter& out, const Environment& environment, double height) {
    const auto level = environment.level(height);
    for (const Region& piece : level->freeFloor()) {
        out.begin("free", "free", "region")
            .key("z")
            .value(height)
            .key("area")
            .value(roundSignificant(piece.area()));
        out.endAsArea({piece});
    }
}

void addRoom(FeatureWriter& out, const Scene& scene) {
    const Regions& indoor = scene.environment.indoor();
    out.begin("indoor", "indoor", "region").key("area").value(roundSignificant(indoor.area()));
    out.endAsArea(indoor.parts);
    addFree(out, scene.environment, kScanHeight);
    const std::vector<Element>& elements = scene.environment.elements();
    const std::vector<ElementLines> lines = elementLinesOf(scene.environment);
    for (std::size_t i = 0; i < elements.size(); ++i) addElement(out, elements[i], lines[i]);
    for (const PlacedRecord& placed : scene.placed) addPlaced(out, scene, placed);
}

void addSlice(FeatureWriter& out, const Environment& environment, double height) {
    const auto level = environment.level(height);
    const Slice& slice = level->slice();
    addFree(out, environment, height);
    const auto begin = [&](std::size_t owner) {
        const Element& element = environment.elements()[owner];
        out.begin(element.id, element.record.keyword(), typeName(element.record.schema().type));
        out.json().key("z").value(height);
    };
    for (std::size_t i = 0; i < slice.sheets.size(); ++i) {
        begin(slice.sheet_owners[i]);
        out.endAsLines({{slice.sheets[i].a, slice.sheets[i].b}});
    }
    for (std::size_t i = 0; i < slice.solids.size(); ++i) {
        begin(slice.solid_owners[i]);
        out.endAsArea({{slice.solids[i], {}}});
    }
}

}  // namespace

std::string writeGeoJson(const Scene& scene, std::optional<double> slice_height) {
    FeatureWriter out;
    if (slice_height) out.json().key("height").value(*slice_height);
    out.beginFeatures();
    if (slice_height)
        addSlice(out, scene.environment, *slice_height);
    else
        addRoom(out, scene);
    return out.finish();
}

}  // namespace ispace
