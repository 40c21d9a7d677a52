// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/photo.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <span>

#include "base/random.h"
#include "trace/render/render.h"

namespace ispace {

struct Photographer::Data {
    const Scene& scene;
    PhotoOptions options;
    RenderScene surfaces;
    /// Of lenses with distortion: computed once for each sensor.
    mutable std::mutex mutex;
    mutable std::map<std::string, CameraView> bent;

    CameraView view(const Sensor& sensor, const Pose3& pose) const {
        const Camera& camera = sensor.as<Camera>();
        if (camera.isStraight()) return {camera, pose};
        const std::lock_guard lock(mutex);
        return bent.try_emplace(sensor.id, camera, pose).first->second.at(pose);
    }
};

Photographer::Photographer(const Scene& scene, const PhotoOptions& options)
    : data_(new Data{
          scene, options, RenderScene(scene, {.devices = options.sensor_bodies}), {}, {}}) {}

Photographer::~Photographer() = default;

void Photographer::moveTo(std::span<const Pose3> poses, std::span<const Angle> swings) {
    data_->surfaces = data_->surfaces.at(poses, swings);
}

Photo Photographer::take(const Sensor& sensor, const Pose3& pose, int frame) const {
    const PhotoOptions& options = data_->options;
    RenderOptions how;
    how.samples = options.samples;
    how.seed = options.seed;
    how.light = options.light;
    how.labels = options.labels;
    how.depths = options.depths;
    how.hidden = ownRecords(data_->scene, sensor);
    constexpr int kBandPixels = 4'000'000;
    Rendering picture = renderInBands(data_->surfaces, data_->view(sensor, pose), how, kBandPixels);
    if (options.with_noise)
        addExposureNoise(sensor.as<Camera>(), options.exposure, options.seed, sensor.id, frame,
                         picture.radiance);
    Photo photo;
    photo.frame = frame;
    photo.pose = pose;
    photo.rgb = toSrgb8(picture, options.exposure);
    photo.labels = std::move(picture.labels);
    photo.depths = std::move(picture.depths);
    // As in coverage: in multiples of the lines of sight, both are depths or both distances.
    const auto& camera = sensor.as<Camera>();
    for (float& depth : photo.depths)
        if (!(depth >= camera.min_range && depth <= camera.max_range))
            depth = std::numeric_limits<float>::infinity();
    return photo;
}

void addExposureNoise(const Camera& camera, double exposure, std::uint64_t seed,
                      const std::string& id, int frame, std::vector<Rgb>& radiance) {
    const RandomKey key{seed, Purpose::Picture, hashOf(id), static_cast<std::uint64_t>(frame)};
    const auto white = static_cast<float>(exposure * camera.full_well);
    const auto read_noise = static_cast<float>(camera.read_noise);
    // A multiple of the block size of random numbers.
    constexpr std::size_t kBlock = 512;
    const std::size_t samples = 3 * radiance.size();
    tbb::parallel_for(std::size_t{0}, (samples + kBlock - 1) / kBlock, [&](std::size_t block) {
        const std::size_t first = block * kBlock, count = std::min(kBlock, samples - first);
        alignas(64) std::array<float, kBlock> shot, read;  // NOLINT: drawn below
        draw(key, static_cast<std::uint32_t>(first),
             {.normal = std::span(shot).first(count), .other = std::span(read).first(count)});
        for (std::size_t k = 0; k < count; ++k) {
            float& value = radiance[(first + k) / 3][(first + k) % 3];
            const float electrons = std::max(0.0F, value * white);
            const float counted = electrons + std::sqrt(electrons) * shot[k] + read_noise * read[k];
            value = std::max(0.0F, counted) / white;
        }
    });
}

}  // namespace ispace
