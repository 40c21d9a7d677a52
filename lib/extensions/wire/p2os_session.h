// SPDX-License-Identifier: GPL-3.0-or-later
// A Pioneer's controller as programs of the robot meet it: Pioneer 2 and 3 Operations Manuals,
// packets and commands. Units are those of the wire, millimetres and degrees.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "extensions/wire/p2os_packet.h"
#include "extensions/wire/wire_session.h"
#include "sim/motion.h"
#include "sim/world.h"

namespace ispace::wire {

/// The motion controller of a Pioneer: stores separate goals for translation and rotation, and
/// converts them to wheel commands. Numbers are in millimetres and degrees.
///
/// Speeds keep to the limits that are set. Distances and headings are reached with the lower of
/// acceleration and deceleration. A robot that runs into a body stands, reports a stall as long as
/// a translation is requested, and retries twice a second.
class P2osDrive {
  public:
    P2osDrive(const P2osType& type, const RobotModel& model);

    [[nodiscard]] const P2osLimits& limits() const { return limits_; }
    [[nodiscard]] const P2osLimits& top() const { return top_; }
    /// Sets one limit, clamped to [1, maximum].
    void limit(double P2osLimits::*which, double value);

    // Goals. Ignored while the motors are off or during an emergency stop.
    void setSpeed(double speed);
    void setRotspeed(double rotspeed);
    void move(double distance);
    /// \param heading by odometry, as is `now`
    void turnTo(Angle heading, Angle now);
    void turnBy(Angle angle, Angle now);
    /// Speeds of the wheels, mm/s.
    void setWheels(double left, double right);
    void stop();
    /// Stops with maximum deceleration; ignores goals until the robot stands.
    void stopHard();
    /// Turns the motors on or off, which stops the robot hard.
    void enable(bool on);
    /// Stops while the client is silent, and resumes afterwards.
    void hush(bool silent);
    /// Restarts the goals after the robot was moved to another pose, at rest.
    void renew();

    [[nodiscard]] bool motors() const { return motors_; }
    [[nodiscard]] bool isStopping() const { return stopping_; }
    [[nodiscard]] bool isStalled() const { return stalled_; }
    [[nodiscard]] bool isHushed() const { return hushed_; }
    [[nodiscard]] bool wantsMotion() const { return drive_.value != 0 || turn_.value != 0; }
    /// True if a distance remains to be driven.
    [[nodiscard]] bool hasDistance() const {
        return drive_.kind == AxisGoal::Kind::Distance && drive_.value != 0;
    }

    /// Sends changed goals to the wheels, or keeps them for later unless may_drive().
    void apply(World& world, std::size_t robot, Angle now, const std::function<bool()>& may_drive);
    /// Updates the goals after a step; changes take effect with apply().
    void stepped(const World& world, std::size_t robot);

  private:
    [[nodiscard]] bool mayMove() const { return motors_ && !stopping_; }
    void halt();
    /// Returns the wheel limits for the current goals.
    [[nodiscard]] WheelOrder order(const RobotStatus& status) const;

    P2osType type_;
    P2osLimits top_, limits_;
    AxisGoal drive_, turn_;         // metres, degrees
    std::optional<Angle> heading_;  // goal, by odometry
    bool new_drive_ = false, new_turn_ = false;
    bool is_resumed_ = false;  // the turn continues after a stop
    bool owns_ = false;  // the motors have been on: before that the robot moves as the scene says
    bool motors_ = false, moving_ = false, stopping_ = false, hushed_ = false, stalled_ = false;
    SimTime retry_{};
    Point2 stall_place_;
    AxisLimits drive_limits_, turn_limits_;  // limits of the wheels
};

/// A robot's pose by odometry in a frame set by its client: it starts at 0,0 with each session, and
/// ignores displacements not made by the wheels.
class P2osOdometer {
  public:
    explicit P2osOdometer(const Pose2& counted) : counted_(counted), origin_(counted) {}
    [[nodiscard]] Pose2 pose() const;
    /// Sets the current pose.
    void set(const Pose2& pose);
    /// Updates the pose from the robot's odometry. \param most upper bound of the motion since the
    /// last call, in metres and radians
    void follow(const Pose2& counted, double most);

