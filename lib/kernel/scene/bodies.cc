// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <utility>

#include "env/body.h"
#include "scene/sensor/field_of_view.h"
#include "scene/sensor/sensor.h"
#include "scene/thing_kind.h"

namespace ispace {

namespace {

using Index = std::uint32_t;

Mesh meshOf(Material material) { return {material, {}, {}}; }

/// Adds a closed pyramid that points forward from a rectangle across x.
void addNose(Mesh& mesh, double from, double to, double half_width, double low, double high) {
    const auto first = static_cast<Index>(mesh.vertices.size());
    for (const double z : {low, high})
        for (const double y : {-half_width, half_width}) mesh.vertices.push_back({from, y, z});
    mesh.vertices.push_back({to, 0, low + (high - low) / 2});
    using Triangle = std::array<Index, 3>;
    for (const auto& [i, j, k] : {Triangle{0, 2, 3}, Triangle{0, 3, 1}, Triangle{0, 1, 4},
                                  Triangle{1, 3, 4}, Triangle{3, 2, 4}, Triangle{2, 0, 4}})
        mesh.triangles.push_back({first + i, first + j, first + k});
}

using Meshes = std::vector<Mesh>;

Meshes matBody(const Scene& scene, const PlacedRecord& placed) {
    constexpr double kThickness = 0.01;
    const Tuple& size = scene.records[placed.record].tuple("size");
    Mesh plate = meshOf(Material::Mat);
    addBox(plate, {-size[0] / 2, -size[1] / 2, 0}, {size[0] / 2, size[1] / 2, kThickness});
    return {std::move(plate)};
}

Meshes gateBody(const Scene& scene, const PlacedRecord& placed) {
    constexpr double kPost = 0.04, kHead = 0.06;
    const Record& record = scene.records[placed.record];
    const double beside = record.number("width") / 2, height = record.number("height");
    Mesh posts = meshOf(Material::Metal), heads = meshOf(Material::Sensor);
    for (const double side : {-1.0, 1.0}) {
        // The width lies between them.
        const auto add = [&](Mesh& mesh, double edge, double low, double high) {
            const double near = side * beside, far = side * (beside + edge);
            addBox(mesh, {-edge / 2, std::min(near, far), low},
                   {edge / 2, std::max(near, far), high});
        };
        add(posts, kPost, 0, height);
        add(heads, kHead, std::max(0.0, height - kHead / 2), height + kHead / 2);
    }
    return {std::move(posts), std::move(heads)};
}

Meshes robotBody(const Scene& scene, const PlacedRecord& placed) {
    return {robotMesh(scene.robots[placed.index].model)};
}

Meshes humanBody(const Scene& scene, const PlacedRecord& placed) {
    return humanBodyOf(personParts(scene.people[placed.index]));
}

struct BodyRow {
    std::string_view keyword;
    Meshes (*make)(const Scene&, const PlacedRecord&);
};

constexpr BodyRow kBodies[] = {
    {"mat", matBody}, {"gate", gateBody}, {"robot", robotBody}, {"human", humanBody}};

// Of a person, as shares of the height: half a metre broad and 1.70 m high.
constexpr double kHead = 0.065;  // radius
constexpr double kHip = 0.48, kShoulder = 1 - 2 * kHead;
constexpr double kBodyWidth = 0.2, kBodyDepth = 0.12;
constexpr double kArm = 0.05, kWrist = 0.45, kFingers = 0.39;
constexpr double kLeg = 0.035, kLegPlace = 0.055;  // radius, and distance from the middle

}  // namespace

std::vector<Mesh> bodyOf(const Scene& scene, const PlacedRecord& placed) {
    const std::string& keyword = scene.records[placed.record].keyword();
    if (const SensorKind* kind = sensorKind(keyword)) return kind->body();
    const auto* row = std::find_if(std::begin(kBodies), std::end(kBodies),
                                   [&](const BodyRow& known) { return known.keyword == keyword; });
    if (row != std::end(kBodies)) return row->make(scene, placed);
    const ThingKind* const thing = thingKind(keyword);
    return thing == nullptr || thing->body == nullptr
               ? Meshes()
               : thing->body(scene.records[placed.record]).meshes;
}

std::optional<Mesh> viewOf(const Scene& scene, const PlacedRecord& placed) {
    const SensorKind* kind = sensorKind(scene.records[placed.record].keyword());
    if (kind == nullptr || kind->view == nullptr) return std::nullopt;
    const Box2 plan = scene.environment.limits();
    const double widest = plan.empty() ? 1 : std::max(plan.width(), plan.depth());
    return kind->view(scene.sensors[placed.index], widest);
}

Mesh robotMesh(const RobotModel& model) {
    const bool is_box = model.length > 0;
    const double length = is_box ? model.length : 2 * model.radius;
    const double width = is_box ? model.width : 2 * model.radius;
    const Point2 middle{model.center, 0};
    Body body;
    body.prisms.push_back(
        {is_box ? rectangle(middle, length, width, {}) : ellipse(middle, length, width, {}), 0,
         model.height, Material::Robot});
    Mesh mesh = std::move(meshesOf(body, Surfaces::Drawn).front());
    // It starts within the body, round or not, and protrudes by as much.
    const double nose = std::min(length, width) / 8, front = model.center + length / 2;
    addNose(mesh, front - nose, front + nose, nose, 0.5 * model.height, 0.75 * model.height);
    return mesh;
}

std::vector<BodyPart> humanParts(double height, Angle swing) {
    const double h = height, slope = std::tan(swing.radians());
    std::vector<BodyPart> parts;
    parts.reserve(8);
    for (const double side : {-1.0, 1.0}) {
        // `ahead`: metres per metre below the joint.
        const auto add = [&](double place, double radius, double low, double high, double joint,
                             double ahead, Material material) {
            parts.push_back({.center = {ahead * (joint - (low + high) / 2) * h, side * place * h},
                             .radius = radius * h,
                             .bottom = low * h,
                             .top = high * h,
                             .lean = -ahead,
                             .material = material});
        };
        constexpr double kBeside = (kBodyWidth + kArm) / 2;
        add(kLegPlace, kLeg, 0, kHip, kHip, side * slope, Material::Cloth);
        add(kBeside, kArm / 2, kWrist, kShoulder, kShoulder, -side * slope, Material::Cloth);
        add(kBeside, kArm / 2, kFingers, kWrist, kShoulder, -side * slope, Material::Skin);
    }
    parts.push_back({.half_length = kBodyDepth / 2 * h,
                     .half_width = kBodyWidth / 2 * h,
                     .bottom = kHip * h,
                     .top = kShoulder * h});
    parts.push_back({.radius = kHead * h,
                     .bottom = kShoulder * h,
                     .top = h,
                     .is_ball = true,
                     .material = Material::Skin});
    return parts;
}

Point3 PersonFigure::carried(Point3 standing) const {
    Point3 at = from + standing.x * x_axis;
    at = at + standing.y * y_axis;
    at = at + standing.z * z_axis;
    return {at.x, at.y, std::max(0.0, at.z)};
}

std::vector<BodyPart> personParts(double height, const PersonFigure* figure, Angle swing) {
    if (figure == nullptr) return humanParts(height, swing);
    std::vector<BodyPart> parts;
    parts.reserve(figure->kept.count() + figure->fixed.size());
    if (figure->kept.any()) {
        const std::vector<BodyPart> usual = humanParts(height, swing);
        for (std::size_t i = 0; i < usual.size(); ++i)
            if (figure->kept[i]) parts.push_back(usual[i]);
    }
    parts.insert(parts.end(), figure->fixed.begin(), figure->fixed.end());
    return parts;
}

std::vector<Mesh> humanBodyOf(double height) { return humanBodyOf(humanParts(height)); }

std::vector<Mesh> humanBodyOf(const std::vector<BodyPart>& parts) {
    Body body;
    std::vector<BodyPart> balls;
    for (const BodyPart& part : parts) {
        if (part.is_ball) {
            balls.push_back(part);
            continue;
        }
        const double round = 2 * part.radius;
        body.prisms.push_back(
            {round > 0 ? ellipse(part.center, round, round, {})
                       : rectangle(part.center, 2 * part.half_length, 2 * part.half_width, {}),
             part.bottom, part.top, part.material});
    }
    std::vector<Mesh> meshes = meshesOf(body, Surfaces::Drawn);
    for (const BodyPart& ball : balls) {
        auto mesh = std::find_if(meshes.begin(), meshes.end(), [&ball](const Mesh& each) {
            return each.material == ball.material;
        });
        if (mesh == meshes.end()) mesh = meshes.insert(mesh, meshOf(ball.material));
        addBall(*mesh, {ball.center.x, ball.center.y, (ball.bottom + ball.top) / 2}, ball.radius);
    }
    return meshes;
}

double strideOf(double height) {
    return 4 * kHip * height * std::tan(Angle::degrees(kMaxSwingDegrees).radians());
}

double humanRadius(double height) { return (kBodyWidth / 2 + kArm) * height; }

double personReach(const PlacedPerson& person) {
    const double usual = humanRadius(person.height);
    return person.figure == nullptr ? usual : std::max(usual, person.figure->reach);
}

}  // namespace ispace
