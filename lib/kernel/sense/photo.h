// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of a scene's cameras, with labels and depths by pixel, and their files: PNG, CSV, rgb24
// and YUV4MPEG2.
//
//     const Photographer photographer(scene, {.samples = 16, .labels = true});
//     const Photo photo = photographer.take(scene.sensors[0], scene.sensors[0].pose, 0);
//     writeAll("view.labels.png", labelPng(scene.sensors[0].as<Camera>(), photo));
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

struct ReadingKind;

/// One picture of a camera, row by row from the top.
struct Photo {
    double time = 0;
    int frame = 0;
    Pose3 pose;
    std::vector<std::uint8_t> rgb;  ///< sRGB: red, green, blue of each pixel
    /// As in Rendering; empty if not requested. Depths outside the camera's range are +infinity.
    std::vector<std::uint16_t> labels;
    std::vector<float> depths;
    static const ReadingKind kKind;
};

struct PhotoOptions {
    int samples = 4;  ///< per pixel
    Illumination light = Illumination::Auto;
    double exposure = 1;         ///< factor; at 1, white in a fully lit room is white
    std::uint64_t seed = 1;      ///< of light sampling
    bool with_noise = false;     ///< shot and read noise, from the seed
    bool sensor_bodies = false;  ///< renders bodies of sensors, tags, mats and gates
    bool labels = false, depths = false;
};

/// Takes the pictures of a scene's cameras. Thread-safe; a picture depends neither on the number of
/// threads nor on earlier pictures.
class Photographer {
  public:
    /// Builds the rendered scene. \pre the scene outlives it \throws FormatError for a texture that
    /// cannot be read
    Photographer(const Scene& scene, const PhotoOptions& options);
    ~Photographer();
    Photographer(const Photographer&) = delete;
    Photographer& operator=(const Photographer&) = delete;

    /// Moves placed records to these poses, one for each of Scene::placed, and swings the limbs of
    /// people, as RenderScene::at does; the room stays. \pre no picture is being taken
    void moveTo(std::span<const Pose3> poses, std::span<const Angle> swings = {});
    /// Takes a picture of a camera at a pose. Skips the body of the camera and of the mover that
    /// carries it.
    [[nodiscard]] Photo take(const Sensor& sensor, const Pose3& pose, int frame) const;

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// Adds the noise of an exposure: each channel of a pixel holds radiance * exposure * full_well
/// electrons; their number spreads by its square root, and reading it out adds read_noise.
void addExposureNoise(const Camera& camera, double exposure, std::uint64_t seed,
                      const std::string& id, int frame, std::vector<Rgb>& radiance);

// Files of a picture.

/// Encodes the labels as 16-bit grey; see labelTable().
std::string labelPng(const Camera& camera, const Photo& photo);
/// Writes the labels in the picture as CSV: label, id, keyword, pixels. Label 0 is the background,
/// which has no id.
std::string labelTable(const Scene& scene, const Photo& photo);
/// Appends the unchanged bytes of red, green and blue.
void appendRgb24(std::string& out, const Photo& photo);
/// Writes the header of YUV4MPEG2: 4:4:4, BT.601, limited range.
std::string y4mHeader(const Camera& camera);
void appendY4mFrame(std::string& out, const Photo& photo);
}  // namespace ispace
