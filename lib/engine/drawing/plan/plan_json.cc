// SPDX-License-Identifier: GPL-3.0-or-later
// The plan for the page of a run: drawn once as a picture, and its shapes turned back into metres,
// rounded to a millimetre, so that page and files show the same drawing.
#include "drawing/plan/plan_json.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "drawing/drawing.h"
#include "drawing/plan/elements.h"
#include "drawing/plan/plan.h"
#include "env/body.h"
#include "env/level.h"
#include "scene/bodies.h"
#include "scene/sensor/sensor.h"

namespace ispace {

namespace {

using Kind = DisplayList::Kind;

/// Size of the picture for which pens are chosen, in pixels.
constexpr double kWidth = 1000, kText = 12;

double toMillimetre(double metres) { return std::round(metres * 1000) / 1000; }
double toHundredth(double pixels) { return std::round(pixels * 100) / 100; }

/// Converts a picture's shapes back to metres.
class ShapeWriter {
  public:
    ShapeWriter(JsonWriter& json, const DisplayList& list, const PageView& view)
        : json_(json), list_(list), view_(view) {}

    void write() {
        json_.beginArray();
        for (const DisplayList::Shape& shape : list_.shapes) add(shape);
        json_.endArray();
    }

  private:
    void add(const DisplayList::Shape& shape) {
        switch (shape.kind) {
            case Kind::Layer:
                json_.beginObject().key("name").value(list_.names[names_++].title);
                json_.key("groups").beginArray();
                break;
            case Kind::Group:
                json_.beginObject().key("id").value(list_.names[names_].id);
                json_.key("title").value(list_.names[names_++].title).key("shapes").beginArray();
                break;
            case Kind::End:
                json_.endArray().endObject();
                break;
            case Kind::Area:
            case Kind::Lines:
                json_.beginObject().key(shape.kind == Kind::Area ? "area" : "lines").beginArray();
                for (std::uint32_t i = shape.first; i < shape.last; ++i) addCurve(i);
                json_.endArray();
                addInks(shape);
                break;
            case Kind::Arc:
                addArc(shape);
                break;
            case Kind::Text:
            case Kind::Image:
                break;  // absent from the plan's fixed part
        }
    }

    void addPoint(Point2 page) {
        json_.value(
            toMillimetre(view_.world_anchor.x + (page.x - view_.page_anchor.x) / view_.scale));
        json_.value(
            toMillimetre(view_.world_anchor.y - (page.y - view_.page_anchor.y) / view_.scale));
    }

    void addCurve(std::uint32_t index) {
        json_.beginArray();
        for (const Point2 p : list_.curve(index)) addPoint(p);
        json_.endArray();
    }

    void addArc(const DisplayList::Shape& shape) {
        const DisplayList::Arc& arc = list_.arcs[shape.first];
        json_.beginObject().key("arc").beginArray();
        addPoint(arc.center);
        json_.value(toMillimetre(arc.radius / view_.scale));
        json_.value(toHundredth(arc.from.degrees())).value(toHundredth(arc.to.degrees()));
        json_.endArray();
        addInks(shape);
    }

    /// Writes the inks, and ends the shape.
    void addInks(const DisplayList::Shape& shape) {
        json_.key("inks").beginArray();
        for (const Ink& ink : list_.inksOf(shape)) {
            if (const auto* fill = std::get_if<Color>(&ink)) {
                json_.beginObject().key("fill").value(cssColor(*fill)).endObject();
            } else if (const auto* stroke = std::get_if<Stroke>(&ink)) {
                json_.beginObject().key("line").value(cssColor(stroke->color));
                json_.key("width").value(toHundredth(stroke->width));
                if (!stroke->dashes.empty()) {
                    json_.key("dash").beginArray();
                    for (const double dash : stroke->dashes) json_.value(toHundredth(dash));
                    json_.endArray();
                }
                json_.endObject();
            }
        }
        json_.endArray().endObject();
    }

    JsonWriter& json_;
    const DisplayList& list_;
    PageView view_;
    std::size_t names_ = 0;
};

}  // namespace

void writePlan(JsonWriter& json, const Scene& scene) {
    const Box2 box = planBox(scene);
    const double scale = kWidth / std::max(box.width(), box.depth());
    PlanStyle style;
    style.view = {scale, {box.low.x, box.high.y}, {}};
    style.em = kText;
    style.box = box;
    Picture picture(kWidth, kWidth);
    PlanDrawing plan(picture, scene, style);
    plan.drawFloor();
    plan.drawZones();
    plan.drawThings();
    plan.drawWalls();
    plan.drawOpenings();
    plan.drawOverhead();
    json.beginObject().key("box").beginArray();
    for (const double side : {box.low.x, box.low.y, box.high.x, box.high.y})
        json.value(toMillimetre(side));
    json.endArray().key("layers");
    ShapeWriter(json, picture.list(), style.view).write();
    json.endObject();
}

}  // namespace ispace
