// SPDX-License-Identifier: GPL-3.0-or-later
// Steps one world with the functions of sim: limits, steering of people, collisions. Pairs of
// movers that cannot meet within a step are told by lanes of eight.
#include "extensions/learning/learning_world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/number.h"
#include "base/simd.h"
#include "geom/tolerance.h"
#include "record/text.h"
#include "scene/robot.h"
#include "sense/noise.h"
#include "sense/selection.h"

namespace ispace::learning {

namespace {

constexpr int kManyDraws = 200;

/// Rounds to millimetres, so that positions print short and read as the same number.
double toMillimetre(double x) {
    constexpr double kScale = 1000;
    return std::round(x * kScale) / kScale;
}

double distanceOf(Point2 a, Point2 b) { return std::hypot(a.x - b.x, a.y - b.y); }

double speedOf(const Motion& motion) {
    const double side = motion.side.speed;  // mostly 0, and a root is slow
    return side == 0 ? std::abs(motion.drive.speed) : std::hypot(motion.drive.speed, side);
}

/// Lanes of movers; the last ones are far away.
constexpr std::size_t kLanes = 8;
constexpr double kFarAway = 1e9;

/// Sets `meets` to 1 for circles that overlap others, and possibly for those that are about to.
ISPACE_SIMD_CLONES void findMeeting(const double* __restrict x, const double* __restrict y,
                                    const double* __restrict reach, std::size_t count,
                                    std::uint8_t* __restrict meets) {
    constexpr double kMore = 1 + 1e-9;
    const std::size_t end = (count + kLanes - 1) / kLanes * kLanes;
    for (std::size_t i = 0; i < count; ++i) {
        std::int64_t met = 0;  // itself included
        for (std::size_t k = 0; k < end; ++k) {
            const double far = (reach[i] + reach[k]) * kMore, dx = x[i] - x[k], dy = y[i] - y[k];
            met += dx * dx + dy * dy <= far * far ? 1 : 0;
        }
        meets[i] = met > 1 ? 1 : 0;
    }
}

}  // namespace

bool LearningWorld::isFreeAt(Point2 p, double radius, double apart) const {
    const LearningRoom& room = *in_;
    for (std::size_t i = 0; i < starts_.size(); ++i) {
        const double reach = radius + room.movers()[i].model.radius;
        if (distanceOf(starts_[i].position, p) < reach + apart) return false;
    }
    return true;
}

/// All draws of an episode follow from the world's seed and the episode's number: other worlds and
/// the threads that step them do not matter.
void LearningWorld::start(const LearningSetting& setting) {
    random_ = EpisodeRandom(mixedBits(mixedBits(seed_) + episode_++));
    room_ = random_.below(setting.rooms.size());
    in_ = setting.rooms[room_].get();
    // Half of 32 bits: any tool and language takes such a seed.
    constexpr unsigned kShift = 33;
    run_seed_ = random_.bits() >> kShift;
    steps_ = 0;
    is_over_ = false;
    actions_.clear();
    const LearningTask& task = setting.task;
    speed_factor_ = random_.within(task.speed);
    accel_factor_ = random_.within(task.accel);
    noise_ = RangeNoise();
    noise_.sigma[0] = random_.within(task.sigma);
    noise_.dropout = random_.within(task.dropout);
    place(setting);
    const LearningRoom& room = *in_;
    robots_.assign(room.robots(), Robot());
    for (std::size_t i = 0; i < robots_.size(); ++i) {
        RobotModel model = room.movers()[i].model;
        model.speed *= speed_factor_;
        model.max_speed *= speed_factor_;
        model.max_sidespeed *= speed_factor_;
        model.accel *= accel_factor_;
        robots_[i].limits = limitsOf(model, 0);
        robots_[i].max_speed = model.max_speed;
        robots_[i].max_rotspeed = model.max_rotspeed;
    }
    if (task.kind == LearningTask::Kind::Patrol) {
        patrolled_.assign((room.patrolPoints().size() + 63) / 64, 0);
        patrol_count_ = 0;
        patrol(setting);
    } else if (task.kind != LearningTask::Kind::Follow) {
        for (std::size_t i = 0; i < robots_.size(); ++i) robots_[i].goal = goals_[i];
    }
}

/// Draws the poses of robots, each with its goal, and of people.
void LearningWorld::place(const LearningSetting& setting) {
    const LearningRoom& room = *in_;
    const LearningTask& task = setting.task;
    // From the centre of a cell, within the margin that is free around it.
    constexpr double kJitter = 0.034, kApart = 0.3;
    const auto cell_point = [&](std::uint32_t cell) {
        const Point2 center = room.cells().center(cell);
        const double x = kJitter * (2 * random_.unit() - 1), y = kJitter * (2 * random_.unit() - 1);
        return Point2{toMillimetre(center.x + x), toMillimetre(center.y + y)};
    };
    const auto heading = [this] {
        constexpr double kTurn = 360, kTenths = 10;
        return Angle::degrees(std::round((random_.unit() - 0.5) * kTurn * kTenths) / kTenths);
    };
    starts_.clear();
    goals_.clear();
    if (task.starts_in_scene)
        for (const Mover& mover : room.movers()) starts_.push_back(mover.pose);
    for (std::size_t i = 0; i < room.robots() && task.starts_in_scene && !room.goals().empty(); ++i)
        goals_.push_back(random_.below(room.goals().size()));
    for (std::size_t i = starts_.size(); i < room.robots(); ++i) {
        Point2 at;
        for (int draw = 0; draw < kManyDraws; ++draw) {
            if (room.goals().empty()) {
                at = cell_point(room.robotCells()[random_.below(room.robotCells().size())]);
            } else {
                const std::size_t goal = random_.below(room.goals().size());
                const auto& starts = room.goals()[goal].starts;
                at = cell_point(starts[random_.below(starts.size())]);
                goals_.resize(i);
                goals_.push_back(goal);
            }
            if (isFreeAt(at, room.movers()[i].model.radius, kApart)) break;
        }
        starts_.push_back({at, heading()});
    }
    const auto people = static_cast<std::size_t>(std::lround(random_.within(task.people)));
    // No person stands right before a robot.
    constexpr double kClear = 0.8, kNear = 1, kFar = 3;
    const std::size_t drawn = task.starts_in_scene ? 0 : std::min(people, room.people());
    for (std::size_t i = 0; i < drawn && !room.personCells().empty(); ++i) {
        const Mover& person = room.movers()[room.robots() + i];
        const bool is_led = i == 0 && task.kind == LearningTask::Kind::Follow;
        bool is_placed = false;
        for (int draw = 0; draw < (is_led ? 20 : 1) * kManyDraws && !is_placed; ++draw) {
            const Point2 at =
                cell_point(room.personCells()[random_.below(room.personCells().size())]);
            if (is_led) {
                const double apart = distanceOf(at, starts_[0].position);
                if (apart < kNear || apart > kFar ||
                    room.obstaclesOf(0).near({at, starts_[0].position}, person.model.radius))
                    continue;
            }
            bool is_clear = isFreeAt(at, person.model.radius, 0.1);
            for (std::size_t k = 0; k < room.robots() && is_clear && !is_led; ++k)
                is_clear = distanceOf(at, starts_[k].position) >=
                           person.model.radius + room.movers()[k].model.radius + kClear;
            if (!is_clear) continue;
            starts_.push_back({at, heading()});
            is_placed = true;
        }
        if (!is_placed) break;  // the floor is full
    }
    const std::size_t movers = starts_.size();
    motions_.assign(movers, Motion());
    clearances_.assign(movers, 0);
    gaits_.assign(movers - room.robots(), Gait());
    memories_.assign(movers - room.robots(), SteeringMemory());
    pilots_.clear();
    for (std::size_t i = 0; i < movers; ++i) {
        motions_[i].pose = {starts_[i].position, wrapped(starts_[i].heading)};
        if (i < room.robots()) continue;
        const Mover& person = room.movers()[i];
        pilots_.emplace_back(person, run_seed_);
        pilots_.back().follow(person.course, person.model.speed, false);
    }
}

Point2 LearningWorld::goal(const LearningSetting& setting, std::size_t robot) const {
    const LearningRoom& room = *in_;
    switch (setting.task.kind) {
        case LearningTask::Kind::Follow:
            return motions_.size() > robots_.size() ? motions_[robots_.size()].pose.position
                                                    : motions_[robot].pose.position;
        case LearningTask::Kind::Patrol:
            return room.patrolPoints()[robots_[robot].goal];
        default:
            return room.goals()[robots_[robot].goal].at;
    }
}

/// Draws another goal for a robot that goes on after it has reached one.
void LearningWorld::chooseGoal(const LearningSetting& setting, std::size_t robot) {
    const LearningRoom& room = *in_;
    if (room.goals().empty()) return;
    const Point2 at = motions_[robot].pose.position;
    for (int draw = 0; draw < kManyDraws; ++draw) {
        const std::size_t goal = random_.below(room.goals().size());
        const double straight = distanceOf(room.goals()[goal].at, at);
        const std::optional<double> way = room.goals()[goal].ways.from(at);
        if (!way || straight < room.distances().low || straight > room.distances().high ||
            *way > setting.task.detour * straight)
            continue;
        robots_[robot].goal = goal;
        break;
    }
    robots_[robot].is_measured = false;
}

/// First half of a step: moves each mover as if alone among the walls. All steer by the poses at
/// the step's begin, so the order does not matter yet.
void LearningWorld::propose(const LearningSetting& setting, LearningScratch& scratch) {
    const LearningRoom& room = *in_;
    const std::size_t count = motions_.size();
    const SimTime length = setting.task.step, now = steps_ * length;
    scratch.moves.resize(count);
    scratch.limits.resize(count);
    scratch.blocked.assign(count, std::nullopt);
    Surroundings around{room.movers().first(count), motions_};
    if (!pilots_.empty()) {
        auto traffic = scratch.traffic.find({&room, count});
        if (traffic == scratch.traffic.end())
            traffic =
                scratch.traffic
                    .emplace(std::pair(&room, count), Traffic(room.fastest().first(count),
                                                              room.order(count), seconds(length)))
                    .first;
        scratch.few.set(traffic->second, around.movers, motions_);
        around.few = &scratch.few;
    }
    for (std::size_t i = 0; i < count; ++i) {
        Motion& motion = motions_[i];
        const RobotModel& model = room.movers()[i].model;
        Move& move = scratch.moves[i];
        const bool is_person = i >= robots_.size();
        move.from = &motion;
        move.limits = &scratch.limits[i];
        move.duration = seconds(length);
        move.radius = model.radius;
        move.drift = {};
        if (is_person) {
            Navigator& pilot = pilots_[i - robots_.size()];
            if (pilot.isDue(now, motion)) {
                Vicinity* const shared =
                    room.vicinitiesOfPerson(i - robots_.size()).at(motion.pose.position);
                if (shared == nullptr) scratch.vicinity = Vicinity();
                SteeringMemory& memory = memories_[i - robots_.size()];
                memory.nearest = 0;
                pilot.steer(
                    {&around, &room.obstaclesOf(i), shared == nullptr ? &scratch.vicinity : shared,
                     i, clearances_[i], now, length, &room.clearanceOf(i), &memory},
                    motion);
                clearances_[i] =
                    std::max(clearances_[i], memory.nearest - model.radius - kContactTolerance);
            }
        }
        if (motion.arrived()) {
            move.to = {.motion = motion};
            continue;
        }
        MotionLimits& limits = scratch.limits[i];
        double rough = 0;
        if (!room.friction().empty()) rough = room.friction().at(motion.pose.position);
        if (is_person) {
            const Navigator& pilot = pilots_[i - robots_.size()];
            limits = limitsOf(model, rough);
            limits.drive.top = (1 - rough) * (pilot.isOn() ? pilot.speed() : model.speed);
        } else if (rough == 0) {
            limits = robots_[i].limits;
        } else {
            RobotModel own = model;
            own.speed *= speed_factor_;
            own.max_speed *= speed_factor_;
            own.max_sidespeed *= speed_factor_;
            own.accel *= accel_factor_;
            limits = limitsOf(own, rough);
            limits.drive.top = (1 - rough) * own.speed;
        }
        move.to = advance(motion, limits, move.duration);
        if (move.to.motion.drive.speed != 0 || move.to.motion.side.speed != 0)
            move.to.motion.keepForward();
        if (move.to.path == 0) continue;
        // As World does: the clearance is measured anew only once it may be used up.
        double& clearance = clearances_[i];
        if (is_person && clearance < move.to.path && move.to.bulge <= FreeStrip::kGap &&
            memories_[i - robots_.size()].strip.contains(move.chord())) {
            clearance = std::max(FreeStrip::kGap, clearance - move.to.path);
            continue;
        }
        if (clearance < move.to.path)
            clearance = room.clearanceOf(i).least(move.start()) - move.radius - kContactTolerance;
        if (clearance < move.to.path) {
            const ClearanceField& field = room.clearanceOf(i);
            clearance = field.clearanceAt(move.start()) - move.radius - kContactTolerance;
            const double reach = move.radius - kContactTolerance + move.to.bulge;
            if (clearance < move.to.path && !field.isClear(move.chord(), reach)) {
                scratch.blocked[i] = collides(move, room.obstaclesOf(i));
                if (scratch.blocked[i]) continue;
            }
        }
        clearance -= move.to.path;
    }
}

/// Second half: takes the moves in World's order and cancels those that hit a wall or another
/// mover, moved already or not yet. So a run of simrun settles alike.
void LearningWorld::settle(LearningScratch& scratch) {
    const LearningRoom& room = *in_;
    const std::size_t count = motions_.size();
    const std::vector<std::size_t>& order = room.order(count);
    scratch.next.resize(count);
    // Pairs that are farther apart than both can come do not collide.
    for (std::vector<double>* const list : {&scratch.x, &scratch.y, &scratch.reach})
        list->resize(count + kLanes);
    for (std::size_t i = 0; i < count; ++i) {
        const Move& move = scratch.moves[i];
        scratch.x[i] = move.start().x;
        scratch.y[i] = move.start().y;
        scratch.reach[i] = move.radius + move.to.lag + move.to.path;
    }
    for (std::size_t i = count; i < count + kLanes; ++i) {
        scratch.x[i] = scratch.y[i] = kFarAway;
        scratch.reach[i] = 0;
    }
    scratch.meets.resize(count);
    findMeeting(scratch.x.data(), scratch.y.data(), scratch.reach.data(), count,
                scratch.meets.data());
    for (std::size_t rank = 0; rank < count; ++rank) {
        const std::size_t i = order[rank];
        Move& move = scratch.moves[i];
        bool is_hit = scratch.blocked[i].has_value();
        for (std::size_t k = 0; k < count && !is_hit && scratch.meets[i] != 0; ++k)
            if (k != rank) is_hit = collides(move, scratch.moves[order[k]], k < rank);
        if (is_hit) {
            move.cancel();
            if (i >= robots_.size()) {
                if (Navigator& pilot = pilots_[i - robots_.size()]; pilot.isOn()) pilot.bumped();
            } else {
                robots_[i].has_collided = true;
            }
        }
        scratch.next[i] = move.to.motion;
        if (i < robots_.size()) continue;
        const Motion& motion = scratch.next[i];
        const double speed = speedOf(motion);
        const double path = move.to.path;
        gaits_[i - robots_.size()].walk(room.movers()[i].model.height,
                                        motion.drive.speed < 0 ? -path : path, speed);
        (void)pilots_[i - robots_.size()].takeUnreached();
    }
    std::swap(motions_, scratch.next);
}

void LearningWorld::prefetch() const {
    constexpr std::size_t kLine = 64;
    const auto fetch = [](const auto& list) {
        const char* const begin = reinterpret_cast<const char*>(list.data());
        const std::size_t bytes = std::min(4 * kLine, list.size() * sizeof(list[0]));
        for (std::size_t at = 0; at < bytes; at += kLine) __builtin_prefetch(begin + at);
    };
    fetch(motions_);
    fetch(pilots_);
    fetch(memories_);
    fetch(clearances_);
    fetch(gaits_);
    fetch(robots_);
}

void LearningWorld::step(const LearningSetting& setting, std::span<const float> actions,
                         LearningScratch& scratch) {
    for (std::size_t i = 0; i < robots_.size(); ++i) {
        Robot& robot = robots_[i];
        robot.has_collided = false;
        robot.last_action = robot.action;
        for (std::size_t k = 0; k < kActions; ++k)
            robot.action[k] = std::clamp(actions[i * kActions + k], -1.0F, 1.0F);
        motions_[i].command(
            {.verb = Verb::Speed, .value = static_cast<double>(robot.action[0]) * robot.max_speed});
        motions_[i].command(
            {.verb = Verb::Rotspeed,
             .value = static_cast<double>(robot.action[1]) * robot.max_rotspeed.degrees()});
        actions_.insert(actions_.end(), robot.action.begin(), robot.action.end());
    }
    propose(setting, scratch);
    settle(scratch);
    ++steps_;
    if (setting.task.kind == LearningTask::Kind::Patrol) patrol(setting);
}

/// Counts the floor near the robots, and sends each to the nearest that is left.
void LearningWorld::patrol(const LearningSetting& setting) {
    const std::span<const Point2> points = in_->patrolPoints();
    const double near = setting.task.near;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
        const Point2 at = motions_[i].pose.position;
        double least = std::numeric_limits<double>::infinity();
        std::size_t best = robots_[i].goal, found = 0;
        for (std::size_t k = 0; k < points.size(); ++k) {
            std::uint64_t& word = patrolled_[k / 64];
            const std::uint64_t bit = std::uint64_t{1} << (k % 64);
            if ((word & bit) != 0) continue;
            const double apart = distanceOf(points[k], at);
            if (apart <= near) {
                word |= bit;
                ++found;
            } else if (apart < least) {
                least = apart;
                best = k;
            }
        }
        patrol_count_ += found;
        robots_[i].new_floor =
            static_cast<double>(found) * LearningRoom::kPatrolSide * LearningRoom::kPatrolSide;
        robots_[i].goal = best;
    }
}

