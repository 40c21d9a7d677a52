// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "base/number.h"
#include "env/slice.h"
#include "geom/predicates.h"
#include "geom/visibility/visibility.h"
#include "scene/bodies.h"
#include "scene/findings/findings.h"
#include "scene/placement_schemas.h"
#include "scene/sensor/sensor.h"

namespace ispace {

namespace {

Box2 boxAbout(Point2 center, double radius) {
    const Vec2 margin{radius, radius};
    return {center - margin, center + margin};
}

/// Returns the point of a polygon or line nearest to p.
Point2 nearestOf(const Polygon& polygon, Point2 p) {
    Point2 best = polygon.front();
    forEachEdge(polygon, [&](const Segment2& edge) {
        const Point2 q = nearestPoint(edge, p);
        if (distance(p, q) < distance(p, best)) best = q;
    });
    return best;
}

/// Names the keys that say where a sensor is, those of its kind, too: "`at` or `on`".
std::string waysToPlace(const SensorKind& kind, const Schema& schema) {
    std::string others;
    if (kind.place != nullptr)
        for (const KeySpec& key : schema.keys)
            if (key.role == Role::Reference) others.append(" or `").append(key.name).append("`");
    return (others.empty() ? "`at` or `on`" : "`at`, `on`") + others;
}

}  // namespace

void checkUnplaced(CheckContext& context, std::size_t record, std::vector<Finding>& findings) {
    if (record == context.scene.records.size()) return;
    const Record& sensor = context.scene.records[record];
    const SensorKind* const kind = sensorKind(sensor.keyword());
    if (kind == nullptr || !kind->is_read || sensor.has("at") || sensor.has("on")) return;
    if (context.placed_of[record] != nullptr) return;  // by its kind
    std::string hint = "give it " + waysToPlace(*kind, sensor.schema());
    if (kind->is_arranged) hint += ", or let arrange place it";
    findings.push_back(context.finding(record, Severity::Warning, {},
                                       " has no position and takes no readings", hint));
}

void checkOutside(CheckContext& context, std::size_t record, std::vector<Finding>& findings) {
    const PlacedRecord* const placed = context.placed_of[record];
    if (placed == nullptr || placed->mount) return;
    const Point3 p = placed->pose.position;
    const bool is_out = context.isOut(p.onFloor());
    if (!is_out && p.z >= -kCornerTolerance) return;
    findings.push_back(
        context.finding(record, Severity::Error, p.onFloor(),
                        (is_out ? " stands outside the room at " : " stands below the floor at ") +
                            placeText(p.onFloor()),
                        is_out ? "move it in" : "raise it by " + distanceText(-p.z)));
}

namespace {

/// The solids over a point, from the floor up.
class SolidsOver {
  public:
    /// \param slack by which a sensor may stand in the top or the bottom of a solid
    SolidsOver(CheckContext& context, Point2 at, double slack)
        : context_(context), at_(at), slack_(slack) {
        context.partsAbout().search({at, at}, [&](const Part& part) {
            if (!part.isSheet() && containsWithMargin(part.footprint, at, kRayEpsilon))
                parts_.push_back(&part);
        });
    }

    /// Returns the tops of the solids that share heights with this range, by element.
    [[nodiscard]] std::map<std::size_t, double> topsIn(double low, double high) const {
        std::map<std::size_t, double> tops;
        for (const Part* const part : parts_)
            if (high >= part->bottom + slack_ && low <= part->top - slack_)
                tops[part->element] = std::max(tops[part->element], part->top);
        for (auto& [element, mesh] : context_.meshes()) {
            const HeightRange& heights = mesh.heights();
            if (!mesh.box().meets({at_, at_}) || high <= heights.bottom || low >= heights.top)
                continue;
            for (const double height : {low, high}) {
                if (height <= heights.bottom || height >= heights.top) continue;
                for (const Polygon& solid : mesh.at(height).solids)
                    if (containsWithMargin(solid, at_, kRayEpsilon)) tops[element] = heights.top;
            }
        }
        return tops;
    }

    /// Returns the lowest hundredth of a metre above a height with some free height over it.
    [[nodiscard]] double freeAbove(double height) const {
        constexpr double kGap = 0.1, kStep = 100;
        double free = height;
        for (auto tops = topsIn(height, height); !tops.empty(); tops = topsIn(free, free + kGap)) {
            double top = free;
            for (const auto& entry : tops) top = std::max(top, entry.second);
            const double next = std::ceil(kStep * top - kCornerTolerance) / kStep;
            free = next > free ? next : (std::round(kStep * free) + 1) / kStep;
        }
        return free;
    }

