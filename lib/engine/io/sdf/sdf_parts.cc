// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/sdf/sdf_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>
#include <variant>

#include "base/number.h"
#include "drawing/plan/elements.h"
#include "geom/tolerance.h"
#include "io/sdf/urdf.h"
#include "scene/robot.h"

namespace ispace {

namespace {

/// Plates are this thick, metres.
constexpr double kPlateThickness = 0.001;

Point2 toLocal(const Pose2& frame, Point2 p) {
    const Vec2 along = unitVector(frame.heading), way = p - frame.position;
    return {dot(way, along), cross(along, way)};
}

/// Removes corners on the line between their neighbours.
Polygon cornersOf(const Polygon& footprint) {
    Polygon corners;
    const std::size_t count = footprint.size();
    for (std::size_t i = 0; i < count; ++i) {
        const Point2 before = footprint[(i + count - 1) % count], here = footprint[i];
        const Vec2 chord = footprint[(i + 1) % count] - before;
        if (std::abs(cross(chord, here - before)) > kContactTolerance * length(chord))
            corners.push_back(here);
    }
    return corners;
}

bool isRectangle(const Polygon& corners) {
    if (corners.size() != 4) return false;
    const Vec2 a = corners[1] - corners[0], b = corners[3] - corners[0];
    return length((corners[2] - corners[1]) - b) <= kContactTolerance &&
           std::abs(dot(a, b)) <= kContactTolerance * std::max(length(a), length(b));
}

/// Converts a rectangle to a box; the direction of its length depends on the preferred heading.
SdfPart boxPart(const Polygon& corners, double bottom, double top, bool is_framed) {
    SdfPart part;
    Vec2 along = corners[1] - corners[0], across = corners[3] - corners[0];
    part.place = {corners[0].x + (along.x + across.x) / 2, corners[0].y + (along.y + across.y) / 2,
                  (bottom + top) / 2};
    const bool swaps = is_framed ? std::abs(along.y) > std::abs(along.x) * (1 + kContactTolerance)
                                 : length(across) > length(along);
    if (swaps) {
        std::swap(along, across);
        across = -across;
    }
    if (along.x < 0 || (along.x == 0 && along.y < 0)) along = -along;
    part.length = length(along);
    part.width = length(across);
    part.height = top - bottom;
    part.heading = directionOf(along.x, along.y);
    return part;
}

SdfPart prismPart(const Prism& prism, const Pose2& frame, double base, bool is_framed) {
    const double bottom = prism.bottom - base, top = prism.top - base;
    SdfPart part;
    if (prism.curve && prism.curve->half_length == prism.curve->half_width) {
        const Point2 center = toLocal(frame, prism.curve->center);
        part.shape = SdfPart::Shape::Cylinder;
        part.place = {center.x, center.y, (bottom + top) / 2};
        part.radius = prism.curve->half_length;
        part.height = top - bottom;
    } else {
        Polygon local;
        local.reserve(prism.footprint.size());
        for (const Point2 p : prism.footprint) local.push_back(toLocal(frame, p));
        Polygon corners = cornersOf(local);
        if (isRectangle(corners)) {
            part = boxPart(corners, bottom, top, is_framed);
        } else {
            part.shape = SdfPart::Shape::Polyline;
            part.place = {0, 0, bottom};
            part.height = top - bottom;
            part.outline = std::move(corners);
        }
    }
    part.material = prism.material;
    return part;
}

/// An upright sheet as a thin wall.
Prism thinWall(const Sheet& sheet) {
    const Vec2 along = sheet.line.b - sheet.line.a;
    const Vec2 side = kSheetThickness / 2 / length(along) * perpendicular(along);
    return {{sheet.line.a - side, sheet.line.b - side, sheet.line.b + side, sheet.line.a + side},
            sheet.bottom,
            sheet.top,
            sheet.material};
}

/// Returns true for furniture and pillars with a position, which is their model's, too.
bool hasFrame(const Record& record) {
    const RecordType type = record.schema().type;
    return (type == RecordType::Other || type == RecordType::Infra) &&
           record.find("at") != nullptr && record.keyword() != "mesh";
}

void setPose(pugi::xml_node node, const SdfPart& part) {
    if (part.place == Point3() && part.heading == Angle()) return;
    addText(node, "pose",
            lengthsText({part.place.x, part.place.y, part.place.z}) + " 0 0 " +
                radiansText(part.heading));
}

void addGeometry(pugi::xml_node parent, const SdfPart& part, const std::string& mesh_file) {
    pugi::xml_node geometry = parent.append_child("geometry");
    switch (part.shape) {
        case SdfPart::Shape::Box:
            addText(geometry.append_child("box"), "size",
                    lengthsText({part.length, part.width, part.height}));
            return;
        case SdfPart::Shape::Cylinder: {
            pugi::xml_node cylinder = geometry.append_child("cylinder");
            addText(cylinder, "radius", lengthsText({part.radius}));
            addText(cylinder, "length", lengthsText({part.height}));
            return;
        }
        case SdfPart::Shape::Ball:
            addText(geometry.append_child("sphere"), "radius", lengthsText({part.radius}));
            return;
        case SdfPart::Shape::Polyline: {
            pugi::xml_node polyline = geometry.append_child("polyline");
            for (const Point2 p : part.outline) addText(polyline, "point", lengthsText({p.x, p.y}));
            addText(polyline, "height", lengthsText({part.height}));
            return;
        }
        case SdfPart::Shape::Mesh: {
            pugi::xml_node mesh = geometry.append_child("mesh");
            addText(mesh, "uri", mesh_file);
            pugi::xml_node submesh = mesh.append_child("submesh");
            addText(submesh, "name", part.mesh);
            addText(submesh, "center", "false");
            return;
        }
    }
}

}  // namespace

std::vector<SdfPart> sdfParts(const Body& body, const Pose2& frame, double bottom, bool is_framed,
                              const std::string& mesh) {
    std::vector<SdfPart> parts;
    for (const Prism& prism : body.prisms)
        parts.push_back(prismPart(prism, frame, bottom, is_framed));
    for (const Sheet& sheet : body.sheets)
        parts.push_back(prismPart(thinWall(sheet), frame, bottom, is_framed));
    for (const Plate& plate : body.plates) {
        parts.push_back(
            prismPart({plate.outline, plate.z, plate.z + kPlateThickness, plate.material}, frame,
                      bottom, is_framed));
        parts.back().is_solid = !plate.visual_only;
    }
    for (const Mesh& part : body.meshes) {
        parts.emplace_back();
        parts.back().shape = SdfPart::Shape::Mesh;
        parts.back().mesh = mesh;
        parts.back().material = part.material;
    }
    return parts;
}

FramedSdfParts sdfParts(const Element& element) {
    Pose2 frame;
    double bottom = 0;
    const bool is_framed = hasFrame(element.record);
    if (is_framed) {
        const Tuple& at = element.record.tuple("at");
        frame.position = {at[0], at[1]};
        // Lamps and other fixtures have no heading.
        if (element.record.schema().find("heading") != nullptr)
            frame.heading = element.record.angle("heading");
        if (at.size() > 2) bottom = at[2];
    }
    return {{{frame.position.x, frame.position.y, bottom}, wrapped(frame.heading), {}, {}},
            sdfParts(element.body, frame, bottom, is_framed, element.id)};
}

SdfPart sdfPart(const BodyPart& part) {
    SdfPart out;
    out.place = {part.center.x, part.center.y, (part.bottom + part.top) / 2};
    out.height = part.top - part.bottom;
    out.material = part.material;
    if (part.radius > 0) {
        out.shape = part.is_ball ? SdfPart::Shape::Ball : SdfPart::Shape::Cylinder;
        out.radius = part.radius;
    } else {
        out.length = 2 * part.half_length;
        out.width = 2 * part.half_width;
    }
    return out;
}

void addSdfMaterial(pugi::xml_node visual, Material material) {
    const Color color = displayColor(material);
    std::string text;
    for (const double part : {color.red, color.green, color.blue, color.alpha})
        text.append(text.empty() ? "" : " ").append(formatFixed(part, 4));
    pugi::xml_node node = visual.append_child("material");
    addText(node, "ambient", text);
    addText(node, "diffuse", text);
}

void addSdfParts(pugi::xml_node link, const std::vector<SdfPart>& parts,
                 const std::string& mesh_file, XmlNames& names) {
    int number = 0;
    for (const SdfPart& part : parts) {
        const std::string name = "part" + std::to_string(++number);
        if (part.is_solid) {
            pugi::xml_node collision = link.append_child("collision");
            collision.append_attribute("name").set_value(names.take(name).c_str());
            setPose(collision, part);
            addGeometry(collision, part, mesh_file);
        }
        pugi::xml_node visual = link.append_child("visual");
        visual.append_attribute("name").set_value(names.take(name + "_visual").c_str());
        setPose(visual, part);
        addGeometry(visual, part, mesh_file);
        addSdfMaterial(visual, part.material);
    }
}

namespace {

/// Bounds of libsdformat for a horizontal field of view, in radians, and for a far plane.
constexpr double kMinFov = 0.1, kMaxFov = 6.283186, kMinFar = 0.1;
/// A picture needs a near plane.
constexpr double kNear = 0.01;

std::string metres(double length) { return lengthsText({length}); }

void addGaussian(pugi::xml_node parent, double mean, double deviation) {
    if (mean == 0 && deviation == 0) return;
    pugi::xml_node noise = parent.append_child("noise");
    addText(noise, "type", "gaussian");
    addText(noise, "mean", formatDouble(mean));
    addText(noise, "stddev", formatDouble(roundSignificant(deviation)));
}

void addRangeNoise(pugi::xml_node parent, const RangeNoise& noise, double max_range) {
    const double r = max_range / 2;
    addGaussian(parent, noise.bias,
                std::max(0.0, noise.sigma[0] + noise.sigma[1] * r + noise.sigma[2] * r * r));
}

void addScan(pugi::xml_node scan, const char* axis, int samples, Angle from, Angle to) {
    pugi::xml_node node = scan.append_child(axis);
    addText(node, "samples", std::to_string(samples));
    addText(node, "resolution", "1");
    addText(node, "min_angle", radiansText(from));
    addText(node, "max_angle", radiansText(to));
}

void addRange(pugi::xml_node lidar, double min_range, double max_range, const RangeNoise& noise) {
    pugi::xml_node range = lidar.append_child("range");
    addText(range, "min", metres(min_range));
    addText(range, "max", metres(max_range));
    addText(range, "resolution", metres(noise.resolution));
    addRangeNoise(lidar, noise, max_range);
}

/// Field of view between the outer edges of a picture, and its size.
void addImage(pugi::xml_node camera, double fov, int columns, int rows, std::string_view format) {
    addText(camera, "horizontal_fov", formatDouble(std::clamp(fov, kMinFov, kMaxFov)));
    pugi::xml_node image = camera.append_child("image");
    addText(image, "width", std::to_string(columns));
    addText(image, "height", std::to_string(rows));
    addText(image, "format", std::string(format));
}

void addClip(pugi::xml_node camera, double near, double far) {
    pugi::xml_node clip = camera.append_child("clip");
    addText(clip, "near", metres(std::max(near, kNear)));
    addText(clip, "far", metres(std::max(far, kMinFar)));
}

/// SDF counts pixels from the picture's edge, not from the middle of the first one.
constexpr double kPixelEdge = 0.5;

void addIntrinsics(pugi::xml_node lens, double fx, double fy, double cx, double cy) {
    pugi::xml_node node = lens.append_child("intrinsics");
    addText(node, "fx", formatDouble(fx));
    addText(node, "fy", formatDouble(fy));
    addText(node, "cx", formatDouble(cx + kPixelEdge));
    addText(node, "cy", formatDouble(cy + kPixelEdge));
    addText(node, "s", "0");
}

void addMask(pugi::xml_node camera) {
    addText(camera, "visibility_mask",
            std::to_string(std::numeric_limits<std::uint32_t>::max() & ~kSensorBodies));
}

double pinholeFov(double columns, double focal) { return 2 * std::atan(columns / (2 * focal)); }

/// A topic may be any name of letters, digits and a few signs.
bool isTopic(std::string_view name) {
    return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '-';
    });
}

