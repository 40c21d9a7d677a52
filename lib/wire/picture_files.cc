// SPDX-License-Identifier: GPL-3.0-or-later
#include "wire/picture_files.h"

#include "raster/encode.h"
#include "sense/reading_picture.h"

namespace ispace {

namespace {

constexpr std::chrono::milliseconds kLeastGap{10};
constexpr double kPerMetre = 1000;

std::shared_ptr<const PictureFile> fileOf(const RunSensor& sensor, const SensorReading& reading) {
    auto file = std::make_shared<PictureFile>();
    file->seq = reading.seq;
    file->time = reading.time;
    if (const auto* const camera = sensor.model<Camera>()) {
        file->type = "image/jpeg";
        file->bytes = jpegOfRgb(camera->columns, camera->rows, std::get<Photo>(reading.value).rgb);
    } else {
        const auto& ranger = *sensor.model<Ranger>();
        file->type = "image/png";
        file->bytes = depthPng(ranger.columns, ranger.rows,
                               std::get<DepthFrame>(reading.value).depths, kPerMetre);
    }
    return file;
}

}  // namespace

std::shared_ptr<const PictureFile> PictureFiles::newest(World& world, std::size_t sensor,
                                                        WallTime now, bool at_once) {
    const RunSensor& placed = world.sensors()[sensor];
    Entry& entry = entries_[placed.id];
    const bool is_new =
        !entry.file || entry.changes != world.changes() || entry.file->seq != world.period(sensor);
    if (!is_new) return entry.file;
    if (!at_once && (now < next_ || now < entry.next)) return nullptr;
    const WallTime began = std::chrono::steady_clock::now();
    entry.file = fileOf(placed, world.take(sensor));
    entry.changes = world.changes();
    entry.next = now + kLeastGap;
    next_ = now + 2 * (std::chrono::steady_clock::now() - began);
    return entry.file;
}

}  // namespace ispace
