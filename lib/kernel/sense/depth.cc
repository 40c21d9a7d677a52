// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/depth.h"

#include <cmath>

#include "base/simd.h"
#include "sense/noise.h"
#include "sense/selection.h"
#include "trace/rays.h"

namespace ispace {

namespace {

/// Exceeds the size of any scene, metres.
constexpr double kEverything = 1e7;

RayGrid gridOf(const Ranger& ranger, const Frame3& axes) {
    const Vec3 corner = ranger.ray(0, 0);
    return {.corner = axes * corner,
            .right = axes * Vec3{0, -1 / ranger.fx(), 0},
            .down = axes * Vec3{0, 0, -1 / ranger.fy()},
            .columns = ranger.columns,
            .rows = ranger.rows};
}

/// Computes rays of a spherical ranger from the cosines of its columns and rows.
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

/// Rays of any ranger with a bearing error each, as unit vectors, and their forward components.
struct StrayRays {
    Directions directions;
    std::vector<float> forward;

    StrayRays(const Ranger& ranger, const Frame3& axes, std::span<const float> errors)
        : forward(ranger.pixels()) {
        directions.resize(ranger.pixels());
        std::size_t pixel = 0;
        for (int j = 0; j < ranger.rows; ++j)
            for (int i = 0; i < ranger.columns; ++i, ++pixel) {
                const Vec3 ray = ranger.ray(i, j);
                const CosSin turn = cosSin(Angle::radians(static_cast<double>(errors[pixel])));
                const Vec3 stray =
                    (1 / length(ray)) * Vec3{ray.x * turn.cos - ray.y * turn.sin,
                                             ray.x * turn.sin + ray.y * turn.cos, ray.z};
                directions.set(pixel, axes * stray);
                forward[pixel] = static_cast<float>(stray.x);
            }
    }
};

/// Computes the lengths of a pinhole's rays, pixel by pixel.
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

/// Ambiguity of a phase: the true distance that a phase stands for, and the reported interval.
struct Phase {
    double ambiguity;
    float least, greatest;  ///< ends of the reported interval

    [[nodiscard]] float wrapped(float distance) const {
        const double full = distance;
        const auto told = static_cast<float>(full - ambiguity * std::floor(full / ambiguity));
        return told >= static_cast<float>(ambiguity) ? 0 : told;
    }
    [[nodiscard]] bool isTold(float wrapped) const {
        return wrapped >= least && wrapped <= greatest;
    }
    /// Clamps a value that noise moved out of range to the nearer limit round the phase.
    [[nodiscard]] float kept(float wrapped) const {
        if (isTold(wrapped)) return wrapped;
        const auto turn = static_cast<float>(ambiguity);
        const float below = wrapped < least ? least - wrapped : least + turn - wrapped;
        const float above = wrapped > greatest ? wrapped - greatest : wrapped + turn - greatest;
        return below <= above ? least : greatest;
    }
};

/// Computes one picture.
class Exposure {
  public:
    Exposure(const RayWorld& environment, const MovingBodies& bodies, const Sensor& sensor,
             const ReadingOptions& options, DepthFrame& frame)
        : environment_(environment),
          bodies_(bodies),
          sensor_(sensor),
          ranger_(sensor.as<Ranger>()),
          noisy_(options.noise_seed.has_value()),
          key_{.seed = options.noise_seed.value_or(0),
               .sensor = hashOf(sensor.id),
               .frame = static_cast<std::uint64_t>(frame.frame)},
          frame_(frame) {}

    void take() {
        frame_.depths.resize(ranger_.pixels());
        if (noisy_ && ranger_.noise.dropsByIncidence()) cosines_.resize(ranger_.pixels());
        const bool by_distance =
            ranger_.projection == Projection::Pinhole && !ranger_.measures_depth;
        if (by_distance) {
            lengths_.resize(ranger_.pixels());
            rayLengths(ranger_.cx(), ranger_.cy(), ranger_.fx(), ranger_.fy(), ranger_.columns,
                       ranger_.rows, lengths_.data());
        }
        if (noisy_ && ranger_.noise.angle_sigma > Angle())
            castStray();
        else
            cast();
        measure();
        if (by_distance) divide(frame_.depths.data(), lengths_.data(), lengths_.size());
    }