/// Casts against the room's lines first and then shortens by the bodies nearby; noise is keyed by
/// seed, laser and step, as in a run of simrun.
void LearningWorld::observe(const LearningSetting& setting, std::size_t robot, std::span<float> out,
                            LearningScratch& scratch) {
    const LearningRoom& room = *in_;
    const RobotLaser& laser = room.laser(robot);
    const Laser& model = laser.sensor.as<Laser>();
    const Motion& motion = motions_[robot];
    const Pose3 pose = mountedPose(motion.pose, laser.mount);
    const std::size_t beams = room.beams();
    const std::span<float> ranges = out.first(beams);
    const Directions& directions = laser.beams->at(pose);
    laser.world->cast(pose.position, directions, model.max_range, ranges);
    if (motions_.size() > 1) {
        scratch.bodies.clear();
        const Point2 here = pose.position.onFloor();
        // Farther bodies shorten no beam, and neither do those behind half a turn of beams.
        constexpr double kBody = 1;  // reach of a person's limbs, at least
        const Vec2 ahead = unitVector(pose.heading + model.first + 0.5 * model.span());
        const bool is_half = model.span() <= Angle::degrees(180);
        const double height = pose.position.z;
        for (std::size_t i = 0; i < motions_.size(); ++i) {
            const Pose2& at = motions_[i].pose;
            const RobotModel& body = room.movers()[i].model;
            const double reach = kBody + body.radius + body.length + std::abs(body.center);
            const Vec2 to = at.position - here;
            const double far = model.max_range + reach;
            if (i == robot || dot(to, to) > far * far || (is_half && dot(to, ahead) < -reach))
                continue;
            if (i < robots_.size()) {
                const MovingBody one = robotBody(body, at, static_cast<std::uint32_t>(i));
                if (isAtSome(one, {&height, 1})) scratch.bodies.push_back(one);
                continue;
            }
            const std::size_t person = i - robots_.size();
            const double speed = speedOf(motions_[i]);
            addHumanBodies(body.height, at, kFirstPerson + static_cast<std::uint32_t>(person),
                           gaits_[person].swing(speed), {&height, 1}, scratch.bodies,
                           room.movers()[i].figure.get());
        }
        if (!scratch.bodies.empty()) {
            scratch.moving.rebuild(scratch.bodies);
            scratch.moving.shorten(pose.position, directions, model.max_range,
                                   static_cast<std::uint32_t>(robot), ranges);
        }
    }
    const NoiseKey key{
        .seed = run_seed_, .sensor = laser.hash, .frame = static_cast<std::uint64_t>(steps_)};
    addNoise(noise_, model.min_range, model.max_range, key, {}, ranges);
    const auto farthest = static_cast<float>(model.max_range);
    float nearest = farthest;
    for (float& range : ranges) {
        range = std::min(range, farthest);
        nearest = std::min(nearest, range);
    }
    Robot& own = robots_[robot];
    own.nearest = static_cast<double>(nearest);
    const Point2 goal = this->goal(setting, robot);
    const Vec2 way = goal - motion.pose.position;
    const Angle bearing = wrapped(directionOf(way.x, way.y) - motion.pose.heading);
    out[beams] = static_cast<float>(length(way));
    out[beams + 1] = static_cast<float>(bearing.radians());
    out[beams + 2] = static_cast<float>(motion.drive.speed);
    out[beams + 3] = static_cast<float>(Angle::degrees(motion.turn.speed).radians());
    if (setting.task.kind == LearningTask::Kind::Dock)
        out[beams + 4] = static_cast<float>(
            wrapped(room.goals()[own.goal].heading - motion.pose.heading).radians());
    if (own.is_measured) return;
    own.distance = length(way);
    own.way.reset();
    if (!room.goals().empty()) own.way = room.goals()[own.goal].ways.from(motion.pose.position);
    own.is_measured = true;
}

