// SPDX-License-Identifier: GPL-3.0-or-later
#include "draw/feature_writer.h"

namespace ispace {

namespace {

/// A frame that is nowhere on Earth, in the words that GDAL reads (WKT 1).
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

/// The first place comes again at the end.
void FeatureWriter::addRing(const Polygon& ring, bool counter_clockwise) {
    const bool turn = (signedArea(ring) > 0) != counter_clockwise;
    json_.beginArray();
    for (std::size_t i = 0; i <= ring.size(); ++i)
        add(ring[turn ? (ring.size() - i) % ring.size() : i % ring.size()]);
    json_.endArray();
}

}  // namespace ispace
