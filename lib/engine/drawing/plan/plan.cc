// SPDX-License-Identifier: GPL-3.0-or-later
#include "drawing/plan/plan.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/number.h"
#include "drawing/drawing.h"

namespace ispace {

namespace {

using namespace palette;

constexpr int kMinWidth = 200, kMaxWidth = 12000;

/// Margins around the plan, in text sizes: coordinates on the left and below, then the scale bar.
constexpr double kLeft = 3.4, kRight = 1.6, kBottom = 4.6, kTop = 1.4, kTitle = 2.4;
/// Even a very narrow room leaves space for marks and names.
constexpr double kMinHeight = 5;
/// Maximum height of a picture's plan, as a multiple of its width.
constexpr double kTall = 1.4;

/// Text size of a plan on paper, in millimetres.
constexpr double kPaperText = 2.8;

struct Page {
    double width = 0, height = 0;  ///< pixels or millimetres
    PlanStyle style;
    [[nodiscard]] double metres(double ems) const { return ems * style.em / style.view.scale; }
};

/// Computes the layout of a page, with `scale` page units a metre.
Page layOut(const Box2& box, double em, double scale, bool with_title, double least_width) {
    const double plan_width = scale * box.width(), plan_height = scale * box.depth();
    const double inner = std::max(plan_width, least_width - (kLeft + kRight) * em);
    const double inner_height = std::max(plan_height, kMinHeight * em);
    const double top = (with_title ? kTitle : 0) * em + kTop * em;
    Page page{inner + (kLeft + kRight) * em, std::ceil(top + inner_height + kBottom * em), {}};
    page.style.em = em;
    page.style.box = box;
    page.style.view = {
        scale,
        {box.low.x, box.high.y},
        {kLeft * em + (inner - plan_width) / 2, top + (inner_height - plan_height) / 2}};
    return page;
}

Page layOutScreen(const Box2& box, const PlanOptions& options) {
    if (options.width < kMinWidth || options.width > kMaxWidth)
        throw UsageError("a plan " + std::to_string(options.width) +
                         " pixels wide cannot be drawn, wanted " + std::to_string(kMinWidth) +
                         " to " + std::to_string(kMaxWidth));
    const double em = std::max(9.0, options.width / 1200.0 * 15);
    const double inner = options.width - (kLeft + kRight) * em;
    const double scale = std::min(inner / box.width(), kTall * options.width / box.depth());
    Page page = layOut(box, em, scale, !options.title.empty(), options.width);
    page.width = options.width;  // without rounding errors
    return page;
}

/// Returns the denominator of the largest usual scale at which the plan fits on the paper.
double paperScale(const Box2& box) {
    const double inner_long = kPaperLong - (kLeft + kRight) * kPaperText;
    const double inner_short = kPaperShort - (kTop + kTitle + kBottom) * kPaperText;
    const double longer = std::max(box.width(), box.depth());
    const double shorter = std::min(box.width(), box.depth());
    return usualScale(1000 * std::max(longer / inner_long, shorter / inner_short));
}

/// Returns metres between grid lines: 1, unless lines would be too dense, or all outside the plan.
double gridStep(const Page& page) {
    constexpr double kNearest = 0.7, kMaxDistance = 25;  // in text sizes
    if (page.metres(kNearest) > 1) return roundStep(page.metres(kNearest));
    if (page.metres(kMaxDistance) < 1) return std::min(1.0, roundStep(page.metres(4)));
    return 1;
}

/// The multiples of a step along a side of the plan, in metres.
struct Ticks {
    double step;
    double label_every;  ///< every `label_every`-th tick has a label
    std::vector<double> multiples = {};

