// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "layout/scene.h"
#include "render/viewpoint.h"
#include "view/view_spec.h"

namespace ispace {

/// Where a place of the world is in a picture, and its depth there as Rendering has it.
struct Sighting {
    PixelPoint pixel;
    double depth = 0;
};

/// A viewpoint that can be asked where something is.
class Eye {
  public:
    virtual ~Eye() = default;
    [[nodiscard]] virtual const Viewpoint& viewpoint() const = 0;
    /// Nothing for what is behind it, or not shown by its lens; else a place on the picture or
    /// beside it.
    [[nodiscard]] virtual std::optional<Sighting> find(Point3 place) const = 0;

  protected:
    Eye() = default;
    Eye(const Eye&) = default;
    Eye& operator=(const Eye&) = default;
};

std::unique_ptr<Eye> cameraEye(const Camera& camera, const Pose3& pose);
/// See OrthographicView.
std::unique_ptr<Eye> parallelEye(const Pose3& pose, double width, int columns, int rows);
/// All around: columns are equal steps of bearing, the heading in the middle and its left on the
/// left; rows of elevation, straight up at the top. Depth is distance.
std::unique_ptr<Eye> panoramaEye(const Pose3& pose, int columns, int rows);

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
    std::unique_ptr<Eye> eye;
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
