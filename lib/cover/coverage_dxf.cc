// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "cover/coverage_formats.h"
#include "cover/map_parts.h"
#include "cover/seen_regions.h"
#include "draw/dxf_writer.h"
#include "plan/dxf_plan.h"

namespace ispace {

namespace {

std::string seenLayer(std::uint32_t times) { return "seen-" + std::to_string(times); }

}  // namespace

std::string coverageDxf(const Scene& scene, const Coverage& coverage) {
    const std::vector<std::uint32_t> times = timesSeen(coverage);
    const std::uint32_t most = mostSeen(coverage, times);
    std::vector<DxfLayer> layers = {{"unseen", palette::kLost}};
    for (std::uint32_t k = 1; k <= most; ++k)
        layers.push_back(
            {seenLayer(k), sequentialColor(static_cast<int>(k), static_cast<int>(most))});
    for (DxfLayer& layer : dxfRoomLayers()) layers.push_back(std::move(layer));
    layers.insert(layers.end(), {{"views", palette::kGlass}, {"sensors", palette::kSensor}});
    DxfWriter out(layers);
    // Fillings first: readers draw in the order of the file.
    for (const Region& piece : seenBy(coverage, 0, times)) out.area("unseen", piece);
    for (std::uint32_t k = 1; k <= most; ++k)
        for (const Region& piece : seenBy(coverage, k, times)) out.area(seenLayer(k), piece);
    addRoomToDxf(out, scene.environment);
    for (const SensorView& view : coverage.sensors) {
        if (view.region)
            for (const Curve& curve : *view.region) out.curve("views", curve);
        else
            for (const Region& piece : viewRegions(view, coverage.target.grid))
                for (const Polygon& ring : curvesOf(piece)) out.path("views", ring, true);
        addSensorToDxf(out, view.id, view.pose);
    }
    return out.finish();
}

}  // namespace ispace
