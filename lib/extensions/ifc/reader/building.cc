// SPDX-License-Identifier: GPL-3.0-or-later
// A building on its way from the confined reader: native bytes of one machine, with counts before
// lists. The receiver trusts no byte: counts are bounded by the bytes left, numbers are finite,
// indices within their lists; else std::runtime_error.
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <type_traits>

#include "extensions/ifc/reader/building.h"

namespace ispace::ifc {

namespace {

/// Appends values as native bytes.
class Packer {
  public:
    template <typename... T>
    void operator()(const T&... values) {
        (put(values), ...);
    }
    [[nodiscard]] std::string take() { return std::move(bytes_); }

  private:
    template <typename T>
    void put(const T& value) {
        if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>)
            bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
        else
            pack(*this, const_cast<T&>(value));
    }
    void put(const std::string& text) {
        put(std::uint64_t{text.size()});
        bytes_ += text;
    }
    template <typename T>
    void put(const std::vector<T>& values) {
        put(std::uint64_t{values.size()});
        for (const T& value : values) put(value);
    }

    std::string bytes_;
};

/// Reads these values. \throws std::runtime_error
class Unpacker {
  public:
    explicit Unpacker(std::string_view bytes) : rest_(bytes) {}

    template <typename... T>
    void operator()(T&... values) {
        (get(values), ...);
    }
    [[nodiscard]] bool isAtEnd() const { return rest_.empty(); }
    static void check(bool is_sound) {
        if (!is_sound) throw std::runtime_error("the reader of buildings did not finish");
    }

  private:
    template <typename T>
    void get(T& value) {
        if constexpr (std::is_same_v<T, bool>) {
            std::uint8_t byte = 0;
            get(byte);
            check(byte <= 1);
            value = byte == 1;
        } else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
            std::memcpy(&value, takeBytes(sizeof value).data(), sizeof value);
            if constexpr (std::is_floating_point_v<T>) check(std::isfinite(value));
        } else {
            pack(*this, value);
        }
    }
    void get(std::string& text) { text = takeBytes(count()); }
    template <typename T>
    void get(std::vector<T>& values) {
        for (std::uint64_t left = count(); left > 0; --left) get(values.emplace_back());
    }
    /// Reads a count of items that take at least a byte each.
    std::uint64_t count() {
        std::uint64_t count = 0;
        get(count);
        check(count <= rest_.size());
        return count;
    }
    std::string_view takeBytes(std::uint64_t size) {
        check(size <= rest_.size());
        const std::string_view taken = rest_.substr(0, size);
        rest_.remove_prefix(size);
        return taken;
    }

    std::string_view rest_;
};

template <typename Archive>
void pack(Archive& archive, Point2& p) {
    archive(p.x, p.y);
}
template <typename Archive>
void pack(Archive& archive, Vec2& v) {
    archive(v.x, v.y);
}
template <typename Archive>
void pack(Archive& archive, BuildingSection::Part& part) {
    archive(part.curves, part.removed);
}
template <typename Archive>
void pack(Archive& archive, BuildingSection& section) {
    archive(section.parts, section.sheets);
}
template <typename Archive>
void pack(Archive& archive, BuildingBox& box) {
    archive(box.center, box.along, box.length, box.width, box.bottom, box.top, box.is_round);
}
template <typename Archive>
void pack(Archive& archive, BuildingStorey& storey) {
    archive(storey.name, storey.building, storey.elevation, storey.cut, storey.walls, storey.doors,
            storey.windows);
}
template <typename Archive>
void pack(Archive& archive, StatedArea& area) {
    archive(area.name, area.area);
}
template <typename Archive>
void pack(Archive& archive, BuildingSpace& space) {
    archive(space.number, space.name, space.storey, space.is_part, space.outline, space.areas);
}
template <typename Archive>
void pack(Archive& archive, BuildingWall& wall) {
    archive(wall.storey, wall.is_column, wall.is_part, wall.is_inside, wall.section, wall.box);
}
template <typename Archive>
void pack(Archive& archive, BuildingOpening& opening) {
    archive(opening.kind, opening.pane, opening.has_hole, opening.storey, opening.name,
            opening.box);
}
template <typename Archive>
void pack(Archive& archive, BuildingThing& thing) {
    archive(thing.type, thing.name, thing.is_low_wall, thing.is_bent, thing.boxes);
}
template <typename Archive>
void pack(Archive& archive, BuildingUnread& part) {
    archive(part.kind, part.owner, part.storey, part.has_place, part.at);
}
template <typename Archive>
void pack(Archive& archive, Building& building) {
    archive(building.storeys, building.spaces, building.walls, building.openings, building.things,
            building.unread);
}

}  // namespace

std::string packedBuilding(const Building& building) {
    Packer packer;
    packer(building);
    return packer.take();
}

Building unpackedBuilding(std::string_view bytes) {
    Unpacker in(bytes);
    Building building;
    in(building);
    Unpacker::check(in.isAtEnd() && !building.storeys.empty());
    for (const BuildingSpace& space : building.spaces)
        Unpacker::check(space.storey < building.storeys.size());
    for (const BuildingWall& wall : building.walls)
        Unpacker::check(wall.storey < building.storeys.size());
    for (const BuildingOpening& opening : building.openings)
        Unpacker::check(opening.kind <= BuildingOpening::Kind::Hole &&
                        opening.pane <= BuildingOpening::Pane::Open &&
                        opening.storey < building.storeys.size());
    for (const BuildingUnread& part : building.unread)
        Unpacker::check(part.storey < building.storeys.size() ||
                        part.storey == BuildingUnread::kNoStorey);
    return building;
}

std::map<std::string, std::size_t> unreadKinds(const Building& building) {
    std::map<std::string, std::size_t> kinds;
    for (const BuildingUnread& part : building.unread) ++kinds[part.kind];
    return kinds;
}

}  // namespace ispace::ifc
