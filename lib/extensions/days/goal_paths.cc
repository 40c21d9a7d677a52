// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/days/goal_paths.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "env/body.h"
#include "geom/polygon.h"
#include "record/edit.h"
#include "scene/placement_schemas.h"
#include "scene/thing_kind.h"

namespace ispace::days {

namespace {

/// Room besides the radius and PathFinder::kMargin, so that a walk does not brush along walls.
constexpr double kWideSpare = 0.1;

/// Room between people who stand beside each other, so that one can steer there.
constexpr double kApart = 0.2;

/// A walk may end as far from its goal.
constexpr double kSlack = 0.06;

/// Returns the middle of an element, of which a person may stand in front.
std::optional<Point2> middleOf(const Element& element) {
    if (element.record.keyword() != "zone") return placeOf(element.record);
    const Box2 box = bounds(zoneOutline(element.record));
    return Point2{(box.low.x + box.high.x) / 2, (box.low.y + box.high.y) / 2};
}

/// Returns true for the things of extensions, which are neither elements nor people, and which no
/// other carries.
bool isThing(const Record& record) {
    const ThingKind* const kind = thingKind(record.keyword());
    return !record.schema().isEnvironment() && kind != nullptr && kind->figure == nullptr &&
           carrierOf(record).empty();
}

/// Returns the things of extensions to which people go, as elements. One that stands in or on
/// another element is beside a person as soon as that element is.
std::vector<Element> thingsOf(const Scene& scene) {
    std::vector<Element> things;
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        if (!isThing(scene.records[i])) continue;
        const auto place = placeOf(scene.records[i]);
        if (!place) continue;
        auto shape = std::make_shared<const Body>();
        for (const Element& element : scene.environment.elements())
            if (std::any_of(element.body.prisms.begin(), element.body.prisms.end(),
                            [&](const Prism& prism) {
                                return locate(prism.footprint, *place) != Side::Outside;
                            }))
                shape = element.shape;
        things.push_back({.record = scene.records[i], .id = scene.ids[i], .shape = shape});
    }
    return things;
}

/// Returns true for records that divide rooms.
bool isDivider(const Record& record) {
    const std::string& keyword = record.keyword();
    return keyword == "wall" || keyword == "fence" || keyword == "ispace" || keyword == "door" ||
           keyword == "window";
}

/// Returns the band of all dividers up to a height.
Slice dividersOf(const Environment& environment, double height) {
    std::vector<std::size_t> dividers;
    for (std::size_t i = 0; i < environment.elements().size(); ++i)
        if (isDivider(environment.elements()[i].record)) dividers.push_back(i);
    return environment.band(0, height, dividers);
}

/// A part of an outline, and a point within it. Two corners: a line; one: a point.
struct OutlinePart {
    Polygon corners;
    Point2 middle;

    explicit OutlinePart(Polygon outline) : corners(std::move(outline)) {
        const Box2 box = bounds(corners);
        middle = {(box.low.x + box.high.x) / 2, (box.low.y + box.high.y) / 2};
    }
    /// Returns its point nearest to p.
    [[nodiscard]] Point2 nearest(Point2 p) const {
        if (corners.size() > 2 && locate(corners, p) != Side::Outside) return p;
        Point2 best = corners.front();
        forEachEdge(corners, [&](const Segment2& edge) {
            const Point2 q = nearestPoint(edge, p);
            if (distance(p, q) < distance(p, best)) best = q;
        });
        return best;
    }
};

/// Returns the outline of an element as seen from above, in parts.
std::vector<OutlinePart> outlineOf(const Element& element, Point2 place) {
    std::vector<OutlinePart> parts;
    for (const Prism& prism : element.body.prisms) parts.emplace_back(prism.footprint);
    for (const Sheet& sheet : element.body.sheets)
        parts.emplace_back(Polygon{sheet.line.a, sheet.line.b});
    for (const Plate& plate : element.body.plates) parts.emplace_back(plate.outline);
    Slice meshes;
    bandOfMeshes(element.body, 0, topOf(element.body), meshes, 0);
    for (const Polygon& solid : meshes.solids) parts.emplace_back(solid);
    for (const Segment2& sheet : meshes.sheets) parts.emplace_back(Polygon{sheet.a, sheet.b});
    if (parts.empty()) parts.emplace_back(Polygon{place});
    return parts;
}

/// Tests points for being beside one element.
class BesideTest {
  public:
    BesideTest(const Element& element, const Obstacles& walls)
        : parts_(outlineOf(element, *middleOf(element))),
          walls_(&walls),
          is_divider_(isDivider(element.record)) {
        for (const OutlinePart& part : parts_)
            for (const Point2 corner : part.corners) box_.add(corner);
    }

    /// Returns a box that holds all points beside the element.
    [[nodiscard]] Box2 limits(double reach) const { return box_.expanded(reach); }

