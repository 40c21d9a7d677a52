// SPDX-License-Identifier: GPL-3.0-or-later
// Slices go through all elements, O(parts), and through meshes by mesh_cut.cc. Levels are cached by
// height, the latest at the end; one that was evicted while a caller holds it is found again by a
// weak pointer, so that no height has two levels at once.
#include "env/environment.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <mutex>
#include <utility>

#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"
#include "env/body_shapes.h"
#include "env/level.h"
#include "env/mesh.h"
#include "env/room_builder.h"
#include "env/room_info.h"
#include "env/slice.h"
#include "env/walls.h"
#include "geom/arrangement.h"
#include "record/text.h"

namespace ispace {

namespace {

/// Calls visit(element, its index) for the elements with these indices; for all without a list.
template <typename Visit>
void forEachOf(std::span<const Element> elements, const std::span<const std::size_t>* which,
               Visit visit) {
    const std::size_t count = which == nullptr ? elements.size() : which->size();
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = which == nullptr ? k : (*which)[k];
        visit(elements[i], i);
    }
}

/// Cuts the elements: the slice at `bottom`, or the band.
Slice cutOf(std::span<const Element> elements, const std::span<const std::size_t>* which,
            double bottom, double top, bool is_slice) {
    assert(is_slice || bottom <= top);  // a slice at NaN is empty
    Slice cut;
    const auto stands = [&](const auto& part) { return part.bottom <= top && bottom <= part.top; };
    forEachOf(elements, which, [&](const Element& element, std::size_t owner) {
        for (const Sheet& sheet : element.body.sheets) {
            if (!stands(sheet) || (is_slice ? !isAmong(Surfaces::Opaque, sheet) : isSoft(sheet)))
                continue;
            cut.sheets.push_back(sheet.line);
            cut.sheet_owners.push_back(owner);
        }
        for (const Prism& prism : element.body.prisms) {
            if (!stands(prism)) continue;
            const bool is_round = is_slice && prism.curve;
            if (is_round) cut.rounds.push_back({*prism.curve, cut.solids.size()});
            cut.solids.push_back(is_round ? outlineOf(*prism.curve) : prism.footprint);
            cut.solid_owners.push_back(owner);
        }
    });
    forEachOf(elements, which, [&](const Element& element, std::size_t owner) {
        if (element.body.meshes.empty()) return;
        if (is_slice)
            cutMeshes(element.body, bottom, cut, owner);
        else
            bandOfMeshes(element.body, bottom, top, cut, owner);
    });
    return cut;
}

}  // namespace

Environment::Environment(std::span<const Record> records, std::span<const std::string> ids) {
    assert(records.size() == ids.size());
    BuiltRoom room = buildRoom(records, ids);
    auto walls = std::make_shared<Walls>();
    walls->indoor = std::move(room.enclosure.indoor);
    walls->inside = room.enclosure.inside;
    walls->limits = room.limits;
    walls->height = room.height;
    walls->lines = std::move(room.wall_lines);
    auto data = std::make_shared<Data>();
    data->elements = std::move(room.elements);
    data->corners = room.corners;
    data->walls = std::move(walls);
    data_ = std::move(data);
    levels_ = std::make_shared<Levels>();
}

Environment::Environment(std::span<const Record> records, std::span<const std::string> ids,
                         const Environment& before)
    : Environment(before) {
    assert(records.size() == ids.size());
    auto edited = editElements(elements(), data_->corners, records, ids);
    if (!edited) {
        *this = Environment(records, ids);
    } else if (edited->is_changed) {
        auto data = std::make_shared<Data>();
        data->elements = std::move(edited->elements);
        data->corners = edited->corners;
        data->walls = data_->walls;
        data_ = std::move(data);
        levels_ = std::make_shared<Levels>();
    }
}

std::optional<ElementChanges> Environment::changesSince(const Environment& before) const {
    if (data_->walls != before.data_->walls) return std::nullopt;
    constexpr std::size_t kMaxChanged = 512, kMaxShare = 4;
    ElementChanges changes;
    const std::vector<Element>&was = before.elements(), &is = elements();
    const std::size_t most = std::min(kMaxChanged, was.size() / kMaxShare + 1);
    for (std::size_t i = 0, j = 0; i < was.size() || j < is.size();) {
        if (i < was.size() && j < is.size() && was[i].shape == is[j].shape) {
            ++i;
            ++j;
        } else if (j == is.size() || (i < was.size() && was[i].slot <= is[j].slot)) {
            changes.removed.push_back(i++);
        } else {
            changes.added.push_back(j++);
        }
        if (changes.size() > most) return std::nullopt;
    }
    return changes;
}

const std::vector<Triangulation>& Environment::Walls::floorParts() const {
    return floor.get([this] {
        std::vector<Triangulation> parts;
        parts.reserve(indoor.parts.size());
        for (const Region& part : indoor.parts) parts.push_back(triangulate(part));
        return parts;
    });
}

Mesh Environment::floor() const { return floorMesh(data_->walls->floorParts()); }

const std::string& Environment::digest() const {
    return data_->digest.get([this] {
        std::vector<const Record*> records;
        records.reserve(elements().size());
        for (const Element& element : elements()) records.push_back(&element.record);
        return environmentDigest(records);
    });
}

