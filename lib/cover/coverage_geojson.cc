// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "base/number.h"
#include "cover/coverage_files.h"
#include "draw/feature_writer.h"
#include "geom/boolean.h"
#include "raster/contour.h"

namespace ispace {

namespace {

/// The most sensors that see one place.
std::uint32_t mostSeeing(const Coverage& coverage, const std::vector<std::uint32_t>& cell_times) {
    if (!coverage.overlay) return *std::max_element(cell_times.begin(), cell_times.end());
    std::int32_t most = 0;
    for (const Overlay::Edge& edge : coverage.overlay->edges())
        most = std::max({most, edge.left.count, edge.right.count});
    return static_cast<std::uint32_t>(most);
}

/// The view of one sensor as pieces.
std::vector<Region> viewOf(const SensorView& view, const Grid& grid) {
    if (!view.region) return cellRegions(grid, view.cells);
    return Overlay(std::vector<Layer>{{.curves = *view.region}})
        .regions([](const LayerLabel& label) { return label.count > 0; });
}

std::vector<Region> seenBy(const Coverage& coverage, std::uint32_t times,
                           const std::vector<std::uint32_t>& cell_times) {
    if (coverage.overlay)
        return coverage.overlay->regions([times](const LayerLabel& label) {
            return label.count == static_cast<std::int32_t>(times) &&
                   (label.marks & kIndoorMark) != 0;
        });
    const Target& target = coverage.target;
    CellSet cells(target.grid.size());
    target.indoor.forEach([&](std::size_t cell) {
        if (cell_times[cell] == times) cells.set(cell);
    });
    return cellRegions(target.grid, cells);
}

}  // namespace

std::string coverageGeoJson(const Scene& scene, const Coverage& coverage) {
    FeatureWriter out;
    const Figure& share = coverage.report.coverage;
    out.json().key("coverage");
    if (const auto known = share.exact ? share.exact : share.grid)
        out.json().value(tidy(*known));
    else
        out.json().null();
    out.beginFeatures();
    out.begin("indoor", "indoor", "region");
    out.endAsArea(scene.environment.indoor().parts);
    out.begin("free", "free", "region");
    out.endAsArea(scene.environment.freeFloor(coverage.target.height));
    const std::vector<std::uint32_t> times = timesSeen(coverage);
    const std::uint32_t most = mostSeeing(coverage, times);
    for (std::uint32_t k = 1; k <= most; ++k) {
        const std::vector<Region> pieces = seenBy(coverage, k, times);
        if (pieces.empty()) continue;
        out.begin("seen-" + std::to_string(k), "seen", "region")
            .key("sensors")
            .value(std::size_t{k});
        out.json().key("area").value(tidy(totalArea(pieces)));
        out.endAsArea(pieces);
    }
    for (const SensorView& view : coverage.sensors) {
        out.begin(view.id, view.kind->keyword, "placement");
        out.json().key("heading").value(tidy(view.pose.heading.degrees()));
        out.endAsPoint(view.pose.position.onFloor());
        out.begin(view.id, "view", "region");
        out.endAsArea(viewOf(view, coverage.target.grid));
    }
    for (std::size_t i = 0; i < coverage.report.unseen.size(); ++i) {
        const UnseenSpot& spot = coverage.report.unseen[i];
        out.begin("unseen-" + std::to_string(i + 1), "unseen", "spot")
            .key("area")
            .value(tidy(spot.area));
        out.endAsPoint(spot.place);
    }
    return out.finish();
}

}  // namespace ispace
