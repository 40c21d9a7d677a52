// SPDX-License-Identifier: GPL-3.0-or-later
// References are by id, in a building with or without the room before it, since loads follow robots
// and people from storey to storey. Masses without a `load` are those of massOfPerson() and
// massOfRobot().
#include "extensions/pressure/pressure_record.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <unordered_set>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "env/body.h"
#include "env/environment.h"
#include "geom/predicates.h"
#include "scene/findings/findings.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace::pressure {

namespace {

constexpr double kFarthest = 1e6, kLongest = 3600, kFastest = 1000, kStrongest = 1e6;

KeySpec numberKey(std::string name, Unit unit, std::string help, double standard, double lower,
                  double upper) {
    return {.name = std::move(name),
            .type = KeyType::Number,
            .unit = unit,
            .help = std::move(help),
            .default_value = standard,
            .lower = lower,
            .upper = upper};
}

KeySpec ofKey(std::string help) {
    return {.name = "of",
            .type = KeyType::Word,
            .help = std::move(help),
            .required = true,
            .role = Role::Reference};
}

/// Numbers of cells, of which a rounding error makes no further one.
std::size_t cellsAlong(double length, double cell) {
    constexpr double kRounding = 1e-9;
    return static_cast<std::size_t>(std::max(1.0, std::ceil(length / cell - kRounding)));
}

PressureFloor floorOf(const Record& record, std::string id) {
    PressureFloor floor;
    floor.id = std::move(id);
    const Tuple &at = record.tuple("at"), &size = record.tuple("size");
    floor.pose = {{at[0], at[1]}, record.angle("heading")};
    floor.length = size[0];
    floor.width = size[1];
    floor.cell = record.number("cell");
    floor.rate = record.number("rate");
    floor.threshold = record.number("threshold");
    floor.sigma = record.number("sigma");
    if (floor.length / floor.cell * (floor.width / floor.cell) >
        static_cast<double>(PressureFloor::kMostCells))
        throw FormatError(record.finding(
            "cell", "`cell`: there are more than a million cells, wanted larger ones"));
    if (floor.cell > std::max(floor.length, floor.width))
        throw FormatError(record.finding("cell", "`cell` is larger than the floor"));
    return floor;
}

PressureSeat seatOf(const Record& record, std::string id, const Scene& scene) {
    PressureSeat seat;
    seat.id = std::move(id);
    seat.reach = record.number("reach");
    seat.settle = record.number("settle");
    seat.rate = record.number("rate");
    seat.threshold = record.number("threshold");
    seat.sigma = record.number("sigma");
    const std::string& of = record.text("of");
    std::vector<std::string> things;
    for (const Element& element : scene.environment.elements()) {
        if (element.body.prisms.empty()) continue;
        things.push_back(element.id);
        if (element.id != of) continue;
        for (const Prism& prism : element.body.prisms) seat.thing.push_back(prism.footprint);
    }
    if (seat.thing.empty())
        throw FormatError(record.finding(
            "of", "`of`: no thing of the room is " + excerpt(of) + didYouMean(of, things)));
    return seat;
}

/// Returns the finding about a record with another `of`.
Finding wrongReference(const Scene& scene, std::size_t record, const std::string& wanted,
                       const std::vector<std::string>& known) {
    const Record& checked = scene.records[record];
    const std::string nearest = nearestWord(checked.text("of"), known);
    return {.severity = Severity::Error,
            .element = scene.ids[record],
            .message = checked.keyword() + ' ' + scene.ids[record] + " is of " +
                       excerpt(checked.text("of")) + ", which is no " + wanted,
            .hint = nearest.empty() ? "name one in `of`" : "name `" + nearest + '`',
            .source = checked.keyPlace("of")};
}

/// Checks that `of` names one of these, or its part after a `/` that one ends with: `ann` of a
/// storey is `ground/ann` in the building.
std::function<std::optional<Finding>(std::size_t record)> referenceCheck(
    const Scene& scene, std::string wanted, std::vector<std::string> known) {
    std::unordered_set<std::string> names;
    for (const std::string& id : known) {
        names.insert(id);
        for (std::size_t i = id.find('/'); i != std::string::npos; i = id.find('/', i + 1))
            names.insert(id.substr(i + 1));
    }
    return [&scene, wanted = std::move(wanted), known = std::move(known),
            names = std::move(names)](std::size_t record) {
        return names.contains(scene.records[record].text("of"))
                   ? std::nullopt
                   : std::optional(wrongReference(scene, record, wanted, known));
    };
}

}  // namespace

std::size_t PressureFloor::columns() const { return cellsAlong(length, cell); }
std::size_t PressureFloor::rows() const { return cellsAlong(width, cell); }

Point2 PressureFloor::middleOf(std::size_t index) const {
    const std::size_t column = index % columns(), row = index / columns();
    constexpr double kMiddle = 0.5;
    return pose * Point2{(static_cast<double>(column) + kMiddle) * cell - length / 2,
                         (static_cast<double>(row) + kMiddle) * cell - width / 2};
}

