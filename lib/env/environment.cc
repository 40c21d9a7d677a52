// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/environment.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <iterator>
#include <mutex>
#include <utility>

#include "env/level.h"
#include "env/room_builder.h"
#include "env/slice.h"
#include "record/text.h"

namespace ispace {

namespace {

/// Calls on_sheet(sheet, element) and on_solid(prism, element) for the walls and things that
/// stand anywhere between two heights; meshes of files are cut elsewhere.
template <typename OnSheet, typename OnSolid>
void forEachStanding(std::span<const Element> elements, double bottom, double top, OnSheet on_sheet,
                     OnSolid on_solid) {
    const auto stands = [&](const auto& part) { return part.bottom <= top && bottom <= part.top; };
    for (std::size_t i = 0; i < elements.size(); ++i) {
        for (const Sheet& sheet : elements[i].body.sheets)
            if (stands(sheet)) on_sheet(sheet, i);
        for (const Prism& prism : elements[i].body.prisms)
            if (stands(prism)) on_solid(prism, i);
    }
}

}  // namespace

Environment::Environment(std::span<const Record> records, std::span<const std::string> ids) {
    assert(records.size() == ids.size());
    BuiltRoom room = buildRoom(records, ids);
    auto data = std::make_shared<Data>();
    data->indoor = std::move(room.enclosure.indoor);
    data->inside = room.enclosure.inside;
    data->limits = room.limits;
    data->height = room.height;
    data->elements = std::move(room.elements);
    data->wall_lines = std::move(room.wall_lines);
    data_ = std::move(data);
    levels_ = std::make_shared<Levels>();
}

const std::vector<Triangulation>& Environment::Data::floorParts() const {
    return floor.get([this] {
        std::vector<Triangulation> parts;
        parts.reserve(indoor.parts.size());
        for (const Region& part : indoor.parts) parts.push_back(triangulate(part));
        return parts;
    });
}

Mesh Environment::floor() const { return floorMesh(data_->floorParts()); }

const std::string& Environment::digest() const {
    return data_->digest.get([this] {
        std::vector<const Record*> records;
        records.reserve(elements().size());
        for (const Element& element : elements()) records.push_back(&element.record);
        return environmentDigest(records);
    });
}

const RegionIndex& Environment::Data::indoorIndex() const {
    return *indoor_index.get([this] { return std::make_shared<const RegionIndex>(indoor.parts); });
}

Slice Environment::Data::slice(double at) const {
    Slice slice;
    slice.height = at;
    const auto add_sheet = [&](const Sheet& sheet, std::size_t owner) {
        if (!isAmong(Surfaces::Opaque, sheet)) return;
        slice.sheets.push_back(sheet.line);
        slice.sheet_owners.push_back(owner);
    };
    const auto add_solid = [&](const Prism& prism, std::size_t owner) {
        if (prism.curve) slice.rounds.push_back({*prism.curve, slice.solids.size()});
        slice.solids.push_back(prism.curve ? outlineOf(*prism.curve) : prism.footprint);
        slice.solid_owners.push_back(owner);
    };
    forEachStanding(elements, at, at, add_sheet, add_solid);
    for (std::size_t i = 0; i < elements.size(); ++i)
        if (!elements[i].body.meshes.empty()) cutMeshes(elements[i].body, at, slice, i);
    return slice;
}

Slice Environment::band(double bottom, double top) const {
    assert(bottom <= top);
    Slice band;
    band.height = bottom;
    const auto add_sheet = [&](const Sheet& sheet, std::size_t owner) {
        band.sheets.push_back(sheet.line);
        band.sheet_owners.push_back(owner);
    };
    const auto add_solid = [&](const Prism& prism, std::size_t owner) {
        band.solids.push_back(prism.footprint);
        band.solid_owners.push_back(owner);
    };
    forEachStanding(elements(), bottom, top, add_sheet, add_solid);
    for (std::size_t i = 0; i < elements().size(); ++i)
        if (!elements()[i].body.meshes.empty())
            bandOfMeshes(elements()[i].body, bottom, top, band, i);
    return band;
}

/// The levels last asked for, the latest at the end, and those that others still hold.
struct Environment::Levels {
    /// A slice takes some 100 bytes a line, and 300 more once it is asked for visibility; free
    /// floor and indexes are of the same order.
    static constexpr std::ptrdiff_t kMaxKept = 64;
    static constexpr std::size_t kMaxLines = 500'000;

    std::mutex mutex;
    std::vector<std::shared_ptr<const Level>> kept;
    std::vector<std::weak_ptr<const Level>> let_go;

    /// The one of this height that somebody holds, or a new one.
    std::shared_ptr<const Level> find(double height, const std::shared_ptr<const Data>& data) {
        std::erase_if(let_go, [](const auto& level) { return level.expired(); });
        for (const auto& held : let_go)
            if (auto level = held.lock(); level != nullptr && level->height() == height)
                return level;
        return std::shared_ptr<const Level>(new Level(data, height));
    }

    /// Takes out those that are too many, the latest excepted.
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
    std::vector<std::shared_ptr<const Level>> surplus;  // ends after the lock
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

}  // namespace ispace
