// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/map.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "cover/map_parts.h"

namespace ispace {

namespace {

constexpr int kLeastWidth = 200, kMostWidth = 12000;

/// Where everything lies on the page.
struct Page {
    double em = 0;  ///< size of text
    double width = 0, height = 0;
    double margin = 0;
    double title_base = 0;  ///< base line of the title
    PageView view;
    Box2 plan;              ///< page units
    Point2 scale_corner;    ///< lower left end of the scale bar
    double scale_most = 0;  ///< its greatest length
    LegendLayout legend;
    Point2 legend_corner;
    double legend_width = 0;
};

/// The plan within a box of the page: as large as fits, in the middle of the width.
void fitPlan(Page& page, const Box2& limits, double left, double top, double width,
             double most_height) {
    const double scale = std::min(width / limits.width(), most_height / limits.depth());
    const double plan_width = scale * limits.width(), plan_height = scale * limits.depth();
    const double x = left + (width - plan_width) / 2;
    // A mere strip of a room still gets room for marks and labels.
    const double y = top + std::max(0.0, (5 * page.em - plan_height) / 2);
    page.plan = {{x, y}, {x + plan_width, y + plan_height}};
    page.view = {scale, {limits.low.x, limits.high.y}, {x, y}};
    page.scale_most = std::max(6 * page.em, 0.25 * plan_width);
    page.scale_corner = {x, std::max(y + plan_height, top + 5 * page.em) + 2 * page.em};
    if (x + page.scale_most + 6 * page.em > left + width) page.scale_corner.x = left;
}

Page layOut(const Scene& scene, const Coverage& coverage, const MapOptions& options) {
    Page page;
    page.width = options.width;
    page.em = std::max(10.0, page.width / 1200 * 17);
    page.margin = std::max(1.4 * page.em, page.width / 40);
    double top = page.margin;
    if (!options.title.empty()) {
        page.title_base = top + 1.1 * page.em;
        top += 2.4 * page.em;
    }
    const Box2& limits = coverage.target.grid.limits;
    const double inner = page.width - 2 * page.margin;
    const double panel = 16 * page.em, gap = 2 * page.em;
    std::vector<LegendBlock> blocks = legendBlocks(scene, coverage);
    const bool beside = panel + gap <= 0.32 * page.width && limits.depth() > 0.65 * limits.width();
    if (beside) {
        fitPlan(page, limits, page.margin, top, inner - panel - gap, 1.4 * page.width);
        page.legend = layOutLegend(std::move(blocks), 1, page.em);
        page.legend_corner = {page.width - page.margin - panel, top};
        page.legend_width = panel;
        page.height = std::max(page.scale_corner.y, top + page.legend.height) + page.margin;
    } else {
        fitPlan(page, limits, page.margin, top, inner, 1.4 * page.width);
        const int columns = std::clamp(static_cast<int>((inner + gap) / (panel + gap)), 1, 4);
        page.legend = layOutLegend(std::move(blocks), columns, page.em);
        page.legend_corner = {page.margin, page.scale_corner.y + 1.5 * page.em};
        page.legend_width = inner;
        page.height = page.legend_corner.y + page.legend.height + page.margin;
    }
    return page;
}

PictureFormat pictureFormat(MapFormat format) {
    switch (format) {
        case MapFormat::Svg:
            return PictureFormat::Svg;
        case MapFormat::Pdf:
            return PictureFormat::Pdf;
        case MapFormat::Png:
            break;
    }
    return PictureFormat::Png;
}

}  // namespace

std::string drawCoverageMap(const Scene& scene, const Coverage& coverage,
                            const MapOptions& options) {
    if (options.width < kLeastWidth || options.width > kMostWidth)
        throw UsageError("a map " + std::to_string(options.width) +
                         " pixels wide cannot be drawn, wanted " + std::to_string(kLeastWidth) +
                         " to " + std::to_string(kMostWidth));
    const Page page = layOut(scene, coverage, options);
    Canvas canvas(pictureFormat(options.format), page.width, std::ceil(page.height));
    if (!options.title.empty()) {
        const TextStyle style{1.35 * page.em, true, Align::Left, map_colors::kInk, {}};
        const double width = page.width - 2 * page.margin;
        canvas.text({page.margin, page.title_base}, fitText(options.title, width, style), style);
    }
    drawPlan(canvas, scene, coverage, page.view, page.em);
    const double rim = page.margin - 0.2 * page.em;
    const Box2 frame{{page.plan.low.x - rim, page.plan.low.y - rim},
                     {page.plan.high.x + rim, page.plan.high.y + rim}};
    drawSensors(canvas, scene, page.view, frame, page.em);
    drawScaleBar(canvas, page.scale_corner, page.scale_most, page.view.scale, page.em);
    drawLegend(canvas, page.legend, page.legend_corner, page.legend_width, page.em);
    return canvas.encode();
}

}  // namespace ispace
