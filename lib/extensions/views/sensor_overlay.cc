// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/views/sensor_overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "base/error.h"
#include "coverage/visible_area.h"
#include "drawing/drawing.h"
#include "scene/sensor/sensor.h"
#include "sense/scan.h"
#include "sense/selection.h"
#include "trace/ray_world.h"

namespace ispace::views {

namespace {

/// Number of rays along the rim of a view cube, equal for all edges of a picture.
constexpr int kRimRays = 96;
constexpr int kMaxDrawnBeams = 120;

/// Finds the last direction in view from `inside`, which is in view, to `rim`.
template <typename IsSeen>
double edgeOf(const IsSeen& is_seen, double inside, double rim) {
    constexpr int kHalvings = 30;
    for (int i = 0; i < kHalvings; ++i) {
        const double middle = (inside + rim) / 2;
        (is_seen(middle) ? inside : rim) = middle;
    }
    return inside;
}

/// Returns directions along the edges of the picture, or along the lens's limit within it.
std::vector<Vec3> rimOf(const Camera& camera) {
    std::vector<Vec3> rim;
    constexpr int kPerEdge = kRimRays / 4;
    const double right = camera.columns - 0.5, bottom = camera.rows - 0.5;
    const std::array<PixelPoint, 5> corners = {
        {{-0.5, -0.5}, {right, -0.5}, {right, bottom}, {-0.5, bottom}, {-0.5, -0.5}}};
    for (std::size_t edge = 0; edge < 4; ++edge)
        for (int i = 0; i < kPerEdge; ++i) {
            const double share = 1.0 * i / kPerEdge;
            const PixelPoint a = corners[edge], b = corners[edge + 1];
            const PixelPoint end{a.column + share * (b.column - a.column),
                                 a.row + share * (b.row - a.row)};
            const auto ray = [&](double way) {
                return camera.ray({camera.cx + way * (end.column - camera.cx),
                                   camera.cy + way * (end.row - camera.cy)});
            };
            const double way =
                ray(1) ? 1 : edgeOf([&](double w) { return ray(w).has_value(); }, 0, 1);
            rim.push_back(ray(way).value_or(Vec3{1, 0, 0}));
        }
    return rim;
}

std::vector<Vec3> rimOf(const FieldOfView& view) {
    std::vector<Vec3> rim;
    for (int i = 0; i < kRimRays; ++i) {
        // With this many rays, corners of pictures of any shape are hit closely.
        const double turn = 2 * std::numbers::pi * i / kRimRays;
        const auto ray = [turn](double angle) {
            return Vec3{std::cos(angle), std::sin(angle) * std::cos(turn),
                        std::sin(angle) * std::sin(turn)};
        };
        constexpr double kBehind = 0.999 * std::numbers::pi;
        rim.push_back(ray(edgeOf([&](double a) { return view.points(ray(a)); }, 0, kBehind)));
    }
    return rim;
}

/// Returns bodiesOf() with swinging limbs.
std::vector<MovingBody> bodiesWith(std::span<const Angle> swings, const Scene& scene) {
    std::vector<MovingBody> bodies = bodiesOf(scene);
    if (swings.empty()) return bodies;
    bodies.resize(scene.robots.size());
    for (std::size_t i = 0; i < scene.people.size(); ++i)
        addHumanBodies(scene.people[i].height, scene.people[i].pose,
                       kFirstPerson + static_cast<std::uint32_t>(i), swings[i], {}, bodies,
                       scene.people[i].figure.get());
    return bodies;
}

/// Casts rays at all standing bodies that block light.
class Sightlines {
  public:
    Sightlines(const Scene& scene, std::span<const Angle> swings)
        : worlds_(scene.environment),
          bodies_(bodiesWith(swings, scene)),
          plan_(scene.environment.limits()),
          height_(scene.environment.height()) {
        worlds_.prepareMesh();
        reach_ = std::hypot(plan_.width(), plan_.depth());
    }

    /// Returns the ends of rays from a sensor, by their directions in its frame: at obstacles, or
    /// at a length that keeps the view cubes of many sensors apart.
    [[nodiscard]] std::vector<Point3> ends(const Sensor& sensor, const std::vector<Vec3>& rays,
                                           const FieldOfView& view) const {
        const Frame3 frame(sensor.pose);
        Directions directions;
        directions.resize(rays.size());
        for (std::size_t i = 0; i < rays.size(); ++i) directions.set(i, frame * rays[i]);
        std::vector<float> ranges(rays.size());
        worlds_.mesh().cast(frame.origin, directions, reach_, ranges);
        bodies_.shorten(frame.origin, directions, reach_, carrierOf(sensor), ranges);
        constexpr double kLength = 0.25;  // of the plan's size
        const double most = std::min(view.max_range, kLength * reach_);
        // A flat end, if the cube is not too wide.
        constexpr double kSteepest = 0.4;
        std::vector<Point3> ends;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            double range = most / std::max(rays[i].x, kSteepest);
            range = std::min(range, wayOut(frame.origin, directions[i]));
            ends.push_back(frame.origin +
                           std::min(static_cast<double>(ranges[i]), range) * directions[i]);
        }
        return ends;
    }

