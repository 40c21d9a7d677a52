// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "io/plan_drawing.h"

namespace ispace {

namespace {

Stroke onPage(const Stroke& line, double em) {
    Stroke stroke = line;
    stroke.width *= em;
    for (double& dash : stroke.dashes) dash *= em;
    return stroke;
}

void draw(Canvas& canvas, const DrawnPath& path, double em) {
    if (path.fill) canvas.fill(path.curves, *path.fill);
    if (!path.line) return;
    const Stroke stroke = onPage(*path.line, em);
    for (const std::vector<Point2>& curve : path.curves) {
        if (path.closed)
            canvas.stroke(curve, stroke);
        else
            canvas.polyline(curve, stroke);
    }
}

void draw(Canvas& canvas, const DrawnText& text, double em) {
    TextStyle style{text.size * em, text.bold, text.align, text.color, {}};
    if (text.halo) style.halo = plan_colors::kPaper.faded(0.85);
    canvas.text(text.anchor, text.text, style);
}

/// The items of one layer after another, each within what its layer may cover.
class Painter {
  public:
    explicit Painter(const PlanDrawing& plan)
        : plan_(plan), canvas_(PictureFormat::Png, plan.width, plan.height) {}

    std::string paint() {
        canvas_.pushView(plan_.view);
        const double rim = plan_.metres() / 2;  // pens on the edge are drawn whole
        const Point2 low = plan_.box.low - Vec2{rim, rim}, high = plan_.box.high + Vec2{rim, rim};
        canvas_.pushClip({low, {high.x, low.y}, high, {low.x, high.y}});
        paint(PlanLayer::Floor, PlanLayer::Zones);
        canvas_.pushClip(curvesOf(plan_.indoor));
        paint(PlanLayer::Views, PlanLayer::Views);
        canvas_.pop();
        paint(PlanLayer::Objects, PlanLayer::Sensors);
        canvas_.pop();
        paint(PlanLayer::Labels, PlanLayer::Frame);
        return canvas_.encode();
    }

  private:
    void paint(PlanLayer first, PlanLayer last) {
        for (const DrawnItem& item : plan_.items) {
            if (item.layer < first || item.layer > last) continue;
            for (const DrawnPath& path : item.paths) draw(canvas_, path, plan_.em);
            for (const DrawnText& text : item.texts) draw(canvas_, text, plan_.em);
        }
    }

    const PlanDrawing& plan_;
    Canvas canvas_;
};

}  // namespace

std::string planPng(const PlanDrawing& plan) { return Painter(plan).paint(); }

}  // namespace ispace
