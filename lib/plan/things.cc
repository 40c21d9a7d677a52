// SPDX-License-Identifier: GPL-3.0-or-later
// What stands in the room of a plan, and what hangs from its ceiling.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/number.h"
#include "plan/display_color.h"
#include "plan/footprint.h"
#include "plan/drawing.h"

namespace ispace {

namespace {

using namespace plan_colors;

/// What begins above people's heads is drawn as what hangs.
constexpr double kOverhead = 1.9;

struct Thing {
    const Element* element;
    std::vector<PartAbove> parts;
    double height = 0;  ///< of its largest part, by which things are laid over each other
};

double areaOf(const PartAbove& part) {
    double area = 0;
    for (const Polygon& curve : part.curves) area += signedArea(curve);
    return std::abs(area);
}

bool hangs(const Thing& thing) {
    return std::all_of(thing.parts.begin(), thing.parts.end(),
                       [](const PartAbove& part) { return part.bottom >= kOverhead; });
}

std::vector<Thing> thingsOf(const Environment& environment) {
    std::vector<Thing> things;
    for (const Element& element : environment.elements()) {
        const RecordType type = element.record.schema().type;
        if (type != RecordType::Infra && type != RecordType::Other) continue;
        Thing thing{&element, partsFromAbove(element.body)};
        if (thing.parts.empty()) continue;
        double largest = -1;
        for (const PartAbove& part : thing.parts) {
            const double area = areaOf(part);
            if (area < largest) continue;
            largest = area;
            thing.height = part.top;
        }
        things.push_back(std::move(thing));
    }
    std::stable_sort(things.begin(), things.end(),
                     [](const Thing& a, const Thing& b) { return a.height < b.height; });
    return things;
}

std::string titleOf(const Thing& thing) {
    double bottom = std::numeric_limits<double>::infinity(), top = -bottom;
    for (const PartAbove& part : thing.parts) {
        bottom = std::min(bottom, part.bottom);
        top = std::max(top, part.top);
    }
    const auto round = [](double value) { return formatDouble(std::round(value * 1000) / 1000); };
    return thing.element->id + ": " + thing.element->record.keyword() + ", from " + round(bottom) +
           " to " + round(top) + " m";
}

/// A pen that leaves small things their colour.
double penWidth(const PlanDrawing& plan, const Thing& thing) {
    Box2 box;
    for (const PartAbove& part : thing.parts)
        for (const Polygon& curve : part.curves)
            for (const Point2 p : curve) box.add(p);
    return std::clamp(0.05 * std::min(box.width(), box.depth()) / plan.metres(), 0.045, 0.07);
}

DrawnItem hangingItem(const Thing& thing) {
    DrawnItem item{PlanLayer::Infra, thing.element->id, titleOf(thing)};
    for (const PartAbove& part : thing.parts) {
        const Color edge = mixed(displayColor(part.material), kInk, 0.5);
        item.paths.push_back({part.curves, true, {}, Stroke{edge, 0.07, {0.4, 0.25}}});
    }
    return item;
}

DrawnItem standingItem(const PlanDrawing& plan, const Thing& thing) {
    DrawnItem item{PlanLayer::Objects, thing.element->id, titleOf(thing)};
    const double pen = penWidth(plan, thing);
    for (const PartAbove& part : thing.parts) {
        if (part.hidden) continue;
        const Color color = displayColor(part.material);
        item.paths.push_back({part.curves, true, mixed(color, kPaper, 0.3),
                              Stroke{mixed(color, kInk, 0.6).faded(1), pen}});
    }
    // Feet and panels below a board, as plans have hidden edges.
    for (const PartAbove& part : thing.parts) {
        const Color edge = mixed(displayColor(part.material), kInk, 0.5).faded(0.55);
        if (part.hidden)
            item.paths.push_back({part.curves, true, {}, Stroke{edge, 0.04, {0.2, 0.15}}});
    }
    return item;
}

/// The id in the middle of the thing, where it has room.
void addName(PlanDrawing& plan, const Thing& thing) {
    Box2 box;
    for (const PartAbove& part : thing.parts)
        for (const Polygon& curve : part.curves)
            for (const Point2 p : curve) box.add(p);
    const double em = plan.metres();
    const TextStyle style{0.7 * plan.em, false, Align::Center, kInk, {}};
    if (box.depth() < 0.8 * em ||
        textWidth(thing.element->id, style) * em / plan.em > 0.96 * box.width())
        return;
    const Point2 middle = box.center();
    DrawnItem item{PlanLayer::Labels, "", ""};
    DrawnText name{{middle.x, middle.y - 0.25 * em}, thing.element->id, 0.7, Align::Center, kInk};
    name.halo = true;
    item.texts.push_back(std::move(name));
    plan.items.push_back(std::move(item));
}

}  // namespace

void addThings(PlanDrawing& plan, const Scene& scene) {
    for (const Thing& thing : thingsOf(scene.environment)) {
        if (hangs(thing)) {
            plan.items.push_back(hangingItem(thing));
            continue;
        }
        plan.items.push_back(standingItem(plan, thing));
        addName(plan, thing);
    }
}

}  // namespace ispace
