// SPDX-License-Identifier: GPL-3.0-or-later
// Verbs are changes of the record (ACT), which the run records and a replay repeats. Places are
// searched in fixed orders, rings of 0.1 m and 24 directions about the person, so that equal runs
// choose equal places: the first free one, which is the nearest but for the steps of the search.
#include "extensions/postures/deeds.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "base/number.h"
#include "env/body.h"
#include "env/body_shapes.h"
#include "env/element_schemas.h"
#include "geom/polygon.h"
#include "geom/predicates.h"
#include "record/edit.h"
#include "scene/bodies.h"
#include "sim/collision.h"

namespace ispace::postures {

namespace {

using days::addPersonVerb;
using days::DeedMoment;
using days::PersonDeed;
using days::PersonVerb;

constexpr double kHighestSeat = 1.1, kHighestBed = 1.5, kShortestBed = 0.6;
constexpr double kWithin = 0.2;  // of a person that sits, from the edge of the thing
constexpr double kSpare = 0.01;  // between a person that stands up and others

const Element* elementNamed(const World& world, const std::string& id) {
    for (const Element& element : world.scene().environment.elements())
        if (element.id == id) return &element;
    return nullptr;
}

const PlacedPerson& personOf(const World& world, std::size_t mover) {
    return world.people()[mover - world.robots().size()];
}

/// Returns the point of a prism's outline nearest to p, p itself within it.
Point2 nearestOf(const Polygon& outline, Point2 p) {
    if (locate(outline, p) != Side::Outside) return p;
    Point2 best = outline.front();
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Point2 q = nearestPoint({outline[i], outline[(i + 1) % outline.size()]}, p);
        if (distance(p, q) < distance(p, best)) best = q;
    }
    return best;
}

Point2 middleOf(const Box2& box) {
    return {(box.low.x + box.high.x) / 2, (box.low.y + box.high.y) / 2};
}

/// Returns whether a person with its trunk here overlaps no other mover.
bool isFreeOfOthers(const World& world, std::size_t mover, Point2 place) {
    const double radius = world.movers()[mover].model.radius + kSpare;
    for (std::size_t i = 0; i < world.movers().size(); ++i)
        if (i != mover && distance(world.status(i).pose.position, place) <
                              radius + world.movers()[i].model.radius)
            return false;
    return true;
}

/// Returns the obstacles that part rooms.
Obstacles dividersOf(const Environment& environment, double height) {
    std::vector<std::size_t> dividers;
    for (std::size_t i = 0; i < environment.elements().size(); ++i)
        if (partsRooms(environment.elements()[i])) dividers.push_back(i);
    return Obstacles(environment.band(0, height, dividers));
}

}  // namespace

bool partsRooms(const Element& element) {
    const std::string& keyword = element.record.keyword();
    return keyword == "wall" || keyword == "fence" || keyword == "ispace" || keyword == "door" ||
           keyword == "window";
}

std::optional<double> topAt(const Element& element, Point2 point) {
    std::optional<double> top;
    for (const Prism& prism : element.body.prisms)
        if (locate(prism.footprint, point) != Side::Outside)
            top = std::max(top.value_or(prism.top), prism.top);
    return top;
}

std::optional<RestingPlace> seatOn(const Element& element, Point2 from, double height) {
    RestingPlace place;
    if (element.record.keyword() == "chair") {
        constexpr double kBack = 0.05;
        const PlacementFrame chair = standingOf(element.record);
        const double depth = humanParts(height)[6].half_length;
        const double ahead = std::min(0.0, kBack + depth - chair.length / 2);
        place.pose = {chair.world_from_body * Point2{ahead, 0}, chair.world_from_body.heading};
    } else {
        std::optional<Point2> edge;
        Point2 middle;
        for (const Prism& prism : element.body.prisms) {
            const Point2 near = nearestOf(prism.footprint, from);
            if (edge && distance(near, from) >= distance(*edge, from)) continue;
            edge = near;
            middle = middleOf(bounds(prism.footprint));
        }
        if (!edge) return std::nullopt;
        // Within a thing, it sits down where it is, away from the middle.
        const Vec2 in = *edge == from ? middle - from : *edge - from;
        if (in == Vec2{}) return std::nullopt;
        const Vec2 inward = 1 / length(in) * in;
        place.pose.position = *edge == from ? from : *edge + kWithin * inward;
        place.pose.heading = Angle::radians(std::atan2(-inward.y, -inward.x));
    }
    const auto top = topAt(element, place.pose.position);
    if (!top || *top > kHighestSeat) return std::nullopt;
    place.support = *top;
    return place;
}

