// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/number.h"
#include "cover/map_parts.h"
#include "draw/picture.h"

namespace ispace {

namespace {

constexpr int kMinWidth = 200, kMaxWidth = 12000;
/// A PDF's page unit is the point.
constexpr double kPointsPerMillimetre = 72 / 25.4;

/// Where everything lies on the page, in its units.
struct Page {
    double em = 0;  ///< size of text
    double width = 0, height = 0;
    double margin = 0;
    double title_base = 0, subtitle_base = 0;  ///< base lines of the head
    bool is_to_scale = false;                  ///< a usual one
    PageView view;
    Box2 plan;
    Point2 scale_corner;       ///< lower left end of the scale bar
    double max_scale_bar = 0;  ///< its greatest length
    LegendLayout legend;
    Point2 legend_corner;
    double legend_width = 0;
};

/// The plan within a box of the page: as large as fits, in the middle of the width.
void fitPlan(Page& page, const Box2& limits, double left, double top, double width,
             double max_height) {
    double scale = std::min(width / limits.width(), max_height / limits.depth());
    if (page.is_to_scale) {
        constexpr double kFull = 1000 * kPointsPerMillimetre;
        scale = kFull / usualScale(kFull / scale);
    }
    const double plan_width = scale * limits.width(), plan_height = scale * limits.depth();
    const double x = left + (width - plan_width) / 2;
    // A mere strip of a room still gets room for marks and labels.
    const double y = top + std::max(0.0, (5 * page.em - plan_height) / 2);
    page.plan = {{x, y}, {x + plan_width, y + plan_height}};
    page.view = {scale, {limits.low.x, limits.high.y}, {x, y}};
    page.max_scale_bar = std::max(6 * page.em, 0.25 * plan_width);
    page.scale_corner = {x, std::max(y + plan_height, top + 5 * page.em) + 2 * page.em};
    if (x + page.max_scale_bar + 6 * page.em > left + width) page.scale_corner.x = left;
}

/// \param max_height of a page to scale; 0: the plan may be 1.4 times as high as the page is wide
Page layOut(const MapPicture& map, double width, double max_height) {
    // Widths of the legend, in sizes of text.
    constexpr double kPanel = 18, kNarrowPanel = 17, kGap = 2;
    Page page;
    page.width = width;
    page.em = map.em;
    page.is_to_scale = max_height > 0;
    const double em = page.em;
    page.margin = std::max(1.4 * em, page.width / 40);
    double top = page.margin;
    if (!map.options.title.empty()) {
        page.title_base = top + 1.1 * em;
        page.subtitle_base = top + 2.6 * em;
        top += 4.0 * em;
    }
    const Box2& limits = map.limits();
    const double inner = page.width - 2 * page.margin;
    // Leaves `below` units to the legend.
    const auto plan_height = [&](double below) {
        if (!page.is_to_scale) return 1.4 * page.width;
        return std::max(5 * em, max_height - page.margin - top - 3.5 * em - below);
    };
    const std::vector<LegendBlock> blocks = legendBlocks(map);
    const double panel = kPanel * em, gap = kGap * em;
    fitPlan(page, limits, page.margin, top, inner - panel - gap, plan_height(0));
    page.legend = layOutLegend(blocks, 1, em);
    const double plan_end = page.scale_corner.y;
    // Beside the plan if it leaves the larger part of the page to it, and no large part empty.
    if (panel + gap <= 0.32 * page.width && limits.depth() > 0.65 * limits.width() &&
        page.legend.height < 1.25 * (plan_end - top)) {
        if (page.is_to_scale) {  // and no wider than it must be
            const double spare = inner - panel - gap - std::max(page.plan.width(), 12 * em);
            page.width -= spare;
            for (double* x : {&page.view.page_anchor.x, &page.plan.low.x, &page.plan.high.x})
                *x -= spare / 2;
            page.scale_corner.x = page.margin;
        }
        page.legend_corner = {page.width - page.margin - panel, top};
        page.legend_width = panel;
        page.height = std::max(plan_end, top + page.legend.height) + page.margin;
        return page;
    }
    const double columns = (inner + gap) / (kNarrowPanel * em + gap);
    page.legend = layOutLegend(blocks, std::clamp(static_cast<int>(columns), 1, 4), em);
    fitPlan(page, limits, page.margin, top, inner, plan_height(page.legend.height));
    page.legend_corner = {page.margin, page.scale_corner.y + 1.5 * em};
    page.legend_width = inner;
    page.height = page.legend_corner.y + page.legend.height + page.margin;
    return page;
}

/// On A4 or A3, upright or lying: where the plan is the largest, on the smallest such sheet.
Page layOutPaper(const MapPicture& map) {
    Page best;
    best.view.scale = 0;
    for (const double share : {std::sqrt(0.5), 1.0})
        for (const bool is_upright : {false, true}) {
            double width = share * kPaperLong, height = share * kPaperShort;
            if (is_upright) std::swap(width, height);
            Page page = layOut(map, kPointsPerMillimetre * width, kPointsPerMillimetre * height);
            if (page.view.scale > best.view.scale) best = std::move(page);
        }
    return best;
}

/// Title and main metrics, of which as many as fit.
void drawHead(Picture& picture, const MapPicture& map, const Page& page) {
    if (map.options.title.empty()) return;
    const double width = page.width - 2 * page.margin;
    const TextStyle title{1.35 * page.em, true, Align::Left, palette::kInk, {}};
    picture.text({page.margin, page.title_base}, fitText(map.options.title, width, title), title);
    const TextStyle style{page.em, false, Align::Left, palette::kFaintInk, {}};
    std::string line;
    for (const std::string& part : mainMetrics(map)) {
        std::string longer = line;
        if (!line.empty()) longer += " · ";
        longer += part;
        if (!line.empty() && textWidth(longer, style) > width) break;
        line = std::move(longer);
    }
    picture.text({page.margin, page.subtitle_base}, fitText(line, width, style), style);
}

/// The plan with what is seen between its floor and what stands on it.
void drawPlanSeen(Picture& picture, const MapPicture& map) {
    PlanDrawing plan(picture, map.scene,
                     {map.view, map.em, map.limits(), map.coverage.target.height, true});
    plan.drawFloor();
    {
        const std::vector<Polygon> indoor = curvesOf(map.scene.environment.indoor());
        const PlanLayer layer(plan, "coverage", indoor);
        drawCoverage(picture, map);
    }
    {
        const PlanLayer layer(plan, "fields of view");
        drawViews(picture, map);
    }
    plan.drawThings();
    plan.drawWalls();
    plan.drawOpenings();
    plan.drawZones();
}

}  // namespace

std::string drawCoverageMap(const Scene& scene, const Coverage& coverage, const MapOptions& options,
                            const Coverage* other) {
    if (options.width < kMinWidth || options.width > kMaxWidth)
        throw UsageError("a map " + std::to_string(options.width) +
                         " pixels wide cannot be drawn, wanted " + std::to_string(kMinWidth) +
                         " to " + std::to_string(kMaxWidth));
    MapPicture map{scene, coverage, options, other};
    const bool on_paper = options.format == PictureFormat::Pdf;
    if (!on_paper) {
        map.em = std::max(10.0, options.width / 1200.0 * 17);
        map.terse = options.width < 50 * map.em;
    }
    const Page page = on_paper ? layOutPaper(map) : layOut(map, options.width, 0);
    map.view = page.view;
    Picture picture(page.width, std::ceil(page.height));
    picture.describe(options.title.empty() ? "coverage" : options.title, "");
    drawPlanSeen(picture, map);
    const double rim = page.margin - 0.2 * page.em;
    const Box2 frame{{page.plan.low.x - rim, page.plan.low.y - rim},
                     {page.plan.high.x + rim, page.plan.high.y + rim}};
    picture.pushLayer("places tried");
    drawTrace(picture, map, frame);
    picture.pop();
    picture.pushLayer("ways of the run");
    drawRun(picture, map);
    picture.pop();
    drawMarks(picture, map, frame);
    picture.pushLayer("frame");
    drawHead(picture, map, page);
    const std::string scale =
        on_paper
            ? "  ·  1:" + formatDouble(std::round(1000 * kPointsPerMillimetre / page.view.scale))
            : "";
    drawScaleBar(picture, page.scale_corner, page.max_scale_bar, page.view.scale, page.em, scale);
    picture.pop();
    picture.pushLayer("legend");
    drawLegend(picture, page.legend, page.legend_corner, page.legend_width, page.em);
    picture.pop();
    return picture.write(options.format);
}

}  // namespace ispace
