// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/number.h"
#include "env/slice.h"
#include "geom/predicates.h"
#include "layout/bodies.h"
#include "layout/check_parts.h"

namespace ispace {

namespace {

Box2 boxAbout(Point2 center, double radius) {
    const Vec2 margin{radius, radius};
    return {center - margin, center + margin};
}

/// The place of a polygon or line nearest to p.
Point2 nearestOf(const Polygon& polygon, Point2 p) {
    Point2 best = polygon.front();
    forEachEdge(polygon, [&](const Segment2& edge) {
        const Point2 q = nearestPoint(edge, p);
        if (distance(p, q) < distance(p, best)) best = q;
    });
    return best;
}

}  // namespace

PlacedCheck::PlacedCheck(CheckContext& context) : context_(&context) {
    const Scene& scene = context.scene;
    std::vector<Box2> boxes;
    for (std::size_t i = 0; i < scene.placed.size(); ++i) {
        const Placed& placed = scene.placed[i];
        const Record& record = scene.records[placed.record];
        const Point2 center = placed.pose.position.onFloor();
        if (record.keyword() == "robot") {
            const RobotModel& model = scene.robots[placed.index].model;
            circles_.push_back({i, center, model.radius, model.height});
        } else if (record.keyword() == "human") {
            const double height = record.number("height");
            circles_.push_back({i, center, humanRadius(height), height});
        } else {
            continue;
        }
        boxes.push_back(boxAbout(center, circles_.back().radius));
    }
    tree_ = BoxTree(boxes);
}

Diagnostic PlacedCheck::finding(std::size_t placed, const std::string& message) const {
    const Scene& scene = context_->scene;
    return scene.records[scene.placed[placed].record].finding(context_->placedName(placed) +
                                                              message);
}

void PlacedCheck::check(std::size_t placed, Diagnostics& findings) {
    const Placed& thing = context_->scene.placed[placed];
    const Point2 p = thing.pose.position.onFloor();
    // What a robot carries is where that is.
    if (!thing.mount && context_->isOut(p))
        findings.add(
            finding(placed, " stands outside the room at " + placeText(p) + "; move it in"));
    const auto circle =
        std::lower_bound(circles_.begin(), circles_.end(), placed,
                         [](const Circle& c, std::size_t i) { return c.placed < i; });
    if (circle != circles_.end() && circle->placed == placed)
        checkCircle(*circle, findings);
    else if (context_->scene.records[thing.record].schema().find("on") != nullptr)
        checkPoint(placed, findings);
}

void PlacedCheck::checkPoint(std::size_t placed, Diagnostics& findings) {
    const Point3 p = context_->scene.placed[placed].pose.position;
    std::map<std::size_t, double> tops;  // of the solids around it, by element
    context_->parts.search({p.onFloor(), p.onFloor()}, [&](const Part& part) {
        if (part.isSheet() || p.z <= part.bottom + kTouching || p.z >= part.top - kTouching) return;
        if (!isDeepIn(part.footprint, p.onFloor())) return;
        tops[part.element] = std::max(tops[part.element], part.top);
    });
    for (auto& [element, mesh] : context_->meshes) {
        const Box2 at{p.onFloor(), p.onFloor()};
        if (!meets(mesh.box(), at) || p.z <= mesh.heights().bottom || p.z >= mesh.heights().top)
            continue;
        for (const Polygon& solid : mesh.at(p.z).solids)
            if (isDeepIn(solid, p.onFloor())) tops[element] = mesh.heights().top;
    }
    for (const auto& [element, top] : tops)
        findings.add(finding(placed, " stands inside " + context_->name(element) + " at " +
                                         placeText(p.onFloor()) + "; move it, or raise it above " +
                                         formatFixed(top, 2) + " m"));
}

const PlacedCheck::MeshBand& PlacedCheck::bandOf(std::size_t element, double height) {
    constexpr std::size_t kKept = 16;
    const auto known = bands_.find({element, height});
    if (known != bands_.end()) return known->second;
    if (bands_.size() >= kKept) bands_.clear();
    MeshBand& near = bands_[{element, height}];
    bandOfMeshes(context_->element(element).body, 0, height, near.band, element);
    std::vector<Box2> boxes;
    boxes.reserve(near.band.solids.size());
    for (const Polygon& solid : near.band.solids) boxes.push_back(bounds(solid));
    near.solids = BoxTree(boxes);
    boxes.clear();
    for (const Segment2& sheet : near.band.sheets) boxes.push_back(bounds(sheet));
    near.sheets = BoxTree(boxes);
    return near;
}

std::map<std::size_t, PlacedCheck::Met> PlacedCheck::metBy(const Circle& circle) {
    std::map<std::size_t, Met> met;
    const HeightRange heights{0, circle.height};
    const auto look = [&](std::size_t element, const Polygon& footprint) {
        const bool is_line = footprint.size() == 2;
        const Point2 nearest = nearestOf(footprint, circle.center);
        const double away = distance(circle.center, nearest);
        const bool inside = !is_line && locate(footprint, circle.center) == Side::Inside;
        if (!inside && away >= circle.radius - kTouching) return;
        const double way = inside ? circle.radius + away : circle.radius - away;
        const auto [place, is_new] = met.try_emplace(element, Met{nearest, way});
        if (!is_new && way > place->second.way) place->second = {nearest, way};
    };
    const Box2 box = boxAbout(circle.center, circle.radius);
    context_->parts.search(box, [&](const Part& part) {
        if (sharedHeights(part, heights).isShared()) look(part.element, part.footprint);
    });
    for (const auto& entry : context_->meshes) {
        const std::size_t element = entry.first;
        const MeshCuts& mesh = entry.second;
        if (!meets(mesh.box(), box) || !sharedHeights(mesh.heights(), heights).isShared()) continue;
        const MeshBand& near = bandOf(element, circle.height);
        near.solids.search(box, [&](std::size_t i) { look(element, near.band.solids[i]); });
        near.sheets.search(box, [&](std::size_t i) {
            look(element, {near.band.sheets[i].a, near.band.sheets[i].b});
        });
    }
    return met;
}

void PlacedCheck::checkCircle(const Circle& circle, Diagnostics& findings) {
    for (const auto& [element, met] : metBy(circle)) {
        if (findings.full()) return;
        findings.add(finding(circle.placed, " stands in " + context_->name(element) + " near " +
                                                placeText(met.place) + "; move it, e.g. by " +
                                                wayText(met.way)));
    }
    std::vector<const Circle*> others;
    tree_.search(boxAbout(circle.center, circle.radius), [&](std::size_t i) {
        const Circle& other = circles_[i];
        if (other.placed > circle.placed &&
            distance(circle.center, other.center) < circle.radius + other.radius - kTouching)
            others.push_back(&other);
    });
    std::sort(others.begin(), others.end(),
              [](const Circle* a, const Circle* b) { return a->placed < b->placed; });
    for (const Circle* other : others) {
        if (findings.full()) return;
        const double away = distance(circle.center, other->center);
        const Point2 middle = circle.center + 0.5 * (other->center - circle.center);
        findings.add(finding(circle.placed, " overlaps " + context_->placedName(other->placed) +
                                                " near " + placeText(middle) +
                                                "; move one, e.g. by " +
                                                wayText(circle.radius + other->radius - away)));
    }
}

}  // namespace ispace
