// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures are captured on request alone, and encoded in the background. Half of the time at most
// goes to streams: after one that took d, the next begins d later. Those wanted at once are made.
#include "extensions/wire/picture_files.h"

#include <utility>

#include "raster/codec.h"
#include "sense/formats/camera_info.h"

namespace ispace::wire {

namespace {

constexpr std::chrono::milliseconds kMinGap{10};
constexpr double kPerMetre = 1000;

std::shared_ptr<const PictureFile> fileOf(const Sensor& sensor, const SensorReading& reading) {
    auto file = std::make_shared<PictureFile>();
    file->seq = reading.seq;
    file->time = reading.time;
    if (const auto* const camera = sensor.tryAs<Camera>()) {
        file->type = "image/jpeg";
        file->bytes = jpegOfRgb(camera->columns, camera->rows, std::get<Photo>(reading.value).rgb);
    } else {
        const auto& ranger = *sensor.tryAs<Ranger>();
        file->type = "image/png";
        file->bytes = depthPng(ranger.columns, ranger.rows,
                               std::get<DepthFrame>(reading.value).depths, kPerMetre);
    }
    return file;
}

}  // namespace

std::shared_ptr<const PictureFiles::PendingPicture> PictureFiles::newest(World& world,
                                                                         std::size_t sensor,
                                                                         WallTime now, bool at_once,
                                                                         const Doer& does) {
    Entry& entry = entries_[{&world, world.sensors()[sensor].id}];
    const std::int64_t seq = world.period(sensor), changes = world.changes();
    const bool is_made = entry.asked && (entry.asked->file || entry.asked->failure);
    const bool is_newest = entry.asked && entry.changes == changes && entry.seq == seq;
    if (is_newest || (entry.asked && !is_made && entry.changes == changes)) return entry.asked;
    if (!at_once && (now < next_ || now < entry.next)) return nullptr;
    entry = {std::make_shared<PendingPicture>(), seq, changes, now + kMinGap};
    // Do not use `entry` below: the other thread may finish first.
    const auto asked = entry.asked;
    make(world, sensor, entry, does);
    return asked;
}

void PictureFiles::make(World& world, std::size_t sensor, const Entry& entry, const Doer& does) {
    struct Making {
        Sensor sensor;
        SensorReading reading;
        std::function<SensorReading()> take;
        std::shared_ptr<const PictureFile> file;
        std::chrono::steady_clock::duration time{};
    };
    const auto making = std::make_shared<Making>(Making{world.sensors()[sensor], {}, {}, {}});
    const bool takes = !world.isCaptured(sensor);
    if (takes)
        making->take = world.captureLater(sensor);
    else
        making->reading = world.reading(sensor);
    does(
        [making] {
            const WallTime began = std::chrono::steady_clock::now();
            if (making->take) making->reading = std::exchange(making->take, nullptr)();
            making->file = fileOf(making->sensor, making->reading);
            making->time = std::chrono::steady_clock::now() - began;
        },
        [this, &world, sensor, takes, making, asked = entry.asked,
         changes = entry.changes](const std::exception_ptr& failure) {
            next_ = std::chrono::steady_clock::now() + making->time;
            asked->failure = failure;
            asked->file = making->file;
            if (takes && !failure && world.changes() == changes)
                world.storeCapture(sensor, std::move(making->reading));
        });
}

}  // namespace ispace::wire
