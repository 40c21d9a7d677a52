// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/outside_view.h"

#include <algorithm>
#include <utility>

#include "coverage/metrics.h"
#include "coverage/pixel_density.h"
#include "geom/curve_clip.h"
#include "geom/overlay/overlay.h"

namespace ispace {

namespace {

CellSet cellsInside(const std::vector<Curve>& region, const Grid& grid) {
    if (region.empty()) return CellSet(grid.size());
    const Overlay overlay(std::vector<Layer>{{.curves = region}});
    const std::vector<Polygon> outlines =
        curvesOf(overlay.regions([](const LayerLabel& label) { return label.count > 0; }));
    return cellsWithin(grid, outlines);
}

std::vector<Curve> movedTo(const Pose2& pose, std::vector<Curve> curves) {
    for (Curve& curve : curves)
        for (CurveEdge& edge : curve) {
            edge.from = pose * edge.from;
            edge.to = pose * edge.to;
            if (edge.isArc()) edge.center = pose * edge.center;
        }
    return curves;
}

}  // namespace

bool seesOutside(const Sensor& sensor) {
    const SensorKind& kind = kindOf(sensor.model);
    const Camera* const camera = sensor.tryAs<Camera>();
    return kind.perceives && kind.together <= 1 && kind.stopped_by == Surfaces::Opaque &&
           fieldOfView(sensor).has_value() &&
           (camera == nullptr || !camera->isLopsided() || camera->fillsPicture());
}

OutsideView viewThrough(const ShadowCaster& caster, const Sensor& sensor, double plane,
                        double density, double reach) {
    OutsideView view{sensor, {}, {}};
    std::visit([reach](auto& model) { model.max_range = std::min(model.max_range, reach); },
               view.sensor.model);
    view.whole = caster.regionSeen(view.sensor, plane).value_or(std::vector<Curve>());
    view.region = view.whole;
    if (Camera* const camera = std::get_if<Camera>(&view.sensor.model);
        camera != nullptr && density > 0 && !view.whole.empty()) {
        Sensor dense = view.sensor;
        dense.model = withDensity(*camera, density);
        view.region = caster.regionSeen(dense, plane).value_or(std::vector<Curve>());
    }
    return view;
}

OutsideView moved(OutsideView view, const Pose2& pose, double lift) {
    Pose3& at = view.sensor.pose;
    const Point2 foot = pose * at.position.onFloor();
    at.position = {foot.x, foot.y, at.position.z + lift};
    at.heading = at.heading + pose.heading;
    view.region = movedTo(pose, std::move(view.region));
    view.whole = movedTo(pose, std::move(view.whole));
    return view;
}

SensorView sensorViewOf(const OutsideView& view, std::size_t index, const Grid& grid,
                        const Box2& limits, const CoverageOptions& options) {
    const Sensor& sensor = view.sensor;
    SensorView out{.kind = &kindOf(sensor.model),
                   .index = index,
                   .id = sensor.id,
                   .model = deviceName(sensor.model),
                   .pose = sensor.pose,
                   .max_range = maxRange(sensor.model)};
    const auto cells = [&](const std::vector<Curve>& region, double density) {
        return view.cells ? view.cells(grid, density) : cellsInside(region, grid);
    };
    out.cells = cells(view.region, options.density);
    out.cells.crop();
    if (options.exact) setRegion(view.region, limits, out);
    if (const Camera* const camera = sensor.tryAs<Camera>()) {
        CoveredSet whole{options.density > 0 ? cells(view.whole, 0) : out.cells, {}};
        if (options.exact) whole.region = cutAlong(view.whole, limits).inside;
        out.classes = classesOf(FloorDensity(*camera, sensor.pose, options.plane), grid, whole);
    }
    return out;
}

}  // namespace ispace
