// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/depth.h"

#include <cmath>
#include <limits>

#include "base/simd.h"
#include "sense/noise.h"

namespace ispace {

namespace {

constexpr float kNoReturn = std::numeric_limits<float>::infinity();

/// Beyond everything there is, in metres.
constexpr double kEverything = 1e7;

RayGrid gridOf(const Ranger& ranger, const Frame3& axes) {
    const Vec3 corner = ranger.ray(0, 0);
    return {.corner = axes * corner,
            .right = axes * Vec3{0, -1 / ranger.fx(), 0},
            .down = axes * Vec3{0, 0, -1 / ranger.fy()},
            .columns = ranger.columns,
            .rows = ranger.rows};
}

/// Rays of a spherical ranger: cosines are those of its columns and of its rows.
Directions sphereOf(const Ranger& ranger, const Frame3& axes) {
    std::vector<CosSin> bearings, elevations;
    bearings.reserve(static_cast<std::size_t>(ranger.columns));
    elevations.reserve(static_cast<std::size_t>(ranger.rows));
    for (int i = 0; i < ranger.columns; ++i) bearings.push_back(cosSin(ranger.bearing(i)));
    for (int j = 0; j < ranger.rows; ++j) elevations.push_back(cosSin(ranger.elevation(j)));
    Directions directions;
    directions.resize(ranger.pixels());
    std::size_t pixel = 0;
    for (const CosSin& e : elevations)
        for (const CosSin& b : bearings)
            directions.set(pixel++, axes * Vec3{b.cos * e.cos, b.sin * e.cos, e.sin});
    return directions;
}

/// Rays of any ranger with an error of bearing each, of unit length.
Directions strayRays(const Ranger& ranger, const Frame3& axes, std::span<const float> errors) {
    Directions directions;
    directions.resize(ranger.pixels());
    std::size_t pixel = 0;
    for (int j = 0; j < ranger.rows; ++j)
        for (int i = 0; i < ranger.columns; ++i) {
            const Vec3 ray = ranger.ray(i, j);
            const CosSin turn = cosSin(Angle::radians(static_cast<double>(errors[pixel])));
            const Vec3 stray{ray.x * turn.cos - ray.y * turn.sin,
                             ray.x * turn.sin + ray.y * turn.cos, ray.z};
            directions.set(pixel++, axes * ((1 / length(ray)) * stray));
        }
    return directions;
}

/// Lengths of the rays of a pinhole, pixel by pixel.
ISPACE_SIMD_CLONES void rayLengths(double cx, double cy, double fx, double fy, int columns,
                                   int rows, float* lengths) {
    for (int j = 0; j < rows; ++j) {
        const double z = (cy - j) / fy;
        float* const row = lengths + static_cast<std::ptrdiff_t>(j) * columns;
        for (int i = 0; i < columns; ++i) {
            const double y = (cx - i) / fx;
            row[i] = static_cast<float>(std::sqrt(1 + y * y + z * z));
        }
    }
}

ISPACE_SIMD_CLONES void multiply(float* values, const float* by, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) values[i] *= by[i];
}

ISPACE_SIMD_CLONES void divide(float* values, const float* by, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) values[i] /= by[i];
}

/// What is outside the limits is no return; ends included, as float32.
ISPACE_SIMD_CLONES void limit(float* values, std::size_t count, float least, float greatest) {
    for (std::size_t i = 0; i < count; ++i) {
        const bool within = values[i] >= least && values[i] <= greatest;
        if (!within) values[i] = kNoReturn;
    }
}

/// Distances modulo the ambiguity.
void wrap(std::span<float> distances, double ambiguity) {
    for (float& distance : distances) {
        if (distance == kNoReturn) continue;
        const double full = distance;
        distance = static_cast<float>(full - ambiguity * std::floor(full / ambiguity));
    }
}

