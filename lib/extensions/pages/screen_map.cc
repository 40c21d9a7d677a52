// SPDX-License-Identifier: GPL-3.0-or-later
// One picture with all layers, of which the page of a report shows some; marks are there in two
// sizes, since narrow screens show the picture at less than half its size.
#include "extensions/pages/screen_map.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "drawing/plan/plan.h"
#include "report/map/map_parts.h"

namespace ispace::pages {

namespace {

// In pixels of a page that is as wide as a narrow column of text.
constexpr double kScreenWidth = 900, kMaxHeight = 1000, kEm = 14, kLargeEm = 27, kScreenMargin = 20,
                 kScaleBar = 40;
constexpr double kLegendWidth = 420, kLegendEm = 15;

constexpr std::pair<MapColor, std::string_view> kDensityLayers[] = {
    {MapColor::Density, "density 2015"}, {MapColor::Levels, "density 2025"}};

void drawFloorLayers(Picture& picture, PlanDrawing& plan, const MapPicture& map) {
    const std::vector<Polygon> indoor = curvesOf(map.scene.environment.indoor());
    MapOptions options = map.options;
    const MapPicture shades{map.scene, map.coverage, options, nullptr, map.em, map.view};
    {
        const PlanLayer layer(plan, "redundancy", indoor);
        drawCoverage(picture, shades);
    }
    if (map.coverage.report.densities.indoor.empty()) return;
    for (const auto& [color, name] : kDensityLayers) {
        options.color = color;
        const MapPicture densities{map.scene, map.coverage, options, nullptr, map.em, map.view};
        const PlanLayer layer(plan, name, indoor);
        picture.area(indoor, {palette::kFloor});
        drawCoverage(picture, densities);
    }
}

Picture drawLegendAlone(const MapPicture& map) {
    std::vector<LegendBlock> blocks = legendBlocks(map);
    if (!map.coverage.report.densities.indoor.empty()) {
        MapOptions options = map.options;
        std::ptrdiff_t at = 2;
        for (const auto& [color, name] : kDensityLayers) {
            options.color = color;
            const MapPicture densities{map.scene, map.coverage, options};
            blocks.insert(blocks.begin() + at++, legendBlocks(densities)[1]);
        }
    }
    const LegendLayout layout = layOutLegend(std::move(blocks), 1, kLegendEm);
    Picture picture(kLegendWidth, std::ceil(layout.height + 2 * kLegendEm));
    picture.describe("legend", "");
    drawLegend(picture, layout, {kLegendEm, kLegendEm}, kLegendWidth - 2 * kLegendEm, kLegendEm);
    return picture;
}

}  // namespace

ScreenMap drawScreenMap(const Scene& scene, const Coverage& coverage) {
    const MapOptions options;
    const Box2& limits = coverage.target.grid.limits;
    const double scale = std::min((kScreenWidth - 2 * kScreenMargin) / limits.width(),
                                  (kMaxHeight - 2 * kScreenMargin - kScaleBar) / limits.depth());
    const double width = std::max(kScreenWidth / 2, scale * limits.width() + 2 * kScreenMargin);
    const double depth = scale * limits.depth();
    const Point2 corner{(width - scale * limits.width()) / 2, kScreenMargin};
    const PageView view{scale, {limits.low.x, limits.high.y}, corner};
    const MapPicture map{scene, coverage, options, nullptr, kEm, view};
    Picture picture(std::ceil(width), std::ceil(depth + 2 * kScreenMargin + kScaleBar));
    picture.describe("map of the floor that sensors see", "");
    PlanDrawing plan(picture, scene, {view, kEm, limits, coverage.target.height, true});
    plan.drawFloor();
    drawFloorLayers(picture, plan, map);
    {
        const PlanLayer layer(plan, "views");
        drawRegions(picture, map);
    }
    plan.drawThings();
    plan.drawWalls();
    plan.drawOpenings();
    plan.drawZones();
    const Box2 frame{{2, 2}, {picture.width() - 2, corner.y + depth + kScreenMargin - 2}};
    drawMarks(picture, map, frame);
    // Narrow screens show the picture at less than half its size.
    const MapPicture large{scene, coverage, options, nullptr, kLargeEm, view};
    drawMarks(picture, large, frame, " (large)");
    for (const auto& [em, name] : {std::pair(kEm, "frame"), std::pair(kLargeEm, "frame (large)")}) {
        picture.pushLayer(name);
        drawScaleBar(picture, {kScreenMargin, picture.height() - kScreenMargin}, 0.3 * width, scale,
                     em);
        picture.pop();
    }
    return {std::move(picture), drawLegendAlone(map), view};
}

}  // namespace ispace::pages