    /// Labels that are `width` text sizes wide do not touch.
    Ticks(const Page& page, double low, double high, double width)
        : step(gridStep(page)), label_every(std::max(1.0, roundStep(page.metres(width) / step))) {
        // Counted: far from the origin, adding 1 may not change a multiple.
        const double first = std::ceil(low / step - 1e-9), last = std::floor(high / step + 1e-9);
        const auto count = static_cast<int>(std::min(last - first, 10000.0));
        for (int i = 0; i <= count; ++i) multiples.push_back(first + i);
    }
    [[nodiscard]] bool hasLabel(double k) const { return std::fmod(std::abs(k), label_every) == 0; }
    /// Formats a multiple without round-off.
    [[nodiscard]] std::string label(double k) const {
        const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
        return formatFixed(k * step, decimals);
    }
};

void drawGrid(Picture& picture, PlanDrawing& plan, const Page& page) {
    const Box2& box = page.style.box;
    const double em = page.style.em;
    std::vector<Segment2> fine, strong;
    const Ticks across(page, box.low.x, box.high.x, 3.2), up(page, box.low.y, box.high.y, 1.6);
    for (const double k : across.multiples)
        (across.hasLabel(k) ? strong : fine)
            .push_back({{k * across.step, box.low.y}, {k * across.step, box.high.y}});
    for (const double k : up.multiples)
        (up.hasLabel(k) ? strong : fine)
            .push_back({{box.low.x, k * up.step}, {box.high.x, k * up.step}});
    const PlanLayer layer(plan, "grid");
    picture.pushGroup("", "grid of " + formatDouble(across.step) + " m");
    picture.lines(fine, {Stroke{kGrid.faded(0.28), 0.05 * em}});
    picture.lines(strong, {Stroke{kGrid.faded(0.6), 0.06 * em}});
    picture.pop();
}

/// Draws coordinates, the plan's edge, the scale bar with its text, and the title.
void drawFrame(Picture& picture, const Page& page, const std::string& title,
               const std::vector<std::string>& notes) {
    const Box2& box = page.style.box;
    const PageView& view = page.style.view;
    const double em = page.style.em;
    picture.pushLayer("frame");
    picture.pushGroup("", "coordinates in metres");
    TextStyle style{0.75 * em, false, Align::Center, kFaintInk, {}};
    const Ticks across(page, box.low.x, box.high.x, 3.2), up(page, box.low.y, box.high.y, 1.6);
    const Point2 corner = view * box.low;
    for (const double k : across.multiples)
        if (across.hasLabel(k))
            picture.text({(view * Point2{k * across.step, 0}).x, corner.y + 1.2 * em},
                         across.label(k), style);
    style.align = Align::Right;
    for (const double k : up.multiples)
        if (up.hasLabel(k))
            picture.text({corner.x - 0.5 * em, (view * Point2{0, k * up.step}).y + 0.27 * em},
                         up.label(k), style);
    picture.pop();
    const Point2 far = view * box.high;
    picture.area(Polygon{corner, {far.x, corner.y}, far, {corner.x, far.y}},
                 {Stroke{kGrid.faded(0.7), 0.05 * em}});
    std::string said;
    for (const std::string& note : notes) said.append("  ·  ").append(note);
    const double left = std::min(corner.x, (view * box.center()).x - 5 * em);
    drawScaleBar(picture, {left, page.height - 1.1 * em}, 15 * em, view.scale, em,
                 said + "  ·  grid " + formatDouble(across.step) + " m");
    const TextStyle head{1.35 * em, true, Align::Left, kInk, {}};
    if (!title.empty())
        picture.text({1.4 * em, 2.3 * em}, fitText(title, page.width - 2.8 * em, head), head);
    picture.pop();
}

void drawScene(Picture& picture, PlanDrawing& plan, const Page& page, const FoundRooms* found) {
    if (found != nullptr) plan.drawOtherRooms(*found);
    plan.drawFloor();
    drawGrid(picture, plan, page);
    plan.drawZones();
    plan.drawFieldsOfView();
    plan.drawThings();
    plan.drawWalls();
    plan.drawOpenings();
    plan.drawOverhead();
    plan.drawRobots();
    plan.drawSensors();
    plan.drawNames();
    if (found != nullptr) plan.drawOtherRoomsWords(*found);
}

}  // namespace

Picture planPicture(const Scene& scene, const PlanOptions& options) {
    const bool on_paper = options.format != PictureFormat::Png;
    const FoundRooms* const found = options.slice ? nullptr : options.found;
    Box2 box = planBox(scene);
    if (found != nullptr)
        for (const FoundRoom& room : found->rooms)
            for (const Region& floor : room.floor) {
                box.add(bounds(floor.outline).low);
                box.add(bounds(floor.outline).high);
            }
    std::vector<std::string> notes;
    if (on_paper) notes.push_back("1:" + formatDouble(paperScale(box)));
    if (options.slice)
        notes.push_back("obstacles at " + formatDouble(std::round(1000 * *options.slice) / 1000) +
                        " m");
    const Page page = on_paper ? layOut(box, kPaperText, 1000 / paperScale(box),
                                        !options.title.empty(), 40 * kPaperText)
                               : layOutScreen(box, options);
    Picture picture(page.width, page.height, on_paper ? PageUnit::Millimetre : PageUnit::Pixel);
    const Point2 origin = page.style.view * Point2();
    const auto round = [](double value) { return formatDouble(std::round(value * 1e4) / 1e4); };
    picture.describe(options.title.empty() ? "plan" : options.title,
                     "Millimetres on paper, 1:" + round(1e3 / page.style.view.scale) +
                         ". The plan's origin lies at " + round(origin.x) + ',' + round(origin.y) +
                         ", y up.");
    PlanDrawing plan(picture, scene, page.style);
    if (options.slice) {
        plan.drawFreeFloor(*options.slice);
        drawGrid(picture, plan, page);
        plan.drawObstacles(*options.slice);
    } else {
        drawScene(picture, plan, page, found);
    }
    drawFrame(picture, page, options.title, notes);
    return picture;
}

std::string drawPlan(const Scene& scene, const PlanOptions& options) {
    return planPicture(scene, options).write(options.format);
}

}  // namespace ispace
