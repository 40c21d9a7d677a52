// SPDX-License-Identifier: GPL-3.0-or-later
// Around a plan: grid and coordinates, bar of scale, title.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/number.h"
#include "plan/drawing.h"

namespace ispace {

namespace {

using namespace plan_colors;

/// 1, 2, 5 or ten times that, …: the least that is no less than `least`.
double roundStep(double least) {
    const double power = std::pow(10, std::floor(std::log10(least)));
    for (const double digit : {1.0, 2.0, 5.0})
        if (digit * power >= least * (1 - 1e-9)) return digit * power;
    return 10 * power;
}

/// Metres between lines: 1, unless lines would lie too near each other, or none in sight.
double gridStep(const PlanDrawing& plan) {
    constexpr double kNearest = 0.7, kFarthest = 25;  // in sizes of text
    const double em = plan.metres();
    if (kNearest * em > 1) return roundStep(kNearest * em);
    if (kFarthest * em < 1) return std::min(1.0, roundStep(4 * em));
    return 1;
}

/// k * step as a text without round-off.
std::string coordinate(double k, double step) {
    const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
    return formatFixed(k * step, decimals);
}

/// Calls visit(k, has_label) for each multiple k * step in [low, high].
template <typename Visit>
void forEachLine(double low, double high, double step, double label_every, Visit visit) {
    // Counted: far from the origin k may be too large to grow by 1.
    const double first = std::ceil(low / step - 1e-9), last = std::floor(high / step + 1e-9);
    const auto count = static_cast<int>(std::min(last - first, 10000.0));
    for (int i = 0; i <= count; ++i) {
        const double k = first + i;
        visit(k, std::fmod(std::abs(k), label_every) == 0);
    }
}

/// Every how many lines a coordinate is written: texts `width` sizes of text wide stay apart.
double labelEvery(const PlanDrawing& plan, double step, double width) {
    return std::max(1.0, roundStep(width * plan.metres() / step));
}

void addGrid(PlanDrawing& plan, double step) {
    const Box2& box = plan.box;
    const double em = plan.metres();
    DrawnPath fine{{}, false, {}, Stroke{kGrid.faded(0.28), 0.05}};
    DrawnPath strong{{}, false, {}, Stroke{kGrid.faded(0.6), 0.06}};
    DrawnItem labels{PlanLayer::Frame, "", "coordinates in metres"};
    const auto text = [&](Point2 anchor, const std::string& value, Align align) {
        labels.texts.push_back({anchor, value, 0.75, align, kFaintInk});
    };
    forEachLine(box.low.x, box.high.x, step, labelEvery(plan, step, 3.2), [&](double k, bool far) {
        const double x = k * step;
        (far ? strong : fine).curves.push_back({{x, box.low.y}, {x, box.high.y}});
        if (far) text({x, box.low.y - 1.2 * em}, coordinate(k, step), Align::Center);
    });
    forEachLine(box.low.y, box.high.y, step, labelEvery(plan, step, 1.6), [&](double k, bool far) {
        const double y = k * step;
        (far ? strong : fine).curves.push_back({{box.low.x, y}, {box.high.x, y}});
        if (far) text({box.low.x - 0.5 * em, y - 0.27 * em}, coordinate(k, step), Align::Right);
    });
    plan.items.push_back({PlanLayer::Grid, "", "grid of " + formatDouble(step) + " m"});
    plan.items.back().paths = {std::move(fine), std::move(strong)};
    plan.items.push_back(std::move(labels));
}

/// Black and white pieces below the coordinates; with what is to be said about the plan.
void addScaleBar(PlanDrawing& plan, const std::vector<std::string>& notes) {
    constexpr double kMost = 15;  // in sizes of text
    const double em = plan.metres();
    const double most = kMost * em;
    const double power = std::pow(10, std::floor(std::log10(most)));
    const double digit = most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1;
    const int pieces = digit == 5 ? 5 : 4;
    const double piece = digit * power / pieces, thick = 0.32 * em;
    const double left = std::min(plan.box.low.x, plan.box.center().x - 5 * em);
    const double bottom = plan.view.world_anchor.y -
                          (plan.height - plan.view.page_anchor.y) / plan.view.scale + 1.1 * em;
    DrawnItem item{PlanLayer::Frame, "", "bar of scale"};
    for (int i = 0; i < pieces; ++i) {
        const double x = left + i * piece;
        item.paths.push_back(
            {{{{x, bottom}, {x + piece, bottom}, {x + piece, bottom + thick}, {x, bottom + thick}}},
             true,
             i % 2 == 0 ? kInk : kPaper,
             Stroke{kInk, 0.05}});
    }
    std::string text = formatDouble(std::round(digit * power * 1e9) / 1e9) + " m";
    for (const std::string& note : notes) text.append("  ·  ").append(note);
    item.texts.push_back(
        {{left + pieces * piece + 0.6 * em, bottom - 0.05 * em}, text, 0.85, Align::Left, kInk});
    plan.items.push_back(std::move(item));
}

void addTitle(PlanDrawing& plan, const std::string& title) {
    if (title.empty()) return;
    constexpr double kSize = 1.35;
    const double em = plan.metres();
    const TextStyle style{kSize * plan.em, true, Align::Left, kInk, {}};
    const double margin = 1.4 * plan.em;
    const double page_top = plan.view.world_anchor.y + plan.view.page_anchor.y / plan.view.scale;
    const double page_left = plan.view.world_anchor.x - plan.view.page_anchor.x / plan.view.scale;
    const Point2 anchor{page_left + margin / plan.view.scale, page_top - 2.3 * em};
    plan.items.push_back({PlanLayer::Frame, "", ""});
    plan.items.back().texts.push_back(
        {anchor, fitText(title, plan.width - 2 * margin, style), kSize, Align::Left, kInk, true});
}

}  // namespace

void addFrame(PlanDrawing& plan, const std::string& title, const std::vector<std::string>& notes) {
    const double step = gridStep(plan);
    addGrid(plan, step);
    const Point2 low = plan.box.low, high = plan.box.high;
    plan.items.push_back({PlanLayer::Frame, "", ""});
    plan.items.back().paths.push_back({{{low, {high.x, low.y}, high, {low.x, high.y}}},
                                       true,
                                       {},
                                       Stroke{kGrid.faded(0.7), 0.05}});
    std::vector<std::string> said{"grid " + formatDouble(step) + " m"};
    said.insert(said.begin(), notes.begin(), notes.end());
    addScaleBar(plan, said);
    addTitle(plan, title);
}

}  // namespace ispace