std::optional<RestingPlace> bedOn(const Element& element, double height, double aside) {
    if (element.body.prisms.empty()) return std::nullopt;
    Pose2 frame;
    double along = 0, across = 0;
    if (standsByItself(element.record)) {
        const PlacementFrame thing = standingOf(element.record);
        frame = thing.world_from_body;
        along = thing.length;
        across = thing.width;
    } else {
        Box2 box;
        for (const Prism& prism : element.body.prisms)
            for (const Point2 corner : prism.footprint) box.add(corner);
        if (box.empty()) return std::nullopt;
        frame.position = middleOf(box);
        along = box.width();
        across = box.depth();
    }
    if (across > along) {
        frame.heading = frame.heading + Angle::degrees(90);
        std::swap(along, across);
    }
    if (along < kShortestBed * height) return std::nullopt;
    // The body reaches from the feet to the top of the head; the trunk is above its position.
    const std::vector<BodyPart> usual = humanParts(height);
    const double middle = (usual[7].top - usual[7].bottom - (usual[0].top - usual[0].bottom)) / 2;
    const RestingPlace place{{frame * Point2{-middle, aside}, wrapped(frame.heading)}, 0};
    const auto top = topAt(element, place.pose.position);
    if (!top || *top > kHighestBed) return std::nullopt;
    return RestingPlace{place.pose, *top};
}

std::optional<Point2> roomToStand(const World& world, std::size_t mover, Point2 from) {
    constexpr double kFarthest = 1.5, kStep = 0.1;
    constexpr int kDirections = 24;
    const Mover& person = world.movers()[mover];
    const Environment& environment = world.scene().environment;
    const Obstacles things(environment, person.model.height, nullptr);
    const Obstacles walls = dividersOf(environment, person.model.height);
    const auto is_free = [&](Point2 place) {
        return !things.overlap(place, person.model.radius) && isFreeOfOthers(world, mover, place) &&
               (place == from || !walls.near({from, place}, kSpare));
    };
    if (is_free(from)) return from;
    for (int ring = 1; ring * kStep <= kFarthest; ++ring)
        for (int i = 0; i < kDirections; ++i) {
            const Angle direction = Angle::degrees(360.0 * i / kDirections);
            const Point2 place = from + ring * kStep * unitVector(direction);
            if (is_free(place)) return place;
        }
    return std::nullopt;
}

Angle headingOfFall(const World& world, const Pose2& pose, double height) {
    constexpr double kStep = 30;
    const PersonPosture fallen{.height = height, .posture = Posture::Fallen};
    const std::vector<BodyPart> parts = figureOf(fallen)->fixed;
    double ahead = 0, behind = 0, beside = 0, tall = 0;
    for (const BodyPart& part : parts) {
        const double reach = part.radius > 0 ? part.radius : part.half_length;
        ahead = std::max(ahead, part.center.x + reach);
        behind = std::min(behind, part.center.x - reach);
        beside = std::max(beside, std::abs(part.center.y) + std::max(part.radius, part.half_width));
        tall = std::max(tall, part.top);
    }
    const Obstacles things(world.scene().environment, tall, nullptr);
    for (const double turn : {0.0, kStep, -kStep, 2 * kStep, -2 * kStep, 3 * kStep, -3 * kStep,
                              4 * kStep, -4 * kStep, 5 * kStep, -5 * kStep, 6 * kStep}) {
        const Pose2 tried{pose.position, wrapped(pose.heading + Angle::degrees(turn))};
        if (!things.near({tried * Point2{behind, 0}, tried * Point2{ahead, 0}}, beside))
            return tried.heading;
    }
    return pose.heading;
}