const RegionIndex& Environment::Walls::indoorIndex() const {
    return *indoor_index.get([this] { return std::make_shared<const RegionIndex>(indoor.parts); });
}

Slice Environment::Data::slice(double at) const { return cutOf(elements, nullptr, at, at, true); }

Slice Environment::slice(double height, std::span<const std::size_t> which) const {
    return cutOf(elements(), &which, height, height, true);
}

Slice Environment::band(double bottom, double top) const {
    return cutOf(elements(), nullptr, bottom, top, false);
}

Slice Environment::band(double bottom, double top, std::span<const std::size_t> which) const {
    return cutOf(elements(), &which, bottom, top, false);
}

/// Cache of the latest levels, the most recent at the end, and weak pointers to evicted levels that
/// callers still hold.
struct Environment::Levels {
    /// A slice takes some 100 bytes a line, and 300 more with its visibility; free floor and
    /// indexes are of the same order.
    static constexpr std::ptrdiff_t kMaxKept = 64;
    static constexpr std::size_t kMaxLines = 500'000;

    std::mutex mutex;
    std::vector<std::shared_ptr<const Level>> kept;
    std::vector<std::weak_ptr<const Level>> let_go;
    std::shared_ptr<Level::Cuts> cuts = std::make_shared<Level::Cuts>();

    /// Returns the evicted level of this height if a caller still holds it, else a new one.
    std::shared_ptr<const Level> find(double height, const std::shared_ptr<const Data>& data) {
        std::erase_if(let_go, [](const auto& level) { return level.expired(); });
        for (const auto& held : let_go)
            if (auto level = held.lock(); level != nullptr && level->height() == height)
                return level;
        return std::shared_ptr<const Level>(new Level(data, height, cuts));
    }

    /// Evicts the oldest levels above the limits, never the latest.
    std::vector<std::shared_ptr<const Level>> takeSurplus() {
        auto first = std::prev(kept.end());
        std::size_t lines = 0;
        while (first != kept.begin() && kept.end() - first < kMaxKept) {
            lines += (*std::prev(first))->linesMade();
            if (lines > kMaxLines) break;
            --first;
        }
        std::vector<std::shared_ptr<const Level>> surplus(std::move_iterator(kept.begin()),
                                                          std::move_iterator(first));
        kept.erase(kept.begin(), first);
        let_go.insert(let_go.end(), surplus.begin(), surplus.end());
        return surplus;
    }
};

std::shared_ptr<const Level> Environment::level(double height) const {
    std::vector<std::shared_ptr<const Level>> surplus;  // destroyed after the lock is released
    const std::scoped_lock lock(levels_->mutex);
    auto& kept = levels_->kept;
    const auto known = std::find_if(kept.begin(), kept.end(), [height](const auto& level) {
        return level->height() == height;
    });
    if (known != kept.end()) {
        std::rotate(known, known + 1, kept.end());
    } else {
        kept.push_back(levels_->find(height, data_));
        surplus = levels_->takeSurplus();
    }
    return kept.back();
}

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

namespace {

void writeLimits(JsonWriter& json, const Box2& b) {
    json.key("limits").beginArray();
    for (const double limit : {b.low.x, b.low.y, b.high.x, b.high.y})
        json.value(roundSignificant(limit));
    json.endArray();
}

std::string roomJson(const EnvironmentInfo& info, bool is_alone) {
    JsonWriter json;
    beginReport(json, "ispace-info/1", "envc");
    json.key("digest").value(info.digest);
    if (is_alone) writeRooms(json, std::vector<RoomInfo>{{"", 0, info.height, &info}});
    writeMeasures(json, info);
    json.endObject();
    return json.take() + '\n';
}

}  // namespace

void writeRooms(JsonWriter& json, std::span<const RoomInfo> rooms) {
    json.key("rooms").beginArray();
    for (const auto& [id, z, height, info] : rooms) {
        json.beginObject().key("id").value(id).key("z").value(roundSignificant(z));
        json.key("digest").value(info->digest);
        writeLimits(json, info->limits);
        json.key("indoor_area").value(roundSignificant(info->indoor_area));
        json.key("free_area").value(roundSignificant(info->free_area));
        json.key("height").value(roundSignificant(height));
        json.key("perimeter").value(roundSignificant(info->perimeter));
        json.key("triangles").value(info->triangles).endObject();
    }
    json.endArray();
}

void writeMeasures(JsonWriter& json, const EnvironmentInfo& info) {
    writeLimits(json, info.limits);
    json.key("indoor_area").value(roundSignificant(info.indoor_area));
    json.key("free_area").value(roundSignificant(info.free_area));
    json.key("height").value(roundSignificant(info.height));
    json.key("perimeter").value(roundSignificant(info.perimeter));
    json.key("counts").beginObject();
    for (const auto& [keyword, count] : info.counts) json.key(keyword).value(count);
    json.endObject();
    json.key("triangles").value(info.triangles);
}

std::string infoJson(const EnvironmentInfo& info) { return roomJson(info, true); }

std::string storeyInfoJson(const EnvironmentInfo& info) { return roomJson(info, false); }

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

/// Far from the origin doubles are coarse: bodies smaller than their resolution have no footprint
/// left.
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
