// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sense/selection.h"
#include "trace/render/render.h"

namespace ispace {

/// One picture of a camera, row by row from the top.
struct Photo {
    double time = 0;
    int frame = 0;
    Pose3 pose;
    std::vector<std::uint8_t> rgb;  ///< sRGB: red, green, blue of each pixel
    /// As in Rendering; empty if not asked for. Depths out of the camera's range are +infinity.
    std::vector<std::uint16_t> labels;
    std::vector<float> depths;
};

struct PhotoOptions {
    int samples = 4;  ///< lines of sight for each pixel
    Illumination light = Illumination::Auto;
    double exposure = 1;         ///< 1: white in the light of the whole room is white
    std::uint64_t seed = 1;      ///< of the light's samples
    bool with_noise = false;     ///< shot and read noise, from the seed
    bool sensor_bodies = false;  ///< bodies of sensors, tags, mats and gates are seen
    bool labels = false, depths = false;
};

/// Takes the pictures of a scene's cameras. Thread-safe; a picture is the same for any number of
/// threads, and does not depend on those before it.
class Photographer {
  public:
    /// \pre the scene outlives it \throws FormatError for a texture that cannot be read
    Photographer(const Scene& scene, const PhotoOptions& options);
    ~Photographer();
    Photographer(const Photographer&) = delete;
    Photographer& operator=(const Photographer&) = delete;

    /// Puts what is placed at these poses, one for each of Scene::placed, with people's limbs as
    /// they swing, as RenderScene::at does; the room stays as it is. \pre no picture is being taken
    void moveTo(std::span<const Pose3> poses, std::span<const Angle> swings = {});
    /// What the sensor, a camera, sees at a pose. Neither its own body nor that of the robot or
    /// person that carries it is in the picture.
    [[nodiscard]] Photo take(const Sensor& sensor, const Pose3& pose, int frame) const;

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// Adds the noise of an exposure: each channel of a pixel holds radiance * exposure * full_well
/// electrons; their number spreads by its square root, and reading it out by read_noise.
void addExposureNoise(const Camera& camera, double exposure, std::uint64_t seed,
                      const std::string& id, int frame, std::vector<Rgb>& radiance);

// Files of a picture.

/// 16-bit grey; see labelTable().
std::string labelPng(const Camera& camera, const Photo& photo);
/// CSV of the labels that the picture has: label, id, keyword, pixels. Label 0 is what no record
/// is; it has no id.
std::string labelTable(const Scene& scene, const Photo& photo);
/// Appends the bytes of red, green and blue as they are.
void appendRgb24(std::string& out, const Photo& photo);
/// YUV4MPEG2: 4:4:4, BT.601, limited range.
std::string y4mHeader(const Camera& camera);
void appendY4mFrame(std::string& out, const Photo& photo);
}  // namespace ispace