  private:
    CheckContext& context_;
    Point2 at_;
    double slack_;
    std::vector<const Part*> parts_;
};

}  // namespace

void checkBuried(CheckContext& context, std::size_t record, std::vector<Finding>& findings) {
    const PlacedRecord* const placed = context.placed_of[record];
    if (placed == nullptr || !mayBeCarried(context.scene.records[record].schema())) return;
    const Point3 p = placed->pose.position;
    const Point2 at = p.onFloor();
    // A level laser measures in the plane of its height, where tops and bottoms count as solid.
    const double slack = context.scene.records[record].keyword() == "laser" ? 0 : kCornerTolerance;
    const SolidsOver solids(context, at, slack);
    const std::map<std::size_t, double> tops = solids.topsIn(p.z, p.z);
    if (tops.empty()) return;
    const double free = solids.freeAbove(p.z);
    const std::string advice = free < context.scene.environment.height()
                                   ? "move it, or raise it above " + formatFixed(free, 2) + " m"
                                   : "move it";
    for (const auto& entry : tops)
        findings.push_back(context.finding(
            record, Severity::Error, at,
            " stands inside " + context.elementName(entry.first) + " at " + placeText(at), advice));
}

void checkPath(CheckContext& context, std::size_t record, std::vector<Finding>& findings) {
    const PlacedRecord* const placed = context.placed_of[record];
    if (placed == nullptr) return;
    const Scene& scene = context.scene;
    const std::string& keyword = scene.records[record].keyword();
    if (keyword != "robot" && keyword != "human") return;
    const std::vector<Point2>& path = keyword == "robot" ? scene.robots[placed->index].course.path
                                                         : scene.people[placed->index].course.path;
    if (context.isOut(placed->pose.position.onFloor())) return;
    for (const Point2 p : path) {
        if (isFull(findings)) return;
        if (context.isOut(p))
            findings.push_back(context.finding(
                record, Severity::Warning, p, " has a path that leaves the room at " + placeText(p),
                "move that point in"));
    }
}

CircleCheck::CircleCheck(CheckContext& context) : context_(&context) {
    const Scene& scene = context.scene;
    std::vector<Box2> boxes;
    for (const PlacedRecord& placed : scene.placed) {
        const Record& record = scene.records[placed.record];
        const Point2 center = placed.pose.position.onFloor();
        if (record.keyword() == "robot") {
            const RobotModel& model = scene.robots[placed.index].model;
            circles_.push_back({placed.record, center, model.radius, model.height});
        } else if (record.keyword() == "human") {
            const PlacedPerson& person = scene.people[placed.index];
            // People sit and lie on things.
            if (person.figure != nullptr && !person.figure->rest.empty()) continue;
            const double height = person.height;
            circles_.push_back({placed.record, center, humanRadius(height), height});
        } else {
            continue;
        }
        boxes.push_back(boxAbout(center, circles_.back().radius));
    }
    tree_ = BoxTree(boxes);
}

const CircleCheck::MeshBand& CircleCheck::bandOf(std::size_t element, double height) {
    constexpr std::size_t kKept = 16;
    const auto known = bands_.find({element, height});
    if (known != bands_.end()) return known->second;
    if (bands_.size() >= kKept) bands_.clear();
    MeshBand& near = bands_[{element, height}];
    bandOfMeshes(context_->element(element).body, 0, height, near.band, element);
    near.solids = BoxTree(boundsOfEach(near.band.solids));
    near.sheets = BoxTree(boundsOfEach(near.band.sheets));
    return near;
}

std::map<std::size_t, CircleCheck::Met> CircleCheck::metBy(const Circle& circle) {
    std::map<std::size_t, Met> met;
    const HeightRange heights{0, circle.height};
    const auto look = [&](std::size_t element, const Polygon& footprint) {
        const bool is_line = footprint.size() == 2;
        const Point2 nearest = nearestOf(footprint, circle.center);
        const double away = distance(circle.center, nearest);
        const bool inside = !is_line && locate(footprint, circle.center) == Side::Inside;
        if (!inside && away >= circle.radius - kCornerTolerance) return;
        const double way = inside ? circle.radius + away : circle.radius - away;
        const auto [place, is_new] = met.try_emplace(element, Met{nearest, way});
        if (!is_new && way > place->second.way) place->second = {nearest, way};
    };
    const Box2 box = boxAbout(circle.center, circle.radius);
    context_->parts().search(box, [&](const Part& part) {
        if (sharedHeights(part, heights).isShared()) look(part.element, part.footprint);
    });
    for (const auto& entry : context_->meshes()) {
        const std::size_t element = entry.first;
        const MeshCuts& mesh = entry.second;
        if (!mesh.box().meets(box) || !sharedHeights(mesh.heights(), heights).isShared()) continue;
        const MeshBand& near = bandOf(element, circle.height);
        near.solids.search(box, [&](std::size_t i) { look(element, near.band.solids[i]); });
        near.sheets.search(box, [&](std::size_t i) {
            look(element, {near.band.sheets[i].a, near.band.sheets[i].b});
        });
    }
    return met;
}

void CircleCheck::check(std::size_t record, std::vector<Finding>& findings) {
    const auto found =
        std::lower_bound(circles_.begin(), circles_.end(), record,
                         [](const Circle& c, std::size_t i) { return c.record < i; });
    if (found == circles_.end() || found->record != record) return;
    const Circle& circle = *found;
    for (const auto& [element, met] : metBy(circle)) {
        if (isFull(findings)) return;
        findings.push_back(context_->finding(
            record, Severity::Error, met.place,
            " stands in " + context_->elementName(element) + " near " + placeText(met.place),
            "move it, e.g. by " + distanceText(met.way)));
    }
    std::vector<const Circle*> others;
    tree_.search(boxAbout(circle.center, circle.radius), [&](std::size_t i) {
        const Circle& other = circles_[i];
        if (other.record > circle.record &&
            distance(circle.center, other.center) < circle.radius + other.radius - kCornerTolerance)
            others.push_back(&other);
    });
    std::sort(others.begin(), others.end(),
              [](const Circle* a, const Circle* b) { return a->record < b->record; });
    for (const Circle* other : others) {
        if (isFull(findings)) return;
        const double away = distance(circle.center, other->center);
        const Point2 middle = circle.center + 0.5 * (other->center - circle.center);
        findings.push_back(context_->finding(
            record, Severity::Error, middle,
            " overlaps " + context_->name(other->record) + " near " + placeText(middle),
            "move one, e.g. by " + distanceText(circle.radius + other->radius - away)));
    }
}

}  // namespace ispace