/// Adds a sensor of any kind; each function returns false for kinds that SDF lacks.
class SensorWriter {
  public:
    SensorWriter(pugi::xml_node link, const std::string& name, const Pose3& pose)
        : link_(link), name_(name), pose_(pose) {}

    [[nodiscard]] bool operator()(const Laser& laser) const {
        pugi::xml_node lidar = begin("gpu_lidar", laser.rate).append_child("lidar");
        addScan(lidar.append_child("scan"), "horizontal", laser.beams, laser.first, laser.last());
        addRange(lidar, laser.min_range, laser.max_range, laser.noise);
        return true;
    }

    [[nodiscard]] bool operator()(const Ranger& ranger) const {
        if (ranger.projection == Projection::Spherical)
            addSpherical(ranger);
        else
            addDepth(ranger);
        return true;
    }

    [[nodiscard]] bool operator()(const Camera& camera) const {
        if (camera.lens == Lens::Mirror) return false;
        const bool is_pinhole = camera.lens == Lens::Pinhole;
        pugi::xml_node node =
            begin(is_pinhole ? "camera" : "wideanglecamera", camera.rate).append_child("camera");
        addImage(node, is_pinhole ? pinholeFov(camera.columns, camera.fx) : camera.fovX().radians(),
                 camera.columns, camera.rows, "R8G8B8");
        addClip(node, camera.min_range, camera.max_range);
        const double grey = camera.full_well / 2;
        addGaussian(node, 0,
                    std::sqrt(grey + camera.read_noise * camera.read_noise) / camera.full_well);
        if (is_pinhole)
            addPinhole(node, camera);
        else
            addFisheye(node, camera);
        addMask(node);
        return true;
    }

