// SPDX-License-Identifier: GPL-3.0-or-later
// Handles a Pioneer's commands. Unknown ones are ignored, as by robots without the optional part.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/number.h"
#include "extensions/wire/p2os_session.h"

namespace ispace::wire {

namespace {

// Ids that share a method.
constexpr std::uint8_t kSeta = 5, kSetv = 6, kMove = 8, kRotate = 9, kSetrv = 10, kVel = 11,
                       kHead = 12, kDhead = 13, kRvel = 21, kSetra = 23, kStop = 29;
// Laser commands, in the old numbering.
constexpr std::uint8_t kLaserOn = 35, kLaserStart = 36, kLaserEnd = 37, kLaserStep = 38,
                       kNewNumbers = 230 - kLaserOn;

/// Returns a command's number; 0 if it has none.
int valueOf(const P2osPacket& packet) { return p2osNumber(packet).value_or(0); }

}  // namespace

struct P2osSession::Handler {
    std::uint8_t id;
    Method method;
};

const P2osSession::Handler* P2osSession::handlerOf(std::uint8_t id) {
    using S = P2osSession;
    static constexpr std::array<Handler, 30> kHandlers = {{
        {1, &S::open},
        {2, &S::leave},
        {4, &S::enable},
        {kSeta, &S::limit},
        {kSetv, &S::limit},
        {7, &S::setOrigin},
        {kMove, &S::move},
        {kRotate, &S::move},
        {kSetrv, &S::limit},
        {kVel, &S::move},
        {kHead, &S::move},
        {kDhead, &S::move},
        {18, &S::config},
        {kRvel, &S::move},
        {kSetra, &S::limit},
        {28, &S::sonar},
        {kStop, &S::stop},
        {32, &S::wheels},
        {kLaserOn, &S::setLaser},
        {kLaserStart, &S::setLaser},
        {kLaserEnd, &S::setLaser},
        {kLaserStep, &S::setLaser},
        {55, &S::stop},
        {224, &S::setPose},
        {225, &S::reset},
        {kLaserOn + kNewNumbers, &S::setLaser},
        {kLaserStart + kNewNumbers, &S::setLaser},
        {kLaserEnd + kNewNumbers, &S::setLaser},
        {kLaserStep + kNewNumbers, &S::setLaser},
        {237, &S::stat},
    }};
    const auto* const found =
        std::find_if(kHandlers.begin(), kHandlers.end(),
                     [id](const Handler& handler) { return handler.id == id; });
    return found == kHandlers.end() ? nullptr : found;
}

void P2osSession::obey(const P2osPacket& packet) {
    if (const Handler* const handler = handlerOf(packet.id)) (this->*handler->method)(packet);
}

void P2osSession::open(const P2osPacket& packet) {
    opened_ = p2osNumber(packet).value_or(1) != 0;
    if (!opened_) return;
    next_ = host_->world().time() + kCycle;
    sendStatus();
}

void P2osSession::leave(const P2osPacket& /*packet*/) { close(); }

void P2osSession::enable(const P2osPacket& packet) { drive_.enable(valueOf(packet) != 0); }

void P2osSession::config(const P2osPacket& /*packet*/) {
    P2osConfig config;
    config.name = name();
    config.top = drive_.top();
    config.now = drive_.limits();
    config.sonars = !model().sonar.places.empty();
    config.front_bumpers = p2osBumperCount(model(), true);
    config.rear_bumpers = p2osBumperCount(model(), false);
    config.cycle = kCycle;
    config.watchdog = kWatchdog;
    send(p2osConfigPacket(type_, config));
}

/// Sets the odometry to 0,0,0, or with six bytes to x, y in millimetres and a heading in degrees.
void P2osSession::setOrigin(const P2osPacket& packet) {
    pose();
    constexpr std::size_t kSize = 7;
    Pose2 at;
    if (packet.data.size() >= kSize) {
        at.position = {p2osInteger(packet.data, 1, 2) / kMmPerMetre,
                       p2osInteger(packet.data, 3, 2) / kMmPerMetre};
        at.heading = Angle::degrees(p2osInteger(packet.data, 5, 2));
    }
    odometer_.set(at);
}

void P2osSession::sonar(const P2osPacket& packet) { sonars_ = valueOf(packet) != 0; }

void P2osSession::move(const P2osPacket& packet) {
    if (!p2osNumber(packet)) return;
    const int value = valueOf(packet);
    const Angle heading = pose().heading;
    switch (packet.id) {
        case kVel:
            return drive_.setSpeed(value);
        case kMove:
            return drive_.move(value);
        case kHead:
            return drive_.turnTo(Angle::degrees(value), heading);
        case kDhead:
            return drive_.turnBy(Angle::degrees(value), heading);
        default:
            return drive_.setRotspeed(value);
    }
}

void P2osSession::limit(const P2osPacket& packet) {
    if (!p2osNumber(packet)) return;
    const int value = valueOf(packet);
    const double size = std::abs(value);
    switch (packet.id) {
        case kSetv:
            return drive_.limit(&P2osLimits::speed, size);
        case kSetrv:
            return drive_.limit(&P2osLimits::rotspeed, size);
        case kSeta:
            return drive_.limit(value < 0 ? &P2osLimits::decel : &P2osLimits::accel, size);
        default:
            return drive_.limit(value < 0 ? &P2osLimits::rotdecel : &P2osLimits::rotaccel, size);
    }
}

/// The low byte of the number is the right wheel's, the high one the left wheel's.
void P2osSession::wheels(const P2osPacket& packet) {
    if (!p2osNumber(packet)) return;
    constexpr double kUnit = 20;
    const auto both = static_cast<std::uint16_t>(valueOf(packet));
    const auto right = static_cast<std::int8_t>(both & 0xFFU);
    const auto left = static_cast<std::int8_t>(both >> 8U);
    drive_.setWheels(kUnit * left, kUnit * right);
}

void P2osSession::stop(const P2osPacket& packet) {
    packet.id == kStop ? drive_.stop() : drive_.stopHard();
}

void P2osSession::setLaser(const P2osPacket& packet) {
    const int value = valueOf(packet);
    constexpr double kHundredth = 0.01;
    switch (packet.id > kLaserStep ? packet.id - kNewNumbers : packet.id) {
        case kLaserStart:
            laser_.first = Angle::degrees(value);
            return;
        case kLaserEnd:
            laser_.last = Angle::degrees(value);
            return;
        case kLaserStep:
            laser_.step = Angle::degrees(kHundredth * std::max(1, std::abs(value)));
            return;
        default:
            laser_.mode = std::clamp(value, 0, 2);
    }
}

/// Ignores the type byte and reads three numbers of four bytes.
void P2osSession::setPose(const P2osPacket& packet) {
    constexpr std::size_t kSize = 13;
    if (packet.data.size() < kSize) return;
    new_place_ = {{p2osInteger(packet.data, 1, 4) / kMmPerMetre,
                   p2osInteger(packet.data, 5, 4) / kMmPerMetre},
                  wrapped(Angle::degrees(p2osInteger(packet.data, 9, 4)))};
    place();
}

void P2osSession::reset(const P2osPacket& /*packet*/) {
    new_place_ = start_;
    place();
    pose();
    odometer_.set({});
}

/// Moves the robot to another pose unless it would overlap a body there. Odometry does not change.
void P2osSession::place() {
    pose();
    const auto& [at, heading] = *new_place_;
    const std::array<std::string, 2> keys = {
        id_ + ".at=" + formatDouble(at.x) + "," + formatDouble(at.y),
        id_ + ".heading=" + formatDouble(heading.degrees())};
    const WireHost::Change change = host_->change(keys);
    if (change == WireHost::Change::Later) return;
    new_place_.reset();
    if (change == WireHost::Change::Refused || isLost()) return;
    changes_ = host_->changes();
    pose();
    drive_.renew();
}

void P2osSession::stat(const P2osPacket& packet) {
    const int mode = p2osNumber(packet).value_or(1);
    tells_sim_ = mode == 2;
    if (mode == 1) sendSim();
}

}  // namespace ispace::wire
