// SPDX-License-Identifier: GPL-3.0-or-later
// A Pioneer's controller: synchronisation, motion with its own ramps, packets at 10 Hz. The world
// moves the robot; here are the controller's odometry, which begins at 0, and its stalls.
#include "extensions/wire/p2os_session.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ispace::wire {

namespace {

constexpr SimTime kRetryAfter = std::chrono::milliseconds(500);

/// Computes an axis' current limits of speed and acceleration.
AxisLimits limitsFor(const AxisGoal& goal, double speed, double max, double accel, double decel) {
    if (goal.kind == AxisGoal::Kind::Distance) return {max, max, std::min(accel, decel)};
    const double wanted = std::clamp(goal.value, -max, max);
    const bool faster = wanted * speed >= 0 && std::abs(wanted) > std::abs(speed);
    return {max, max, faster ? accel : decel};
}

bool wants(const AxisGoal& goal) { return goal.value != 0; }

}  // namespace

P2osDrive::P2osDrive(const P2osType& type, const RobotModel& model)
    : type_(type), top_(p2osTopLimits(type, model)), limits_(p2osUsualLimits(model)) {}

void P2osDrive::limit(double P2osLimits::*which, double value) {
    limits_.*which = std::clamp(value, 1.0, std::max(1.0, top_.*which));
}

void P2osDrive::setSpeed(double speed) {
    if (!mayMove()) return;
    const AxisGoal goal{AxisGoal::Kind::Speed, speed / kMmPerMetre};
    if (goal == drive_) return;
    if (goal.value * drive_.value <= 0) stalled_ = false;
    drive_ = goal;
    new_drive_ = true;
}

void P2osDrive::setRotspeed(double rotspeed) {
    if (!mayMove()) return;
    heading_.reset();
    turn_ = {AxisGoal::Kind::Speed, rotspeed};
    new_turn_ = true;
}

void P2osDrive::move(double distance) {
    if (!mayMove()) return;
    drive_ = {AxisGoal::Kind::Distance, distance / kMmPerMetre};
    new_drive_ = true;
    stalled_ = false;
}

void P2osDrive::turnTo(Angle heading, Angle now) {
    if (!mayMove()) return;
    heading_ = heading;
    turn_ = {AxisGoal::Kind::Distance, wrapped(heading - now).degrees()};
    new_turn_ = true;
}

void P2osDrive::turnBy(Angle angle, Angle now) {
    if (!mayMove()) return;
    heading_ = wrapped(now + angle);
    turn_ = {AxisGoal::Kind::Distance, angle.degrees()};
    new_turn_ = true;
}

void P2osDrive::setWheels(double left, double right) {
    setSpeed((left + right) / 2);
    setRotspeed(Angle::radians((right - left) / 2 * type_.turn).degrees());
}

void P2osDrive::stop() {
    setSpeed(0);
    setRotspeed(0);
}

void P2osDrive::halt() {
    drive_ = turn_ = {};
    heading_.reset();
    new_drive_ = new_turn_ = true;
    stopping_ = moving_;
    stalled_ = false;
}

void P2osDrive::stopHard() { halt(); }

void P2osDrive::enable(bool on) {
    if (motors_ == on) return;
    halt();
    motors_ = on;
    owns_ = true;
}

void P2osDrive::hush(bool silent) {
    if (silent == hushed_) return;
    hushed_ = silent;
    renew();
}

void P2osDrive::renew() {
    // The remaining distance is unknown.
    if (drive_.kind == AxisGoal::Kind::Distance) drive_ = {};
    new_drive_ = new_turn_ = is_resumed_ = true;
}

WheelOrder P2osDrive::order(const RobotStatus& status) const {
    const P2osLimits& is = stopping_ ? top_ : limits_;
    WheelOrder order;
    order.drive_limits =
        limitsFor(hushed_ ? AxisGoal() : drive_, status.speed, is.speed / kMmPerMetre,
                  is.accel / kMmPerMetre, is.decel / kMmPerMetre);
    order.turn_limits = limitsFor(hushed_ ? AxisGoal() : turn_, status.rotspeed.degrees(),
                                  is.rotspeed, is.rotaccel, is.rotdecel);
    return order;
}

void P2osDrive::apply(World& world, std::size_t robot, Angle now,
                      const std::function<bool()>& may_drive) {
    if (!owns_) return;
    WheelOrder next = order(world.status(robot));
    const bool same = next.drive_limits == drive_limits_ && next.turn_limits == turn_limits_;
    if ((same && !new_drive_ && !new_turn_) || !may_drive()) return;
    if (new_drive_) {
        next.drive = hushed_ ? AxisGoal{} : drive_;
        retry_ = world.time() + kRetryAfter;
    }
    if (new_turn_) {
        if (heading_ && is_resumed_) turn_.value = wrapped(*heading_ - now).degrees();
        next.turn = hushed_ ? AxisGoal{} : turn_;
    }
    is_resumed_ = false;
    new_drive_ = new_turn_ = false;
    drive_limits_ = next.drive_limits;
    turn_limits_ = next.turn_limits;
    world.steer(robot, next);
}

