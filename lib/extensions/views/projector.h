// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of a room for people: viewpoints, and sensors' views drawn into pictures.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/picture_size.h"
#include "geom/point.h"
#include "scene/scene.h"
#include "trace/render/viewpoint.h"

namespace ispace::views {

/// The view modes of the thesis (sections 3.3.4, 3.4.6 and 3.5.2), and a camera's picture.
enum class ViewMode {
    Bird,         ///< from above, to scale, north up
    FirstPerson,  ///< at the eye height of a person standing there
    Omni,         ///< an equirectangular panorama at a point
    Central,      ///< around a point or an object, which stays in the middle
    Orbit,        ///< around the whole plan, which fills the picture
    Robot,        ///< from the top of a robot, ahead
    Camera,       ///< through the lens of a camera
};

/// A parsed `--view`. Omitted parts are empty.
struct ViewSpec {
    ViewMode mode = ViewMode::Bird;
    std::string name;             ///< usable in a file name: "orbit", "robot-r1"
    std::string id;               ///< of the target or the viewer's carrier
    std::optional<Point2> at;     ///< position of the target or the viewer
    std::optional<double> z;      ///< height of Omni
    std::optional<double> width;  ///< of Bird, metres
    std::optional<double> distance;
    /// Heading of the viewer; of Central and Orbit the viewer's direction as seen from the middle.
    std::optional<Angle> heading;
    std::optional<Angle> tilt;  ///< up is positive; of Central and Orbit the viewer's elevation
    /// Of a building, from `bird:STOREY/...`; an id may have a storey, too.
    std::string storey = {};
    std::vector<Point3> contents = {};  ///< fills the picture of Orbit; empty: the room
};

/// Parses `MODE[:VALUE,…]`, in which a storey and a slash may precede the first number.
/// \throws UsageError
ViewSpec parseView(const std::string& text);

/// Returns "bird[:X,Y[,WIDTH]]", … in the order of ViewMode.
std::vector<std::string> viewForms();

/// Position of a point in a picture, and its depth as in Rendering.
struct ProjectedPoint {
    PixelPoint pixel;
    double depth = 0;
};

/// A viewpoint that also projects points to the picture.
class Projector {
  public:
    virtual ~Projector() = default;
    [[nodiscard]] virtual const Viewpoint& viewpoint() const = 0;
    /// Projects a point; empty if it is behind the viewer or outside the lens, else a position on
    /// the picture or beside it.
    [[nodiscard]] virtual std::optional<ProjectedPoint> find(Point3 place) const = 0;

  protected:
    Projector() = default;
    Projector(const Projector&) = default;
    Projector& operator=(const Projector&) = default;
};

std::unique_ptr<Projector> cameraEye(const Camera& camera, const Pose3& pose);
/// Creates a parallel projection, see OrthographicView.
std::unique_ptr<Projector> parallelEye(const Pose3& pose, double width, int columns, int rows);
/// Creates a panorama: columns are equal steps of bearing, the heading in the middle and left of it
/// on the left; rows of elevation, straight up at the top. Depth is distance.
std::unique_ptr<Projector> panoramaEye(const Pose3& pose, int columns, int rows);

/// Computes the size of a view's picture: `wanted`, with rows computed from the view if they are 0;
/// without it a camera's resolution, or a default of the mode.
PictureSize sizeOf(const ViewSpec& spec, const Scene& scene, std::optional<PictureSize> wanted);

/// The viewpoint of a picture.
struct Standpoint {
    std::unique_ptr<Projector> eye;
    /// The viewer looks into the room from outside: ceilings, and walls in between, are hidden, and
    /// the background is empty.
    bool looks_in = false;
    bool is_to_scale = false;              ///< of Bird
    std::optional<Point3> place;           ///< of the viewer; empty for Bird
    std::vector<std::size_t> hidden = {};  ///< records, see RenderOptions::hidden
};

/// Eye height of an adult, metres (thesis, section 3.3.1).
constexpr double kEyeHeight = 1.7;

/// Computes the standpoint of a view. \throws UsageError for an unknown id, with the nearest one
Standpoint standpointOf(const ViewSpec& spec, const Scene& scene, PictureSize size);

/// Finds an index in `ids`. \throws UsageError with the unknown id and the nearest of the ids
std::size_t indexOfId(const std::string& id, const std::vector<std::string>& ids,
                      const std::string& wanted);

}  // namespace ispace::views
