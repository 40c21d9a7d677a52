// SPDX-License-Identifier: GPL-3.0-or-later
// What all cameras together see, by density of pixels and by the angles between their axes.
#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>

#include "base/error.h"
#include "cover/pictures.h"
#include "geom/boolean.h"
#include "geom/tolerance.h"

namespace ispace {

namespace {

std::vector<const SensorView*> camerasOf(const Coverage& coverage) {
    std::vector<const SensorView*> cameras;
    for (const SensorView& view : coverage.sensors)
        if (!view.classes.empty()) cameras.push_back(&view);
    return cameras;
}

Layer markLayer(std::vector<Curve> curves, std::uint64_t marks) {
    return {.curves = std::move(curves), .counts = false, .marks = marks};
}

/// The zones from `first` on, as many as fit.
Overlay densityOverlay(const Coverage& coverage, const Environment& environment,
                       const std::vector<Region>& free_floor, std::span<const Zone> zones) {
    std::vector<Layer> layers = {markLayer(curvesWithArcs(environment.indoor()), kIndoorMark)};
    std::vector<Curve> free;
    for (const Region& piece : free_floor)
        for (Curve& curve : curvesWithArcs(piece)) free.push_back(std::move(curve));
    layers.push_back(markLayer(std::move(free), kFreeMark));
    for (const SensorView* view : camerasOf(coverage)) {
        layers.push_back(markLayer(*view->region, kCameraMark));
        for (std::size_t i = 0; i < view->classes.size(); ++i)
            layers.push_back(markLayer(*view->classes[i].region, classMark(i)));
    }
    for (std::size_t i = 0; i < zones.size(); ++i) {
        Polygon outline = zones[i].outline;
        if (signedArea(outline) < 0) std::reverse(outline.begin(), outline.end());
        layers.push_back(markLayer({curveOf(outline)}, densityZoneMark(i)));
    }
    return Overlay(layers, environment.slice(coverage.target.height).sheets);
}

/// The exact shares, of the indoor region, the free floor, and the zones from `first` on.
void addShares(CoverageReport& report, const Overlay& overlay, std::size_t first) {
    const std::size_t classes = pixelDensities().size();
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
                  const std::vector<Region>& free_floor, const std::vector<Zone>& zones) {
    const std::vector<const SensorView*> cameras = camerasOf(coverage);
    if (cameras.empty()) return;
    CoverageReport& report = coverage.report;
    const std::size_t classes = pixelDensities().size();
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
                std::span(zones).subspan(first, std::min(kDensityZones, zones.size() - first))));
        coverage.density_overlays = std::move(overlays);
    } catch (const FormatError&) {
        return;  // more crossings than can be laid over each other: by cells only
    }
    for (std::size_t i = 0; i < coverage.density_overlays.size(); ++i)
        addShares(report, coverage.density_overlays[i], i * kDensityZones);
}

namespace {

/// Cameras have bits; sets of them are words.
using CameraBits = std::uint64_t;
constexpr std::size_t kMaxExact = 60;

/// Which sets of cameras hold so many whose axes are pairwise far enough apart.
class AxisPairs {
  public:
    AxisPairs(const std::vector<const SensorView*>& cameras, const ParallaxChoice& choice)
        : wanted_(choice.cameras), apart_(cameras.size()) {
        const double most = cos(choice.least) + kUnitTolerance;
        for (std::size_t i = 0; i < cameras.size(); ++i)
            for (std::size_t k = 0; k < cameras.size(); ++k)
                if (i != k &&
                    dot(Frame3(cameras[i]->pose).forward, Frame3(cameras[k]->pose).forward) <= most)
                    apart_[i].push_back(k);
    }
    /// `seen_by[i]`: whether camera i is in the set.
    [[nodiscard]] bool isEnough(const std::vector<bool>& seen_by) const {
        std::vector<std::size_t> all;
        for (std::size_t i = 0; i < seen_by.size(); ++i)
            if (seen_by[i]) all.push_back(i);
        return canChoose(all, wanted_);
    }

  private:
    /// True if `count` of these are pairwise apart.
    [[nodiscard]] bool canChoose(const std::vector<std::size_t>& from, int count) const {
        if (count <= 0) return true;
        if (from.size() < static_cast<std::size_t>(count)) return false;
        for (std::size_t i = 0; i < from.size(); ++i) {
            std::vector<std::size_t> rest;
            for (std::size_t k = i + 1; k < from.size(); ++k)
                if (std::binary_search(apart_[from[i]].begin(), apart_[from[i]].end(), from[k]))
                    rest.push_back(from[k]);
            if (canChoose(rest, count - 1)) return true;
        }
        return false;
    }

    int wanted_;
    std::vector<std::vector<std::size_t>> apart_;
};

std::optional<double> exactShare(const std::vector<const SensorView*>& cameras,
                                 const AxisPairs& pairs, const Environment& environment,
                                 double indoor_area) {
    if (cameras.size() > kMaxExact) return std::nullopt;
    constexpr CameraBits kIndoor = CameraBits{1} << 63U;
    std::vector<Layer> layers = {markLayer(curvesWithArcs(environment.indoor()), kIndoor)};
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        if (!cameras[i]->region) return std::nullopt;
        layers.push_back(markLayer(*cameras[i]->region, CameraBits{1} << i));
    }
    std::unordered_map<CameraBits, bool> known;
    const auto is_enough = [&](CameraBits marks) {
        const auto found = known.find(marks);
        if (found != known.end()) return found->second;
        std::vector<bool> seen_by(cameras.size());
        for (std::size_t i = 0; i < cameras.size(); ++i) seen_by[i] = ((marks >> i) & 1U) != 0;
        return known[marks] = pairs.isEnough(seen_by);
    };
    try {
        const double area = Overlay(layers).area([&](const LayerLabel& label) {
            return (label.marks & kIndoor) != 0 && is_enough(label.marks & ~kIndoor);
        });
        return shareOf(area, indoor_area);
    } catch (const FormatError&) {
        return std::nullopt;
    }
}

}  // namespace

void addParallax(Coverage& coverage, const Environment& environment, const ParallaxChoice& choice) {
    const std::vector<const SensorView*> cameras = camerasOf(coverage);
    const AxisPairs pairs(cameras, choice);
    CoverageReport& report = coverage.report;
    report.parallax = choice;
    CellSet cells(coverage.target.grid.size());
    std::vector<bool> seen_by(cameras.size());
    coverage.target.indoor.forEach([&](std::size_t cell) {
        for (std::size_t i = 0; i < cameras.size(); ++i) seen_by[i] = cameras[i]->cells.test(cell);
        if (pairs.isEnough(seen_by)) cells.set(cell);
    });
    report.parallax_coverage.grid = coveredShare(cells, coverage.target.indoor);
    report.parallax_coverage.exact = exactShare(cameras, pairs, environment, report.indoor_area);
}

}  // namespace ispace
