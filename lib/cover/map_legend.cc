// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/number.h"
#include "cover/map_parts.h"

namespace ispace {

namespace {

// Of the size of text: from one line to the next, and between blocks.
constexpr double kLine = 1.5, kBlockGap = 0.9;

using Sign = LegendItem::Sign;

std::string percent(double share) { return formatFixed(100 * share, 1) + "%"; }
std::string percent(const std::optional<double>& share) { return share ? percent(*share) : "–"; }
std::string area(double value) { return formatFixed(value, value < 1000 ? 1 : 0) + " m²"; }

LegendBlock figuresBlock(const CoverageReport& report) {
    const auto line = [](std::string text, std::string value) {
        return LegendItem{Sign::None, {}, {}, std::move(text), std::move(value)};
    };
    const std::optional<double>& effective = report.total_effective_area.grid;
    return {
        "Figures",
        {line("Coverage", percent(report.coverage.grid)),
         line("Free coverage", percent(report.free_coverage.grid)),
         line("Indoor area", area(report.indoor_area)), line("Free floor", area(report.free_area)),
         line("Effective area", effective ? area(*effective) : "–"),
         line("Grid", std::to_string(report.columns) + " × " + std::to_string(report.rows))}};
}

LegendBlock shadesBlock(const std::vector<double>& redundancy) {
    const auto patch = [](Color color, std::string text, double share) {
        return LegendItem{Sign::Patch, color, map_colors::kObjectEdge, std::move(text),
                          percent(share)};
    };
    const Shades shades = shadesFor(redundancy);
    std::vector<double> shares(static_cast<std::size_t>(shades.count) + 1);
    for (std::uint32_t k = 0; k < redundancy.size(); ++k)
        if (redundancy[k] > 0) shares[static_cast<std::size_t>(shades.of(k))] += redundancy[k];
    LegendBlock block{"Indoor floor seen by", {}};
    block.items.push_back(patch(map_colors::kUncovered, "no sensor", shares[0]));
    if (redundancy.size() < 2) return block;
    for (int shade = 1; shade <= shades.count; ++shade) {
        const std::uint32_t last = static_cast<std::uint32_t>(shade) * shades.width;
        std::string text;
        if (shades.width > 1) text = std::to_string(last - shades.width + 1).append("–");
        text.append(std::to_string(last)).append(last == 1 ? " sensor" : " sensors");
        block.items.push_back(
            patch(shades.color(shade), std::move(text), shares[static_cast<std::size_t>(shade)]));
    }
    return block;
}

LegendBlock sensorsBlock(const std::vector<PlacedLaser>& sensors) {
    constexpr std::size_t kMostListed = 10, kListedOfMore = 8;
    LegendBlock block{sensors.size() > 1 ? std::to_string(sensors.size()) + " sensors" : "Sensor",
                      {}};
    const std::size_t listed = sensors.size() > kMostListed ? kListedOfMore : sensors.size();
    for (std::size_t i = 0; i < listed; ++i) {
        const std::string& model = sensors[i].laser.model;
        block.items.push_back(
            {Sign::Sensor, seriesColor(i), {}, sensors[i].id, model.empty() ? "laser" : model});
    }
    const auto remark = [&block](std::string text) {
        block.items.push_back({Sign::None, {}, {}, std::move(text), ""});
    };
    if (listed < sensors.size())
        remark("… and " + std::to_string(sensors.size() - listed) + " more");
    if (sensors.empty()) remark("none is placed");
    return block;
}

LegendBlock planBlock(const MapContents& contents, double height) {
    LegendBlock block{"Plan", {}};
    const auto add = [&block](bool shown, Sign sign, Color color, Color edge, std::string text) {
        if (shown) block.items.push_back({sign, color, edge, std::move(text), ""});
    };
    using namespace map_colors;
    add(contents.walls, Sign::Line, kWall, {}, "wall");
    add(contents.solids, Sign::Patch, kSolid, kSolidEdge,
        "object at " + formatDouble(height) + " m");
    add(contents.objects, Sign::Patch, kObject, kObjectEdge, "object above or below");
    add(contents.outside, Sign::Patch, kOutside, kObjectEdge, "not indoor");
    add(contents.zones, Sign::Dashes, kZone, {}, "zone");
    return block;
}

double heightOf(const LegendBlock& block, double em) {
    return em * kLine * static_cast<double>(block.items.size() + 1);
}

/// The sign of an item, in a box 1.6 em wide from `left` on, middle at y.
void drawSign(Canvas& canvas, const LegendItem& item, double left, double y, double em) {
    const double right = left + 1.6 * em;
    switch (item.sign) {
        case Sign::None:
            break;
        case Sign::Patch: {
            const Polygon patch = {{left, y - 0.42 * em},
                                   {right, y - 0.42 * em},
                                   {right, y + 0.42 * em},
                                   {left, y + 0.42 * em}};
            canvas.fill(patch, item.color);
            canvas.stroke(patch, {item.edge, em / 16});
            break;
        }
        case Sign::Line:
            canvas.line({left, y}, {right, y}, {item.color, em / 7});
            break;
        case Sign::Dashes:
            canvas.line({left, y}, {right, y}, {item.color, em / 10, {em / 2, em / 3}});
            break;
        case Sign::Sensor:
            drawSensorMark(canvas, {left + 0.4 * em, y}, Angle(), 0.36 * em, item.color);
            break;
    }
}

void drawItem(Canvas& canvas, const LegendItem& item, Point2 corner, double width, double em) {
    const double base = corner.y + em * kLine * 0.5 + 0.36 * em;
    const double indent = item.sign == Sign::None ? 0 : 2.2 * em;
    drawSign(canvas, item, corner.x, corner.y + em * kLine * 0.5, em);
    TextStyle style{em, false, Align::Left, map_colors::kInk, {}};
    TextStyle value_style = style;
    value_style.align = Align::Right;
    if (item.sign == Sign::Sensor) value_style.color = map_colors::kFaintInk;
    const std::string value = fitText(item.value, (width - indent) * 0.6, value_style);
    const double left_over = width - indent - textWidth(value, value_style) - 0.5 * em;
    canvas.text({corner.x + indent, base}, fitText(item.text, left_over, style), style);
    if (!value.empty()) canvas.text({corner.x + width, base}, value, value_style);
}

}  // namespace

std::vector<LegendBlock> legendBlocks(const Scene& scene, const Coverage& coverage) {
    const MapContents contents = contentsOf(scene, coverage);
    return {figuresBlock(coverage.report), shadesBlock(coverage.report.redundancy),
            sensorsBlock(scene.lasers), planBlock(contents, coverage.target.height)};
}

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

void drawLegend(Canvas& canvas, const LegendLayout& layout, Point2 corner, double width,
                double em) {
    const double gap = 2 * em;
    const auto count = static_cast<double>(layout.columns.size());
    const double column_width = (width - (count - 1) * gap) / count;
    const TextStyle title{em, true, Align::Left, map_colors::kInk, {}};
    double x = corner.x;
    for (const auto& blocks : layout.columns) {
        double y = corner.y;
        for (const LegendBlock& block : blocks) {
            canvas.text({x, y + em}, fitText(block.title, column_width, title), title);
            canvas.line({x, y + 1.3 * em}, {x + column_width, y + 1.3 * em},
                        {map_colors::kObjectEdge, em / 16});
            y += em * kLine;
            for (const LegendItem& item : block.items) {
                drawItem(canvas, item, {x, y}, column_width, em);
                y += em * kLine;
            }
            y += kBlockGap * em;
        }
        x += column_width + gap;
    }
}

void drawScaleBar(Canvas& canvas, Point2 corner, double most, double page_per_metre, double em) {
    const double limit = most / page_per_metre;
    double metres = std::pow(10, std::floor(std::log10(limit)));
    for (const double factor : {5, 2}) {
        if (factor * metres <= limit) {
            metres *= factor;
            break;
        }
    }
    const double right = corner.x + metres * page_per_metre;
    const Stroke stroke{map_colors::kInk, em / 8};
    const std::vector<Point2> bar = {
        {corner.x, corner.y - 0.4 * em}, corner, {right, corner.y}, {right, corner.y - 0.4 * em}};
    canvas.polyline(bar, stroke);
    canvas.line({corner.x + (right - corner.x) / 2, corner.y},
                {corner.x + (right - corner.x) / 2, corner.y - 0.25 * em},
                {map_colors::kInk, em / 12});
    const TextStyle style{em, false, Align::Left, map_colors::kInk, {}};
    canvas.text({right + 0.6 * em, corner.y}, formatDouble(metres) + " m", style);
}

}  // namespace ispace
