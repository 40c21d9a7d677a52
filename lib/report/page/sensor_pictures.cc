// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/number.h"
#include "drawing/plan/plan.h"
#include "geom/curve.h"
#include "raster/contour.h"
#include "raster/grid.h"
#include "report/page/installation.h"
#include "sense/photo.h"

namespace ispace {

namespace {

constexpr double kShare = 0.31;  // of the column's width

/// Reduces a camera to a picture of about this width.
Sensor reduced(const Sensor& sensor) {
    constexpr double kWidth = 320;
    Sensor small = sensor;
    Camera& camera = small.as<Camera>();
    const double factor = std::min(1.0, kWidth / camera.columns);
    camera.columns = std::max(1, static_cast<int>(std::lround(factor * camera.columns)));
    camera.rows = std::max(1, static_cast<int>(std::lround(factor * camera.rows)));
    for (double* length : {&camera.fx, &camera.fy}) *length *= factor;
    camera.cx = factor * (camera.cx + 0.5) - 0.5;
    camera.cy = factor * (camera.cy + 0.5) - 0.5;
    return small;
}

PageFigure photoOf(const Photographer& photographer, const Sensor& sensor) {
    const Sensor small = reduced(sensor);
    const Photo photo = photographer.take(small, small.pose, 0);
    const Camera& camera = small.as<Camera>();
    Image image{camera.columns, camera.rows, {}};
    image.pixels.reserve(camera.pixels());
    constexpr unsigned kRed = 16, kGreen = 8;
    for (std::size_t i = 0; i < camera.pixels(); ++i)
        image.pixels.push_back(std::uint32_t{photo.rgb[3 * i]} << kRed |
                               std::uint32_t{photo.rgb[3 * i + 1]} << kGreen |
                               photo.rgb[3 * i + 2]);
    Picture picture(camera.columns, camera.rows);
    picture.describe("picture of " + sensor.id, "");
    picture.image({0, 0}, std::move(image), 1, 1);
    return {sensor.id + ": picture", std::move(picture), kShare};
}

/// Draws the floor that a sensor sees, to fill the figure.
PageFigure regionOf(const Coverage& coverage, const SensorView& view) {
    constexpr double kSide = 300, kRim = 14, kEm = 15;
    std::vector<Polygon> curves;
    if (view.region)
        for (const Curve& curve : *view.region) curves.push_back(chords(curve, 0.01));
    else
        curves = contours(coverage.target.grid, view.cells);
    const Point2 at = view.pose.position.onFloor();
    Box2 box{at, at};
    for (const Polygon& curve : curves)
        for (const Point2 p : curve) box.add(p);
    const double extent = std::max({box.width(), box.depth(), 0.1});
    const double scale = (kSide - 2 * kRim) / extent;
    Picture picture(kSide, std::ceil(scale * box.depth() + 2 * kRim + 2 * kEm));
    picture.describe("floor that " + view.id + " sees", "");
    const PageView page{scale, {box.low.x, box.high.y}, {(kSide - scale * box.width()) / 2, kRim}};
    picture.pushView(page);
    picture.area(curves, {palette::kBoth.faded(0.5), Stroke{palette::kInk, 1}});
    picture.pop();
    drawSensorMark(picture, page * at, {view.kind->sign, headingOf(view.pose), palette::kSensor},
                   0.36 * kEm);
    drawScaleBar(picture, {kRim, picture.height() - 0.6 * kEm}, 0.4 * kSide, scale, 0.8 * kEm);
    return {view.id + ": the floor that it sees", std::move(picture), kShare};
}

}  // namespace

std::vector<PageFigure> sensorPictures(const Scene& scene, const Coverage& coverage) {
    std::vector<PageFigure> figures;
    std::optional<Photographer> photographer;
    for (const SensorView& view : coverage.sensors) {
        const Sensor& sensor = scene.sensors[view.index];
        if (sensor.mount || sensor.person) continue;
        if (!sensor.is<Camera>()) {
            figures.push_back(regionOf(coverage, view));
            continue;
        }
        if (!photographer) photographer.emplace(scene, PhotoOptions{});
        figures.push_back(photoOf(*photographer, sensor));
    }
    return figures;
}

}  // namespace ispace