std::array<double, kTaskSignals> LearningWorld::signalsOf(const LearningSetting& setting,
                                                          std::size_t robot) {
    const LearningRoom& room = *in_;
    const LearningTask& task = setting.task;
    Robot& own = robots_[robot];
    const Motion& motion = motions_[robot];
    std::array<double, kTaskSignals> signals{};
    const auto set = [&signals](TaskSignal signal, double value) {
        signals[static_cast<std::size_t>(signal)] = value;
    };
    const bool has_goals = !room.goals().empty();
    const double distance = distanceOf(goal(setting, robot), motion.pose.position);
    set(TaskSignal::Step, 1);
    set(TaskSignal::Steps, static_cast<double>(steps_));
    set(TaskSignal::Collision, own.has_collided ? 1 : 0);
    set(TaskSignal::Progress,
        task.kind == LearningTask::Kind::Patrol ? 0 : own.distance - distance);
    set(TaskSignal::Distance, distance);
    set(TaskSignal::Clearance, own.nearest);
    set(TaskSignal::Speed, motion.drive.speed);
    set(TaskSignal::Turn,
        std::abs(Angle::degrees(motion.turn.speed).radians()) * seconds(task.step));
    double change = 0;
    for (std::size_t k = 0; k < kActions; ++k)
        change +=
            std::abs(static_cast<double>(own.action[k]) - static_cast<double>(own.last_action[k]));
    set(TaskSignal::Change, change);
    set(TaskSignal::NewFloor, own.new_floor);
    if (task.kind == LearningTask::Kind::Patrol)
        set(TaskSignal::Floor,
            static_cast<double>(patrol_count_) / static_cast<double>(room.patrolPoints().size()));
    set(TaskSignal::Gap, std::max({0.0, distance - task.band.high, task.band.low - distance}));
    bool is_reached = has_goals && distance < task.reach;
    if (task.kind == LearningTask::Kind::Dock) {
        constexpr double kAligned = 10, kAtRest = 0.05;  // degrees, m/s
        const double aim =
            std::abs(wrapped(room.goals()[own.goal].heading - motion.pose.heading).degrees());
        set(TaskSignal::Aim, Angle::degrees(aim).radians());
        is_reached = is_reached && aim < kAligned && std::abs(motion.drive.speed) < kAtRest;
    }
    set(TaskSignal::Reached, is_reached ? 1 : 0);
    if (has_goals) {
        const std::optional<double> way = room.goals()[own.goal].ways.from(motion.pose.position);
        if (way && own.way) set(TaskSignal::PathProgress, *own.way - *way);
        if (way) own.way = way;
    }
    own.distance = distance;
    return signals;
}

