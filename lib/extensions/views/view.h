// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/views: pictures of a room from any standpoint, with what its sensors see.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "drawing/drawing.h"
#include "extensions/views/projector.h"
#include "scene/scene.h"
#include "trace/render/render.h"

namespace ispace::views {

/// The overlay that shows sensors' views.
enum class OverlayLayers {
    None,
    Beams,  ///< beams of lasers, and view cubes of all sensors with an axis
    Area,   ///< the floor that each sensor covers in its colour, and view cubes
};

struct ViewOptions {
    OverlayLayers show = OverlayLayers::None;
    std::vector<std::string> highlight = {};  ///< ids of highlighted records
    bool labels = true;                       ///< ids beside sensors and robots, dots for cameras
    int samples = 16;                         ///< per pixel, see RenderOptions
    /// Auto: lamps if the viewer looks in from outside, else as RenderOptions.
    Illumination light = Illumination::Auto;
    double exposure = 1;  ///< factor of brightness
    /// Viewpoints of other pictures: red points in pictures to scale (thesis, section 3.3.1).
    std::vector<Point3> viewers = {};
    std::vector<std::vector<Point2>> ways = {};  ///< of robots so far
    /// Of the limbs of Scene::people, see humanParts(); empty: people stand.
    std::vector<Angle> swings = {};
    /// A picture of the same size that stands for the empty background, where the viewer looks in
    /// from outside; null: white.
    const Image* behind = nullptr;
    std::function<void(double share)> on_progress = {};  ///< see RenderOptions
};

/// Renders a picture of a scene for people. Deterministic for any number of threads. \throws
/// UsageError for unknown ids, FormatError for a texture that cannot be read
Image viewPicture(const Scene& scene, const ViewSpec& spec, PictureSize size,
                  const ViewOptions& options);

/// A picture without overlays in which the background is clear: each of its pixels is the mean of a
/// few parts, some of them clear.
struct ViewLayer {
    PictureSize size;
    unsigned parts = 1;                              ///< of a pixel
    std::vector<std::array<std::uint16_t, 3>> sums;  ///< of red, green and blue of opaque parts
    std::vector<std::uint8_t> clear;                 ///< number of clear parts

    /// Returns the picture before another one of the same size.
    [[nodiscard]] Image over(const Image& behind) const;
    /// Marks the pixels that it hides wholly.
    void hide(std::vector<bool>& hidden) const;
};

/// Renders as viewPicture(), without ViewOptions::show, ways and behind.
/// \param hidden marks pixels that a nearer layer hides wholly: these are not rendered
ViewLayer viewLayer(const Scene& scene, const ViewSpec& spec, PictureSize size,
                    const ViewOptions& options, const std::vector<bool>& hidden);

/// Writes the ids and dots of ViewOptions::labels into a picture of several scenes, for one of
/// them. \pre the viewer looks in from outside
Image withLabels(const Image& picture, const Scene& scene, const ViewSpec& spec,
                 const ViewOptions& options);

/// Returns a warning, as a phrase, if the viewer is below the floor, on the line of a wall, outside
/// the room, or inside a solid; else "".
std::string standpointWarning(const ViewSpec& spec, const Scene& scene);

/// Moves a robot of the scene, and the sensors mounted on it. \pre it has that robot
void moveRobot(Scene& scene, std::size_t robot, const Pose2& pose);

}  // namespace ispace::views