std::optional<Point3> pointOf(const World& world, const std::string& id) {
    constexpr double kChest = 0.75;
    for (std::size_t i = 0; i < world.movers().size(); ++i) {
        const Mover& mover = world.movers()[i];
        if (mover.id != id) continue;
        const Pose2 pose = world.status(i).pose;
        const double share = mover.is_person ? kChest : 1.0 / 2;
        Point3 local{0, 0, share * mover.model.height};
        if (mover.figure != nullptr) local = mover.figure->carried(local);
        const Point2 at = pose * local.onFloor();
        return Point3{at.x, at.y, local.z};
    }
    const Scene& scene = world.scene();
    for (const Sensor& sensor : scene.sensors)
        if (sensor.id == id) return sensor.pose.position;
    const Element* const element = elementNamed(world, id);
    if (element != nullptr && element->record.keyword() == "zone") {
        const Point2 middle = middleOf(bounds(zoneOutline(element->record)));
        return Point3{middle.x, middle.y, 0};
    }
    if (element != nullptr && !element->body.prisms.empty()) {
        Box2 box;
        double low = element->body.prisms.front().bottom;
        for (const Prism& prism : element->body.prisms) {
            low = std::min(low, prism.bottom);
            for (const Point2 corner : prism.footprint) box.add(corner);
        }
        const Point2 middle = middleOf(box);
        return Point3{middle.x, middle.y, (low + topOf(element->body)) / 2};
    }
    // Lamps and the like, and things of extensions: where they are.
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        if (scene.ids[i] != id) continue;
        const Record& record = scene.records[i];
        const auto at = placeOf(record);
        if (!at) return std::nullopt;
        double height = element == nullptr ? 0 : topOf(element->body) / 2;
        // Panels of light are in the ceiling.
        if (height == 0 && record.schema().type == RecordType::Infra)
            height = scene.environment.height();
        if (record.schema().find("at") != nullptr && record.find("at") != nullptr &&
            record.tuple("at").size() > 2)
            height = record.tuple("at")[2];
        else if (record.schema().find("height") != nullptr && record.find("height") != nullptr)
            height = record.number("height");
        return Point3{at->x, at->y, height};
    }
    return std::nullopt;
}

