// SPDX-License-Identifier: GPL-3.0-or-later
// A contact is 64 points of equal weight on a sunflower's spiral (Vogel, A better way to construct
// the sunflower head, 1979): a cell that covers a share of a disc feels that share to 5 % of the
// weight. Weight is mass times the standard gravity, without the jolt of a step.
//
// A walking person's feet follow limbSwing(), by which sensors see the legs: the foot that goes
// back carries. A person beside a seat counts as on it after `settle` seconds without motion, on
// the nearest seat in reach.
#include "extensions/pressure/pressure.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "base/random.h"
#include "scene/bodies.h"
#include "scene/robot.h"

namespace ispace::pressure {

namespace {

constexpr double kGravity = 9.80665;  // m/s^2, the standard one

/// Returns the noise of elements of a reading, newtons.
std::vector<float> noiseOf(const std::string& id, std::uint64_t seed, std::int64_t number,
                           std::size_t count) {
    std::vector<float> noise(count);
    draw({.seed = seed,
          .purpose = Purpose::Range,
          .sensor = hashOf(id),
          .frame = static_cast<std::uint64_t>(number)},
         0, {.normal = noise});
    return noise;
}

}  // namespace

double PressureReading::kilograms() const { return newtons / kGravity; }

std::vector<FootContact> feetOf(double height, double mass, const RobotStatus& status) {
    const double speed = std::hypot(status.speed, status.sidespeed);
    // The left leg goes back from a quarter of the stride to three quarters, see limbSwing().
    const double left =
        0.5 - 0.5 * shareOfSwing(speed) * std::cos(2 * std::numbers::pi * status.phase);
    std::vector<FootContact> feet;
    for (const BodyPart& part : humanParts(height, limbSwing(status.phase, speed))) {
        if (part.bottom > 0 || part.radius <= 0 || part.is_ball) continue;
        const double middle = (part.bottom + part.top) / 2;
        const bool is_left = part.center.y > 0;
        feet.push_back(
            {.center = status.pose * Point2{part.center.x - part.lean * middle, part.center.y},
             .radius = part.radius,
             .newtons = (is_left ? left : 1 - left) * mass * kGravity});
    }
    return feet;
}

std::vector<FootContact> restingContacts(const PersonFigure& figure, double mass,
                                         const Pose2& pose) {
    constexpr double kTrunk = 0.2;
    if (figure.support > 0) return {{pose.position, kTrunk, mass * kGravity}};
    std::vector<FootContact> contacts;
    double volume = 0;
    // Things have no weight: those that lie beside the person do not press.
    for (std::size_t i = 0; i + figure.load_parts < figure.fixed.size(); ++i) {
        const BodyPart& part = figure.fixed[i];
        if (part.bottom > 0) continue;
        const double thin = std::min(part.half_length, part.half_width);
        const double radius = part.radius > 0 ? part.radius : thin;
        const double along = part.half_length - radius, across = part.half_width - radius;
        const double longest = std::max({0.0, along, across});
        const int count = 1 + static_cast<int>(std::ceil(longest / radius));
        const double flat = part.radius > 0 ? std::numbers::pi * radius * radius
                                            : 4 * part.half_length * part.half_width;
        const double own = flat * (part.top - part.bottom);
        volume += own;
        for (int k = 0; k < count; ++k) {
            const double share = count == 1 ? 0 : 2.0 * k / (count - 1) - 1;
            const Vec2 off{share * std::max(0.0, along), share * std::max(0.0, across)};
            contacts.push_back({pose * (part.center + off), radius, own / count});
        }
    }
    for (FootContact& contact : contacts) contact.newtons *= mass * kGravity / volume;
    return contacts;
}

std::vector<FootContact> wheelsOf(double radius, double mass, const RobotStatus& status) {
    constexpr double kPlace = 0.7, kDriven = 0.4, kCastor = 0.2, kTread = 0.1;
    const double place = kPlace * radius, weight = mass * kGravity;
    return {{status.pose * Point2{0, place}, kTread * radius, kDriven * weight},
            {status.pose * Point2{0, -place}, kTread * radius, kDriven * weight},
            {status.pose * Point2{-place, 0}, kTread * radius, kCastor * weight}};
}

PressureReading readFloor(const PressureFloor& floor, std::span<const FootContact> contacts,
                          std::int64_t number, const std::uint64_t* noise) {
    constexpr int kParts = 64;
    const std::size_t columns = floor.columns(), rows = floor.rows();
    const double reach = std::hypot(floor.length, floor.width) / 2;
    const double turn = floor.pose.heading.radians(), c = std::cos(turn), s = std::sin(turn);
    PressureReading reading{.number = number};
    for (const FootContact& contact : contacts) {
        if (distance(contact.center, floor.pose.position) > reach + contact.radius) continue;
        for (int k = 0; k < kParts; ++k) {
            // Even parts of a disc: a sunflower's seeds (Vogel 1979).
            const double r = contact.radius * std::sqrt((k + 0.5) / kParts);
            const double angle = k * std::numbers::pi * (3 - std::sqrt(5.0));
            const Vec2 from = contact.center + Vec2{r * std::cos(angle), r * std::sin(angle)} -
                              floor.pose.position;
            const double x = c * from.x + s * from.y + floor.length / 2;
            const double y = c * from.y - s * from.x + floor.width / 2;
            if (x < 0 || y < 0 || x > floor.length || y > floor.width) continue;
            const std::size_t column =
                std::min(static_cast<std::size_t>(x / floor.cell), columns - 1);
            const std::size_t row = std::min(static_cast<std::size_t>(y / floor.cell), rows - 1);
            reading.cells[row * columns + column] += contact.newtons / kParts;
        }
    }
    if (noise != nullptr && floor.sigma > 0) {
        const std::vector<float> errors = noiseOf(floor.id, *noise, number, columns * rows);
        for (std::size_t i = 0; i < errors.size(); ++i)
            reading.cells[i] += floor.sigma * static_cast<double>(errors[i]);
    }
    std::erase_if(reading.cells, [&](const auto& cell) {
        return cell.second <= 0 || cell.second < floor.threshold;
    });
    for (const auto& cell : reading.cells) reading.newtons += cell.second;
    reading.is_occupied = !reading.cells.empty();
    return reading;
}

PressureField::PressureField(const World& world, std::string prefix)
    : world_(&world),
      prefix_(std::move(prefix)),
      changes_(world.changes()),
      scene_(pressureScene(world.scene(), prefix_)) {
    readPostures();
    observe();
}

void PressureField::readPostures() {
    postured_.clear();
    const Scene& scene = world_->scene();
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        const Record& record = scene.records[i];
        if (record.keyword() == "human" && record.schema().find("posture") != nullptr &&
            record.has("posture"))
            postured_.insert(scene.ids[i]);
    }
}