  private:
    Pose2 counted_;  // odometry since the robot's start
    Pose2 origin_;   // of the client's frame, in that of counted_
};

/// A Pioneer's side of a dialogue: three SYNC packets, then commands; after the open command,
/// status packets every tenth of a simulated second. The session holds the robot until it ends; it
/// closes at once if another client holds the robot.
///
/// The watchdog stops the robot once the client has been silent for kWatchdog of wall time and of
/// simulated time, so that a slow or fast world does not trip it.
class P2osSession : public WireSession {
  public:
    static constexpr std::chrono::milliseconds kWatchdog{2000}, kCycle{100};
    /// Wall time in which a packet must be complete; otherwise its bytes are dropped.
    static constexpr std::chrono::milliseconds kPacketTime{500};
    using WallClock = std::function<std::chrono::steady_clock::time_point()>;

    /// \pre the robot exists
    P2osSession(WireHost& host, std::string robot,
                WallClock wall_clock = &std::chrono::steady_clock::now);
    ~P2osSession() override;
    P2osSession(const P2osSession&) = delete;
    P2osSession& operator=(const P2osSession&) = delete;

    void receive(std::string_view bytes) override;
    void stepped(std::size_t unsent) override;
    [[nodiscard]] bool waitsToChange() const override { return new_place_.has_value(); }
    void proceed() override;
    [[nodiscard]] bool isEngaged() const override { return understood(); }

  private:
    struct Handler;
    using Method = void (P2osSession::*)(const P2osPacket&);
    static const Handler* handlerOf(std::uint8_t id);

    [[nodiscard]] std::size_t robot() const { return *host_->world().robotNamed(id_); }
    [[nodiscard]] const RobotModel& model() const;
    [[nodiscard]] bool isLost();
    [[nodiscard]] std::string name() const;
    /// Current pose by odometry.
    Pose2 pose();
    void follow();
    void listen();
    void feed();
    void watch();

    void greet(const P2osPacket& packet);
    void obey(const P2osPacket& packet);
    void sendStatus();
    void sendScan();
    void sendSim();

    // Commands.
    void open(const P2osPacket& packet);
    void leave(const P2osPacket& packet);
    void enable(const P2osPacket& packet);
    void config(const P2osPacket& packet);
    void setOrigin(const P2osPacket& packet);
    void sonar(const P2osPacket& packet);
    void move(const P2osPacket& packet);
    void limit(const P2osPacket& packet);
    void wheels(const P2osPacket& packet);
    void stop(const P2osPacket& packet);
    void setLaser(const P2osPacket& packet);
    void setPose(const P2osPacket& packet);
    void reset(const P2osPacket& packet);
    void stat(const P2osPacket& packet);
    void place();
    void drive();

    WireHost* host_;
    std::string id_;
    P2osType type_;
    WallClock wall_clock_;
    std::optional<std::int64_t> hold_;
    Pose2 start_;
    std::int64_t changes_ = 0;        // change count of the world seen last
    Pose2 seen_;                      // the robot's true pose at that count
    std::optional<Pose2> new_place_;  // pose to which it must be moved
    P2osParser parser_;
    P2osDrive drive_;
    P2osOdometer odometer_;
    bool greeted_ = false, opened_ = false, sonars_ = true;
    std::size_t first_sonar_ = 0;
    std::uint16_t bumpers_ = 0;
    P2osLaser laser_;
    bool tells_sim_ = false;
    SimTime next_{};  // next status packet
    SimTime fed_{};   // watchdog, in simulated time
    std::chrono::steady_clock::time_point fed_wall_;
    std::chrono::steady_clock::time_point begun_;  // start of the incomplete packet
};

/// The row of `--p2os`.
extern const WireProtocol kP2os;

}  // namespace ispace::wire
