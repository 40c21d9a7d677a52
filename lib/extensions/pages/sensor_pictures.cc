// SPDX-License-Identifier: GPL-3.0-or-later
// Draws a picture for each sensor: of a camera the one that it takes, with people in the zones that
// it serves, of a laser its scan, of others the floor that they see.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/number.h"
#include "coverage/metrics.h"
#include "drawing/plan/plan.h"
#include "extensions/pages/installation.h"
#include "geom/curve.h"
#include "raster/contour.h"
#include "raster/grid.h"
#include "report/map/map_parts.h"
#include "scene/placement_schemas.h"
#include "scene/sensor/lens_resolution.h"
#include "sense/photo.h"
#include "trace/ray_world.h"

namespace ispace::pages {

namespace {

constexpr double kShare = 0.31;      // of the column's width
constexpr double kPersonTall = 1.7;  // metres
constexpr double kFaceHeight = 1.6;  // metres, where pixels a metre count

/// A person on the floor that a camera sees.
struct ServedSpot {
    std::string name;  ///< of the zone; "" without one
    Point2 place;
};

/// Returns a point in the picture of a camera; empty if it is not there.
std::optional<PixelPoint> pixelOf(const Sensor& sensor, Point3 place) {
    const Camera& camera = sensor.as<Camera>();
    const auto pixel = camera.project(Frame3(sensor.pose).toLocal(place));
    return pixel && camera.holds(*pixel) ? pixel : std::nullopt;
}

/// Returns the cell of a set whose centre is nearest to the middle of all of them, of those on
/// which the camera sees a person whole, if there are any, else of those on which it sees the face.
std::optional<Point2> middleCell(const Grid& grid, const CellSet& cells, const Sensor& sensor,
                                 const RayWorld& room) {
    constexpr double kAboveHead = 1.8;  // metres
    std::vector<Point2> centers;
    std::vector<Point3> faces;
    Vec2 sum;
    cells.forEach([&](std::size_t cell) {
        const Point2 center = grid.center(cell);
        centers.push_back(center);
        faces.push_back({center.x, center.y, kFaceHeight});
        sum = sum + (center - Point2{});
    });
    std::vector<std::uint8_t> is_free(faces.size(), 0);
    room.query(sensor.pose.position, faces, is_free);
    const Point2 middle = Point2{} + 1 / std::max(1.0, static_cast<double>(centers.size())) * sum;
    std::optional<Point2> best;
    int most = -1;
    for (std::size_t i = 0; i < centers.size(); ++i) {
        const Point2 center = centers[i];
        const bool is_whole = pixelOf(sensor, {center.x, center.y, kAboveHead}).has_value();
        const int shown = is_free[i] == 0 || !pixelOf(sensor, faces[i]) ? 0 : is_whole ? 2 : 1;
        if (shown < most || (shown == most && distance(center, middle) >= distance(*best, middle)))
            continue;
        best = center;
        most = shown;
    }
    return best;
}

/// Returns a spot in each zone of which the camera sees half or more, or one in the floor that it
/// sees.
std::vector<ServedSpot> spotsOf(const Scene& scene, const Coverage& coverage,
                                const SensorView& view, const RayWorld& room) {
    const Grid& grid = coverage.target.grid;
    const Sensor& sensor = scene.sensors[view.index];
    std::vector<ServedSpot> spots;
    for (const Zone& zone : zonesOf(scene.environment)) {
        CellSet cells = cellsWithin(grid, std::span(&zone.outline, 1));
        const std::size_t all = cells.count();
        cells &= view.cells;
        if (all == 0 || 2 * cells.count() < all) continue;
        CellSet free = cells;
        free &= coverage.target.free;
        if (const auto place = middleCell(grid, free.count() > 0 ? free : cells, sensor, room))
            spots.push_back({zone.id, *place});
    }
    if (!spots.empty()) return spots;
    CellSet free = view.cells;
    free &= coverage.target.free;
    if (const auto place = middleCell(grid, free, sensor, room)) spots.push_back({"", *place});
    return spots;
}

/// Adds people at these spots who face the camera; two in one spot are one.
Scene withPeople(Scene scene, const std::vector<ServedSpot>& spots, Point2 camera) {
    for (const ServedSpot& spot : spots) {
        const Vec2 way = camera - spot.place;
        const Pose2 pose{spot.place, directionOf(way.x, way.y)};
        Record person(*sceneSchemas().find("human"));
        person.set("height", Value(kPersonTall));
        scene.placed.push_back({scene.records.size(),
                                {{spot.place.x, spot.place.y, 0}, pose.heading, {}, {}},
                                scene.people.size()});
        scene.records.push_back(std::move(person));
        scene.ids.emplace_back();
        scene.people.push_back({"", kPersonTall, 0, pose, {}, {}});
    }
    return scene;
}

/// Reduces a camera to a picture of about this width.
Sensor reduced(const Sensor& sensor, double width) {
    Sensor small = sensor;
    Camera& camera = small.as<Camera>();
    const double factor = std::min(1.0, width / camera.columns);
    camera.columns = std::max(1, static_cast<int>(std::lround(factor * camera.columns)));
    camera.rows = std::max(1, static_cast<int>(std::lround(factor * camera.rows)));
    for (double* length : {&camera.fx, &camera.fy}) *length *= factor;
    camera.cx = factor * (camera.cx + 0.5) - 0.5;
    camera.cy = factor * (camera.cy + 0.5) - 0.5;
    return small;
}

Image imageOf(const Photo& photo, const Camera& camera) {
    Image image{camera.columns, camera.rows, {}};
    image.pixels.reserve(camera.pixels());
    constexpr unsigned kRed = 16, kGreen = 8;
    for (std::size_t i = 0; i < camera.pixels(); ++i)
        image.pixels.push_back(std::uint32_t{photo.rgb[3 * i]} << kRed |
                               std::uint32_t{photo.rgb[3 * i + 1]} << kGreen |
                               photo.rgb[3 * i + 2]);
    return image;
}

/// Writes pixels a metre beside the head of a person.
void drawDensityOf(Picture& picture, const Sensor& sensor, const Sensor& small, Point2 place,
                   double above, double em) {
    const auto head = pixelOf(small, {place.x, place.y, kFaceHeight});
    if (!head) return;
    const TextStyle style{em, true, Align::Left, palette::kInk, palette::kWhite.faded(0.9)};
    const std::string text =
        formatFixed(lensDensity(sensor, {place.x, place.y, kFaceHeight}), 0) + " px/m";
    const double wide = textWidth(text, style);
    // Beside the head, 0.25 m off, within the picture.
    const double aside = 0.25 * lensDensity(small, {place.x, place.y, kFaceHeight});
    double x = head->column + aside;
    if (x + wide > picture.width() - 2) x = head->column - aside - wide;
    x = std::clamp(x, 2.0, std::max(2.0, picture.width() - wide - 2));
    const double y = std::clamp(above + head->row + 0.36 * em, above + em,
                                std::max(above + em, picture.height() - 3));
    picture.text({x, y}, text, style);
}

PageFigure photoOf(const Scene& scene, const Coverage& coverage, const SensorView& view,
                   const RayWorld& room, Color color, double width) {
    constexpr double kBand = 0.012;  // of the picture's width, in the sensor's colour
    const Sensor& sensor = scene.sensors[view.index];
    const Sensor small = reduced(sensor, width);
    const std::vector<ServedSpot> spots = spotsOf(scene, coverage, view, room);
    const Scene peopled = withPeople(scene, spots, sensor.pose.position.onFloor());
    // Two samples a pixel, as the page shows the picture at two thirds of its size or less.
    const Photographer photographer(peopled, PhotoOptions{.samples = 2});
    const Camera& camera = small.as<Camera>();
    const double band = std::ceil(kBand * camera.columns);
    Picture picture(camera.columns, camera.rows + band);
    picture.describe("picture of " + sensor.id, "");
    picture.area(Polygon{{0, 0}, {picture.width(), 0}, {picture.width(), band}, {0, band}},
                 {color});
    picture.image({0, band}, imageOf(photographer.take(small, small.pose, 0), camera), 1, 1);
    std::string caption = sensor.id + ": picture";
    std::string_view separator = "; people of 1.70 m: ";
    for (const ServedSpot& spot : spots) {
        drawDensityOf(picture, sensor, small, spot.place, band, 0.042 * camera.columns);
        caption.append(separator).append(spot.name.empty() ? "" : "in " + spot.name + ", ");
        caption += formatFixed(distance(spot.place, sensor.pose.position.onFloor()), 1) + " m, " +
                   formatFixed(lensDensity(sensor, {spot.place.x, spot.place.y, kFaceHeight}), 0) +
                   " px/m";
        separator = "; ";
    }
    return {std::move(caption), std::move(picture), kShare};
}

/// A figure of floor around a sensor, to fill a square.
class FloorFigure {
  public:
    FloorFigure(const SensorView& view, const Box2& box, const std::string& title)
        : picture_(kSide, std::ceil(scaleFor(box) * box.depth() + 2 * kRim + 2 * kEm)),
          page_{scaleFor(box),
                {box.low.x, box.high.y},
                {(kSide - scaleFor(box) * box.width()) / 2, kRim}},
          view_(view) {
        picture_.describe(title, "");
    }

