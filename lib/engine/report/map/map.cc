// SPDX-License-Identifier: GPL-3.0-or-later
// On a screen the width is given, and the plan is at most 1.4 times as high; on paper the scale is
// a usual one, and the sheet the smallest of A4 and A3 on which the plan is largest. The legend
// stands beside the plan if that leaves most of the page to it, else below.
#include "report/map/map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/number.h"
#include "drawing/drawing.h"
#include "report/map/map_layer.h"
#include "report/map/map_parts.h"

namespace ispace {

namespace {

constexpr int kMinWidth = 200, kMaxWidth = 12000;
/// The page unit of PDF is the point.
constexpr double kPointsPerMillimetre = 72 / 25.4;

/// Bounds of the parts of a page, in its units.
struct Page {
    double em = 0;  ///< size of text
    double width = 0, height = 0;
    double margin = 0;
    double title_base = 0, subtitle_base = 0;  ///< base lines of the title and subtitle
    bool is_to_scale = false;                  ///< plan drawn at a usual scale
    PageView view;
    Box2 plan;
    Point2 scale_corner;       ///< lower left end of the scale bar
    double max_scale_bar = 0;  ///< its maximum length
    LegendLayout legend;
    Point2 legend_corner;
    double legend_width = 0;
};

/// Fits the plan into a box of the page: as large as possible, centred in the width.
void fitPlan(Page& page, const Box2& limits, double left, double top, double width,
             double max_height) {
    double scale = std::min(width / limits.width(), max_height / limits.depth());
    if (page.is_to_scale) {
        constexpr double kFull = 1000 * kPointsPerMillimetre;
        scale = kFull / usualScale(kFull / scale);
    }
    const double plan_width = scale * limits.width(), plan_height = scale * limits.depth();
    const double x = left + (width - plan_width) / 2;
    // Even a very narrow room leaves space for marks and labels.
    const double y = top + std::max(0.0, (5 * page.em - plan_height) / 2);
    page.plan = {{x, y}, {x + plan_width, y + plan_height}};
    page.view = {scale, {limits.low.x, limits.high.y}, {x, y}};
    page.max_scale_bar = std::max(6 * page.em, 0.25 * plan_width);
    page.scale_corner = {x, std::max(y + plan_height, top + 5 * page.em) + 2 * page.em};
    if (x + page.max_scale_bar + 6 * page.em > left + width) page.scale_corner.x = left;
}

/// \param max_height maximum height of a page to scale; 0: the plan may be 1.4 times as high as the
/// page is wide
Page layOut(const MapPicture& map, double width, double max_height) {
    // Widths of the legend, in text sizes.
    constexpr double kPanel = 20, kNarrowPanel = 19, kGap = 2;
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
    // Reserves `below` units for the legend.
    const auto plan_height = [&](double below) {
        if (!page.is_to_scale) return 1.4 * page.width;
        return std::max(5 * em, max_height - page.margin - top - 3.5 * em - below);
    };
    const std::vector<LegendBlock> blocks = legendBlocks(map);
    const double panel = kPanel * em, gap = kGap * em;
    fitPlan(page, limits, page.margin, top, inner - panel - gap, plan_height(0));
    page.legend = layOutLegend(blocks, 1, em);
    const double plan_end = page.scale_corner.y;
    // The legend stands beside the plan if that leaves most of the page to the plan, and no large
    // gap.
    if (panel + gap <= 0.32 * page.width && limits.depth() > 0.65 * limits.width() &&
        page.legend.height < 1.25 * (plan_end - top)) {
        if (page.is_to_scale) {  // and not wider than necessary
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

/// Chooses A4 or A3, portrait or landscape: the smallest sheet on which the plan is largest.
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

/// Draws the title and as many main metrics as fit.
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

/// Draws the coverage between the plan's floor and the bodies that stand on it.
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
    drawPassages(picture, map);
}

}  // namespace

Picture coverageMap(const Scene& scene, const Coverage& coverage, const MapOptions& options,
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
    Box2 frame = page.plan.expanded(page.margin - 0.2 * page.em);
    if (!options.title.empty())  // not over the head
        frame.low.y = std::max(frame.low.y, page.subtitle_base + 0.4 * page.em);
    picture.pushLayer("places tried");
    drawTrace(picture, map, frame);
    picture.pop();
    for (const MapLayer* const layer : options.layers) {
        picture.pushLayer(layer->name());
        layer->draw(picture, map);
        picture.pop();
    }
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
    return picture;
}

std::string drawCoverageMap(const Scene& scene, const Coverage& coverage, const MapOptions& options,
                            const Coverage* other) {
    return coverageMap(scene, coverage, options, other).write(options.format);
}

namespace {

// In text sizes: line spacing, and the gap between blocks.
constexpr double kLine = 1.5, kBlockGap = 0.9;
// Likewise: the gap between columns of metrics, and the width of a sign.
constexpr double kColumnGap = 0.7, kSignWidth = 1.6;

using Sign = LegendItem::Sign;

double heightOf(const LegendBlock& block, double em) {
    return em * kLine * static_cast<double>(block.items.size() + 1);
}

/// Draws the colour scale of tried positions, from left to right.
void drawScale(Picture& picture, double left, double y, double em) {
    constexpr int kSteps = 24;
    const double half = 0.42 * em, step = kSignWidth * em / kSteps;
    for (int i = 0; i < kSteps; ++i) {
        const double from = left + i * step;
        // Each rectangle extends to the end, which avoids visible seams.
        const double to = left + kSignWidth * em;
        const Polygon patch = {{from, y - half}, {to, y - half}, {to, y + half}, {from, y + half}};
        picture.area(patch, {triedColor(i / (kSteps - 1.0))});
    }
}

void drawPatch(Picture& picture, const LegendItem& item, double left, double y, double em) {
    const double right = left + kSignWidth * em, half = 0.42 * em;
    const Polygon patch = {
        {left, y - half}, {right, y - half}, {right, y + half}, {left, y + half}};
    picture.area(patch, {item.color});
    if (item.sign == Sign::Hatched)
        picture.area(std::span(&patch, 1), {Hatch{item.edge, 0.5 * em, 0.09 * em}});
    picture.area(patch, {Stroke{palette::kObjectEdge, em / 16}});
}

/// Draws the sign of an item in a box kSignWidth em wide from `left` on, middle at y.
void drawSign(Picture& picture, const LegendItem& item, double left, double y, double em) {
    const double right = left + kSignWidth * em;
    switch (item.sign) {
        case Sign::None:
            break;
        case Sign::Patch:
        case Sign::Hatched:
            drawPatch(picture, item, left, y, em);
            break;
        case Sign::Line:
            picture.line({left, y}, {right, y}, {item.color, em / 7});
            break;
        case Sign::Dashes:
            picture.line({left, y}, {right, y}, {item.color, em / 10, {em / 2, em / 3}});
            break;
        case Sign::Sensor:
            if (item.color.alpha > 0) drawPatch(picture, item, left, y, em);
            drawSensorMark(picture, {left + 0.45 * em, y}, item.mark, 0.3 * em);
            break;
        case Sign::LineColumn:
            drawSpotSign(picture, {left + kSignWidth / 2 * em, y}, item.number, em);
            break;
        case Sign::Scale:
            drawScale(picture, left, y, em);
            break;
        case Sign::Ring:
            drawChosenRing(picture, {left + kSignWidth / 2 * em, y}, 0.5 * em, em);
            break;
    }
}

/// Distances of a block's metric columns from its right side.
struct ColumnWidths {
    double second = 0;  ///< without its gap; 0: only one column
    double first = 0;   ///< of the first column alone
};

ColumnWidths columnsOf(const LegendBlock& block, double em) {
    ColumnWidths widths;
    if (block.columns[0].empty()) return widths;
    const TextStyle style{em, false, Align::Right, palette::kInk, {}};
    widths = {textWidth(block.columns[1], style), textWidth(block.columns[0], style)};
    for (const LegendItem& item : block.items) {
        widths.second = std::max(widths.second, textWidth(item.second, style));
        // A single metric may be wider than its column.
        if (!item.second.empty())
            widths.first = std::max(widths.first, textWidth(item.value, style));
    }
    return widths;
}

void drawItem(Picture& picture, const LegendItem& item, const ColumnWidths& columns, Point2 corner,
              double width, double em) {
    const double base = corner.y + em * kLine * 0.5 + 0.36 * em;
    const double indent = item.sign == Sign::None ? 0 : (kSignWidth + 0.6) * em;
    drawSign(picture, item, corner.x, corner.y + em * kLine * 0.5, em);
    const TextStyle style{em, false, Align::Left, palette::kInk, {}};
    TextStyle value_style = style;
    value_style.align = Align::Right;
    if (item.sign == Sign::Sensor || item.sign == Sign::LineColumn)
        value_style.color = palette::kFaintInk;
    const double right = corner.x + width;
    double room = width - indent;
    if (columns.second > 0) {
        const double first = right - columns.second - kColumnGap * em;
        picture.text({first, base}, item.value, value_style);
        room -= right - first + kColumnGap * em;
        room -= item.second.empty() ? textWidth(item.value, value_style) : columns.first;
        value_style.color = palette::kFaintInk;
        picture.text({right, base}, item.second, value_style);
    } else {
        // Wider text is cut on both sides.
        const double needed = textWidth(item.text, style) + 0.7 * em;
        const double most = std::max(0.5 * room, room - needed);
        const std::string value = fitText(item.value, most, value_style);
        picture.text({right, base}, value, value_style);
        room -= textWidth(value, value_style) + (value.empty() ? 0 : 0.7 * em);
    }
    picture.text({corner.x + indent, base}, fitText(item.text, room, style), style);
}

void drawHead(Picture& picture, const LegendBlock& block, const ColumnWidths& columns,
              Point2 corner, double width, double em) {
    const TextStyle title{em, true, Align::Left, palette::kInk, {}};
    const double base = corner.y + em, right = corner.x + width;
    double room = width;
    if (columns.second > 0) {
        const TextStyle head{em, false, Align::Right, palette::kFaintInk, {}};
        const double first = columns.second + kColumnGap * em;
        picture.text({right - first, base}, block.columns[0], head);
        picture.text({right, base}, block.columns[1], head);
        room -= first + textWidth(block.columns[0], head) + kColumnGap * em;
    }
    picture.text({corner.x, base}, fitText(block.title, room, title), title);
    picture.line({corner.x, corner.y + 1.3 * em}, {right, corner.y + 1.3 * em},
                 {palette::kObjectEdge, em / 16});
}

}  // namespace

LegendLayout layOutLegend(std::vector<LegendBlock> blocks, int columns, double em) {
    LegendLayout layout;
    layout.columns.resize(static_cast<std::size_t>(columns));
    std::vector<double> heights(layout.columns.size());
    for (LegendBlock& block : blocks) {
        const auto shortest = std::min_element(heights.begin(), heights.end());
        if (*shortest > 0) *shortest += kBlockGap * em;
        *shortest += heightOf(block, em);
        layout.columns[static_cast<std::size_t>(shortest - heights.begin())].push_back(
            std::move(block));
    }
    layout.height = *std::max_element(heights.begin(), heights.end());
    return layout;
}

void drawLegend(Picture& picture, const LegendLayout& layout, Point2 corner, double width,
                double em) {
    const double gap = 2 * em;
    const auto count = static_cast<double>(layout.columns.size());
    const double column_width = (width - (count - 1) * gap) / count;
    double x = corner.x;
    for (const auto& blocks : layout.columns) {
        double y = corner.y;
        for (const LegendBlock& block : blocks) {
            const ColumnWidths widths = columnsOf(block, em);
            drawHead(picture, block, widths, {x, y}, column_width, em);
            y += em * kLine;
            for (const LegendItem& item : block.items) {
                drawItem(picture, item, widths, {x, y}, column_width, em);
                y += em * kLine;
            }
            y += kBlockGap * em;
        }
        x += column_width + gap;
    }
}

}  // namespace ispace
