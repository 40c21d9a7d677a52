// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <utility>

#include "env/body.h"
#include "sensor/drawing.h"
#include "sensor/kind.h"

namespace ispace {

namespace {

using Index = std::uint32_t;

Mesh meshOf(Material material) { return {material, {}, {}}; }

/// A pyramid that points forward from a rectangle across x, closed.
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

/// Turns upright prisms into triangles of one mesh.
Mesh uprights(Material material, std::vector<Polygon> footprints, double bottom, double top) {
    Body body;
    for (Polygon& footprint : footprints)
        body.prisms.push_back({std::move(footprint), bottom, top, material});
    return std::move(meshesOf(body, Surfaces::Drawn).front());
}

using Meshes = std::vector<Mesh>;

Meshes matBody(const Scene& scene, const Placed& placed) {
    constexpr double kThickness = 0.01;
    const Tuple& size = scene.records[placed.record].tuple("size");
    Mesh plate = meshOf(Material::Mat);
    addBox(plate, {-size[0] / 2, -size[1] / 2, 0}, {size[0] / 2, size[1] / 2, kThickness});
    return {std::move(plate)};
}

Meshes gateBody(const Scene& scene, const Placed& placed) {
    constexpr double kPost = 0.04, kHead = 0.06;
    const Record& record = scene.records[placed.record];
    const double beside = record.number("width") / 2, height = record.number("height");
    Mesh posts = meshOf(Material::Metal), heads = meshOf(Material::Sensor);
    for (const double side : {-1.0, 1.0}) {
        // What lies between them is the width.
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

Meshes robotBody(const Scene& scene, const Placed& placed) {
    return {robotMesh(scene.robots[placed.index].model)};
}

Meshes humanBody(const Scene& scene, const Placed& placed) {
    return humanBodyOf(scene.records[placed.record].number("height"));
}

struct BodyRow {
    std::string_view keyword;
    Meshes (*make)(const Scene&, const Placed&);
};

constexpr BodyRow kBodies[] = {
    {"mat", matBody}, {"gate", gateBody}, {"robot", robotBody}, {"human", humanBody}};

// Of a person, as shares of the height: half a metre broad and 1.70 m high.
constexpr double kHead = 0.065;  // radius
constexpr double kHip = 0.48, kShoulder = 1 - 2 * kHead;
constexpr double kBodyWidth = 0.2, kBodyDepth = 0.12;
constexpr double kArm = 0.05, kWrist = 0.45, kFingers = 0.39;
constexpr double kLeg = 0.035, kLegPlace = 0.055;  // radius, and distance from the middle

std::vector<Polygon> legs(double height) {
    const double diameter = 2 * kLeg * height;
    return {ellipse({0, -kLegPlace * height}, diameter, diameter, {}),
            ellipse({0, kLegPlace * height}, diameter, diameter, {})};
}

/// How far ahead a swinging limb gets per metre below its joint.
double slopeOf(Angle swing) { return std::tan(swing.radians()); }

/// Swings the vertices from `first` on about a joint at height `joint`: those on the left forward,
/// those on the right back.
void shear(Mesh& mesh, std::size_t first, double joint, double slope) {
    if (slope == 0) return;
    for (std::size_t i = first; i < mesh.vertices.size(); ++i) {
        Point3& p = mesh.vertices[i];
        p.x += (p.y > 0 ? slope : -slope) * (joint - p.z);
    }
}

/// A limb that hangs from its top, in pieces if it swings.
void addLimb(std::vector<Upright>& parts, const Upright& limb, double slope) {
    constexpr int kPieces = 4;
    if (slope == 0) return parts.push_back(limb);
    const auto add = [&](double low, double high) {
        Upright piece = limb;
        piece.bottom = low;
        piece.top = high;
        piece.center.x += slope * (limb.top - (low + high) / 2);
        parts.push_back(piece);
    };
    double low = limb.bottom;
    int left = kPieces;
    if (low == 0 && 2 * kScanHeight < limb.top) {
        add(0, 2 * kScanHeight);
        low = 2 * kScanHeight;
        --left;
    }
    const double each = (limb.top - low) / left;
    for (int i = 0; i < left; ++i)
        add(low + i * each, i + 1 == left ? limb.top : low + (i + 1) * each);
}

}  // namespace

std::vector<Mesh> bodyOf(const Scene& scene, const Placed& placed) {
    const std::string& keyword = scene.records[placed.record].keyword();
    if (const SensorKind* kind = sensorKind(keyword)) return kind->body();
    const auto* row = std::find_if(std::begin(kBodies), std::end(kBodies),
                                   [&](const BodyRow& known) { return known.keyword == keyword; });
    return row == std::end(kBodies) ? Meshes() : row->make(scene, placed);
}

std::optional<Mesh> viewOf(const Scene& scene, const Placed& placed) {
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
    Mesh mesh = uprights(
        Material::Robot,
        {is_box ? rectangle(middle, length, width, {}) : ellipse(middle, length, width, {})}, 0,
        model.height);
    // It begins within the body, round or not, and stands out by as much.
    const double nose = std::min(length, width) / 8, front = model.center + length / 2;
    addNose(mesh, front - nose, front + nose, nose, 0.5 * model.height, 0.75 * model.height);
    return mesh;
}

std::vector<Mesh> humanBodyOf(double height, Angle swing) {
    const double h = height, slope = slopeOf(swing);
    Mesh skin = meshOf(Material::Skin), cloth = uprights(Material::Cloth, legs(h), 0, kHip * h);
    shear(cloth, 0, kHip * h, slope);
    addBall(skin, {0, 0, (1 - kHead) * h}, kHead * h);
    addBox(cloth, {-kBodyDepth / 2 * h, -kBodyWidth / 2 * h, kHip * h},
           {kBodyDepth / 2 * h, kBodyWidth / 2 * h, kShoulder * h});
    for (const double side : {-1.0, 1.0}) {
        const double near = side * kBodyWidth / 2 * h, far = side * (kBodyWidth / 2 + kArm) * h;
        const auto add = [&](Mesh& mesh, double low, double high) {
            const std::size_t first = mesh.vertices.size();
            addBox(mesh, {-kArm / 2 * h, std::min(near, far), low * h},
                   {kArm / 2 * h, std::max(near, far), high * h});
            shear(mesh, first, kShoulder * h, -slope);
        };
        add(cloth, kWrist, kShoulder);
        add(skin, kFingers, kWrist);
    }
    return {std::move(skin), std::move(cloth)};
}

double strideOf(double height) {
    return 4 * kHip * height * std::tan(Angle::degrees(kMaxSwingDegrees).radians());
}

std::vector<Upright> humanUprights(double height, Angle swing) {
    const double h = height, slope = slopeOf(swing);
    std::vector<Upright> parts;
    parts.reserve(16);
    for (const double side : {-1.0, 1.0}) {
        addLimb(parts, {{0, side * kLegPlace * h}, 0, 0, kLeg * h, 0, kHip * h}, side * slope);
        addLimb(parts,
                {{0, side * (kBodyWidth + kArm) / 2 * h},
                 kArm / 2 * h,
                 kArm / 2 * h,
                 0,
                 kFingers * h,
                 kShoulder * h},
                -side * slope);
    }
    parts.push_back({{}, kBodyDepth / 2 * h, kBodyWidth / 2 * h, 0, kHip * h, kShoulder * h});
    parts.push_back({{0, 0}, 0, 0, kHead * h, kShoulder * h, h});
    return parts;
}

std::vector<Polygon> legCircles(double height) {
    return kScanHeight <= kHip * height ? legs(height) : std::vector<Polygon>();
}

double humanRadius(double height) { return (kBodyWidth / 2 + kArm) * height; }

}  // namespace ispace