void PressureField::observe() {
    if (std::exchange(changes_, world_->changes()) != world_->changes()) {
        scene_ = pressureScene(world_->scene(), prefix_, LoadsOf::Any);
        readPostures();
    }
    if (!scene_.floors.empty() || !scene_.seats.empty()) findContacts();
}

std::optional<double> PressureField::massOf(const std::string& id) const {
    for (const auto* const loads : {&scene_.loads, &visitors_})
        if (const auto known = loads->find(id); known != loads->end()) return known->second;
    return std::nullopt;
}

void PressureField::findContacts() {
    contacts_.clear();
    on_seats_.clear();
    const SimTime now = world_->time();
    const std::size_t robots = world_->robots().size();
    for (std::size_t i = 0; i < world_->movers().size(); ++i) {
        const std::string id(world_->movers()[i].id);
        const RobotStatus status = world_->status(i);
        const bool is_person = i >= robots;
        const double height = is_person ? world_->people()[i - robots].height : 0;
        const double radius = is_person ? 0 : world_->robots()[i].model.radius;
        const double mass =
            massOf(id).value_or(is_person ? massOfPerson(height) : massOfRobot(radius));
        const bool stands =
            status.speed == 0 && status.sidespeed == 0 && status.rotspeed == Angle();
        const PersonFigure* const figure = world_->movers()[i].figure.get();
        const std::string rest(world_->movers()[i].rest());
        const bool rests = !rest.empty();
        SimTime since = now;
        if (stands) {
            Stay& stay =
                stays_.try_emplace(id, Stay{now, status.pose.position, rest}).first->second;
            // To sit down and to stand up, at once in another place, is motion.
            if (stay.place != status.pose.position || stay.rest != rest)
                stay = {now, status.pose.position, rest};
            since = stay.since;
        } else {
            stays_.erase(id);
        }
        // Others that stand still beside a seat count as on it.
        const bool is_on_floor = rests ? figure->support <= 0 : postured_.contains(id);
        if (is_person && stands && !is_on_floor) {
            const PressureSeat* nearest = nullptr;
            double least = 0;
            for (const PressureSeat& seat : scene_.seats) {
                const double away = seat.distanceTo(status.pose.position);
                if (away > (rests ? 0 : seat.reach) || now - since < simSeconds(seat.settle))
                    continue;
                if (nearest != nullptr && away >= least) continue;
                nearest = &seat;
                least = away;
            }
            if (nearest != nullptr) {
                on_seats_[nearest->id] += mass;
                continue;
            }
        }
        const std::vector<FootContact> touching = rests
                                                      ? restingContacts(*figure, mass, status.pose)
                                                  : is_person ? feetOf(height, mass, status)
                                                              : wheelsOf(radius, mass, status);
        contacts_.insert(contacts_.end(), touching.begin(), touching.end());
    }
}

PressureReading PressureField::read(const PressureFloor& floor, std::int64_t number) const {
    const std::uint64_t* const noise =
        world_->options().sensor_noise ? &world_->options().seed : nullptr;
    PressureReading reading = readFloor(floor, contacts_, number, noise);
    reading.time = world_->time();
    return reading;
}

PressureReading PressureField::read(const PressureSeat& seat, std::int64_t number) const {
    PressureReading reading{.number = number, .time = world_->time()};
    const auto on = on_seats_.find(seat.id);
    reading.newtons = on == on_seats_.end() ? 0 : on->second * kGravity;
    if (world_->options().sensor_noise && seat.sigma > 0)
        reading.newtons +=
            seat.sigma *
            static_cast<double>(noiseOf(seat.id, world_->options().seed, number, 1).front());
    reading.newtons = std::max(0.0, reading.newtons);
    reading.is_occupied = reading.newtons > 0 && reading.newtons >= seat.threshold;
    return reading;
}

}  // namespace ispace::pressure
