// SPDX-License-Identifier: GPL-3.0-or-later
// What stands in the room of a plan, and what hangs from its ceiling.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/number.h"
#include "plan/drawing.h"

namespace ispace {

namespace {

using namespace palette;

/// What begins above people's heads is drawn as what hangs.
constexpr double kOverhead = 1.9;

double areaOf(const PartAbove& part) {
    double area = 0;
    for (const Polygon& curve : part.curves) area += signedArea(curve);
    return std::abs(area);
}

}  // namespace

std::vector<PlanDrawing::Thing> PlanDrawing::thingsOf(const Environment& environment) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::vector<Thing> things;
    for (const Element& element : environment.elements()) {
        const RecordType type = element.record.schema().type;
        if (type == RecordType::Infra || type == RecordType::Other)
            things.push_back({&element, {}, {}, kInfinity, -kInfinity});
    }
    constexpr std::size_t kFew = 64;  // are done before another thread would begin
    const auto look_at = [](Thing& thing) {
        thing.parts = partsFromAbove(thing.element->body);
        double largest = -1;
        for (const PartAbove& part : thing.parts) {
            thing.bottom = std::min(thing.bottom, part.bottom);
            thing.top = std::max(thing.top, part.top);
            for (const Polygon& curve : part.curves)
                for (const Point2 p : curve) thing.box.add(p);
            const double area = areaOf(part);
            if (area < largest) continue;
            largest = area;
            thing.height = part.top;
        }
    };
    tbb::parallel_for(tbb::blocked_range(std::size_t{0}, things.size(), kFew),
                      [&](const auto& range) {
                          for (std::size_t i = range.begin(); i < range.end(); ++i)
                              look_at(things[i]);
                      });
    std::erase_if(things, [](const Thing& thing) { return thing.parts.empty(); });
    std::stable_sort(things.begin(), things.end(),
                     [](const Thing& a, const Thing& b) { return a.height < b.height; });
    return things;
}

std::string PlanDrawing::thingTitle(const Thing& thing) {
    const auto round = [](double value) { return formatDouble(std::round(value * 1000) / 1000); };
    return thing.element->id + ": " + thing.element->record.keyword() + ", from " +
           round(thing.bottom) + " to " + round(thing.top) + " m";
}

bool PlanDrawing::isOverhead(const Thing& thing) const {
    return !style_.neutral && thing.bottom >= kOverhead;
}

void PlanDrawing::drawThings() {
    const PlanLayer layer(*this, "objects");
    for (const Thing& thing : things_) {
        if (isOverhead(thing)) continue;
        picture_.pushGroup(thing.element->id, thingTitle(thing));
        if (style_.neutral)
            drawNeutralThing(thing);
        else
            drawThing(thing);
        picture_.pop();
    }
}

void PlanDrawing::drawThing(const Thing& thing) {
    // A pen that leaves small things their colour.
    const double side = std::min(thing.box.width(), thing.box.depth());
    const double width = std::clamp(0.05 * side / metres(1), 0.045, 0.07);
    for (const PartAbove& part : thing.parts) {
        if (part.hidden) continue;
        const Color color = displayColor(part.material);
        picture_.area(part.curves,
                      {mixed(color, kWhite, 0.3), pen(mixed(color, kInk, 0.6).faded(1), width)});
    }
    // Feet and panels below a board, as plans have hidden edges.
    for (const PartAbove& part : thing.parts) {
        const Color edge = mixed(displayColor(part.material), kInk, 0.5).faded(0.55);
        if (part.hidden) picture_.area(part.curves, {pen(edge, 0.04, {0.2, 0.15})});
    }
}

void PlanDrawing::drawNeutralThing(const Thing& thing) {
    for (const bool at_cut : {false, true})
        for (const PartAbove& part : thing.parts) {
            if (standsAt(part.bottom, part.top, style_.cut) != at_cut) continue;
            // What does not stand in the way lets the floor's colour through.
            if (at_cut)
                picture_.area(part.curves, {kSolid, pen(kSolidEdge, 0.0625)});
            else
                picture_.area(part.curves, {kObject.faded(0.6), pen(kObjectEdge, 0.0625)});
        }
}

void PlanDrawing::drawOverhead() {
    const PlanLayer layer(*this, "infra");
    for (const Thing& thing : things_) {
        if (!isOverhead(thing)) continue;
        picture_.pushGroup(thing.element->id, thingTitle(thing));
        for (const PartAbove& part : thing.parts)
            picture_.area(part.curves,
                          {pen(mixed(displayColor(part.material), kInk, 0.5), 0.07, {0.4, 0.25})});
        picture_.pop();
    }
}

}  // namespace ispace