void P2osDrive::stepped(const World& world, std::size_t robot) {
    const RobotStatus status = world.status(robot);
    moving_ = status.speed != 0 || status.rotspeed != Angle();
    stopping_ = stopping_ && moving_;
    const bool hit = std::any_of(world.collisions().begin(), world.collisions().end(),
                                 [robot](const Collision& one) { return one.robot == robot; });
    if (hit) {
        // Standing also ends a turn.
        stalled_ = wants(drive_);
        stall_place_ = status.pose.position;
        retry_ = world.time() + kRetryAfter;
        new_turn_ = is_resumed_ = wants(turn_);
        if (drive_.kind == AxisGoal::Kind::Distance) drive_.value = 0;
    }
    // A robot that can move only up to a step away from the body remains stalled.
    constexpr double kFree = 0.02;
    if (distance(status.pose.position, stall_place_) > kFree) stalled_ = false;
    if (stalled_ && drive_.kind == AxisGoal::Kind::Speed && world.time() >= retry_)
        new_drive_ = true;
}

namespace {

constexpr std::uint8_t kLastSync = 2;
/// Maximum length of names sent.
constexpr std::size_t kMaxName = 24;

Pose2 product(const Pose2& a, const Pose2& b) {
    return {a * b.position, wrapped(a.heading + b.heading)};
}

Pose2 inverse(const Pose2& pose) {
    const Pose2 turned{{}, -pose.heading};
    const Point2 p = pose.position;
    return {turned * Point2{-p.x, -p.y}, -pose.heading};
}

}  // namespace

Pose2 P2osOdometer::pose() const { return product(inverse(origin_), counted_); }

void P2osOdometer::set(const Pose2& pose) { origin_ = product(counted_, inverse(pose)); }

void P2osOdometer::follow(const Pose2& counted, double most) {
    const Pose2 before = pose();
    const bool jumped = distance(counted.position, counted_.position) > most ||
                        std::abs(wrapped(counted.heading - counted_.heading).radians()) > most;
    counted_ = counted;
    if (jumped) set(before);
}

P2osSession::P2osSession(WireHost& host, std::string robot, WallClock wall_clock)
    : host_(&host),
      id_(std::move(robot)),
      type_(p2osTypeOf(host.world().scene(), id_)),
      wall_clock_(std::move(wall_clock)),
      hold_(host.hold(id_)),
      start_(host.world().robots()[this->robot()].pose),
      changes_(host.changes()),
      seen_(host.world().status(this->robot()).pose),
      drive_(type_, model()),
      odometer_(host.world().odometry(this->robot()).pose) {
    if (!hold_) close();
}

P2osSession::~P2osSession() {
    if (hold_) host_->release(id_, *hold_);
}

const RobotModel& P2osSession::model() const { return host_->world().robots()[robot()].model; }

bool P2osSession::isLost() { return !hold_ || !host_->holds(id_, *hold_); }

std::string P2osSession::name() const { return id_.substr(0, kMaxName); }

Pose2 P2osSession::pose() {
    const World& world = host_->world();
    // Twice the distance of a step, since the previous step may be unseen, too.
    const double step = seconds(world.stepLength());
    const double speed = std::max(model().max_speed, model().max_rotspeed.radians());
    constexpr double kSlack = 0.01;
    odometer_.follow(world.odometry(robot()).pose, 4 * step * speed + kSlack);
    return odometer_.pose();
}

/// Handles displacements by other clients' changes, which leave the robot at rest, and by a
/// replay's seek.
void P2osSession::follow() {
    const World& world = host_->world();
    if (changes_ == host_->changes()) return;
    changes_ = host_->changes();
    next_ = std::min<SimTime>(next_, world.time() + kCycle);
    fed_ = std::min(fed_, world.time());
    const RobotStatus status = world.status(robot());
    if (status.speed != 0 || status.rotspeed != Angle()) return;
    const bool is_elsewhere =
        status.pose.position != seen_.position || status.pose.heading != seen_.heading;
    // A robot that was not moved continues, and may have received a distance just now. One without
    // an order may be on a trip by another client.
    if (drive_.wantsMotion() && (is_elsewhere || !drive_.hasDistance())) drive_.renew();
}

void P2osSession::feed() {
    fed_ = host_->world().time();
    fed_wall_ = wall_clock_();
    drive_.hush(false);
}

void P2osSession::watch() {
    if (drive_.isHushed() || host_->world().time() - fed_ < kWatchdog) return;
    if (wall_clock_() - fed_wall_ >= kWatchdog) drive_.hush(true);
}

