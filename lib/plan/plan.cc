// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/plan.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/number.h"
#include "plan/drawing.h"

namespace ispace {

namespace {

constexpr int kLeastWidth = 200, kMostWidth = 12000;

/// Around the plan, in sizes of text: coordinates on the left and below, then the bar of scale.
constexpr double kLeft = 3.4, kRight = 1.6, kBottom = 4.6, kTop = 1.4, kTitle = 2.4;
/// A mere strip of a room still gets room for marks and names.
constexpr double kLeastHeight = 5;
/// Most height of a picture's plan, of its width.
constexpr double kTall = 1.4;

/// A3 across less some margin, and the text of a plan on paper, in millimetres.
constexpr double kPaperLong = 400, kPaperShort = 277, kPaperText = 2.8;

/// Lays the plan on a page, with `scale` page units a metre.
void layOut(PlanDrawing& plan, double scale, bool with_title, double least_width) {
    const double em = plan.em;
    const double plan_width = scale * plan.box.width(), plan_height = scale * plan.box.depth();
    const double inner = std::max(plan_width, least_width - (kLeft + kRight) * em);
    const double inner_height = std::max(plan_height, kLeastHeight * em);
    const double top = (with_title ? kTitle : 0) * em + kTop * em;
    plan.width = inner + (kLeft + kRight) * em;
    plan.height = std::ceil(top + inner_height + kBottom * em);
    plan.view = {scale,
                 {plan.box.low.x, plan.box.high.y},
                 {kLeft * em + (inner - plan_width) / 2, top + (inner_height - plan_height) / 2}};
}

void layOutPicture(PlanDrawing& plan, const PlanOptions& options) {
    if (options.width < kLeastWidth || options.width > kMostWidth)
        throw UsageError("a plan " + std::to_string(options.width) +
                         " pixels wide cannot be drawn, wanted " + std::to_string(kLeastWidth) +
                         " to " + std::to_string(kMostWidth));
    plan.em = std::max(9.0, options.width / 1200.0 * 15);
    const double inner = options.width - (kLeft + kRight) * plan.em;
    const double scale =
        std::min(inner / plan.box.width(), kTall * options.width / plan.box.depth());
    layOut(plan, scale, !options.title.empty(), options.width);
    plan.width = options.width;  // without what rounding adds
}

/// Denominator of the largest usual scale (1, 2, 5, 10, 20, 25, 50, 100, 200, 250, …) at which the
/// plan fits on the paper.
double paperScale(const Box2& box) {
    const double inner_long = kPaperLong - (kLeft + kRight) * kPaperText;
    const double inner_short = kPaperShort - (kTop + kTitle + kBottom) * kPaperText;
    const double longer = std::max(box.width(), box.depth());
    const double shorter = std::min(box.width(), box.depth());
    const double least = 1000 * std::max(longer / inner_long, shorter / inner_short);
    double power = 1;
    for (;; power *= 10)
        for (const double digit : {1.0, 2.0, 2.5, 5.0})
            if (const double scale = digit * power; scale >= least && scale == std::floor(scale))
                return scale;
}

double layOutPaper(PlanDrawing& plan, const PlanOptions& options) {
    plan.em = kPaperText;
    const double scale = paperScale(plan.box);
    layOut(plan, 1000 / scale, !options.title.empty(), 40 * plan.em);
    return scale;
}

}  // namespace

std::string drawPlan(const Scene& scene, const PlanOptions& options) {
    if (options.format == PictureFormat::Pdf)
        throw UsageError("a plan is drawn as PNG or SVG, not as PDF");
    const bool on_paper = options.format == PictureFormat::Svg;
    PlanDrawing plan;
    plan.box = planBox(scene);
    plan.indoor = scene.environment.indoor();
    std::vector<std::string> notes;
    if (on_paper)
        notes.push_back("1:" + formatDouble(layOutPaper(plan, options)));
    else
        layOutPicture(plan, options);
    if (options.slice) {
        addObstacles(plan, scene.environment, *options.slice);
        notes.push_back("obstacles at " + formatDouble(*options.slice) + " m");
    } else {
        addRoom(plan, scene);
        addThings(plan, scene);
        addPlaced(plan, scene);
    }
    addFrame(plan, options.title, notes);
    return writePlan(plan, options.format, options.title);
}

}  // namespace ispace
