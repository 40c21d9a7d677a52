// SPDX-License-Identifier: GPL-3.0-or-later
// lib/kernel/trace/render: renders lit pictures of a scene. Uses trace and below; Embree inside.
//
// Labels and depths are measurements: the first surface at each pixel's centre, exact as rays are
// (embree_scene.h). Colours are for eyes: light of lamps or sun with soft shadows, one bounce
// estimated from nearby surfaces, samples smoothed but never across edges. Bytes are the same for
// any number of threads and for bands; random numbers are keyed by pixel and seed.
//
//     const RenderScene room(scene);
//     const Rendering picture = render(room, CameraView(camera, pose), {.samples = 9});
//     const std::vector<std::uint8_t> bytes = toSrgb8(picture);
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "env/mesh.h"
#include "scene/scene.h"
#include "trace/render/viewpoint.h"

namespace ispace {

/// Red, green and blue, linear, with the primaries of sRGB; not limited to 1.
using Rgb = std::array<float, 3>;

/// A surface for pictures only, in world coordinates: visible from both sides, without shadow,
/// label and depth.
struct PaintedMesh {
    Mesh mesh;
    Rgb color{};
    float opacity = 1;
    bool is_lit = true;  ///< false: keeps its colour in light and shade, as signs do
};

/// Contents of a scene to render, besides its environment.
struct RenderSceneOptions {
    /// Level plates of Material::Ceiling; without them a room can be seen from above.
    bool ceilings = true;
    /// Bodies of sensors, tags, mats and gates.
    bool devices = true;
    /// Records (indices in Scene::records) of sensors with visible fields of view, see viewOf().
    std::vector<std::size_t> views = {};
    /// Records drawn in this colour.
    struct Tint {
        std::size_t record = 0;
        Rgb color{};
    };
    std::vector<Tint> tints = {};
    std::vector<PaintedMesh> paint = {};
    /// Selects parts of elements to omit, by their footprint (two points: of a sheet), e.g. walls
    /// between an outside viewer and the room.
    std::function<bool(const Element&, std::span<const Point2> footprint)> leaves_out = {};
};

/// Light source of a scene.
enum class Illumination {
    Auto,   ///< lamps if the scene has a ceiling or lamp records, else sun and sky
    Lamps,  ///< square panels under the ceiling, or at the height of the walls
    Sky,    ///< the sun, half-way up in the south-west, and a clear sky
};

/// Quality and products of one picture. The defaults suit screens.
struct RenderOptions {
    /// Lines of sight per pixel: smooth edges. Light follows: more samples, less noise.
    int samples = 4;
    std::uint64_t seed = 1;
    Illumination light = Illumination::Auto;
    bool labels = false, depths = false;
    bool colors = true;  ///< false: labels and depths only, far faster
    /// Records with bodies invisible to the viewpoint that cast shadows: the camera and the
    /// body that carries it, see ownRecords().
    std::vector<std::size_t> hidden = {};
    /// Background colour; by default the sky, and the ground around the building.
    std::optional<Rgb> background = std::nullopt;
    /// Surfaces with smaller depths are ignored, e.g. the wall behind a camera.
    double min_depth = 1e-3;
    /// Marks pixels, row by row, that need not be computed, as a nearer picture hides them: their
    /// values are arbitrary. Null: all are needed.
    const std::vector<bool>* hidden_pixels = nullptr;
    /// Receives the share of the picture done since the last call, 1 in all, in any thread.
    std::function<void(double share)> on_progress = {};
};

/// A picture, row by row from the top.
struct Rendering {
    int columns = 0, rows = 0;
    std::vector<Rgb> radiance;  ///< 1: a white surface in the light of the whole room
    /// Record at the pixel's centre, as index in Scene::records plus 1; 0: no record (background or
    /// floor). Clear glass is transparent. Empty if not requested.
    std::vector<std::uint16_t> labels;
    /// Depth at the pixel's centre, in multiples of its line of sight; +infinity: no surface. Empty
    /// if not requested.
    std::vector<float> depths;
};

/// A scene prepared for rendering. Copies share their data; thread-safe.
class RenderScene {
  public:
    /// Reads the textures named by records, relative to the current folder.
    /// \throws FormatError for an unreadable texture
    explicit RenderScene(const Scene& scene, const RenderSceneOptions& options = {});

    /// Returns the same environment with placed elements at other poses, one for each of
    /// Scene::placed, in the world. `swings`: of the limbs of walking people, in their order, see
    /// personParts(). Takes far less time than a new scene.
    [[nodiscard]] RenderScene at(std::span<const Pose3> poses,
                                 std::span<const Angle> swings = {}) const;

    struct Data;
    [[nodiscard]] const Data& data() const { return *data_; }

  private:
    explicit RenderScene(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
    std::shared_ptr<const Data> data_;
};

/// Renders a picture; identical bytes for any number of threads.
/// \pre options.samples > 0
Rendering render(const RenderScene& scene, const Viewpoint& viewpoint,
                 const RenderOptions& options = {});

/// Lists the texture files named by a scene, each once: further inputs of its pictures.
std::vector<std::string> textureFiles(const Scene& scene);

/// Returns the records of the sensor and of its robot or person, see RenderOptions::hidden.
std::vector<std::size_t> ownRecords(const Scene& scene, const Sensor& sensor);

/// Converts to red, green and blue bytes for screens and files: radiance times exposure, highlights
/// rolled off softly, in sRGB (IEC 61966-2-1). Three bytes a pixel, row by row.
std::vector<std::uint8_t> toSrgb8(const Rendering& picture, double exposure = 1);
/// Converts one colour, without the roll-off.
std::array<std::uint8_t, 3> toSrgb8(const Rgb& color);

/// Renders band by band: the working memory per pixel (some 150 bytes) is needed for one band only.
/// Bands overlap where light is smoothed, so that seams are invisible.
Rendering renderInBands(const RenderScene& scene, const Viewpoint& viewpoint,
                        const RenderOptions& options, int most_pixels = 1'000'000);

}  // namespace ispace