/// Any robot's end ends the world: the others are truncated, not terminated. Goals are drawn anew
/// only after all robots are judged by the old ones.
void LearningWorld::judge(const LearningSetting& setting) {
    const LearningTask& task = setting.task;
    std::vector<std::size_t> arrived;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
        Robot& own = robots_[i];
        const auto signals = signalsOf(setting, i);
        const auto value = [&signals](const TaskRow& row) {
            return signals[static_cast<std::size_t>(row.signal)];
        };
        RobotOutcome& outcome = own.outcome;
        outcome = {};
        outcome.collided = own.has_collided;
        for (const TaskRow& row : task.rewards)
            if (row.holds(value(row))) outcome.reward += row.weight * value(row);
        for (const TaskRow& row : task.ends)
            if (row.holds(value(row))) {
                outcome.terminated = true;
                outcome.success = outcome.success || row.is_success;
            }
        if (!outcome.terminated)
            for (const TaskRow& row : task.truncations)
                if (row.holds(value(row))) {
                    outcome.truncated = true;
                    outcome.success = outcome.success || row.is_success;
                }
        // A robot that did not get there safely has no success.
        if (outcome.collided) outcome.success = false;
        own.sum += outcome.reward;
        is_over_ = is_over_ || outcome.terminated || outcome.truncated;
        if (signals[static_cast<std::size_t>(TaskSignal::Reached)] > 0) arrived.push_back(i);
    }
    // A world ends for all of its robots.
    if (is_over_)
        for (Robot& own : robots_) own.outcome.truncated = !own.outcome.terminated;
    else
        for (const std::size_t robot : arrived) chooseGoal(setting, robot);
}

