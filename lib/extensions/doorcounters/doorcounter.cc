// SPDX-License-Identifier: GPL-3.0-or-later
// A counter keeps no state of its own: each reading follows from the one before, so that a replay
// gives equal counts. A mover counts as seen at the centre of a body that a ray reaches, which a
// person under a table or behind a door leaf is not. Two people side by side are two, as each has a
// body of its own; real sensors merge them at times.
//
// The check walks 33 x 33 rays of the view, and asks for one point on each side of the line at a
// height that people reach.
#include "extensions/doorcounters/doorcounter.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "env/environment.h"
#include "env/openings.h"
#include "env/walls.h"
#include "geom/point.h"
#include "scene/findings/findings.h"
#include "scene/scene.h"
#include "scene/sensor/kind_functions.h"
#include "sense/formats/field_values.h"
#include "sense/moment.h"
#include "sense/sighting.h"

namespace ispace::doorcounters {

DoorCounter withParameters(DoorCounter base, const Record& record) {
    Diagnostics findings;
    if (record.has("door")) base.door = record.text("door");
    applyRange(record, base.min_range, base.max_range, findings);
    if (record.has("fov")) {
        const Tuple& fov = record.tuple("fov");
        base.fov_across = Angle::degrees(fov.front());
        base.fov_along = Angle::degrees(fov.back());
    }
    if (record.has("height")) base.height = record.number("height");
    if (record.has("rate")) base.rate = record.number("rate");
    findings.throwIfAny();
    return base;
}

FieldOfView fieldOfView(const DoorCounter& counter, const Pose3& pose) {
    Pose3 down = pose;
    down.tilt = down.tilt - Angle::degrees(90);
    return FieldOfView::pyramid(down, 0.5 * counter.fov_across, 0.5 * counter.fov_along,
                                counter.max_range, false);
}

DoorCount countAt(const Moment& now) {
    const DoorCounter& counter = now.sensor.as<DoorCounter>();
    const Observer observer{fieldOfView(counter, now.pose), counter.min_range,
                            carrierOf(now.sensor)};
    const Vec2 inwards = unitVector(now.pose.heading);
    const Point3 origin = now.pose.position;
    DoorCount count;
    for (const Sighting& seen :
         sightingsOf(observer, now.mesh(), now.bodies, [](std::uint32_t) { return true; })) {
        const Point3 spot = origin + seen.range * seen.direction;
        if (spot.z < counter.height) continue;
        const double ahead = dot(spot.onFloor() - origin.onFloor(), inwards);
        const int zone = ahead > 0 ? 1 : ahead < 0 ? -1 : 0;
        count.tracks.push_back({seen.body->owner, zone, zone});
    }
    std::ranges::sort(count.tracks, {}, &CountedTrack::owner);
    return count;
}

void addPassages(const DoorCount& before, DoorCount& now) {
    now.entered = before.entered;
    now.left = before.left;
    for (const CountedTrack& last : before.tracks) {
        const auto here =
            std::ranges::lower_bound(now.tracks, last.owner, {}, &CountedTrack::owner);
        if (here != now.tracks.end() && here->owner == last.owner) {
            if (last.from != 0) here->from = last.from;
            if (here->at == 0) here->at = last.at;
        } else if (last.from * last.at < 0) {
            ++(last.at > 0 ? now.entered : now.left);
        }
    }
}

namespace {

void addCounterKeys(std::vector<KeySpec>& keys) {
    constexpr double kWidest = 170, kTallest = 10;
    keys.push_back({.name = "door",
                    .type = KeyType::Word,
                    .help = "id of the door above which it hangs, on the side towards `heading`, "
                            "unless `at` or `on` says where",
                    .role = Role::Reference});
    keys.push_back(rangeKey("least and greatest distance seen, or the greatest alone"));
    keys.push_back({.name = "fov",
                    .type = KeyType::Tuple,
                    .unit = Unit::Angle,
                    .help = "field of view across its heading and along it, or both",
                    .min_count = 1,
                    .max_count = 2,
                    .lower = 0,
                    .upper = kWidest,
                    .lower_open = true});
    keys.push_back({.name = "height",
                    .type = KeyType::Number,
                    .unit = Unit::Length,
                    .help = "people and robots that are lower where it sees them are not counted",
                    .lower = 0,
                    .upper = kTallest});
    keys.push_back(positiveKey("rate", Unit::Frequency, "readings a second", kMaxRate));
}

/// The middle of a door's opening, at its top.
struct DoorTop {
    std::string id;
    Point3 middle;
    Vec2 across;       ///< unit vector through the wall
    double depth = 0;  ///< of the wall
};

/// Returns the doors of the room. Findings about them are those of the environment.
std::vector<DoorTop> doorsOf(const RoomRecords& room) {
    std::vector<Element> elements;
    elements.reserve(room.records.size());
    Diagnostics ignored;
    WallPlan plan;
    const auto body = std::make_shared<const Body>();
    for (std::size_t i = 0; i < room.records.size(); ++i) {
        if (room.records[i].schema().type == RecordType::Placement) continue;
        for (const WallLine& wall : wallLinesOf(room.records[i], ignored))
            plan.add(wall, elements.size());
        elements.push_back({room.records[i], room.ids[i], body, i});
    }
    std::vector<DoorTop> doors;
    for (const Opening& opening : placeOpenings(elements, plan, ignored)) {
        const Element& element = elements[opening.element];
        if (element.record.keyword() != "door") continue;
        const Segment2 wall = plan.lines[opening.line];
        const Vec2 along = 1 / distance(wall.a, wall.b) * (wall.b - wall.a);
        const Point2 middle = wall.a + 0.5 * (opening.from + opening.to) * along;
        doors.push_back({element.id,
                         {middle.x, middle.y, opening.top},
                         {-along.y, along.x},
                         std::max(opening.depth, plan.walls[opening.line].thickness)});
    }
    return doors;
}

/// Returns the pose above the door that the record names, beside the wall: on the side towards the
/// record's heading, or to the left of it if the wall goes along it.
std::optional<Pose3> placeAtDoor(const Record& record, const RoomRecords& room) {
    constexpr double kBesideWall = 0.06, kAlong = 1e-9;
    if (!record.has("door")) return std::nullopt;
    const auto doors = room.shared<DoorTop>([&room] { return doorsOf(room); });
    const std::string& name = record.text("door");
    const auto* const door = std::find_if(doors.begin(), doors.end(),
                                          [&](const DoorTop& one) { return one.id == name; });
    if (door == doors.end()) {
        std::vector<std::string> known;
        for (const DoorTop& one : doors) known.push_back(one.id);
        throw FormatError(record.finding(
            "door", "`door`: no door has the id " + excerpt(name) + didYouMean(name, known)));
    }
    const Vec2 ahead = unitVector(record.angle("heading"));
    Vec2 inwards = door->across;
    const double along = dot(inwards, ahead);
    if (along < -kAlong || (along <= kAlong && cross(ahead, inwards) < 0)) inwards = -inwards;
    const Point2 at = door->middle.onFloor() + (0.5 * door->depth + kBesideWall) * inwards;
    return Pose3{{at.x, at.y, door->middle.z},
                 Angle::radians(std::atan2(inwards.y, inwards.x)),
                 record.angle("tilt"),
                 record.angle("roll")};
}

/// Checks the door of a sensor that stands elsewhere, too.
void lookUpDoor(SensorModel& /*model*/, const Record& record, const RoomRecords& room) {
    static_cast<void>(placeAtDoor(record, room));
}

/// Where a counter sees people and robots that it counts: before its line, and behind it.
struct CountedSides {
    bool ahead = false, behind = false;
};

/// Looks along rays across the view. \param tallest of the people and robots
CountedSides countedSides(const DoorCounter& counter, const Pose3& pose, double tallest) {
    constexpr int kRays = 16;  // from the middle to an edge
    constexpr double kLevel = 1e-9, kOnLine = 1e-6;
    Pose3 down = pose;
    down.tilt = down.tilt - Angle::degrees(90);
    const Frame3 frame(down);
    const Vec2 inwards = unitVector(pose.heading);
    const double across = std::tan(0.5 * counter.fov_across.radians()) / kRays;
    const double along = std::tan(0.5 * counter.fov_along.radians()) / kRays;
    const double top = pose.position.z - tallest, bottom = pose.position.z - counter.height;
    CountedSides sides;
    for (int i = -kRays; i <= kRays; ++i) {
        for (int k = -kRays; k <= kRays; ++k) {
            const Vec3 ray = frame * Vec3{1, i * across, k * along};
            const double fall = -ray.z / length(ray);
            double from = counter.min_range, to = counter.max_range;
            if (std::abs(fall) > kLevel) {
                from = std::max(from, std::min(top / fall, bottom / fall));
                to = std::min(to, std::max(top / fall, bottom / fall));
            } else if (top > 0 || bottom < 0) {
                continue;
            }
            if (from > to) continue;
            const double ahead = dot(Vec2{ray.x, ray.y}, inwards);
            sides.ahead = sides.ahead || ahead > kOnLine;
            sides.behind = sides.behind || ahead < -kOnLine;
        }
    }
    return sides;
}

/// Warns of a counter that can count no passage.
std::optional<Finding> checkCounter(const Scene& scene, std::size_t record) {
    const auto placed = std::ranges::find(scene.placed, record, &PlacedRecord::record);
    if (placed == scene.placed.end()) return std::nullopt;
    const DoorCounter& counter = scene.sensors[placed->index].as<DoorCounter>();
    double tallest = 1.7;  // of a person without `height`
    for (const PlacedPerson& person : scene.people) tallest = std::max(tallest, person.height);
    for (const PlacedRobot& robot : scene.robots) tallest = std::max(tallest, robot.model.height);
    CountedSides sides;
    if (counter.height <= tallest) sides = countedSides(counter, placed->pose, tallest);
    if (sides.ahead && sides.behind) return std::nullopt;
    std::string message = "doorcounter " + scene.ids[record] + " counts no passage: ";
    if (sides.ahead || sides.behind)
        message += "it sees one side of its line only";
    else
        message.append("no point of its view is at `height` (")
            .append(formatDouble(counter.height))
            .append(" m) or above on a person or robot of up to ")
            .append(formatDouble(tallest))
            .append(" m");
    return Finding{.severity = Severity::Warning,
                   .element = scene.ids[record],
                   .at = placed->pose.position.onFloor(),
                   .message = std::move(message),
                   .hint = "hang it above heads, looking down, or change `height` or `range`",
                   .source = scene.records[record].place()};
}

/// Builds a flat box with its lens below.
std::vector<Mesh> counterBody() {
    Mesh box{Material::Sensor, {}, {}};
    addBox(box, {-0.04, -0.06, 0.01}, {0.04, 0.06, 0.04});
    addBall(box, {0, 0, 0.01}, 0.01);
    return {std::move(box)};
}

using namespace fields;

template <auto kMember>
FieldValue counted(const View& reading) {
    return fieldOf(reading.as<DoorCount>().*kMember);
}
template <auto kMember>
FieldValue countedAsDouble(const View& reading) {
    return fieldOf(static_cast<double>(reading.as<DoorCount>().*kMember));
}
FieldValue present(const View& reading) { return fieldOf(reading.as<DoorCount>().tracks.size()); }
FieldValue presentAsDouble(const View& reading) {
    return fieldOf(static_cast<double>(reading.as<DoorCount>().tracks.size()));
}
std::vector<std::uint64_t> oneNumber(const View& /*reading*/) { return {}; }

constexpr unsigned kCounts = kInJson | kInLine | kIsState | kInColumn | kInPage;

constexpr ReadingField kFields[] = {
    {"door", kInInfo,
     [](const View& r) {
         const std::string& door = r.sensor.as<DoorCounter>().door;
         return door.empty() ? FieldValue() : FieldValue(FieldText(door));
     }},
    {"range_min", kInInfo, figure<DoorCounter, &DoorCounter::min_range>},
    {"range_max", kInInfo, figure<DoorCounter, &DoorCounter::max_range>},
    {"fov", kInInfo,
     [](const View& r) {
         const DoorCounter& counter = r.sensor.as<DoorCounter>();
         return FieldValue(std::vector{counter.fov_across, counter.fov_along});
     }},
    {"height", kInInfo, figure<DoorCounter, &DoorCounter::height>},
    {"rate", kInInfo, figure<DoorCounter, &DoorCounter::rate>},
    {"entered", kCounts | kIsTotal, counted<&DoorCount::entered>},
    {"left", kCounts | kIsTotal, counted<&DoorCount::left>},
    {"present", kCounts | kIsLevel, present},
    {"entered", kInArray, countedAsDouble<&DoorCount::entered>, kFloat64, oneNumber},
    {"left", kInArray, countedAsDouble<&DoorCount::left>, kFloat64, oneNumber},
    {"present", kInArray, presentAsDouble, kFloat64, oneNumber},
    {"limits", kInFixed, limitsOf<DoorCounter>}};

constexpr RosTopic kTopics[] = {
    {RosType::Int32, "entered", RosFrame::Sensor,
     [](const RosHeader& /*header*/, const View& r) {
         return integerMessage(static_cast<std::int32_t>(r.as<DoorCount>().entered));
     }},
    {RosType::Int32, "left", RosFrame::Sensor,
     [](const RosHeader& /*header*/, const View& r) {
         return integerMessage(static_cast<std::int32_t>(r.as<DoorCount>().left));
     }},
    {RosType::Int32, "present", RosFrame::Sensor, [](const RosHeader& /*header*/, const View& r) {
         return integerMessage(static_cast<std::int32_t>(r.as<DoorCount>().tracks.size()));
     }}};

const ReadingKind kReading = {.fields = kFields, .topics = kTopics};

}  // namespace

const SensorKind DoorCounter::kKind = {
    .keyword = "doorcounter",
    .noun = "door counter",
    .help =
        "time-of-flight sensor above a door, which counts people that pass; bare: range=0.02,4 "
        "fov=60,60 height=1.1 rate=15",
    .heading_help = "direction in which people enter, from +x; its view is straight down",
    .sign = SensorSign::Square,
    .add_keys = addCounterKeys,
    .body = counterBody,
    .read = readModel<DoorCounter>,
    .look_up = lookUpDoor,
    .summary = [](const SensorModel& model) -> DeviceSummary {
        const DoorCounter& counter = *tryModel<DoorCounter>(model);
        return {rangeText(counter.min_range, counter.max_range),
                degreesText(counter.fov_across) + "x" + degreesText(counter.fov_along), "-",
                formatDouble(counter.rate)};
    },
    .bearings = [](const SensorModel& /*model*/) { return BearingSpan{}; },
    .perceives = false,
    .is_read = true,
    .place = placeAtDoor,
    .measure = [](const Moment& now) { return std::any(countAt(now)); },
    .follow = [](const AddedReading& before,
                 AddedReading& now) { addPassages(before.as<DoorCount>(), now.as<DoorCount>()); },
    .needs_each_period = true,
    .reading = &kReading};

void addDoorCounters() {
    addSensorKind(DoorCounter::kKind);
    addRecordCheck("doorcounter", checkCounter);
}

}  // namespace ispace::doorcounters
