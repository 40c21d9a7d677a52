// SPDX-License-Identifier: GPL-3.0-or-later
// Computes pixel densities of all cameras.
#include "coverage/pixel_density.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/error.h"
#include "coverage/dense_floor.h"
#include "coverage/shadow_footprint.h"
#include "geom/arrangement.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"
#include "geom/tolerance.h"
#include "scene/sensor/density_classes.h"

namespace ispace {

FloorDensity::FloorDensity(const Camera& camera, const Pose3& pose, double plane)
    : focal_(std::min(camera.fx, camera.fy)),
      drop_(plane - pose.position.z),
      is_by_depth_(camera.lens == Lens::Pinhole),
      foot_(pose.position.onFloor()),
      frame_(pose),
      axis_(frame_.forward),
      slope_(std::hypot(axis_.x, axis_.y)) {
    if (!LensResolution::isEven(camera)) lens_.emplace(camera);
}

double FloorDensity::at(Point2 place) const {
    const Vec2 way = place - foot_;
    if (lens_) return lens_->densityAt(localOf(way));
    const double far = is_by_depth_ ? axis_.x * way.x + axis_.y * way.y + axis_.z * drop_
                                    : std::hypot(way.x, way.y, drop_);
    return far > 0 ? focal_ / far : std::numeric_limits<double>::infinity();
}

namespace {

std::vector<Curve> movedTo(Point2 foot, std::vector<Curve> curves) {
    const Vec2 way = foot - Point2{};
    for (Curve& curve : curves)
        for (CurveEdge& edge : curve)
            edge = {edge.from + way, edge.to + way, edge.radius, edge.center + way};
    return curves;
}

}  // namespace

DenseFloor FloorDensity::denseFloor(const Box2& box) const {
    const Vec2 way = Point2{} - foot_;
    return {*lens_, frame_, drop_, Box2{box.low + way, box.high + way}};
}

std::vector<Curve> FloorDensity::least(double pixels_per_metre, const Box2& box) const {
    if (lens_) return movedTo(foot_, denseFloor(box).least(pixels_per_metre));
    const double far = focal_ / pixels_per_metre;
    if (!is_by_depth_) {
        if (!(std::fabs(drop_) < far)) return {};
        return movedTo(foot_, {circleOf(std::sqrt(far * far - drop_ * drop_))});
    }
    const Polygon polygon = {box.low, {box.high.x, box.low.y}, box.high, {box.low.x, box.high.y}};
    const double offset = far - axis_.z * drop_ + axis_.x * foot_.x + axis_.y * foot_.y;
    const Polygon half = halfOf(polygon, Vec2{-axis_.x, -axis_.y}, offset);
    if (half.empty()) return {};
    return {curveOf(half)};
}

namespace {

/// Mean of ln(t) for t from a to b, both positive.
double meanLog(double a, double b) {
    const double step = b - a, middle = a + step / 2;
    if (std::fabs(step) < 1e-2 * middle) {
        const double share = step / middle, squared = share * share;
        return std::log(middle) - squared / 24 - squared * squared / 320;
    }
    return (b * std::log(b) - a * std::log(a)) / step - 1;
}

}  // namespace

/// Computes the contribution of an edge to the integral of focal / depth, by Green's theorem: depth
/// grows along one direction of the plane, and edges are weighted by their extent across it.
double FloorDensity::alongAxis(Point2 a, Point2 b) const {
    constexpr double kNearest = 1e-12;
    const Vec2 uphill{axis_.x / slope_, axis_.y / slope_};
    const auto depth = [&](Point2 p) {
        return std::max(kNearest, slope_ * dot(uphill, p - foot_) + axis_.z * drop_);
    };
    return focal_ / slope_ * cross(uphill, b - a) * meanLog(depth(a), depth(b));
}

/// Likewise of focal / distance, weighted by the angle that an edge spans about the foot.
double FloorDensity::around(Point2 a, Point2 b) const {
    constexpr std::array<double, 4> kPlaces = {-0.861136311594052575, -0.339981043584856265,
                                               0.339981043584856265, 0.861136311594052575};
    constexpr std::array<double, 4> kWeights = {0.347854845137453857, 0.652145154862546143,
                                                0.652145154862546143, 0.347854845137453857};
    const Vec2 from = a - foot_, way = b - a;
    const double high = std::fabs(drop_), scale = high + distance(foot_, Segment2{a, b});
    constexpr double kMaxPieces = 4096;
    const double pieces = std::clamp(std::ceil(2 * length(way) / scale), 1.0, kMaxPieces);
    double sum = 0;
    for (double i = 0; i < pieces; ++i)
        for (std::size_t k = 0; k < kPlaces.size(); ++k) {
            const Vec2 p = from + (i + (1 + kPlaces[k]) / 2) / pieces * way;
            sum += kWeights[k] / 2 / (std::hypot(p.x, p.y, high) + high);
        }
    return focal_ * cross(from, way) * sum / pieces;
}

/// Likewise of the density of a lens, by its integral along the ray from the foot.
double FloorDensity::byLens(Point2 a, Point2 b) const {
    constexpr std::array<double, 4> kPlaces = {-0.861136311594052575, -0.339981043584856265,
                                               0.339981043584856265, 0.861136311594052575};
    constexpr std::array<double, 4> kWeights = {0.347854845137453857, 0.652145154862546143,
                                                0.652145154862546143, 0.347854845137453857};
    const auto along_ray = [&](Vec2 to) {  // the mean of t density(t to), t from 0 to 1
        constexpr int kPieces = 8;
        double sum = 0;
        for (int i = 0; i < kPieces; ++i)
            for (std::size_t k = 0; k < kPlaces.size(); ++k) {
                const double t = (i + (1 + kPlaces[k]) / 2) / kPieces;
                sum += kWeights[k] / 2 / kPieces * t * lens_->densityAt(localOf(t * to));
            }
        return sum;
    };
    const Vec2 from = a - foot_, way = b - a;
    const double scale = std::fabs(drop_) + distance(foot_, Segment2{a, b});
    constexpr double kMaxPieces = 64;
    constexpr double kShort = 0.25, kTwo = 0.577350269189625765;  // two places do for short edges
    if (length(way) < kShort * scale)
        return cross(from, way) / 2 *
               (along_ray(from + (1 - kTwo) / 2 * way) + along_ray(from + (1 + kTwo) / 2 * way));
    const double pieces = std::clamp(std::ceil(2 * length(way) / scale), 1.0, kMaxPieces);
    double sum = 0;
    for (double i = 0; i < pieces; ++i)
        for (std::size_t k = 0; k < kPlaces.size(); ++k)
            sum += kWeights[k] / 2 * along_ray(from + (i + (1 + kPlaces[k]) / 2) / pieces * way);
    return cross(from, way) * sum / pieces;
}

double FloorDensity::integral(std::span<const Curve> curves) const {
    constexpr double kLevel = 1e-9;
    if (!lens_ && is_by_depth_ && slope_ < kLevel)
        return focal_ / std::fabs(axis_.z * drop_) * signedArea(curves);
    constexpr double kLensError = 10 * kConicError;  // of a sum that takes a hundred times longer
    double sum = 0;
    for (const Curve& curve : curves)
        forEachEdge(chords(curve, lens_ ? kLensError : kConicError), [&](const Segment2& edge) {
            sum += lens_          ? byLens(edge.a, edge.b)
                   : is_by_depth_ ? alongAxis(edge.a, edge.b)
                                  : around(edge.a, edge.b);
        });
    return sum;
}

namespace {

/// Bounds the density of an even lens in a view: at the vertices, where depth and distance are
/// greatest, and at the foot. Chords replace arcs: a margin covers their error.
Interval densityRange(const FloorDensity& density, const std::vector<Curve>& region) {
    constexpr double kMargin = 1.01;
    Interval range{std::numeric_limits<double>::infinity(), density.at(density.foot()) * kMargin};
    for (const Curve& curve : region)
        for (const Point2 p : chords(curve, kConicError)) {
            const double pixels = density.at(p);
            range.low = std::min(range.low, pixels / kMargin);
            range.high = std::max(range.high, pixels * kMargin);
        }
    return range;
}

}  // namespace

std::vector<CoveredSet> classesOf(const FloorDensity& density, const Grid& grid,
                                  const CoveredSet& view) {
    const auto classes = densityClasses();
    std::vector<CoveredSet> sets(classes.size());
    for (CoveredSet& set : sets) set.cells = CellSet(grid.size());
    view.cells.forEach([&](std::size_t cell) {
        const double pixels = density.at(grid.center(cell));
        for (std::size_t i = 0; i < classes.size(); ++i)
            if (pixels >= classes[i].pixels_per_metre) sets[i].cells.set(cell);
    });
    for (CoveredSet& set : sets) set.cells.crop();
    if (!view.region) return sets;
    for (CoveredSet& set : sets) set.region.emplace();
    Box2 box = boundsOfAll(*view.region);
    if (box.empty()) return sets;
    constexpr double kAround = 1;
    box = box.expanded(kAround);
    std::optional<DenseFloor> floor;
    if (!density.isEven()) floor.emplace(density.denseFloor(box));
    const Point2 origin = Point2{} + (Point2{} - density.foot());
    const Interval range = floor ? floor->densitiesIn(movedTo(origin, *view.region))
                                 : densityRange(density, *view.region);
    std::vector<Layer> layers = {{.curves = *view.region}};
    std::vector<std::size_t> cut;  // classes whose bound may cross the view, rising
    for (const std::size_t i : classesByDensity()) {
        const double wanted = classes[i].pixels_per_metre;
        if (wanted > range.high) continue;
        if (wanted <= range.low) {
            sets[i].region = *view.region;
            continue;
        }
        std::vector<Curve> dense =
            floor ? movedTo(density.foot(), floor->least(wanted)) : density.least(wanted, box);
        cut.push_back(i);
        if (!dense.empty())
            layers.push_back({.curves = std::move(dense), .counts = false, .marks = classMark(i)});
    }
    if (layers.size() == 1) return sets;
    const Overlay overlay(layers);
    std::uint64_t marks = 0;  // of the class and of all denser ones, which are parts of it
    for (std::size_t k = cut.size(); k-- > 0;) {
        marks |= classMark(cut[k]);
        sets[cut[k]].region = overlay.curves([marks](const LayerLabel& label) {
            return label.count > 0 && (label.marks & marks) != 0;
        });
    }
    return sets;
}

namespace {

/// Adds the least and greatest distance of curves from a point; the least is 0 if they enclose it.
void addDistances(const std::vector<Curve>& curves, Point2 foot, PictureMetrics& metrics) {
    bool is_inside = false;
    for (const Curve& curve : curves) {
        const Polygon polygon = chords(curve);
        is_inside = is_inside != (locate(polygon, foot) == Side::Inside);
        forEachEdge(polygon, [&](const Segment2& edge) {
            metrics.nearest =
                std::min(metrics.nearest.value_or(std::numeric_limits<double>::infinity()),
                         distance(foot, edge));
            metrics.farthest = std::max(metrics.farthest.value_or(0), distance(foot, edge.a));
        });
    }
    if (is_inside) metrics.nearest = 0;
}

}  // namespace

PictureMetrics pictureMetricsOf(const FloorDensity& density, const Grid& grid, Point2 foot,
                                const SensorView& view) {
    PictureMetrics metrics;
    for (const CoveredSet& set : view.classes) {
        Metric area{static_cast<double>(set.cells.count()) * grid.cellArea(), {}};
        if (set.region) area.exact = std::max(0.0, signedArea(*set.region));
        metrics.areas.push_back(area);
    }
    double sum = 0;
    std::size_t cells = 0;
    view.cells.forEach([&](std::size_t cell) {
        const Point2 center = grid.center(cell);
        if (const double pixels = density.at(center); std::isfinite(pixels)) {
            sum += pixels;
            ++cells;
        }
        if (view.region) return;
        const double far = distance(foot, center);
        metrics.nearest = std::min(metrics.nearest.value_or(far), far);
        metrics.farthest = std::max(metrics.farthest.value_or(far), far);
    });
    if (cells > 0) metrics.mean_density.grid = sum / static_cast<double>(cells);
    if (!view.region) return metrics;
    std::vector<Curve> whole = *view.region;
    whole.insert(whole.end(), view.beyond.begin(), view.beyond.end());
    addDistances(whole, foot, metrics);
    const double area = signedArea(*view.region);
    if (area > kMinPiece) metrics.mean_density.exact = density.integral(*view.region) / area;
    return metrics;
}

std::vector<const SensorView*> camerasOf(const Coverage& coverage) {
    std::vector<const SensorView*> cameras;
    for (const SensorView& view : coverage.sensors)
        if (!view.classes.empty()) cameras.push_back(&view);
    return cameras;
}

namespace {

/// Finds curves and walls that may bound floor seen by a camera.
class SeenBoxes {
  public:
    explicit SeenBoxes(const std::vector<const SensorView*>& cameras) {
        constexpr double kMargin = 1e-3;  // above the rounding of an overlay
        std::vector<Box2> boxes;
        for (const SensorView* view : cameras) {
            std::vector<const SharedCurves*> regions = {&*view->region};
            for (const CoveredSet& set : view->classes) regions.push_back(&*set.region);
            for (const SharedCurves* region : regions) {
                const Box2 box = boundsOfAll(*region);
                if (!box.empty()) boxes.push_back(box.expanded(kMargin));
            }
        }
        tree_ = BoxTree(boxes);
    }
    [[nodiscard]] bool meet(const Box2& box) const {
        bool is_met = false;
        tree_.search(box, [&is_met](std::size_t) { is_met = true; });
        return is_met;
    }

