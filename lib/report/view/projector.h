// SPDX-License-Identifier: GPL-3.0-or-later
// lib/report/view: pictures of a room for people: from where one looks, what sensors see drawn into
// it. Uses cover, render, draw and below.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geom/point.h"
#include "scene/scene.h"
#include "trace/render/viewpoint.h"

namespace ispace {

/// The view modes of the thesis (sections 3.3.4, 3.4.6 and 3.5.2), and what a camera sees.
enum class ViewMode {
    Bird,         ///< from above, to scale, north up
    FirstPerson,  ///< by the eyes of somebody who stands there
    Omni,         ///< all around from any place, as a panorama of equal angles
    Central,      ///< around a place or a thing, which stays in the middle
    Orbit,        ///< around the whole plan, which fills the picture
    Robot,        ///< from on top of a robot, ahead
    Camera,       ///< through the lens of a camera
};

/// What `--view` says. What is left out has no value.
struct ViewSpec {
    ViewMode mode = ViewMode::Bird;
    std::string name;             ///< fit for a file: "orbit", "robot-r1"
    std::string id;               ///< of what is looked at, or from
    std::optional<Point2> at;     ///< of what is looked at, or from
    std::optional<double> z;      ///< of Omni
    std::optional<double> width;  ///< of Bird, metres
    std::optional<double> distance;
    /// Where the viewer faces; of Central and Orbit where he stands, seen from the middle.
    std::optional<Angle> heading;
    std::optional<Angle> tilt;  ///< up is positive; of Central and Orbit the viewer's elevation
};

/// Reads `MODE[:VALUE,…]`. \throws UsageError
ViewSpec parseView(const std::string& text);

/// "bird[:X,Y[,WIDTH]]", … in the order of ViewMode.
std::vector<std::string> viewForms();

/// Where a place of the world is in a picture, and its depth there as Rendering has it.
struct ProjectedPoint {
    PixelPoint pixel;
    double depth = 0;
};

/// A viewpoint that can be asked where something is.
class Projector {
  public:
    virtual ~Projector() = default;
    [[nodiscard]] virtual const Viewpoint& viewpoint() const = 0;
    /// Nothing for what is behind it, or not shown by its lens; else a place on the picture or
    /// beside it.
    [[nodiscard]] virtual std::optional<ProjectedPoint> find(Point3 place) const = 0;

  protected:
    Projector() = default;
    Projector(const Projector&) = default;
    Projector& operator=(const Projector&) = default;
};

std::unique_ptr<Projector> cameraEye(const Camera& camera, const Pose3& pose);
/// See OrthographicView.
std::unique_ptr<Projector> parallelEye(const Pose3& pose, double width, int columns, int rows);
/// All around: columns are equal steps of bearing, the heading in the middle and its left on the
/// left; rows of elevation, straight up at the top. Depth is distance.
std::unique_ptr<Projector> panoramaEye(const Pose3& pose, int columns, int rows);

/// Columns and rows of a picture.
struct PictureSize {
    int columns = 1280, rows = 960;
    friend bool operator==(const PictureSize&, const PictureSize&) = default;
};

/// The size of a view's picture: `wanted`, whose rows follow from the view if they are 0; without,
/// a camera's own, or one that fits the mode.
PictureSize sizeOf(const ViewSpec& spec, const Scene& scene, std::optional<PictureSize> wanted);

/// From where a picture of a scene is taken.
struct Standpoint {
    std::unique_ptr<Projector> eye;
    /// One looks into the room from outside: ceilings, and walls in between, are left out, and
    /// there is nothing around.
    bool looks_in = false;
    bool is_to_scale = false;              ///< of Bird
    std::optional<Point3> place;           ///< of the viewer; none for Bird
    std::vector<std::size_t> hidden = {};  ///< records, see RenderOptions::hidden
};

/// Eyes of an adult, metres (thesis, section 3.3.1).
constexpr double kEyeHeight = 1.7;

/// \throws UsageError for an unknown id, with the nearest one
Standpoint standpointOf(const ViewSpec& spec, const Scene& scene, PictureSize size);

/// Index in `ids`. \throws UsageError naming what was wanted, with the nearest of the ids
std::size_t indexOfId(const std::string& id, const std::vector<std::string>& ids,
                      const std::string& wanted);

}  // namespace ispace
