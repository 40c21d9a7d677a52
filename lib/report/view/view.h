// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "drawing/drawing.h"
#include "report/view/projector.h"
#include "scene/scene.h"
#include "trace/render/render.h"

namespace ispace {

/// What is drawn of what sensors see.
enum class OverlayLayers {
    None,
    Beams,  ///< beams of lasers, and view cubes of all sensors with an axis
    Area,   ///< the floor that each sensor covers in its colour, and view cubes
};

struct ViewOptions {
    OverlayLayers show = OverlayLayers::None;
    std::vector<std::string> highlight = {};  ///< ids of records that stand out
    bool labels = true;                       ///< ids beside sensors and robots, dots for cameras
    int samples = 16;                         ///< of each pixel, see RenderOptions
    /// Auto: lamps for those who look in from outside, else as RenderOptions has it.
    Illumination light = Illumination::Auto;
    double exposure = 1;  ///< factor of brightness
    /// Where other pictures are taken from: red points in those to scale (thesis, section 3.3.1).
    std::vector<Point3> viewers = {};
    std::vector<std::vector<Point2>> ways = {};  ///< that robots have gone
    /// Of the limbs of Scene::people, see humanParts(); none: they stand.
    std::vector<Angle> swings = {};
};

/// A picture of a scene for people. The same pixels for any number of threads.
/// \throws UsageError for unknown ids, FormatError for a texture that cannot be read
Image viewPicture(const Scene& scene, const ViewSpec& spec, PictureSize size,
                  const ViewOptions& options);

/// What the user may not have meant, a phrase: the viewer is below the floor, on the line of a
/// wall, outside the room, or inside something solid; "" if all is well.
std::string standpointWarning(const ViewSpec& spec, const Scene& scene);

/// The scene with a robot elsewhere, and with it what it carries. \pre it has that robot
void moveRobot(Scene& scene, std::size_t robot, const Pose2& pose);

}  // namespace ispace