namespace {

/// Returns `at=x,y heading=h` of a pose, exactly.
std::string placeText(const Pose2& pose) {
    return "at=" + formatDouble(pose.position.x) + ',' + formatDouble(pose.position.y) +
           " heading=" + formatDouble(pose.heading.degrees());
}

std::string restText(const DeedMoment& moment, std::string_view posture,
                     const RestingPlace& place) {
    return "ACT " + moment.id + " posture=" + std::string(posture) +
           " support=" + formatDouble(place.support) + ' ' + placeText(place.pose);
}

/// Returns ` left_arm=0,-90` for each arm that is raised.
std::string armsDown(const DeedMoment& moment) {
    constexpr double kHangs = -90;
    std::string keys;
    for (const char* const key : {"left_arm", "right_arm"})
        if (moment.person->has(key) && moment.person->tuple(key)[1] != kHangs)
            keys.append(" ").append(key).append("=0,-90");
    return keys;
}

Pose2 poseOf(const DeedMoment& moment) { return moment.world->status(moment.mover).pose; }

double heightOf(const DeedMoment& moment) { return personOf(*moment.world, moment.mover).height; }

PersonDeed sitDown(const DeedMoment& moment) {
    const Element* const thing = elementNamed(*moment.world, moment.target);
    const auto seat =
        thing == nullptr ? std::nullopt : seatOn(*thing, poseOf(moment).position, heightOf(moment));
    if (!seat) return {"", "one does not sit on " + moment.target};
    // Beside others on a sofa.
    constexpr double kAside = 0.1;
    for (int step = 0; step <= 10; ++step)
        for (const double side : {1.0, -1.0}) {
            const Point2 place = seat->pose * Point2{0, side * kAside * step};
            if (topAt(*thing, place) != seat->support ||
                !isFreeOfOthers(*moment.world, moment.mover, place))
                continue;
            return {restText(moment, "sit", {{place, seat->pose.heading}, seat->support}), ""};
        }
    return {"", "all of " + moment.target + " is taken"};
}

PersonDeed lieDown(const DeedMoment& moment) {
    const Element* const thing = elementNamed(*moment.world, moment.target);
    constexpr double kAside = 0.1;
    bool is_bed = false;
    for (int step = 0; thing != nullptr && step <= 10; ++step)
        for (const double side : {1.0, -1.0}) {
            const auto bed = bedOn(*thing, heightOf(moment), side * kAside * step);
            is_bed = is_bed || bed;
            if (bed && isFreeOfOthers(*moment.world, moment.mover, bed->pose.position))
                return {restText(moment, "lie", *bed) + armsDown(moment), ""};
        }
    return {"", is_bed ? "all of " + moment.target + " is taken"
                       : "one does not lie on " + moment.target};
}

/// Stands up beside the thing, where the person came from if that is free.
PersonDeed standUp(const DeedMoment& moment) {
    if (moment.world->movers()[moment.mover].rest().empty()) return {};
    const PersonPosture posture = postureOf(*moment.person);
    if (posture.posture == Posture::Fallen) return {};
    auto place = roomToStand(*moment.world, moment.mover, moment.stood.position);
    if (!place) place = roomToStand(*moment.world, moment.mover, poseOf(moment).position);
    if (!place) return {"", "there is no room to stand up"};
    return {"ACT " + moment.id + " posture=stand " + placeText({*place, moment.stood.heading}), ""};
}

std::string refuseToStand(const DeedMoment& moment) {
    return moment.world->movers()[moment.mover].rest().empty() ? "it stands" : "";
}

PersonDeed getUp(const DeedMoment& moment) {
    const Pose2 pose = poseOf(moment);
    const auto place = roomToStand(*moment.world, moment.mover, pose.position);
    if (!place) return {"", "there is no room to stand up"};
    if (*place == pose.position) return {"SET " + moment.id + ".posture=stand", ""};
    return {"ACT " + moment.id + " posture=stand " + placeText({*place, pose.heading}), ""};
}

/// Returns the id of the thing that a person carries, or "".
std::string loadOf(const World& world, const std::string& person) {
    for (const Element& element : world.scene().environment.elements())
        if (personWith(element.record) == person) return element.id;
    return "";
}

/// Returns the change that sets a thing down at a point.
std::string putAt(const std::string& thing, Point3 at) {
    return thing + " carried= at=" + formatDouble(at.x) + ',' + formatDouble(at.y) + ',' +
           formatDouble(at.z);
}

/// Returns a number in whole millimetres.
double inMillimetres(double metres) { return std::round(metres * 1000) / 1000 + 0.0; }

Point2 inMillimetres(Point2 p) { return {inMillimetres(p.x), inMillimetres(p.y)}; }

/// Finds spots of the floor for a thing that a person sets down or drops.
class FloorSpots {
  public:
    /// \param from where the person is
    FloorSpots(const World& world, std::size_t mover, Point2 from, const std::string& thing)
        : world_(world), mover_(mover), from_(from) {
        const PlacementFrame frame = standingOf(elementNamed(world, thing)->record);
        const Environment& environment = world.scene().environment;
        radius_ = std::hypot(frame.length, frame.width) / 2;
        things_.emplace(environment, std::max(kSpare, frame.height()), nullptr);
        walls_.emplace(dividersOf(environment, world.movers()[mover].model.height));
    }
    /// Returns whether no thing and no other mover overlaps it, and no wall is in between.
    [[nodiscard]] bool isFree(Point2 at) const {
        if (things_->overlap(at, radius_) || walls_->near({from_, at}, kSpare)) return false;
        for (std::size_t i = 0; i < world_.movers().size(); ++i)
            if (i != mover_ && distance(world_.status(i).pose.position, at) <
                                   radius_ + world_.movers()[i].model.radius)
                return false;
        return true;
    }
    /// Radius of a circle that holds the thing.
    [[nodiscard]] double radius() const { return radius_; }