double PressureSeat::distanceTo(Point2 point) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Polygon& outline : thing) {
        if (locate(outline, point) != Side::Outside) return 0;
        for (std::size_t i = 0; i < outline.size(); ++i)
            nearest = std::min(
                nearest, distance(point, Segment2{outline[i], outline[(i + 1) % outline.size()]}));
    }
    return nearest;
}

std::vector<Schema> pressureSchemas() {
    const KeySpec rate =
        numberKey("rate", Unit::Frequency, "readings a second", 10, 0.001, kFastest);
    const KeySpec sigma =
        numberKey("sigma", Unit::None, "standard deviation of its noise, N", 0, 0, kStrongest);
    KeySpec heading = headingKey("direction of its columns");
    heading.default_value = 0.0;
    return {
        {.keyword = "floor_sensor",
         .type = RecordType::Placement,
         .help = "a part of the floor whose cells feel weights, for simrun and scan",
         .keys = {idKey(),
                  {.name = "at",
                   .type = KeyType::Tuple,
                   .unit = Unit::Length,
                   .help = "its middle x,y",
                   .min_count = 2,
                   .max_count = 2,
                   .lower = -kFarthest,
                   .upper = kFarthest,
                   .required = true,
                   .role = Role::Place},
                  heading,
                  {.name = "size",
                   .type = KeyType::Tuple,
                   .unit = Unit::Length,
                   .help = "its length and width",
                   .min_count = 2,
                   .max_count = 2,
                   .lower = 0.01,
                   .upper = 1000,
                   .required = true},
                  numberKey("cell", Unit::Length, "side of a cell", 0.25, 0.01, 100),
                  rate,
                  numberKey("threshold", Unit::None, "force below which a cell reads 0, N", 5, 0,
                            kStrongest),
                  sigma}},
        {.keyword = "seat_sensor",
         .type = RecordType::Placement,
         .help = "a bed, chair or sofa that feels the people on it, for simrun",
         .keys = {idKey(), ofKey("id of the thing"),
                  numberKey("reach", Unit::Length, "from the thing to a person on it", 0.6, 0, 10),
                  numberKey("settle", Unit::Time, "without motion until a person is on it", 2, 0,
                            kLongest),
                  rate,
                  numberKey("threshold", Unit::None, "force from which it is occupied, N", 50, 0,
                            kStrongest),
                  sigma}},
        {.keyword = "load",
         .type = RecordType::Placement,
         .help = "the weight of a robot or a person, for floor_sensor and seat_sensor",
         .keys = {idKey(),
                  ofKey("id of the robot or person"),
                  {.name = "kg",
                   .type = KeyType::Number,
                   .help = "its mass, kilograms",
                   .lower = 0,
                   .upper = 1e5,
                   .required = true}}}};
}

void addPressureChecks() {
    addRecordCheck("seat_sensor", [](const Scene& scene) {
        std::vector<std::string> things;
        for (const Element& element : scene.environment.elements())
            if (!element.body.prisms.empty()) things.push_back(element.id);
        return referenceCheck(scene, "thing of the room", std::move(things));
    });
    addRecordCheck("load", [](const Scene& scene) {
        std::vector<std::string> movers;
        for (const PlacedRobot& robot : scene.robots) movers.push_back(robot.id);
        for (const PlacedPerson& person : scene.people) movers.push_back(person.id);
        return referenceCheck(scene, "robot or person", std::move(movers));
    });
}

double massOfPerson(double height) {
    constexpr double kDensity = 23;  // kg/m^2
    return kDensity * height * height;
}

double massOfRobot(double radius) {
    constexpr double kDensity = 144;  // kg/m^2
    return kDensity * radius * radius;
}

namespace {

/// Adds a record. \param known ids of movers that a load may be of; null: of any
void add(const Scene& scene, std::size_t index, const std::string& prefix,
         const std::vector<std::string>* known, PressureScene& made) {
    const Record& record = scene.records[index];
    const std::string name = prefix + scene.ids[index];
    if (record.keyword() == "floor_sensor") {
        made.floors.push_back(floorOf(record, name));
    } else if (record.keyword() == "seat_sensor") {
        made.seats.push_back(seatOf(record, name, scene));
    } else if (record.keyword() == "load") {
        const std::string& of = record.text("of");
        const std::string id = of.starts_with(prefix) ? of : prefix + of;
        if (known != nullptr && std::find(known->begin(), known->end(), id) == known->end())
            throw FormatError(record.finding(
                "of", "`of`: no robot or person is " + excerpt(of) + didYouMean(of, *known)));
        if (!made.loads.emplace(id, record.number("kg")).second)
            throw FormatError(record.finding("of", "`of`: " + excerpt(of) + " has a load already"));
    }
}

}  // namespace

PressureScene pressureScene(const Scene& scene, const std::string& prefix, LoadsOf movers) {
    PressureScene made;
    std::vector<std::string> known;
    for (const PlacedPerson& person : scene.people) known.push_back(person.id);
    for (const PlacedRobot& robot : scene.robots) known.push_back(robot.id);
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        try {
            add(scene, i, prefix, movers == LoadsOf::ItsOwn ? &known : nullptr, made);
        } catch (const FormatError&) {
            // Of a change by a client: the other sensors go on.
            if (movers == LoadsOf::ItsOwn) throw;
        }
    }
    return made;
}

}  // namespace ispace::pressure
