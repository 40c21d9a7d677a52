// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "base/number.h"
#include "plan/drawing.h"

namespace ispace {

namespace {

Stroke onPage(const Stroke& line, double em) {
    Stroke stroke = line;
    stroke.width *= em;
    for (double& dash : stroke.dashes) dash *= em;
    return stroke;
}

void draw(Picture& picture, const DrawnPath& path, double em) {
    if (path.closed && path.fill && path.line)
        picture.area(path.curves, {*path.fill, onPage(*path.line, em)});
    else if (path.fill)
        picture.area(path.curves, {*path.fill});
    else if (path.closed)
        picture.area(path.curves, {onPage(*path.line, em)});
    else
        picture.lines(path.curves, {onPage(*path.line, em)});
}

void draw(Picture& picture, const DrawnText& text, double em) {
    TextStyle style{text.size * em, text.bold, text.align, text.color, {}};
    if (text.halo) style.halo = plan_colors::kPaper.faded(0.85);
    picture.text(text.anchor, text.text, style);
}

/// What a layer may cover: all but labels and the frame keep within the plan.
std::vector<Polygon> clipOf(const PlanDrawing& plan, PlanLayer layer) {
    if (layer == PlanLayer::Views) return curvesOf(plan.indoor);
    if (layer >= PlanLayer::Labels) return {};
    const double rim = plan.metres() / 2;  // pens on the edge are drawn whole
    const Point2 low = plan.box.low - Vec2{rim, rim}, high = plan.box.high + Vec2{rim, rim};
    return {{low, {high.x, low.y}, high, {low.x, high.y}}};
}

}  // namespace

std::string writePlan(const PlanDrawing& plan, PictureFormat format, const std::string& title) {
    const bool on_paper = format != PictureFormat::Png;
    Picture picture(plan.width, plan.height, on_paper ? PageUnit::Millimetre : PageUnit::Pixel);
    const Point2 origin = plan.view * Point2();
    const auto round = [](double value) { return formatDouble(std::round(value * 1e4) / 1e4); };
    picture.describe(title.empty() ? "plan" : title,
                     "Millimetres on paper, 1:" + round(1e3 / plan.view.scale) +
                         ". The plan's origin lies at " + round(origin.x) + ',' + round(origin.y) +
                         ", y up.");
    picture.pushView(plan.view);
    for (std::size_t i = 0; i < kPlanLayers.size(); ++i) {
        const auto layer = static_cast<PlanLayer>(i);
        picture.pushLayer(kPlanLayers[i], clipOf(plan, layer));
        for (const DrawnItem& item : plan.items) {
            if (item.layer != layer) continue;
            picture.pushGroup(item.id, item.title);
            for (const DrawnPath& path : item.paths) draw(picture, path, plan.em);
            for (const DrawnText& text : item.texts) draw(picture, text, plan.em);
            picture.pop();
        }
        picture.pop();
    }
    picture.pop();
    return picture.write(format);
}

}  // namespace ispace