  private:
    const World& world_;
    std::size_t mover_;
    Point2 from_;
    double radius_ = 0;
    std::optional<Obstacles> things_, walls_;
};

/// Returns where a person that falls drops a thing: ahead of its hand, else beside it.
std::optional<Point2> dropSpot(const World& world, const DeedMoment& moment, const Pose2& fallen,
                               const std::string& thing) {
    // Of the height: where the arm ahead and the arms at the sides end, and a bit more.
    constexpr double kHand = 0.65, kAhead = 0.7, kArms = 0.17, kAside = 0.3;
    const double h = heightOf(moment);
    const FloorSpots spots(world, moment.mover, fallen.position, thing);
    const double ahead = std::max(kAhead * h, kHand * h + spots.radius());
    const double aside = std::max(kAside * h, kArms * h + spots.radius());
    for (const Point2 local :
         {Point2{ahead, 0}, Point2{ahead, -aside}, Point2{ahead, aside}, Point2{kAside * h, -aside},
          Point2{kAside * h, aside}, Point2{0, -aside}, Point2{0, aside},
          Point2{-kAside * h, -aside}, Point2{-kAside * h, aside}})
        if (const Point2 at = inMillimetres(fallen * local); spots.isFree(at)) return at;
    return std::nullopt;
}

PersonDeed fall(const DeedMoment& moment) {
    const World& world = *moment.world;
    const PersonPosture before = postureOf(*moment.person);
    if (before.posture == Posture::Fallen) return {"", "it has fallen"};
    Pose2 pose = poseOf(moment);
    const bool was_on_thing = before.support > 0;
    if (was_on_thing)
        if (const auto beside = roomToStand(world, moment.mover, pose.position))
            pose.position = *beside;
    pose.heading = headingOfFall(world, pose, heightOf(moment));
    const bool is_moved = was_on_thing || pose.heading != poseOf(moment).heading;
    std::string change = "ACT " + moment.id + " posture=fallen support=0" + armsDown(moment);
    if (is_moved) change.append(" ").append(placeText(pose));
    // It drops the thing that it carries; without room for that the thing stays in the hand.
    if (const std::string load = loadOf(world, moment.id); !load.empty())
        if (const auto at = dropSpot(world, moment, pose, load))
            change.append(" ; ").append(putAt(load, {at->x, at->y, 0}));
    return {std::move(change), ""};
}

/// Returns the side of the arm that points there: 1: left.
double sideOf(Point2 local) { return local.y >= 0 ? 1 : -1; }

Point3 inFrameOf(const Pose2& pose, Point3 point) {
    const Vec2 way = point.onFloor() - pose.position;
    const CosSin axes = cosSin(pose.heading);
    return {axes.cos * way.x + axes.sin * way.y, axes.cos * way.y - axes.sin * way.x, point.z};
}

std::string armKey(double side) { return side > 0 ? "left_arm" : "right_arm"; }

/// Returns `left_arm=yaw,pitch,reach`, in hundredths of a degree and millimetres.
std::string armText(const ArmPose& arm, double side) {
    constexpr double kHundred = 100, kThousand = 1000, kSlack = 1e-6;
    const auto degrees = [](Angle angle) {
        return formatDouble(std::round(kHundred * angle.degrees()) / kHundred + 0.0);
    };
    return armKey(side) + '=' + degrees(arm.yaw) + ',' + degrees(arm.pitch) + ',' +
           formatDouble(std::floor(kThousand * arm.reach + kSlack) / kThousand);
}

std::string refuseArms(const DeedMoment& moment) {
    const Posture posture = postureOf(*moment.person).posture;
    return posture == Posture::Lie || posture == Posture::Fallen
               ? "it " + std::string(moment.world->movers()[moment.mover].rest())
               : "";
}

/// Returns the change of the arm that shows to a point; `stretched`, or as far as the point is.
PersonDeed raiseArm(const DeedMoment& moment, bool stretched) {
    const auto point = pointOf(*moment.world, moment.target);
    if (!point) return {"", moment.target + " is nowhere"};
    const Point3 local = inFrameOf(poseOf(moment), *point);
    const double side = sideOf(local.onFloor());
    ArmPose arm = armTo(postureOf(*moment.person), local, side);
    if (stretched) arm.reach = longestReach(heightOf(moment));
    return {"SET " + moment.id + '.' + armText(arm, side), ""};
}

PersonDeed point(const DeedMoment& moment) { return raiseArm(moment, true); }
PersonDeed reachFor(const DeedMoment& moment) { return raiseArm(moment, false); }

PersonDeed lowerArms(const DeedMoment& moment) {
    const std::string arms = armsDown(moment);
    return {arms.empty() ? "" : "ACT " + moment.id + arms, ""};
}

std::vector<std::string> pointTargets(const World& world) {
    std::vector<std::string> ids;
    for (const Mover& mover : world.movers()) ids.push_back(mover.id);
    for (const Sensor& sensor : world.scene().sensors) ids.push_back(sensor.id);
    return ids;
}

std::optional<Point2> aimOf(const World& world, const std::string& target) {
    const auto point = pointOf(world, target);
    return point ? std::optional(point->onFloor()) : std::nullopt;
}

std::vector<std::string> thingsToCarry(const World& world) {
    std::vector<std::string> ids;
    for (const Element& element : world.scene().environment.elements())
        if (element.record.schema().find(carriedKey()) != nullptr) ids.push_back(element.id);
    return ids;
}

std::string refuseToTake(const DeedMoment& moment) {
    const Element* const thing = elementNamed(*moment.world, moment.target);
    if (thing == nullptr) return moment.target + " is gone";
    if (const std::string load = loadOf(*moment.world, moment.id); !load.empty())
        return "it carries " + load;
    if (const std::string by = personWith(thing->record); !by.empty())
        return by + " carries " + moment.target;
    if (thing->record.schema().find(carriedKey()) == nullptr)
        return moment.target + " is nothing to carry";
    if (!mayBeCarried(thing->record))
        return moment.target + " is larger than " + formatDouble(kLargestLoad) + " m";
    return "";
}

PersonDeed take(const DeedMoment& moment) {
    if (std::string reason = refuseToTake(moment); !reason.empty()) return {"", std::move(reason)};
    return {"SET " + moment.target + ".carried=" + moment.id, ""};
}

std::string refuseToPut(const DeedMoment& moment) {
    return loadOf(*moment.world, moment.id) == moment.object ? ""
                                                             : "it does not carry " + moment.object;
}

/// Finds spots on a thing for another one.
class TopSpots {
  public:
    TopSpots(const Environment& environment, const Element& below, const Record& thing)
        : environment_(environment), below_(below), frame_(standingOf(thing)) {}