    template <typename Model>
    [[nodiscard]] bool operator()(const Model& /*model*/) const {
        return false;
    }

  private:
    [[nodiscard]] pugi::xml_node begin(const char* type, double rate) const {
        pugi::xml_node sensor = link_.append_child("sensor");
        sensor.append_attribute("name").set_value(name_.c_str());
        sensor.append_attribute("type").set_value(type);
        if (pose_ != Pose3())
            addText(sensor, "pose",
                    lengthsText({pose_.position.x, pose_.position.y, pose_.position.z}) + ' ' +
                        anglesText(pose_));
        addText(sensor, "always_on", "true");
        addText(sensor, "update_rate", formatDouble(rate));
        addText(sensor, "visualize", "true");
        if (isTopic(name_)) addText(sensor, "topic", name_);
        return sensor;
    }

    void addSpherical(const Ranger& ranger) const {
        pugi::xml_node lidar = begin("gpu_lidar", ranger.rate).append_child("lidar");
        pugi::xml_node scan = lidar.append_child("scan");
        addScan(scan, "horizontal", ranger.columns, ranger.bearing(ranger.columns - 1),
                ranger.bearing(0));
        addScan(scan, "vertical", ranger.rows, ranger.elevation(ranger.rows - 1),
                ranger.elevation(0));
        addRange(lidar, ranger.min_range, ranger.max_range, ranger.noise);
    }