  private:
    BoxTree tree_;
};

/// Adds the layers of a camera's view and of its classes. These are parts of each other: those of
/// one area are the same, and share a layer.
void addNested(const SensorView& view, std::vector<Layer>& layers) {
    std::vector<std::pair<double, std::size_t>> known;  // area, layer
    const auto add = [&](const SharedCurves& region, std::uint64_t mark) {
        if (region.empty()) return;
        const double area = signedArea(region);
        for (const auto& [other, layer] : known)
            if (other == area && layers[layer].curves.size() == region.size()) {
                layers[layer].marks |= mark;
                return;
            }
        known.emplace_back(area, layers.size());
        layers.push_back(markLayer(region, mark));
    };
    add(*view.region, kCameraMark);
    for (std::size_t i = 0; i < view.classes.size(); ++i)
        add(*view.classes[i].region, classMark(i));
}

/// Builds the overlay of as many zones from `first` on as fit. Floor away from all cameras may lack
/// its marks unless `is_whole`: it is no part of any metric of densities.
Overlay densityOverlay(const Coverage& coverage, const Environment& environment,
                       const std::vector<Region>& free_floor, std::span<const Zone> zones,
                       bool is_whole) {
    const std::vector<const SensorView*> cameras = camerasOf(coverage);
    const SeenBoxes seen(cameras);
    const auto is_kept = [&](const Box2& box) { return is_whole || seen.meet(box); };
    std::vector<Layer> layers = {markLayer(curvesWithArcs(environment.indoor()), kIndoorMark)};
    std::vector<Curve> free;
    for (const Region& piece : free_floor)
        for (Curve& curve : curvesWithArcs(piece))
            if (is_kept(bounds(curve))) free.push_back(std::move(curve));
    layers.push_back(markLayer(std::move(free), kFreeMark));
    for (const SensorView* view : cameras) addNested(*view, layers);
    for (std::size_t i = 0; i < zones.size(); ++i) {
        Polygon outline = zones[i].outline;
        if (signedArea(outline) < 0) std::reverse(outline.begin(), outline.end());
        layers.push_back(markLayer({curveOf(outline)}, densityZoneMark(i)));
    }
    std::vector<Segment2> walls = environment.slice(coverage.target.height).sheets;
    std::erase_if(walls, [&](const Segment2& wall) { return !is_kept(bounds(wall)); });
    return Overlay(layers, walls);
}

/// Sets the exact shares of the indoor region, the free floor, and the zones from `first` on.
void addShares(CoverageReport& report, const Overlay& overlay, std::size_t first) {
    const std::size_t classes = densityClasses().size();
    const std::size_t zones = std::min(kDensityZones, report.zones.size() - first);
    double seen = 0;
    std::vector<double> indoor(classes), free(classes), by_zone(classes * zones);
    overlay.addAreas([&](const LayerLabel& label, double area) {
        if ((label.marks & kIndoorMark) != 0 && (label.marks & kCameraMark) != 0) seen += area;
        for (std::size_t i = 0; i < classes; ++i) {
            if ((label.marks & classMark(i)) == 0) continue;
            if ((label.marks & kFreeMark) != 0) free[i] += area;
            if ((label.marks & kIndoorMark) == 0) continue;
            indoor[i] += area;
            for (std::size_t zone = 0; zone < zones; ++zone)
                if ((label.marks & densityZoneMark(zone)) != 0) by_zone[zone * classes + i] += area;
        }
    });
    report.densities.seen.exact = shareOf(seen, report.indoor_area);
    for (std::size_t i = 0; i < classes; ++i) {
        report.densities.indoor[i].exact = shareOf(indoor[i], report.indoor_area);
        report.densities.free[i].exact = shareOf(free[i], report.free_area);
        for (std::size_t zone = 0; zone < zones; ++zone)
            report.zones[first + zone].densities[i].exact =
                shareOf(by_zone[zone * classes + i], report.zones[first + zone].area);
    }
}

}  // namespace

CellSet cellsOfClass(const Coverage& coverage, std::size_t index) {
    CellSet cells(coverage.target.grid.size());
    for (const SensorView* view : camerasOf(coverage)) cells |= view->classes[index].cells;
    return cells;
}

void addDensities(Coverage& coverage, const Environment& environment,
                  const std::vector<Region>& free_floor, const std::vector<Zone>& zones,
                  bool is_whole) {
    const std::vector<const SensorView*> cameras = camerasOf(coverage);
    if (cameras.empty()) return;
    CoverageReport& report = coverage.report;
    const std::size_t classes = densityClasses().size();
    report.densities.indoor.resize(classes);
    report.densities.free.resize(classes);
    CellSet seen(coverage.target.grid.size());
    for (const SensorView* view : cameras) seen |= view->cells;
    report.densities.seen.grid = coveredShare(seen, coverage.target.indoor);
    for (ZoneMetrics& zone : report.zones) zone.densities.resize(classes);
    for (std::size_t i = 0; i < classes; ++i) {
        const CellSet cells = cellsOfClass(coverage, i);
        report.densities.indoor[i].grid = coveredShare(cells, coverage.target.indoor);
        report.densities.free[i].grid = coveredShare(cells, coverage.target.free);
        for (std::size_t k = 0; k < zones.size(); ++k) {
            CellSet zone = cellsWithin(coverage.target.grid, std::span(&zones[k].outline, 1));
            zone &= coverage.target.indoor;
            report.zones[k].densities[i].grid = coveredShare(cells, zone);
        }
    }
    const bool is_known = std::all_of(cameras.begin(), cameras.end(), [](const SensorView* view) {
        return view->region && view->classes.front().region;
    });
    if (!is_known) return;
    try {
        std::vector<Overlay> overlays;
        for (std::size_t first = 0; first == 0 || first < zones.size(); first += kDensityZones)
            overlays.push_back(densityOverlay(
                coverage, environment, free_floor,
                std::span(zones).subspan(first, std::min(kDensityZones, zones.size() - first)),
                is_whole));
        coverage.density_overlays = std::move(overlays);
        coverage.are_densities_whole = is_whole;
    } catch (const FormatError&) {
        return;  // too many crossings for an overlay: by cells only
    }
    for (std::size_t i = 0; i < coverage.density_overlays.size(); ++i)
        addShares(report, coverage.density_overlays[i], i * kDensityZones);
}

}  // namespace ispace