    /// Returns the height of the top that bears the whole thing there, free of others.
    [[nodiscard]] std::optional<double> topAt(Point2 at) {
        constexpr double kHighest = 1.6;
        const auto top = postures::topAt(below_, at);
        if (!top || *top > kHighest) return std::nullopt;
        const Pose2 pose{at, frame_.world_from_body.heading};
        for (const double x : {-frame_.length / 2, frame_.length / 2})
            for (const double y : {-frame_.width / 2, frame_.width / 2})
                if (postures::topAt(below_, pose * Point2{x, y}) != top) return std::nullopt;
        return isFree(at, *top) ? top : std::nullopt;
    }

  private:
    [[nodiscard]] bool isFree(Point2 at, double top) {
        auto others = others_.find(top);
        if (others == others_.end())
            others = others_
                         .try_emplace(
                             top, environment_.band(top + kSpare,
                                                    top + std::max(2 * kSpare, frame_.height())))
                         .first;
        return !others->second.overlap(at, std::hypot(frame_.length, frame_.width) / 2);
    }

    const Environment& environment_;
    const Element& below_;
    PlacementFrame frame_;
    std::map<double, Obstacles> others_;  // above a top
};

/// Returns where a person sets a thing down on another: within its edge, or the nearest free spot
/// to that within reach.
std::optional<Point3> spotOn(const World& world, const Element& below, const Record& thing,
                             Point2 from) {
    constexpr double kInside = 0.15, kReach = 1, kStep = 0.05;
    constexpr int kDirections = 24;
    Point2 first = nearestOf(below.body.prisms.front().footprint, from);
    for (const Prism& prism : below.body.prisms) {
        const Point2 near = nearestOf(prism.footprint, from);
        if (distance(near, from) < distance(first, from)) first = near;
    }
    const Vec2 in = first - from;
    if (in != Vec2{}) first = first + kInside / length(in) * in;
    TopSpots spots(world.scene().environment, below, thing);
    const double reach = std::max(kReach, distance(first, from));
    for (int ring = 0; ring * kStep <= 2 * kReach; ++ring)
        for (int i = 0; i < (ring == 0 ? 1 : kDirections); ++i) {
            const Angle direction = Angle::degrees(360.0 * i / kDirections);
            const Point2 at = inMillimetres(first + ring * kStep * unitVector(direction));
            if (distance(at, from) > reach) continue;
            if (const auto top = spots.topAt(at)) return Point3{at.x, at.y, *top};
        }
    return std::nullopt;
}

/// Sets it down on a thing, else on the floor ahead.
PersonDeed putDown(const DeedMoment& moment) {
    if (std::string reason = refuseToPut(moment); !reason.empty()) return {"", std::move(reason)};
    const Element* const thing = elementNamed(*moment.world, moment.target);
    const Pose2 pose = poseOf(moment);
    if (thing != nullptr && !thing->body.prisms.empty()) {
        const auto spot = spotOn(*moment.world, *thing,
                                 elementNamed(*moment.world, moment.object)->record, pose.position);
        if (!spot) return {"", "there is no room on " + moment.target};
        return {"ACT " + putAt(moment.object, *spot), ""};
    }
    const FloorSpots spots(*moment.world, moment.mover, pose.position, moment.object);
    const double ahead =
        moment.world->movers()[moment.mover].model.radius + spots.radius() + 2 * kSpare;
    constexpr double kStep = 30;
    for (const double turn : {0.0, kStep, -kStep, 2 * kStep, -2 * kStep, 3 * kStep, -3 * kStep,
                              4 * kStep, -4 * kStep, 5 * kStep, -5 * kStep, 6 * kStep}) {
        const Point2 at =
            inMillimetres(pose.position + ahead * unitVector(pose.heading + Angle::degrees(turn)));
        if (spots.isFree(at)) return {"ACT " + putAt(moment.object, {at.x, at.y, 0}), ""};
    }
    return {"", "there is no room to set it down"};
}

}  // namespace