    /// Computes the distance at which a ray leaves the plan or passes above its walls: a room may
    /// lack a ceiling, and windows may be open.
    [[nodiscard]] double wayOut(Point3 origin, Vec3 direction) const {
        double way = std::numeric_limits<double>::infinity();
        const auto limit = [&way](double room, double speed) {
            if (room > 0 && speed > 0) way = std::min(way, room / speed);
        };
        limit(plan_.high.x - origin.x, direction.x);
        limit(origin.x - plan_.low.x, -direction.x);
        limit(plan_.high.y - origin.y, direction.y);
        limit(origin.y - plan_.low.y, -direction.y);
        limit(height_ - origin.z, direction.z);
        return way;
    }

    [[nodiscard]] std::vector<float> ranges(const Sensor& laser) {
        worlds_.prepare(laser.pose);
        LaserCaster caster(worlds_, bodies_, laser, false, {});
        Scan scan;
        scan.pose = laser.pose;
        caster.cast(scan);
        return std::move(scan.ranges);
    }

  private:
    RayScenes worlds_;
    MovingBodies bodies_;
    Box2 plan_;
    double height_, reach_ = 0;
};

/// Returns the sides of a pyramid from `apex` to a rim.
Mesh cubeOf(Point3 apex, const std::vector<Point3>& rim) {
    Mesh mesh;
    mesh.material = Material::View;
    mesh.open = true;
    mesh.vertices = rim;
    mesh.vertices.push_back(apex);
    const auto count = static_cast<std::uint32_t>(rim.size());
    for (std::uint32_t i = 0; i < count; ++i) mesh.triangles.push_back({i, (i + 1) % count, count});
    return mesh;
}

void addCube(SensorOverlay& marks, const Sightlines& sightlines, const Sensor& sensor,
             Color color) {
    const std::optional<FieldOfView> view = fieldOfView(sensor);
    if (!view) return;
    const bool is_camera = sensor.is<Camera>();
    const std::vector<Vec3> rays = is_camera ? rimOf(sensor.as<Camera>()) : rimOf(*view);
    std::vector<Point3> ends = sightlines.ends(sensor, rays, *view);
    const Point3 apex = sensor.pose.position;
    constexpr float kOpacity = 0.16F;
    marks.paint.push_back({cubeOf(apex, ends), linearOf(color), kOpacity, false});
    const Color edge = color.faded(0.85);
    if (is_camera)
        for (std::size_t i = 0; i < ends.size(); i += kRimRays / 4)
            marks.lines.push_back({{apex, ends[i]}, edge});
    ends.push_back(ends.front());
    marks.lines.push_back({std::move(ends), edge});
}

/// True if a sensor's unobstructed view contains the point, or the sensor is there.
bool isWithin(std::optional<Point3> place, const Sensor& sensor) {
    const std::optional<FieldOfView> view = fieldOfView(sensor);
    return place && view && (*place == sensor.pose.position || view->holds(*place));
}

void addBeams(SensorOverlay& marks, Sightlines& sightlines, const Sensor& sensor, Color color) {
    const auto& laser = sensor.as<Laser>();
    const std::vector<float> ranges = sightlines.ranges(sensor);
    const int step = 1 + (laser.beams - 1) / kMaxDrawnBeams;
    for (int i = 0; i < laser.beams; i += step) {
        const auto k = static_cast<std::size_t>(i);
        const double range = std::min(static_cast<double>(ranges[k]), laser.max_range);
        const Point3 end = sensor.pose.position + range * sensor.pose.beam(laser.bearing(i));
        marks.lines.push_back({{sensor.pose.position, end}, color.faded(0.6), 0.8});
    }
}

}  // namespace

Color sensorColor(std::size_t index) {
    // Skips black, the colour of walls.
    constexpr std::array<std::size_t, 6> kOrder = {3, 0, 1, 2, 4, 6};
    return seriesColor(kOrder[index % kOrder.size()]);
}