    [[nodiscard]] Picture& picture() { return picture_; }
    [[nodiscard]] const PageView& page() const { return page_; }

    /// Draws the walls about the floor that are level with the sensor.
    void drawWalls(const Scene& scene, double height) {
        const Box2 frame{{2, 2}, {kSide - 2, picture_.height() - 2 * kEm}};
        std::vector<Segment2> lines;
        const auto add = [&](const Segment2& line) {
            if (const auto part = clipped(Segment2{page_ * line.a, page_ * line.b}, frame))
                lines.push_back(*part);
        };
        const Slice slice = scene.environment.slice(height);
        for (const Segment2& line : slice.sheets) add(line);
        for (const Polygon& solid : slice.solids) forEachEdge(solid, add);
        picture_.lines(lines, {Stroke{palette::kWall, 1.5}});
    }

    PageFigure finish(Color color, std::string caption) {
        drawSensorMark(picture_, page_ * view_.pose.position.onFloor(),
                       {view_.kind->sign, headingOf(view_.pose), color}, 0.36 * kEm);
        drawScaleBar(picture_, {kRim, picture_.height() - 0.6 * kEm}, 0.4 * kSide, page_.scale,
                     0.8 * kEm);
        return {std::move(caption), std::move(picture_), kShare};
    }

  private:
    static constexpr double kSide = 300, kRim = 14, kEm = 15;