void addDeeds() {
    using Approach = PersonVerb::Approach;
    static const PersonVerb put_down{.word = "to",
                                     .target = "kitchen",
                                     .approach = Approach::Beside,
                                     .refusal = refuseToPut,
                                     .begin = putDown};
    addPersonVerb({.verb = "carries",
                   .target = "cup",
                   .approach = Approach::Beside,
                   .targets = thingsToCarry,
                   .is_for_goals = false,
                   .aim = aimOf,
                   .refusal = refuseToTake,
                   .begin = take,
                   .then = &put_down});
    addPersonVerb({.verb = "sits",
                   .word = "on",
                   .target = "chair1",
                   .lasts = true,
                   .approach = Approach::Beside,
                   .begin = sitDown,
                   .end = standUp});
    addPersonVerb({.verb = "lies",
                   .word = "on",
                   .target = "bed",
                   .lasts = true,
                   .approach = Approach::Beside,
                   .begin = lieDown,
                   .end = standUp});
    addPersonVerb({.verb = "falls", .is_of_rest = true, .interrupts = true, .begin = fall});
    addPersonVerb({.verb = "stands", .is_of_rest = true, .refusal = refuseToStand, .begin = getUp});
    addPersonVerb({.verb = "points",
                   .word = "at",
                   .target = "lamp1",
                   .lasts = true,
                   .approach = Approach::Faces,
                   .is_of_rest = true,
                   .targets = pointTargets,
                   .aim = aimOf,
                   .refusal = refuseArms,
                   .begin = point,
                   .end = lowerArms});
    addPersonVerb({.verb = "reaches",
                   .target = "kettle",
                   .lasts = true,
                   .approach = Approach::Beside,
                   .aim = aimOf,
                   .begin = reachFor,
                   .end = lowerArms});
}

}  // namespace ispace::postures