    void addDepth(const Ranger& ranger) const {
        pugi::xml_node camera = begin("depth_camera", ranger.rate).append_child("camera");
        addImage(camera, pinholeFov(ranger.columns, ranger.fx()), ranger.columns, ranger.rows,
                 "R_FLOAT32");
        addClip(camera, ranger.min_range, ranger.max_range);
        addRangeNoise(camera, ranger.noise, ranger.max_range);
        addIntrinsics(camera.append_child("lens"), ranger.fx(), ranger.fy(), ranger.cx(),
                      ranger.cy());
        addMask(camera);
    }

    static void addPinhole(pugi::xml_node node, const Camera& camera) {
        if (camera.isDistorted()) {
            pugi::xml_node distortion = node.append_child("distortion");
            const auto& [k1, k2, p1, p2, k3] = camera.distortion;
            addText(distortion, "k1", formatDouble(k1));
            addText(distortion, "k2", formatDouble(k2));
            addText(distortion, "k3", formatDouble(k3));
            addText(distortion, "p1", formatDouble(p1));
            addText(distortion, "p2", formatDouble(p2));
            addText(distortion, "center",
                    formatDouble((camera.cx + kPixelEdge) / camera.columns) + ' ' +
                        formatDouble((camera.cy + kPixelEdge) / camera.rows));
        }
        addIntrinsics(node.append_child("lens"), camera.fx, camera.fy, camera.cx, camera.cy);
    }

    static void addFisheye(pugi::xml_node node, const Camera& camera) {
        pugi::xml_node lens = node.append_child("lens");
        addText(lens, "type", "equidistant");
        addText(lens, "scale_to_hfov", "true");
        addText(lens, "cutoff_angle", radiansText(std::min(camera.widest, Angle::degrees(179.99))));
    }

    mutable pugi::xml_node link_;
    const std::string& name_;
    const Pose3& pose_;
};

}  // namespace

bool addSdfSensor(pugi::xml_node link, const std::string& name, const SensorModel& model,
                  const Pose3& link_from_sensor) {
    return std::visit(SensorWriter(link, name, link_from_sensor), model);
}

}  // namespace ispace