    [[nodiscard]] bool isBeside(Point2 p, double reach) const {
        return std::any_of(parts_.begin(), parts_.end(), [&](const OutlinePart& part) {
            const Point2 q = part.nearest(p);
            if (distance(p, q) > reach || isParted(p, q)) return false;
            // A thing that sticks out through a wall is on the side of its middle.
            return is_divider_ || walls_->near({part.middle, part.middle}, kTouches) ||
                   !isParted(q, part.middle);
        });
    }

  private:
    static constexpr double kTouches = 0.01;

    /// Returns true if a divider crosses the way between two points; one that `to` touches does
    /// not.
    [[nodiscard]] bool isParted(Point2 from, Point2 to) const {
        const double way = distance(from, to);
        if (way <= kTouches) return false;
        return walls_->near({from, to + kTouches / way * (from - to)}, kTouches / 2);
    }

    std::vector<OutlinePart> parts_;
    Box2 box_;
    const Obstacles* walls_;
    bool is_divider_;
};

}  // namespace

std::vector<std::string> goalIds(const Scene& scene) {
    std::vector<std::string> ids;
    for (const Element& element : scene.environment.elements())
        if (middleOf(element)) ids.push_back(element.id);
    for (std::size_t i = 0; i < scene.records.size(); ++i)
        if (isThing(scene.records[i]) && placeOf(scene.records[i])) ids.push_back(scene.ids[i]);
    return ids;
}

GoalPaths::GoalPaths(const Scene& scene, Environment environment, double radius, double height)
    : radius_(radius),
      environment_(std::move(environment)),
      obstacles_(environment_, height, nullptr),
      walls_(dividersOf(scene.environment, height)),
      things_(thingsOf(scene)) {}

std::vector<const Element*> GoalPaths::named(const std::string& id) const {
    std::vector<const Element*> found;
    for (const std::span<const Element> some :
         {std::span(environment_.elements()), std::span<const Element>(things_)})
        for (const Element& element : some)
            if (element.id == id && middleOf(element)) found.push_back(&element);
    return found;
}

std::vector<Point2> GoalPaths::way(Point2 from, const std::string& id, std::span<const Spot> others,
                                   std::size_t* work) const {
    const auto count = [work](std::size_t cells) {
        if (work != nullptr) *work += cells;
    };
    // Testing a cell against obstacles takes as long as going on from some.
    constexpr std::size_t kTest = 8;
    const auto finder = [&](std::optional<PathFinder>& known, double spare) -> const PathFinder& {
        if (!known) {
            known.emplace(obstacles_, bounds(environment_.indoor()), radius_ + spare);
            count(kTest * known->cells());
        }
        return *known;
    };
    const auto wide = [&]() -> const PathFinder& { return finder(wide_, kWideSpare); };
    const auto narrow = [&]() -> const PathFinder& { return finder(narrow_, 0); };
    for (const Element* const named_so : named(id)) {
        const Element& element = *named_so;
        const auto middle = middleOf(element);
        const bool is_zone = element.record.keyword() == "zone";
        const Polygon zone = is_zone ? zoneOutline(element.record) : Polygon();
        const auto is_taken = [&](Point2 p) {
            return std::any_of(others.begin(), others.end(), [&](const Spot& other) {
                return distance(p, other.center) < radius_ + other.radius + kApart;
            });
        };
        const BesideTest beside(element, walls_);
        const auto is_suitable = [&](Point2 p) {
            return (is_zone ? locate(zone, p) != Side::Outside
                            : beside.isBeside(p, kReach - kSlack)) &&
                   !is_taken(p);
        };
        // Before others rather than behind them.
        const double share = kApart / std::max(kApart, distance(from, *middle));
        const Point2 aim = is_taken(*middle) ? *middle + share * (from - *middle) : *middle;
        const Box2 limits = is_zone ? bounds(zone) : beside.limits(kReach);
        const auto search = [&](const PathFinder& cells) {
            const PathFinder::Approach found = cells.approach(from, aim, limits, is_suitable);
            count(found.field.expanded + kTest * others.size());
            return found.goal ? cells.way(found.field, *found.goal) : std::vector<Point2>();
        };
        const auto search_around = [&](const PathFinder& cells) {
            count(cells.cells() / kTest);  // copies them
            return search(cells.around(others));
        };
        std::vector<Point2> way;
        if (!others.empty()) way = search_around(wide());
        if (way.empty() && !others.empty()) way = search_around(narrow());
        // Those in the way may leave it.
        if (way.empty()) way = search(wide());
        if (way.empty()) way = search(narrow());
        if (!way.empty()) return way;
    }
    return {};
}

bool GoalPaths::isAt(Point2 p, const std::string& id) const {
    const std::vector<const Element*> all = named(id);
    return std::any_of(all.begin(), all.end(), [&](const Element* element) {
        if (element->record.keyword() == "zone")
            return locate(zoneOutline(element->record), p) != Side::Outside;
        return BesideTest(*element, walls_).isBeside(p, kReach);
    });
}

}  // namespace ispace::days