/// One picture in the making.
class Exposure {
  public:
    Exposure(const RayWorld& environment, const MovingBodies& bodies, const PlacedRanger& sensor,
             const ReadingOptions& options, DepthFrame& frame)
        : environment_(environment),
          bodies_(bodies),
          sensor_(sensor),
          ranger_(sensor.ranger),
          noisy_(options.noise_seed.has_value()),
          key_{.seed = options.noise_seed.value_or(0),
               .sensor = hashOf(sensor.id),
               .frame = static_cast<std::uint64_t>(frame.frame)},
          frame_(frame) {}

    void take() {
        frame_.depths.resize(ranger_.pixels());
        if (noisy_ && ranger_.noise.dropsByIncidence()) cosines_.resize(ranger_.pixels());
        cast();
        const bool by_distance =
            ranger_.projection == Projection::Pinhole && !ranger_.measures_depth;
        std::vector<float> lengths;
        if (by_distance) {
            lengths.resize(ranger_.pixels());
            rayLengths(ranger_.cx(), ranger_.cy(), ranger_.fx(), ranger_.fy(), ranger_.columns,
                       ranger_.rows, lengths.data());
            multiply(frame_.depths.data(), lengths.data(), lengths.size());
        }
        measure();
        if (by_distance) divide(frame_.depths.data(), lengths.data(), lengths.size());
    }

  private:
    /// Multiples of the pixels' rays.
    void cast() {
        const double most = ranger_.ambiguity > 0 ? kEverything : ranger_.max_range;
        const Point3 origin = frame_.pose.position;
        const Frame3 axes(frame_.pose);
        const std::uint32_t own = sensor_.mount ? static_cast<std::uint32_t>(sensor_.mount->robot)
                                                : MovingBodies::kNobody;
        const bool pinhole = ranger_.projection == Projection::Pinhole;
        const bool stray = noisy_ && ranger_.noise.angle_sigma > Angle();
        if (pinhole && !stray) {
            const RayGrid grid = gridOf(ranger_, axes);
            environment_.cast(origin, grid, most, frame_.depths, cosines_);
            bodies_.shorten(origin, grid, most, own, frame_.depths, cosines_);
            return;
        }
        std::vector<float> errors(stray ? ranger_.pixels() : 0);
        if (stray) bearingErrors(ranger_.noise, key_, errors);
        const Directions rays = stray ? strayRays(ranger_, axes, errors) : sphereOf(ranger_, axes);
        // The rays of a pinhole are at most as long as that of a corner.
        const double reach = pinhole ? most * length(ranger_.ray(0, 0)) : most;
        environment_.cast(origin, rays, reach, frame_.depths, cosines_);
        bodies_.shorten(origin, rays, reach, own, frame_.depths, cosines_);
        if (!pinhole) return;
        std::vector<float> lengths(ranger_.pixels());
        rayLengths(ranger_.cx(), ranger_.cy(), ranger_.fx(), ranger_.fy(), ranger_.columns,
                   ranger_.rows, lengths.data());
        divide(frame_.depths.data(), lengths.data(), lengths.size());
    }

    /// From what is to what the device says of it.
    void measure() {
        const double least = ranger_.min_range;
        const bool wraps = ranger_.ambiguity > 0;
        const double greatest = wraps ? kEverything : ranger_.max_range;
        const std::span<float> values = frame_.depths;
        if (noisy_)
            addNoise(ranger_.noise, wraps ? -kEverything : least, greatest, key_, cosines_, values);
        if (wraps) wrap(values, ranger_.ambiguity);
        limit(values.data(), values.size(), static_cast<float>(least),
              static_cast<float>(greatest));
    }

    const RayWorld& environment_;
    const MovingBodies& bodies_;
    const PlacedRanger& sensor_;
    const Ranger& ranger_;
    bool noisy_;
    NoiseKey key_;
    DepthFrame& frame_;
    std::vector<float> cosines_;
};

}  // namespace

DepthFrame castDepth(const RayWorld& environment, const MovingBodies& bodies,
                     const PlacedRanger& sensor, const Pose3& pose, int frame,
                     const ReadingOptions& options) {
    DepthFrame picture;
    picture.frame = frame;
    picture.pose = pose;
    Exposure(environment, bodies, sensor, options, picture).take();
    return picture;
}

}  // namespace ispace
