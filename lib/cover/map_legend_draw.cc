// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/number.h"
#include "cover/map_parts.h"

namespace ispace {

namespace {

// Of the size of text: from one line to the next, and between blocks.
constexpr double kLine = 1.5, kBlockGap = 0.9;
// Likewise: between columns of metrics, and the place of a sign.
constexpr double kColumnGap = 0.7, kSignWidth = 1.6;

using Sign = LegendItem::Sign;

double heightOf(const LegendBlock& block, double em) {
    return em * kLine * static_cast<double>(block.items.size() + 1);
}

/// The colours of places tried, from left to right.
void drawScale(Picture& picture, double left, double y, double em) {
    constexpr int kSteps = 24;
    const double half = 0.42 * em, step = kSignWidth * em / kSteps;
    for (int i = 0; i < kSteps; ++i) {
        const double from = left + i * step;
        // Each reaches to the end, so that no seam shows.
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

/// The sign of an item, in a box kSignWidth em wide from `left` on, middle at y.
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
        case Sign::Spot:
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

/// How far the columns of a block's metrics reach from its right side.
struct ColumnWidths {
    double second = 0;  ///< without its gap; 0: there is one column only
    double first = 0;   ///< of the first alone
};

ColumnWidths columnsOf(const LegendBlock& block, double em) {
    ColumnWidths widths;
    if (block.columns[0].empty()) return widths;
    const TextStyle style{em, false, Align::Right, palette::kInk, {}};
    widths = {textWidth(block.columns[1], style), textWidth(block.columns[0], style)};
    for (const LegendItem& item : block.items) {
        widths.second = std::max(widths.second, textWidth(item.second, style));
        // A metric alone may take more than its column.
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
    if (item.sign == Sign::Sensor || item.sign == Sign::Spot)
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
        // What does not fit is cut on both sides alike.
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
