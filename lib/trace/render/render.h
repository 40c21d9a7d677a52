// SPDX-License-Identifier: GPL-3.0-or-later
// lib/trace/render: pictures of a scene as light makes them. Uses trace and below; Embree inside.
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

/// Red, green and blue, linear.
using Rgb = std::array<float, 3>;

/// A surface that only pictures have, in the world: seen from both sides, without shadow, label
/// and depth.
struct PaintedMesh {
    Mesh mesh;
    Rgb color{};
    float opacity = 1;
    bool is_lit = true;  ///< false: has its colour in light and shade, as signs have
};

struct RenderSceneOptions {
    /// Level plates of Material::Ceiling; without them a room can be seen from above.
    bool ceilings = true;
    /// Bodies of sensors, tags, mats and gates.
    bool devices = true;
    /// Records (indices in Scene::records) of sensors whose fields of view are drawn, see viewOf().
    std::vector<std::size_t> views = {};
    /// Records that have this colour all over.
    struct Tint {
        std::size_t record = 0;
        Rgb color{};
    };
    std::vector<Tint> tints = {};
    std::vector<PaintedMesh> paint = {};
    /// Parts of elements that are left out, by their footprint (two points: of a sheet): walls
    /// between a viewer outside and the room.
    std::function<bool(const Element&, std::span<const Point2> footprint)> leaves_out = {};
};

/// What lights a scene.
enum class Illumination {
    Auto,   ///< lamps where the scene has a ceiling, else sun and sky
    Lamps,  ///< square panels under the ceiling, or at the height of the walls
    Sky,    ///< the sun, half-way up in the south-west, and a clear sky
};

struct RenderOptions {
    /// Lines of sight for each pixel: smooth edges. Light follows: more samples, less noise.
    int samples = 4;
    std::uint64_t seed = 1;
    Illumination light = Illumination::Auto;
    bool labels = false, depths = false;
    bool colors = true;  ///< false: labels and depths alone, far quicker
    /// Records whose bodies the viewpoint does not see, though they cast shadows: the camera that
    /// looks and what carries it, see ownRecords().
    std::vector<std::size_t> hidden = {};
    /// What is seen where nothing is; without it the sky, and the ground about the building.
    std::optional<Rgb> background = std::nullopt;
    /// Surfaces with smaller depths are not seen: what a camera on a wall is on.
    double min_depth = 1e-3;
};

/// A picture, row by row from the top.
struct Rendering {
    int columns = 0, rows = 0;
    std::vector<Rgb> radiance;  ///< 1 is a white surface in the light of the whole room
    /// Index in Scene::records of what the pixel's centre shows, plus 1; 0: nothing, or what no
    /// record is (the floor). One looks through clear glass. Empty if not asked for.
    std::vector<std::uint16_t> labels;
    /// Of the pixel's centre, in multiples of its line of sight; +infinity: nothing. As `labels`.
    std::vector<float> depths;
};

/// A scene, ready to be rendered. Copies share what they hold; thread-safe.
class RenderScene {
  public:
    /// Reads the textures that records name, relative to the current folder.
    /// \throws FormatError for a texture that cannot be read
    explicit RenderScene(const Scene& scene, const RenderSceneOptions& options = {});

    /// The same environment with what is placed at other poses, one for each of Scene::placed, in
    /// the world. `swings` of the people's limbs, in their order, if they walk: see humanParts().
    /// Takes far less time than a new scene.
    [[nodiscard]] RenderScene at(std::span<const Pose3> poses,
                                 std::span<const Angle> swings = {}) const;

    struct Data;
    [[nodiscard]] const Data& data() const { return *data_; }

  private:
    explicit RenderScene(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
    std::shared_ptr<const Data> data_;
};

/// The picture is the same, byte by byte, for any number of threads.
/// \pre options.samples > 0
Rendering render(const RenderScene& scene, const Viewpoint& viewpoint,
                 const RenderOptions& options = {});

/// The files of the textures that a scene names, each once: what a picture depends on.
std::vector<std::string> textureFiles(const Scene& scene);

/// Records of the sensor and of the robot or person that carries it, see RenderOptions::hidden.
std::vector<std::size_t> ownRecords(const Scene& scene, const Sensor& sensor);

/// Red, green and blue bytes for screens and files: radiance times exposure, highlights rolled off
/// softly, in sRGB.
std::vector<std::uint8_t> toSrgb8(const Rendering& picture, double exposure = 1);
/// Of one colour, without the roll-off.
std::array<std::uint8_t, 3> toSrgb8(const Rgb& color);

/// render() band by band: what it needs for each pixel while it works (some 150 bytes) is needed
/// for a band alone. Bands overlap where light is smoothed, so that no seam is seen.
Rendering renderInBands(const RenderScene& scene, const Viewpoint& viewpoint,
                        const RenderOptions& options, int most_pixels = 1'000'000);

}  // namespace ispace
