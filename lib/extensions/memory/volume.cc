// SPDX-License-Identifier: GPL-3.0-or-later
// Balls and boxes; the boundary is inside. A box turns about the vertical only.
#include "extensions/memory/volume.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace::memory {

bool Volume::contains(Point3 point) const {
    const Vec3 way = point - at;
    if (!size) return length(way) <= radius;
    const double turn = heading * std::numbers::pi / 180, c = std::cos(turn), s = std::sin(turn);
    return std::abs(c * way.x + s * way.y) <= size->x / 2 &&
           std::abs(c * way.y - s * way.x) <= size->y / 2 && std::abs(way.z) <= size->z / 2;
}

double Volume::reach() const { return size ? std::hypot(size->x, size->y) / 2 : radius; }

std::vector<Schema> volumeSchemas() {
    constexpr double kFarthest = 1e6, kLongest = 3600;
    return {
        {.keyword = "volume",
         .type = RecordType::Placement,
         .help = "a part of the room that holds a content, which tags touch, for simrun",
         .keys = {
             {.name = "id", .type = KeyType::Word, .help = "its name"},
             {.name = "at",
              .type = KeyType::Tuple,
              .unit = Unit::Length,
              .help = "centre x,y[,z]",
              .min_count = 2,
              .max_count = 3,
              .lower = -kFarthest,
              .upper = kFarthest,
              .required = true,
              .role = Role::Place,
              .standard_z = kVolumeHeight},
             {.name = "radius",
              .type = KeyType::Number,
              .unit = Unit::Length,
              .help = "of a ball",
              .lower = kLeastVolume,
              .upper = kMostVolume},
             {.name = "size",
              .type = KeyType::Tuple,
              .unit = Unit::Length,
              .help = "of a box along x, y and z, instead of a radius",
              .min_count = 3,
              .max_count = 3,
              .lower = kLeastVolume,
              .upper = kMostVolume},
             headingKey("turns the box about the vertical"),
             {.name = "content", .type = KeyType::Text, .help = "what it holds, a line of text"},
             {.name = "dwell",
              .type = KeyType::Number,
              .unit = Unit::Time,
              .help = "time after which a touch is a stay",
              .lower = 0,
              .upper = kLongest}}}};
}

std::vector<Volume> volumesOf(const Scene& scene, const std::string& prefix, std::size_t room) {
    std::vector<Volume> volumes;
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        const Record& record = scene.records[i];
        if (record.keyword() != "volume") continue;
        Volume volume{.id = prefix + scene.ids[i], .room = room};
        const Tuple& at = record.tuple("at");
        volume.at = {at[0], at[1], at.size() > 2 ? at[2] : kVolumeHeight};
        if (record.has("radius") && record.has("size"))
            throw FormatError(
                record.finding("size", "`size`: a box has no `radius`, a ball no size"));
        if (record.has("radius")) volume.radius = record.number("radius");
        if (record.has("size")) {
            const Tuple& size = record.tuple("size");
            volume.size = Vec3{size[0], size[1], size[2]};
        }
        if (record.has("heading")) volume.heading = record.number("heading");
        if (record.has("dwell")) volume.dwell = record.number("dwell");
        if (record.has("content")) volume.content = record.text("content");
        volumes.push_back(std::move(volume));
    }
    return volumes;
}

}  // namespace ispace::memory
