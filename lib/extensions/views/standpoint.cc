// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/message.h"
#include "env/mesh.h"
#include "extensions/views/projector.h"
#include "trace/render/render.h"

namespace ispace::views {

namespace {

const Angle kQuarter = Angle::degrees(90);
// Default direction of the viewer in Central and Orbit: south-west, well above the walls.
const Angle kAzimuth = Angle::degrees(-120), kElevation = Angle::degrees(42);
constexpr double kMargin = 0.05;  // around the contents of a picture, as a share of it

Camera pinhole(PictureSize size, Angle fov_across) {
    Camera camera;
    camera.columns = size.columns;
    camera.rows = size.rows;
    camera.fx = camera.fy = size.columns / 2.0 / tan(0.5 * fov_across);
    camera.cx = (size.columns - 1) / 2.0;
    camera.cy = (size.rows - 1) / 2.0;
    return camera;
}

/// Returns corners that bound the scene.
std::vector<Point3> extremesOf(const Scene& scene) {
    std::vector<Point3> places;
    for (const Region& part : scene.environment.indoor().parts)
        for (const Point2& p : part.outline) {
            places.push_back({p.x, p.y, 0});
            places.push_back({p.x, p.y, scene.environment.height()});
        }
    return places;
}

/// Sets the focal length and the centre so that these points just fill the picture. \pre all of
/// them are in front of the camera
void fill(Camera& camera, const Pose3& pose, const std::vector<Point3>& places) {
    const Frame3 frame(pose);
    Box2 tangents;
    for (const Point3& p : places) {
        const Vec3 local = frame.toLocal(p);
        tangents.add({-local.y / local.x, -local.z / local.x});
    }
    const double room = 1 - 2 * kMargin;
    const double focal =
        std::min(room * camera.columns / tangents.width(), room * camera.rows / tangents.depth());
    camera.fx = camera.fy = focal;
    camera.cx = (camera.columns - 1) / 2.0 - focal * tangents.center().x;
    camera.cy = (camera.rows - 1) / 2.0 - focal * tangents.center().y;
}

Pose3 around(Point3 middle, Angle azimuth, Angle elevation, double distance) {
    const double level = distance * cos(elevation);
    return {{middle.x + level * cos(azimuth), middle.y + level * sin(azimuth),
             middle.z + distance * sin(elevation)},
            wrapped(azimuth + Angle::degrees(180)),
            -elevation,
            {}};
}

/// The centre of Central's orbit.
struct Focus {
    Point3 middle;
    double size = 0;
};

Focus focusOf(const std::vector<Mesh>& meshes) {
    Box2 plan, heights;
    for (const Mesh& mesh : meshes)
        for (const Point3& p : mesh.vertices) {
            plan.add({p.x, p.y});
            heights.add({0, p.z});
        }
    if (plan.empty()) return {};
    return {{plan.center().x, plan.center().y, heights.center().y},
            std::max({plan.width(), plan.depth(), heights.depth()})};
}

Focus focusOn(const std::string& id, const Scene& scene) {
    const std::size_t record = indexOfId(id, scene.ids, "nothing has the id");
    for (const PlacedRecord& placed : scene.placed)
        if (placed.record == record) {
            const Point3 p = placed.pose.position;
            // For targets on the floor, the viewer looks slightly above it.
            return {{p.x, p.y, p.z > 0 ? p.z : 0.3}, 0.5};
        }
    for (const Element& element : scene.environment.elements())
        if (element.id == id) {
            const Focus focus = focusOf(meshesOf(element.body, Surfaces::Drawn));
            if (element.record.keyword() == "zone") {
                const Box2 zone = bounds(zoneOutline(element.record));
                return {{zone.center().x, zone.center().y, 0}, zone.width()};
            }
            if (focus.size > 0) return focus;
        }
    throw UsageError(excerpt(id) + " has no place to look at");
}

bool isWithin(const Scene& scene, Point3 place) {
    return place.z < scene.environment.height() &&
           scene.environment.indoor().locate(place.onFloor()) == Side::Inside;
}

Standpoint lookIn(const Scene& scene, const Camera& camera, const Pose3& pose) {
    return {.eye = cameraEye(camera, pose),
            .looks_in = !isWithin(scene, pose.position),
            .place = pose.position};
}

/// Returns the mean of the points, at a third of their height.
Point3 middleOf(const std::vector<Point3>& places) {
    Vec2 sum;
    Box2 heights;
    for (const Point3& p : places) {
        sum = sum + Vec2{p.x, p.y};
        heights.add({0, p.z});
    }
    const auto count = static_cast<double>(places.size());
    return {sum.x / count, sum.y / count, heights.low.y + heights.depth() / 3};
}

Standpoint orbit(const ViewSpec& spec, const Scene& scene, PictureSize size) {
    const bool is_room = spec.contents.empty();
    const std::vector<Point3> extremes = is_room ? extremesOf(scene) : spec.contents;
    const Box2& plan = scene.environment.limits();
    const Point3 middle =
        is_room ? Point3{plan.center().x, plan.center().y, scene.environment.height() / 3}
                : middleOf(extremes);
    double radius = 0;
    for (const Point3& p : extremes) radius = std::max(radius, length(p - middle));
    constexpr double kNear = 2.5;  // in radii: perspective without visible distortion
    const double distance = spec.distance.value_or(kNear * radius);
    const Pose3 pose =
        around(middle, spec.heading.value_or(kAzimuth), spec.tilt.value_or(kElevation), distance);
    Camera camera = pinhole(size, Angle::degrees(45));
    if (!spec.distance) fill(camera, pose, extremes);
    return lookIn(scene, camera, pose);
}

Standpoint central(const ViewSpec& spec, const Scene& scene, PictureSize size) {
    if (!spec.at && spec.id.empty()) return orbit(spec, scene, size);
    const Focus focus =
        spec.at ? Focus{{spec.at->x, spec.at->y, 0.8}, 1.2} : focusOn(spec.id, scene);
    const double distance = spec.distance.value_or(std::max(4.0, 5 * focus.size));
    const Pose3 pose = around(focus.middle, spec.heading.value_or(kAzimuth),
                              spec.tilt.value_or(kElevation), distance);
    return lookIn(scene, pinhole(size, Angle::degrees(55)), pose);
}

Standpoint bird(const ViewSpec& spec, const Scene& scene, PictureSize size) {
    const Box2& plan = scene.environment.limits();
    const Point2 middle = spec.at.value_or(plan.center());
    const double shape = static_cast<double>(size.columns) / size.rows;
    const double whole = std::max(plan.width(), plan.depth() * shape) / (1 - 2 * kMargin);
    double top = scene.environment.height();
    for (const Element& element : scene.environment.elements())
        top = std::max(top, topOf(element.body));
    const Pose3 pose{{middle.x, middle.y, top + 5}, kQuarter, -kQuarter, {}};
    return {.eye = parallelEye(pose, spec.width.value_or(whole), size.columns, size.rows),
            .looks_in = true,
            .is_to_scale = true,
            .place = std::nullopt};
}

Standpoint onRobot(const ViewSpec& spec, const Scene& scene, PictureSize size) {
    std::vector<std::string> ids;
    for (const PlacedRobot& robot : scene.robots) ids.push_back(robot.id);
    const std::size_t index = indexOfId(spec.id, ids, "no robot has the id");
    const PlacedRobot& robot = scene.robots[index];
    constexpr double kMast = 0.3;  // metres above the robot
    const Point3 place{robot.pose.position.x, robot.pose.position.y, robot.model.height + kMast};
    Standpoint out{.eye = cameraEye(pinhole(size, Angle::degrees(80)),
                                    {place, robot.pose.heading, Angle::degrees(-8), {}}),
                   .place = place};
    for (const PlacedRecord& placed : scene.placed) {
        const bool is_carried = placed.mount && placed.mount->robot == index;
        if (is_carried || scene.ids[placed.record] == spec.id) out.hidden.push_back(placed.record);
    }
    return out;
}

const Sensor& cameraOf(const std::string& id, const Scene& scene) {
    std::vector<std::string> ids;
    for (const Sensor& sensor : scene.sensors) {
        if (sensor.is<Camera>())
            ids.push_back(sensor.id);
        else if (sensor.id == id)
            throw UsageError(excerpt(id) + " is no camera");
    }
    indexOfId(id, ids, "no placed camera has the id");
    return *std::find_if(scene.sensors.begin(), scene.sensors.end(),
                         [&id](const Sensor& sensor) { return sensor.id == id; });
}

/// Returns the same lens with another number of pixels.
Camera scaled(Camera camera, PictureSize size) {
    const double across = static_cast<double>(size.columns) / camera.columns;
    const double down = static_cast<double>(size.rows) / camera.rows;
    camera.fx *= across;
    camera.fy *= down;
    camera.cx = (camera.cx + 0.5) * across - 0.5;
    camera.cy = (camera.cy + 0.5) * down - 0.5;
    camera.columns = size.columns;
    camera.rows = size.rows;
    return camera;
}

Standpoint throughCamera(const ViewSpec& spec, const Scene& scene, PictureSize size) {
    const Sensor& sensor = cameraOf(spec.id, scene);
    return {.eye = cameraEye(scaled(sensor.as<Camera>(), size), sensor.pose),
            .place = sensor.pose.position,
            .hidden = ownRecords(scene, sensor)};
}

int atLeastOne(double pixels) { return std::max(1, static_cast<int>(std::lround(pixels))); }

}  // namespace

std::size_t indexOfId(const std::string& id, const std::vector<std::string>& ids,
                      const std::string& wanted) {
    const auto found = std::find(ids.begin(), ids.end(), id);
    if (found == ids.end()) throw UsageError(wanted + " " + excerpt(id) + didYouMean(id, ids));
    return static_cast<std::size_t>(found - ids.begin());
}

PictureSize sizeOf(const ViewSpec& spec, const Scene& scene, std::optional<PictureSize> wanted) {
    if (spec.mode == ViewMode::Camera) {
        const auto& camera = cameraOf(spec.id, scene).as<Camera>();
        const double shape = static_cast<double>(camera.columns) / camera.rows;
        if (!wanted) return {camera.columns, camera.rows};
        // The largest size of this shape.
        if (wanted->rows > 0 && wanted->columns > shape * wanted->rows)
            return {atLeastOne(shape * wanted->rows), wanted->rows};
        return {wanted->columns, atLeastOne(wanted->columns / shape)};
    }
    const PictureSize usual =
        spec.mode == ViewMode::Omni ? PictureSize{1600, 800} : PictureSize{1280, 960};
    if (!wanted) return usual;
    if (wanted->rows > 0) return *wanted;
    return {wanted->columns, atLeastOne(1.0 * wanted->columns * usual.rows / usual.columns)};
}

Standpoint standpointOf(const ViewSpec& spec, const Scene& scene, PictureSize size) {
    switch (spec.mode) {
        case ViewMode::Bird:
            return bird(spec, scene, size);
        case ViewMode::Central:
            return central(spec, scene, size);
        case ViewMode::Orbit:
            return orbit(spec, scene, size);
        case ViewMode::Robot:
            return onRobot(spec, scene, size);
        case ViewMode::Camera:
            return throughCamera(spec, scene, size);
        case ViewMode::FirstPerson:
        case ViewMode::Omni:
            break;
    }
    const Point3 place{spec.at->x, spec.at->y, spec.z.value_or(kEyeHeight)};
    const Pose3 pose{place, spec.heading.value_or(Angle()), spec.tilt.value_or(Angle()), {}};
    // North is in the middle of a panorama.
    return {.eye = spec.mode == ViewMode::Omni
                       ? panoramaEye({place, kQuarter, {}, {}}, size.columns, size.rows)
                       : cameraEye(pinhole(size, Angle::degrees(80)), pose),
            .place = place};
}

}  // namespace ispace::views