    static double scaleFor(const Box2& box) {
        return (kSide - 2 * kRim) / std::max({box.width(), box.depth(), 0.1});
    }

    Picture picture_;
    PageView page_;
    const SensorView& view_;
};

/// Draws the floor that a sensor sees.
PageFigure regionOf(const Scene& scene, const Coverage& coverage, const SensorView& view,
                    Color color) {
    std::vector<Polygon> curves;
    if (view.region)
        for (const Curve& curve : *view.region) curves.push_back(chords(curve, 0.01));
    else
        curves = contours(coverage.target.grid, view.cells);
    const Point2 at = view.pose.position.onFloor();
    Box2 box{at, at};
    for (const Polygon& curve : curves)
        for (const Point2 p : curve) box.add(p);
    FloorFigure figure(view, box, "floor that " + view.id + " sees");
    const FittedCurves outline = fitted(std::move(curves), cornersFor(coverage.sensors.size()));
    figure.picture().pushView(figure.page());
    figure.picture().area(outline.curves, {color.faded(0.35), Stroke{color, 1}});
    figure.picture().pop();
    figure.drawWalls(scene, kScanHeight);
    return figure.finish(color, view.id + ": the floor that it sees" + toleranceText(outline));
}

/// Draws the scan of a laser: its beams, with a dot at each return.
PageFigure scanOf(const Scene& scene, const SensorView& view, Color color) {
    constexpr std::size_t kMaxDrawnBeams = 361;
    const Laser& laser = scene.sensors[view.index].as<Laser>();
    const Point2 at = view.pose.position.onFloor();
    const std::size_t stride = (view.beams.size() + kMaxDrawnBeams - 1) / kMaxDrawnBeams;
    Box2 box{at, at};
    std::vector<Segment2> beams, returns;
    for (std::size_t k = 0; k < view.beams.size(); k += stride) {
        const double range = std::min<double>(view.beams[k], view.max_range);
        const Vec3 way = range * view.pose.beam(laser.bearing(static_cast<int>(k)));
        const Point2 end = (view.pose.position + way).onFloor();
        box.add(end);
        beams.push_back({at, end});
        if (view.beams[k] < view.max_range) returns.push_back({end, end});
    }
    FloorFigure figure(view, box, "scan of " + view.id);
    figure.picture().pushView(figure.page());
    figure.picture().lines(beams, {Stroke{color.faded(0.45), 0.6}});
    figure.picture().pop();
    figure.drawWalls(scene, view.pose.position.z);
    figure.picture().pushView(figure.page());
    figure.picture().lines(returns, {Stroke{color, 3}});
    figure.picture().pop();
    std::string caption = view.id + ": its scan of " + std::to_string(view.beams.size()) + " beams";
    if (stride > 1) caption += ", one of " + std::to_string(stride) + " drawn";
    return figure.finish(color, std::move(caption));
}

}  // namespace

double lensDensity(const Sensor& sensor, Point3 place) {
    const Camera& camera = sensor.as<Camera>();
    const Vec3 local = Frame3(sensor.pose).toLocal(place);
    if (camera.lens == Lens::Pinhole && !(local.x > 0)) return 0;
    return LensResolution(camera).densityAt(local);
}

PageFigure floorFigure(const Scene& scene, const Coverage& coverage, std::size_t index) {
    return regionOf(scene, coverage, coverage.sensors[index], sensorColors(coverage)[index]);
}

std::vector<PageFigure> sensorPictures(const Scene& scene, const Coverage& coverage,
                                       Progress* progress) {
    const auto cameras =
        std::count_if(coverage.sensors.begin(), coverage.sensors.end(),
                      [](const SensorView& view) { return view.kind == &Camera::kKind; });
    // Many pictures are smaller, so that the page stays light.
    constexpr double kWide = 576, kNarrow = 360;
    constexpr std::ptrdiff_t kFew = 8;
    const double width = cameras > kFew ? kNarrow : kWide;
    const std::vector<Color> colors = sensorColors(coverage);
    std::optional<RayWorld> room;
    if (cameras > 0) room = RayWorld::ofEnvironment(scene.environment);
    std::vector<PageFigure> figures;
    for (std::size_t i = 0; i < coverage.sensors.size(); ++i) {
        const SensorView& view = coverage.sensors[i];
        if (progress != nullptr) progress->advance(1);
        if (view.index >= scene.sensors.size()) continue;  // of another storey
        const Sensor& sensor = scene.sensors[view.index];
        if (sensor.mount || sensor.person) continue;
        if (sensor.is<Camera>())
            figures.push_back(photoOf(scene, coverage, view, *room, colors[i], width));
        else if (!view.beams.empty() && sensor.as<Laser>().sweep == SweepAxis::None)
            figures.push_back(scanOf(scene, view, colors[i]));
        else
            figures.push_back(regionOf(scene, coverage, view, colors[i]));
    }
    return figures;
}

}  // namespace ispace::pages
