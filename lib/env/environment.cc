// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/environment.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

#include "env/check.h"
#include "env/enclosure.h"
#include "env/walls.h"
#include "geom/boolean.h"
#include "geom/planar_map.h"

namespace ispace {

namespace {

bool isWall(const Record& record) {
    const std::string& keyword = record.keyword();
    return keyword == "wall" || keyword == "fence" || keyword == "ispace";
}

/// What a record is besides its walls: those follow from the lines of all records, welded.
Body bodyBesideWalls(const Record& record) {
    if (!isWall(record)) return bodyOf(record);
    Body body;
    if (record.keyword() == "ispace") body.plates = bodyOf(record).plates;
    return body;
}

/// Adds the bodies of the welded wall lines to the elements that own the lines.
void addWallBodies(std::vector<Element>& elements, std::span<const WallLine> walls,
                   const OwnedLines& owned, const WeldedLines& welded) {
    std::vector<Body> parts = wallBodies(walls, welded);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        Body& body = elements[owned.owner[i]].body;
        std::move(parts[i].sheets.begin(), parts[i].sheets.end(), std::back_inserter(body.sheets));
        std::move(parts[i].prisms.begin(), parts[i].prisms.end(), std::back_inserter(body.prisms));
    }
}

/// The `inside` record, or null; a second one is a finding.
const Record* insideRecord(std::span<const Element> elements, Diagnostics& findings) {
    const Record* inside = nullptr;
    for (const Element& element : elements) {
        if (element.record.keyword() != "inside") continue;
        if (inside == nullptr)
            inside = &element.record;
        else
            findings.add(element.record.finding("a second `inside` record (the first is on line " +
                                                std::to_string(inside->place().line) +
                                                "); one point tells which room is meant"));
    }
    return inside;
}

/// Calls on_sheet(line, element) and on_solid(footprint, element) for what stands anywhere between
/// two heights.
template <typename OnSheet, typename OnSolid>
void forEachStanding(std::span<const Element> elements, double bottom, double top, OnSheet on_sheet,
                     OnSolid on_solid) {
    const auto stands = [&](const auto& part) { return part.bottom <= top && bottom <= part.top; };
    for (std::size_t i = 0; i < elements.size(); ++i) {
        for (const Sheet& sheet : elements[i].body.sheets)
            if (stands(sheet)) on_sheet(sheet.line, i);
        for (const Prism& prism : elements[i].body.prisms)
            if (stands(prism)) on_solid(prism.footprint, i);
    }
}

/// For findings about the file as a whole.
Diagnostic fileFinding(std::span<const Element> elements, std::string message) {
    if (elements.empty()) return {{}, 0, 0, std::move(message)};
    Diagnostic diagnostic = elements.front().record.finding(std::move(message));
    diagnostic.line = diagnostic.column = 0;
    return diagnostic;
}

}  // namespace

Environment::Environment(std::span<const Record> records, std::span<const std::string> ids) {
    assert(records.size() == ids.size());
    Diagnostics findings;
    std::vector<WallLine> walls;
    OwnedLines owned;
    for (std::size_t i = 0; i < records.size(); ++i) {
        const Record& record = records[i];
        if (!record.schema().isEnvironment()) continue;
        for (const WallLine& wall : wallLinesOf(record, findings)) {
            walls.push_back(wall);
            owned.lines.push_back(wall.line);
            owned.owner.push_back(elements_.size());
        }
        elements_.push_back({record, ids[i], bodyBesideWalls(record)});
        checkShape(record, elements_.back().body, findings);
    }
    const Record* inside = insideRecord(elements_, findings);
    findings.throwIfAny();
    if (walls.empty())
        throw FormatError(fileFinding(
            elements_, "no walls: nothing encloses a room; add an ispace, wall or fence record"));

    WeldedLines welded = weld(owned.lines);
    addWallBodies(elements_, walls, owned, welded);
    for (const Segment2& piece : welded.pieces) {
        limits_.add(piece.a);
        limits_.add(piece.b);
    }
    for (const Element& element : elements_)
        if (isWall(element.record)) height_ = std::max(height_, topOf(element.body));
    Enclosure enclosure = enclose(owned, welded, limits_, elements_, inside);
    indoor_ = std::move(enclosure.indoor);
    inside_ = enclosure.inside;
    wall_lines_ = std::move(welded.pieces);
}

Slice Environment::slice(double height) const {
    Slice slice;
    slice.height = height;
    forEachStanding(
        elements_, height, height,
        [&](const Segment2& line, std::size_t /*owner*/) { slice.sheets.push_back(line); },
        [&](const Polygon& solid, std::size_t /*owner*/) { slice.solids.push_back(solid); });
    return slice;
}

Band Environment::band(double bottom, double top) const {
    assert(bottom <= top);
    Band band;
    band.bottom = bottom;
    band.top = top;
    const auto add_sheet = [&](const Segment2& line, std::size_t owner) {
        band.sheets.push_back(line);
        band.sheet_owners.push_back(owner);
    };
    const auto add_solid = [&](const Polygon& solid, std::size_t owner) {
        band.solids.push_back(solid);
        band.solid_owners.push_back(owner);
    };
    forEachStanding(elements_, bottom, top, add_sheet, add_solid);
    return band;
}

std::vector<Region> Environment::freeFloor(double height) const {
    const Box2 box = bounds(indoor_.outline);
    std::vector<Polygon> solids = slice(height).solids;
    std::erase_if(solids, [&box](const Polygon& solid) {
        const Box2 other = bounds(solid);
        return other.low.x > box.high.x || other.high.x < box.low.x || other.low.y > box.high.y ||
               other.high.y < box.low.y;
    });
    if (solids.empty()) return {indoor_};
    return difference(indoor_, solids);
}

}  // namespace ispace
