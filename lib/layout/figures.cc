// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <utility>

#include "env/body.h"

namespace ispace {

namespace {

using Index = std::uint32_t;

Mesh meshOf(Material material) { return {material, {}, {}}; }

void addBox(Mesh& mesh, Point3 low, Point3 high) {
    const auto first = static_cast<Index>(mesh.vertices.size());
    for (const double z : {low.z, high.z})
        for (const Point2 p :
             {Point2{low.x, low.y}, {high.x, low.y}, {high.x, high.y}, {low.x, high.y}})
            mesh.vertices.push_back({p.x, p.y, z});
    using Triangle = std::array<Index, 3>;
    for (const auto& [i, j, k] : {Triangle{0, 2, 1},
                                  {0, 3, 2},
                                  {4, 5, 6},
                                  {4, 6, 7},
                                  {0, 1, 5},
                                  {0, 5, 4},
                                  {1, 2, 6},
                                  {1, 6, 5},
                                  {2, 3, 7},
                                  {2, 7, 6},
                                  {3, 0, 4},
                                  {3, 4, 7}})
        mesh.triangles.push_back({first + i, first + j, first + k});
}

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

/// Corners of what is drawn round; these bodies stop nothing, so coarse is good enough.
constexpr Index kAround = 24;

Point2 onCircle(double radius, Index i) {
    const Angle t = Angle::degrees(360.0 * i / kAround);
    return {radius * cos(t), radius * sin(t)};
}

/// A cylinder about an axis along x.
void addDisc(Mesh& mesh, Point3 back, double radius, double length) {
    const auto first = static_cast<Index>(mesh.vertices.size());
    for (const double x : {back.x, back.x + length})
        for (Index i = 0; i < kAround; ++i) {
            const Point2 p = onCircle(radius, i);
            mesh.vertices.push_back({x, back.y + p.x, back.z + p.y});
        }
    for (Index i = 0; i < kAround; ++i) {
        const Index next = (i + 1) % kAround;
        mesh.triangles.push_back({first + i, first + next, first + kAround + next});
        mesh.triangles.push_back({first + i, first + kAround + next, first + kAround + i});
    }
    for (Index i = 2; i < kAround; ++i) {
        mesh.triangles.push_back({first, first + i, first + i - 1});
        mesh.triangles.push_back({first + kAround, first + kAround + i - 1, first + kAround + i});
    }
}

void addBall(Mesh& mesh, Point3 center, double radius) {
    constexpr Index kRings = 11;  // between the poles
    const auto first = static_cast<Index>(mesh.vertices.size());
    for (Index ring = 1; ring <= kRings; ++ring) {
        const Angle up = Angle::degrees(180.0 * ring / (kRings + 1) - 90);
        for (Index i = 0; i < kAround; ++i) {
            const Point2 p = onCircle(radius * cos(up), i);
            mesh.vertices.push_back({center.x + p.x, center.y + p.y, center.z + radius * sin(up)});
        }
    }
    const auto low = static_cast<Index>(mesh.vertices.size()), high = low + 1;
    mesh.vertices.push_back({center.x, center.y, center.z - radius});
    mesh.vertices.push_back({center.x, center.y, center.z + radius});
    for (Index i = 0; i < kAround; ++i) {
        const Index next = (i + 1) % kAround;
        for (Index ring = 0; ring + 1 < kRings; ++ring) {
            const Index a = first + ring * kAround, b = a + kAround;
            mesh.triangles.push_back({a + i, a + next, b + next});
            mesh.triangles.push_back({a + i, b + next, b + i});
        }
        const Index top = first + (kRings - 1) * kAround;
        mesh.triangles.push_back({first + next, first + i, low});
        mesh.triangles.push_back({top + i, top + next, high});
    }
}

/// Turns upright prisms into triangles of one mesh.
Mesh uprights(Material material, std::vector<Polygon> footprints, double bottom, double top) {
    Body body;
    for (Polygon& footprint : footprints)
        body.prisms.push_back({std::move(footprint), bottom, top, material});
    return std::move(meshesOf(body, Surfaces::Drawn).front());
}

using Figure = std::vector<Mesh>;

/// A box behind the optical centre with lenses at these places beside it.
Figure pictureSensor(Vec3 size, std::initializer_list<double> lenses, double radius) {
    constexpr double kLens = 0.02;
    Mesh box = meshOf(Material::Sensor), glass = meshOf(Material::Metal);
    addBox(box, {-kLens - size.x, -size.y / 2, -size.z / 2}, {-kLens, size.y / 2, size.z / 2});
    for (const double y : lenses) addDisc(glass, {-kLens, y, 0}, radius, kLens);
    return {std::move(box), std::move(glass)};
}

Figure laserFigure(const Scene& /*scene*/, const Placed& /*placed*/) { return {sensorMesh()}; }

Figure rangerFigure(const Scene& /*scene*/, const Placed& /*placed*/) {
    return pictureSensor({0.05, 0.18, 0.05}, {-0.05, 0.05}, 0.015);
}

Figure cameraFigure(const Scene& /*scene*/, const Placed& /*placed*/) {
    return pictureSensor({0.07, 0.06, 0.06}, {0}, 0.022);
}

Figure ultrasoundFigure(const Scene& /*scene*/, const Placed& /*placed*/) {
    Mesh housing = meshOf(Material::Sensor), front = meshOf(Material::Metal);
    addDisc(housing, {-0.03, 0, 0}, 0.03, 0.025);
    addDisc(front, {-0.005, 0, 0}, 0.024, 0.005);
    return {std::move(housing), std::move(front)};
}

Figure tagFigure(const Scene& /*scene*/, const Placed& /*placed*/) {
    Mesh ball = meshOf(Material::Sensor);
    addBall(ball, {}, 0.025);
    return {std::move(ball)};
}

Figure matFigure(const Scene& scene, const Placed& placed) {
    constexpr double kThickness = 0.01;
    const Tuple& size = scene.records[placed.record].tuple("size");
    Mesh plate = meshOf(Material::Mat);
    addBox(plate, {-size[0] / 2, -size[1] / 2, 0}, {size[0] / 2, size[1] / 2, kThickness});
    return {std::move(plate)};
}

Figure gateFigure(const Scene& scene, const Placed& placed) {
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

Figure robotFigure(const Scene& scene, const Placed& placed) {
    return {robotMesh(scene.robots[placed.index].model)};
}

Figure humanFigure(const Scene& scene, const Placed& placed) {
    return figureOfHuman(scene.records[placed.record].number("height"));
}

struct FigureOf {
    std::string_view keyword;
    Figure (*make)(const Scene&, const Placed&);
};

constexpr FigureOf kFigures[] = {{"laser", laserFigure},   {"ranger", rangerFigure},
                                 {"camera", cameraFigure}, {"ultrasound", ultrasoundFigure},
                                 {"tag", tagFigure},       {"mat", matFigure},
                                 {"gate", gateFigure},     {"robot", robotFigure},
                                 {"human", humanFigure}};

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

}  // namespace

std::vector<Mesh> figureOf(const Scene& scene, const Placed& placed) {
    const std::string& keyword = scene.records[placed.record].keyword();
    const auto* figure =
        std::find_if(std::begin(kFigures), std::end(kFigures),
                     [&](const FigureOf& known) { return known.keyword == keyword; });
    return figure == std::end(kFigures) ? Figure() : figure->make(scene, placed);
}

Mesh sensorMesh() {
    constexpr double kHalf = 0.025, kHalfHeight = 0.035, kNose = 0.05;
    Mesh mesh = meshOf(Material::Sensor);
    for (const double z : {-kHalfHeight, kHalfHeight})
        for (const auto& [x, y] :
             {Point2{-kHalf, -kHalf}, {kHalf, -kHalf}, {kHalf, kHalf}, {-kHalf, kHalf}})
            mesh.vertices.push_back({x, y, z});
    mesh.vertices.push_back({kNose, 0, 0});
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4}, {2, 3, 7},
                      {2, 7, 6}, {3, 0, 4}, {3, 4, 7}, {1, 2, 8}, {2, 6, 8}, {6, 5, 8}, {5, 1, 8}};
    return mesh;
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

std::vector<Mesh> figureOfHuman(double height) {
    const double h = height;
    Mesh skin = meshOf(Material::Skin), cloth = uprights(Material::Cloth, legs(h), 0, kHip * h);
    addBall(skin, {0, 0, (1 - kHead) * h}, kHead * h);
    addBox(cloth, {-kBodyDepth / 2 * h, -kBodyWidth / 2 * h, kHip * h},
           {kBodyDepth / 2 * h, kBodyWidth / 2 * h, kShoulder * h});
    for (const double side : {-1.0, 1.0}) {
        const double near = side * kBodyWidth / 2 * h, far = side * (kBodyWidth / 2 + kArm) * h;
        const auto add = [&](Mesh& mesh, double low, double high) {
            addBox(mesh, {-kArm / 2 * h, std::min(near, far), low * h},
                   {kArm / 2 * h, std::max(near, far), high * h});
        };
        add(cloth, kWrist, kShoulder);
        add(skin, kFingers, kWrist);
    }
    return {std::move(skin), std::move(cloth)};
}

std::vector<Upright> uprightsOfHuman(double height) {
    const double h = height;
    std::vector<Upright> parts;
    const auto box = [&](double y, double half_length, double half_width, double low, double high) {
        parts.push_back({{0, y}, half_length, half_width, 0, low * h, high * h});
    };
    for (const double side : {-1.0, 1.0}) {
        parts.push_back({{0, side * kLegPlace * h}, 0, 0, kLeg * h, 0, kHip * h});
        box(side * (kBodyWidth + kArm) / 2 * h, kArm / 2 * h, kArm / 2 * h, kFingers, kShoulder);
    }
    box(0, kBodyDepth / 2 * h, kBodyWidth / 2 * h, kHip, kShoulder);
    parts.push_back({{0, 0}, 0, 0, kHead * h, kShoulder * h, h});
    return parts;
}

std::vector<Polygon> legCircles(double height) {
    return kScanHeight <= kHip * height ? legs(height) : std::vector<Polygon>();
}

double humanRadius(double height) { return (kBodyWidth / 2 + kArm) * height; }

}  // namespace ispace
