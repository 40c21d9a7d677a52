// SPDX-License-Identifier: GPL-3.0-or-later
// tests/bench: programs of Google Benchmark that `make bench` runs. Every result is verified
// before its time is taken.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "env/environment.h"
#include "env/slice.h"
#include "scene/sensor/laser.h"
#include "scene/sensor/sensor.h"
#include "trace/rays.h"

namespace ispace::bench {

/// Embree alone on the surfaces of a RayWorld: the same ROBUST scene, rays in 16-wide coherent
/// packets with prepared directions, no contact rule, no exact distance.
class RawEmbree {
  public:
    /// \param height of the rays
    static RawEmbree ofSlice(const Slice& slice, double height);
    static RawEmbree ofEnvironment(const Environment& environment);
    RawEmbree(RawEmbree&&) noexcept;
    ~RawEmbree();

    /// Packs every beam of these sensors, in separate packets for each sensor.
    void prepare(std::span<const Sensor> sensors);
    /// Packs pictures of one size in tiles of 4 x 4; a picture counts as a sensor.
    /// \pre columns and rows are multiples of 4
    void prepare(std::span<const Point3> origins, std::span<const RayGrid> grids, double most);
    /// The tight loop: fills in and traces packets first .. last-1 of all.
    void trace(std::size_t first, std::size_t last);
    [[nodiscard]] std::size_t packets() const;
    /// Packets of one sensor. \pre prepare() was called
    [[nodiscard]] std::size_t packetsPerSensor() const;
    /// Ranges of the last trace, sensor after sensor, a picture row by row; +infinity for no
    /// return.
    [[nodiscard]] std::vector<float> ranges() const;

  private:
    struct Data;
    void reserve(std::size_t sensors, std::size_t beams);
    explicit RawEmbree(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

/// The triangles of a RayWorld, ready to be built into a scene as that has it.
class RawTriangles {
  public:
    explicit RawTriangles(const Slice& slice);
    explicit RawTriangles(const Environment& environment);
    /// Makes the scene and lets it go.
    void build() const;
    [[nodiscard]] std::size_t size() const { return triangles_.size(); }

  private:
    std::vector<std::array<float, 3>> vertices_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
};

}  // namespace ispace::bench