  private:
    /// Computes depths, or distances, along the pixels' rays.
    void cast() {
        const double most = reach();
        const Point3 origin = frame_.pose.position;
        const Frame3 axes(frame_.pose);
        if (ranger_.projection == Projection::Pinhole) {
            const RayGrid grid = gridOf(ranger_, axes);
            environment_.cast(origin, grid, most, frame_.depths, cosines_);
            bodies_.shorten(origin, grid, most, own(), frame_.depths, cosines_);
            if (!lengths_.empty()) multiply(frame_.depths.data(), lengths_.data(), lengths_.size());
        } else {
            const Directions rays = sphereOf(ranger_, axes);
            environment_.cast(origin, rays, most, frame_.depths, cosines_);
            bodies_.shorten(origin, rays, most, own(), frame_.depths, cosines_);
        }
    }

    /// Likewise along rays with bearing errors.
    void castStray() {
        std::vector<float> errors(ranger_.pixels());
        bearingErrors(ranger_.noise, key_, errors);
        const StrayRays rays(ranger_, Frame3(frame_.pose), errors);
        // No ray of a pinhole is longer than that of a corner.
        const double most = reach() * length(ranger_.ray(0, 0));
        environment_.cast(frame_.pose.position, rays.directions, most, frame_.depths, cosines_);
        bodies_.shorten(frame_.pose.position, rays.directions, most, own(), frame_.depths,
                        cosines_);
        if (ranger_.measures_depth)
            multiply(frame_.depths.data(), rays.forward.data(), rays.forward.size());
    }

    /// Converts true values to measured ones.
    void measure() {
        const double least = ranger_.min_range, greatest = ranger_.max_range;
        const std::span<float> values = frame_.depths;
        RangeNoise noise = noisy_ ? ranger_.noise : RangeNoise();
        if (ranger_.ambiguity > 0) {
            const Phase phase{ranger_.ambiguity, static_cast<float>(least),
                              static_cast<float>(greatest)};
            for (float& value : values)
                if (!(value < kNoReturn) || !phase.isTold(phase.wrapped(value))) value = kNoReturn;
            // Spread is added before the phase wraps, resolution after it.
            noise.resolution = 0;
            addNoise(noise, -kEverything, kEverything, key_, cosines_, values);
            for (float& value : values)
                if (value < kNoReturn) value = phase.kept(phase.wrapped(value));
            noise = RangeNoise();
            if (noisy_) noise.resolution = ranger_.noise.resolution;
            addNoise(noise, least, greatest, key_, {}, values);
        } else {
            addNoise(noise, least, greatest, key_, cosines_, values);
        }
    }

    [[nodiscard]] double reach() const {
        return ranger_.ambiguity > 0 ? kEverything : ranger_.max_range;
    }
    [[nodiscard]] std::uint32_t own() const { return carrierOf(sensor_); }

    const RayWorld& environment_;
    const MovingBodies& bodies_;
    const Sensor& sensor_;
    const Ranger& ranger_;
    bool noisy_;
    NoiseKey key_;
    DepthFrame& frame_;
    std::vector<float> cosines_, lengths_;
};

}  // namespace

DepthFrame castDepth(const RayWorld& environment, const MovingBodies& bodies, const Sensor& sensor,
                     const Pose3& pose, int frame, const ReadingOptions& options) {
    DepthFrame picture;
    picture.frame = frame;
    picture.pose = pose;
    Exposure(environment, bodies, sensor, options, picture).take();
    return picture;
}

}  // namespace ispace