std::size_t LearningWorld::bytes() const {
    std::size_t sum = sizeof(*this);
    const auto add = [&sum](const auto& list) { sum += list.capacity() * sizeof(list[0]); };
    add(motions_);
    add(clearances_);
    add(pilots_);
    add(memories_);
    add(gaits_);
    add(robots_);
    add(patrolled_);
    add(starts_);
    add(goals_);
    add(actions_);
    for (const Navigator& pilot : pilots_) sum += pilot.course().path.capacity() * sizeof(Point2);
    return sum;
}

/// Drawn starts are whole millimetres and tenths of a degree and the seed has 31 bits, so that the
/// files read as the numbers of this episode.
LearningWorld::Episode LearningWorld::episode(const LearningSetting& setting) const {
    const LearningRoom& room = *in_;
    const Scene& scene = room.scene();
    Document environment, layout;
    layout.kind = DocumentKind::Layout;
    std::size_t robot = 0, person = 0;
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        Record record = scene.records[i];
        if (record.schema().type == RecordType::Meta) continue;
        if (record.schema().type != RecordType::Placement) {
            environment.records.push_back(std::move(record));
            continue;
        }
        record.set("id", Value(scene.ids[i]));
        const bool is_robot = record.keyword() == "robot", is_person = record.keyword() == "human";
        if (is_robot || is_person) {
            const std::size_t mover = is_robot ? robot++ : room.robots() + person++;
            if (mover >= starts_.size()) continue;  // a person that this episode does not have
            const Pose2& start = starts_[mover];
            record.set("at", Value(Tuple{start.position.x, start.position.y}));
            record.set("heading", Value(start.heading.degrees()));
            if (is_robot) {
                RobotModel model = room.movers()[mover].model;
                record.set("speed", Value(model.speed * speed_factor_));
                record.set("max_speed", Value(model.max_speed * speed_factor_));
                record.set("accel", Value(model.accel * accel_factor_));
                for (const char* key : {"motion_noise", "odometry_noise", "start_noise"})
                    if (record.has(key)) record.erase(key);
            }
        }
        for (std::size_t k = 0; k < room.robots(); ++k)
            if (room.laser(k).sensor.id == scene.ids[i]) {
                record.set("rate", Value(1 / seconds(setting.task.step)));
                if (noise_.sigma[0] > 0) record.set("sigma", Value(Tuple{noise_.sigma[0], 0, 0}));
                if (noise_.dropout > 0) record.set("dropout", Value(noise_.dropout));
            }
        layout.records.push_back(std::move(record));
    }
    Episode episode;
    episode.room = writeRecordText(environment);
    episode.layout = writeRecordText(layout);
    const std::size_t width = kActions * robots_.size();
    for (std::size_t k = 0; k < actions_.size(); ++k) {
        const auto step = static_cast<std::int64_t>(k / width);
        const Robot& own = robots_[k % width / kActions];
        const std::string& id = scene.robots[k % width / kActions].id;
        const auto share = static_cast<double>(actions_[k]);
        const bool is_speed = k % kActions == 0;
        episode.script +=
            formatSimTime(step * setting.task.step) + ' ' + id +
            (is_speed ? " SPEED " : " ROTSPEED ") +
            formatDouble(is_speed ? share * own.max_speed : share * own.max_rotspeed.degrees()) +
            '\n';
    }
    episode.options = "--dt " + formatSimTime(setting.task.step) + " --seed " +
                      std::to_string(run_seed_) + (setting.task.isNoisy() ? " --noise" : "") +
                      " --until " + formatSimTime(steps_ * setting.task.step);
    return episode;
}

}  // namespace ispace::learning