Rgb linearOf(const Color& color) {
    const auto linear = [](double x) {
        return static_cast<float>(x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4));
    };
    return {linear(color.red), linear(color.green), linear(color.blue)};
}

SensorOverlay sightMarks(const Scene& scene, bool beams, std::optional<Point3> viewer,
                         std::span<const Angle> swings) {
    SensorOverlay marks;
    Sightlines sightlines(scene, swings);
    for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
        const Sensor& sensor = scene.sensors[i];
        if (!sensor.is<Laser>() && !isWithin(viewer, sensor))
            addCube(marks, sightlines, sensor, sensorColor(i));
        else if (beams && sensor.is<Laser>() && sensor.as<Laser>().sweep == SweepAxis::None)
            addBeams(marks, sightlines, sensor, sensorColor(i));
    }
    return marks;
}

namespace {

/// Merges cells of a set into rectangles, row by row.
std::vector<Polygon> rectanglesOf(const CellSet& cells, const Grid& grid) {
    const double width = grid.limits.width() / grid.columns;
    const double depth = grid.limits.depth() / grid.rows;
    std::vector<Polygon> out;
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column) {
            const int first = column;
            while (column < grid.columns && cells.test(grid.cell(column, row))) ++column;
            if (column == first) continue;
            const Point2 low = grid.limits.low + Vec2{first * width, row * depth};
            const Point2 high = grid.limits.low + Vec2{column * width, (row + 1) * depth};
            out.push_back({low, {high.x, low.y}, high, {low.x, high.y}});
        }
    return out;
}

}  // namespace

FloorColors::FloorColors(const Scene& scene) : limits_(scene.environment.limits()) {
    constexpr double kMaxPixels = 2400, kFinest = 100;
    scale_ = std::min(kFinest, kMaxPixels / std::max(limits_.width(), limits_.depth()));
    columns_ = std::max(1, static_cast<int>(std::ceil(scale_ * limits_.width())));
    rows_ = std::max(1, static_cast<int>(std::ceil(scale_ * limits_.depth())));
    sums_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    RayScenes worlds(scene.environment);
    const VisibleArea sight(scene.environment, 0, &worlds);
    constexpr int kCells = 400;
    const double cell = std::max(limits_.width(), limits_.depth()) / kCells;
    const Grid grid{limits_, std::max(1, static_cast<int>(limits_.width() / cell)),
                    std::max(1, static_cast<int>(limits_.depth() / cell))};
    for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
        const Sensor& sensor = scene.sensors[i];
        if (!kindOf(sensor.model).perceives) continue;
        std::vector<Polygon> seen;
        if (const auto region = sight.regionOf(sensor)) {
            for (const Curve& curve : *region) seen.push_back(chords(curve, 0.5 / scale_));
        } else {
            sight.prepare(sensor);
            seen = rectanglesOf(sight.cellsOf(grid, sensor), grid);
        }
        add(seen, sensorColor(i));
    }
}

void FloorColors::add(const std::vector<Polygon>& seen, const Color& color) {
    const Box2 box = bounds(seen);
    if (box.empty()) return;
    // Only the pixels near it: there may be thousands of sensors.
    const auto pixel = [this](double metres, int most) {
        return std::clamp(static_cast<int>(std::floor(scale_ * metres)), 0, most);
    };
    const int left = pixel(box.low.x - limits_.low.x, columns_ - 1);
    const int right = pixel(box.high.x - limits_.low.x, columns_ - 1) + 1;
    const int top = pixel(limits_.high.y - box.high.y, rows_ - 1);
    const int bottom = pixel(limits_.high.y - box.low.y, rows_ - 1) + 1;
    Picture floor(right - left, bottom - top);
    floor.pushView(
        {scale_, {limits_.low.x + left / scale_, limits_.high.y - top / scale_}, {0, 0}});
    floor.area(seen, {Color{}});
    floor.pop();
    const Image image = rasterOf(floor);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const auto share = 1 - static_cast<float>(image.pixels[i] & 0xFFU) / 255;
        const auto wide = static_cast<std::size_t>(image.width);
        Sum& sum =
            sums_[(static_cast<std::size_t>(top) + i / wide) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(left) + i % wide];
        sum.color[0] += share * static_cast<float>(color.red);
        sum.color[1] += share * static_cast<float>(color.green);
        sum.color[2] += share * static_cast<float>(color.blue);
        sum.sensors += share;
    }
}