/// Processes arrived packets. A damaged header may announce bytes that never arrive.
void P2osSession::listen() {
    if (parser_.pending() == 0) return;
    const auto now = wall_clock_();
    while (!closing()) {
        const auto packet = parser_.take();
        const bool is_late = !packet && parser_.pending() > 0 && now - begun_ >= kPacketTime;
        if (packet || is_late) begun_ = now;
        if (packet) {
            setUnderstood();
            feed();
            greeted_ ? obey(*packet) : greet(*packet);
        } else if (is_late) {
            parser_.skip();
        } else {
            return;
        }
    }
}

void P2osSession::receive(std::string_view bytes) {
    if (isLost()) return close();
    follow();
    if (parser_.pending() == 0) begun_ = wall_clock_();
    parser_.append(bytes);
    listen();
    if (closing()) return;
    drive();
    seen_ = host_->world().status(robot()).pose;
}

void P2osSession::stepped(std::size_t unsent) {
    if (isLost()) return close();
    World& world = host_->world();
    follow();
    listen();
    if (closing()) return;
    if (waitsToChange()) place();
    watch();
    drive_.stepped(world, robot());
    drive();
    seen_ = world.status(robot()).pose;
    if (!opened_ || world.time() < next_) return;
    while (next_ <= world.time()) next_ += kCycle;
    // Unread packets would be outdated when they are read.
    constexpr std::size_t kMaxUnsent = 16384;
    if (unsent > kMaxUnsent) return;
    if (tells_sim_) sendSim();
    sendStatus();
    sendScan();
}

void P2osSession::drive() {
    const Angle heading = pose().heading;
    if (!host_->isReplay())
        drive_.apply(host_->world(), robot(), heading, [this] { return host_->mayDrive(id_); });
}

void P2osSession::proceed() {
    if (isLost()) return close();
    follow();
    place();
}

void P2osSession::greet(const P2osPacket& packet) {
    if (packet.id > kLastSync) return;
    if (packet.id < kLastSync) return send(p2osBytes(packet.id));
    P2osWriter out;
    send(out.text(name()).text("Pioneer").text(type_.name).packet(kLastSync));
    greeted_ = true;
}

void P2osSession::sendStatus() {
    World& world = host_->world();
    const Odometry odometry = world.odometry(robot());
    P2osStatus status;
    status.pose = pose();
    status.speed = odometry.speed;
    status.rotspeed = odometry.rotspeed;
    status.stall = drive_.isStalled();
    status.motors = drive_.motors();
    status.stopped = drive_.isStopping();
    status.sonars = sonars_;
    if (sonars_) status.ranges = world.sonar(robot());
    status.first_sonar = first_sonar_;
    // Pressed bumpers stay pressed while the robot tries to move on.
    if (!status.stall || world.status(robot()).stall)
        bumpers_ = p2osBumpers(model(), world.bumper(robot()));
    status.bumpers = bumpers_;
    send(p2osStatusPacket(type_, status));
    if (status.ranges.size() > kMaxP2osSonars)
        first_sonar_ = (first_sonar_ + kMaxP2osSonars) % status.ranges.size();
}

/// Sends a scan of the robot's laser, or of a simulated one at the position that clients assume,
/// with the requested beams.
void P2osSession::sendScan() {
    const int readings = laser_.readings();
    if (laser_.mode == 0 || readings == 0) return;
    constexpr double kUsualRange = 32;
    World& world = host_->world();
    Sensor sensor{.id = "", .model = Laser(), .pose = {}};
    auto& laser = sensor.as<Laser>();
    laser.max_range = kUsualRange;
    sensor.mount = Mount{
        robot(),
        {{type_.laser_x / kMmPerMetre, type_.laser_y / kMmPerMetre, kScanHeight}, {}, {}, {}}};
    for (const Sensor& own : world.sensors()) {
        if (own.tryAs<Laser>() == nullptr || !own.isOn(robot())) continue;
        sensor.mount = own.mount;
        laser.min_range = own.tryAs<Laser>()->min_range;
        laser.max_range = own.tryAs<Laser>()->max_range;
        break;
    }
    laser.beams = readings;
    laser.first = laser_.first;
    laser.step = laser_.last < laser_.first ? -laser_.step : laser_.step;
    const Scan scan = world.look(sensor);
    send(p2osLaserPackets(laser_.mode, type_, pose(), scan.ranges, laser.max_range));
}

void P2osSession::sendSim() {
    const World& world = host_->world();
    send(p2osSimPacket(world.status(robot()).pose, world.stepLength()));
}

namespace {

std::unique_ptr<WireSession> openP2os(WireHost& host, const std::string& id) {
    return std::make_unique<P2osSession>(host, id);
}

}  // namespace

const WireProtocol kP2os{.name = "p2os",
                         .device = "ROBOT",
                         .help = "the packets of Pioneer robots, for ARIA and Player",
                         .port = 8101,
                         .clients = 1,
                         .refusal = refusalOfRobot,
                         .open = openP2os};

}  // namespace ispace::wire
