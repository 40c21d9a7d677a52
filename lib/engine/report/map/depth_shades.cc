// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/map/depth_shades.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/error.h"
#include "coverage/metrics.h"
#include "env/level.h"
#include "report/map/map_parts.h"

namespace ispace {

void addDepthShades(Coverage& coverage, const Scene& scene, std::uint32_t scale) {
    if (!coverage.overlay) return;
    std::vector<Layer> layers;
    layers.reserve(coverage.sets.size() + 1);
    for (std::size_t i = 0; i < coverage.sets.size(); ++i)
        layers.push_back(
            {.curves = *coverage.sets[i].region, .number = static_cast<std::int64_t>(i) + 1});
    layers.push_back(markLayer(curvesWithArcs(scene.environment.indoor()), kIndoorMark));
    const Shades shades = shadesFor(coverage.report, scale);
    const auto shade_of = [&shades](const LayerLabel& label) {
        LayerLabel shade{.marks = label.marks};
        if (label.count == 1) {
            shade.count = 1;
            shade.numbers = label.numbers;
        } else if (label.count > 1) {
            const int own =
                std::min(shades.of(static_cast<std::uint32_t>(label.count)), shades.count);
            shade.count = std::max(2, static_cast<std::int32_t>(shades.least(own)));
        }
        return shade;
    };
    const auto level = scene.environment.level(coverage.target.height);
    coverage.overlay.reset();  // as large as the one that follows
    try {
        coverage.overlay.emplace(
            layers, level->slice().sheets,
            Overlay::Coarse{.label = shade_of, .add_area = [](const LayerLabel&, double) {}});
    } catch (const FormatError&) {
        return;  // maps by cells
    }
}

}  // namespace ispace