Rgb FloorColors::at(Point2 place) const {
    const auto x = static_cast<int>(std::floor(scale_ * (place.x - limits_.low.x)));
    const auto y = static_cast<int>(std::floor(scale_ * (limits_.high.y - place.y)));
    if (x < 0 || y < 0 || x >= columns_ || y >= rows_) return {1, 1, 1};
    const Sum& sum = sums_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                           static_cast<std::size_t>(x)];
    if (sum.sensors <= 0) return {1, 1, 1};
    // The mean colour, deeper for each further sensor, up to a limit that keeps it light.
    constexpr double kOne = 0.38, kEachMore = 0.07, kMaxDepth = 0.6;
    const double share = std::min(sum.sensors, 1.0F);
    const double depth = share * std::min(kOne + kEachMore * (sum.sensors - share), kMaxDepth);
    const Color mean{sum.color[0] / sum.sensors, sum.color[1] / sum.sensors,
                     sum.color[2] / sum.sensors};
    return linearOf(tint(mean, depth));
}

namespace {

bool isPartOfWall(const Element& element) {
    const std::string& keyword = element.record.keyword();
    return keyword == "wall" || keyword == "ispace" || keyword == "fence" || keyword == "door" ||
           keyword == "window";
}

struct Crossing {
    Point2 middle;
    Vec2 across;  ///< from the middle to just beside the wall
};

/// Crosses the longest edge, or the line.
Crossing crossingOf(std::span<const Point2> footprint) {
    Vec2 longest{}, sum{};
    for (std::size_t i = 0; i < footprint.size(); ++i) {
        const Vec2 edge = footprint[(i + 1) % footprint.size()] - footprint[i];
        if (length(edge) > length(longest)) longest = edge;
        sum = sum + (footprint[i] - Point2());
    }
    const Point2 middle = Point2() + 1.0 / static_cast<double>(footprint.size()) * sum;
    const Vec2 unit = 1 / length(longest) * perpendicular(longest);
    double half = 0;
    for (const Point2& p : footprint) half = std::max(half, std::fabs(dot(p - middle, unit)));
    constexpr double kBeside = 0.05;
    return {middle, (half + kBeside) * unit};
}

void addPlate(Mesh& mesh, std::span<const Point2> outline, double z) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Point2& p : outline) mesh.vertices.push_back({p.x, p.y, z});
    for (std::uint32_t i = 2; i < outline.size(); ++i)
        mesh.triangles.push_back({first, first + i - 1, first + i});
}

void addStrip(Mesh& mesh, const Segment2& line, double half_width, double z) {
    const Vec2 along = half_width / distance(line.a, line.b) * (line.b - line.a);
    const Vec2 side = perpendicular(along);
    const Point2 a = line.a - along, b = line.b + along;
    addPlate(mesh, std::array{a - side, b - side, b + side, a + side}, z);
}

}  // namespace

bool WallTops::isBetween(const Element& element, std::span<const Point2> footprint) const {
    if (!standpoint_.looks_in || !standpoint_.place || !isPartOfWall(element)) return false;
    const auto [middle, across] = crossingOf(footprint);
    const Vec2 way = standpoint_.place->onFloor() - middle;
    const Vec2 outward = dot(way, across) < 0 ? -across : across;
    const Regions& indoor = scene_.environment.indoor();
    return indoor.locate(middle + outward) != Side::Inside &&
           indoor.locate(middle - outward) == Side::Inside;
}

PaintedMesh WallTops::paint() const {
    PaintedMesh tops{{}, linearOf(palette::kWall), 1, false};
    tops.mesh.material = Material::Wall;
    tops.mesh.open = true;
    constexpr double kAbove = 0.003;
    // Visible as a line in pictures of whole buildings, too.
    constexpr double kThin = 0.03, kThick = 0.2, kOfPlan = 0.0009;
    const Box2& plan = scene_.environment.limits();
    const double half_width =
        std::clamp(kOfPlan * std::max(plan.width(), plan.depth()), kThin, kThick);
    const auto height = [&](const Element& element, std::span<const Point2> footprint,
                            double bottom, double top) {
        return (isBetween(element, footprint) ? bottom : top) + kAbove;
    };
    for (const Element& element : scene_.environment.elements()) {
        if (!isPartOfWall(element)) continue;
        for (const Sheet& sheet : element.body.sheets) {
            const std::array line{sheet.line.a, sheet.line.b};
            addStrip(tops.mesh, sheet.line, half_width,
                     height(element, line, sheet.bottom, sheet.top));
        }
        for (const Prism& prism : element.body.prisms)
            if (isStrictlyConvex(prism.footprint))
                addPlate(tops.mesh, prism.footprint,
                         height(element, prism.footprint, prism.bottom, prism.top));
    }
    return tops;
}

}  // namespace ispace::views
