// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "server/device/p2os_packet.h"
#include "server/device/wire_session.h"
#include "sim/motion.h"
#include "sim/world.h"

namespace ispace {

/// The motion controller of a Pioneer: it keeps what is to be reached along the heading and about
/// the centre, each by itself, and gives it to the wheels. Numbers are in millimetres and degrees.
///
/// Speeds keep to the limits that are set. Distances and headings are reached with the lower of
/// acceleration and deceleration. Who runs into something stands, is stalled as long as a speed
/// along the heading is wanted, and tries again twice a second.
class P2osDrive {
  public:
    P2osDrive(const P2osType& type, const RobotModel& model);

    [[nodiscard]] const P2osLimits& limits() const { return limits_; }
    [[nodiscard]] const P2osLimits& top() const { return top_; }
    /// One of them, up to the top one; nothing but 1 is less than 1.
    void limit(double P2osLimits::*which, double value);

    // What is to be reached. Ignored while the motors are off, or an emergency stop lasts.
    void setSpeed(double speed);
    void setRotspeed(double rotspeed);
    void move(double distance);
    /// \param heading by odometry, as `now` is
    void turnTo(Angle heading, Angle now);
    void turnBy(Angle angle, Angle now);
    /// \param by their wheels, mm/s
    void setWheels(double left, double right);
    void stop();
    /// Stops as hard as can be; nothing else until it stands.
    void stopHard();
    /// Turns the motors on or off, which stops the robot hard.
    void enable(bool on);
    /// Stands while the client is silent, and goes on then.
    void hush(bool silent);
    /// The robot was put elsewhere, at rest: reaches for the same again.
    void renew();

    [[nodiscard]] bool motors() const { return motors_; }
    [[nodiscard]] bool isStopping() const { return stopping_; }
    [[nodiscard]] bool isStalled() const { return stalled_; }
    [[nodiscard]] bool isHushed() const { return hushed_; }
    /// True if it is to go a distance.
    [[nodiscard]] bool hasDistance() const {
        return drive_.kind == AxisGoal::Kind::Distance && drive_.value != 0;
    }

    /// Gives the wheels what is new.
    void apply(World& world, std::size_t robot, Angle now);
    /// After each step; what is new then waits for apply().
    void stepped(const World& world, std::size_t robot);

  private:
    [[nodiscard]] bool mayMove() const { return motors_ && !stopping_; }
    void halt();
    /// The limits that fit what the axes do.
    [[nodiscard]] WheelOrder order(const RobotStatus& status) const;

    P2osType type_;
    P2osLimits top_, limits_;
    AxisGoal drive_, turn_;         // metres, degrees
    std::optional<Angle> heading_;  // to be reached, by odometry
    bool new_drive_ = false, new_turn_ = false;
    bool is_resumed_ = false;  // the turn goes on after a stop
    bool owns_ = false;        // the motors were on: until then the robot goes its own way
    bool motors_ = false, moving_ = false, stopping_ = false, hushed_ = false, stalled_ = false;
    SimTime retry_{};
    Point2 stall_place_;
    AxisLimits drive_limits_, turn_limits_;  // that the wheels have
};

/// Where a robot believes to be, in a frame that its client sets: it starts at 0,0 with each
/// session, and is not moved by what moves the robot without its wheels.
class P2osOdometer {
  public:
    explicit P2osOdometer(const Pose2& counted) : counted_(counted), origin_(counted) {}
    [[nodiscard]] Pose2 pose() const;
    /// From now on this is where it is.
    void set(const Pose2& pose);
    /// What the robot has counted by now. \param most metres and radians that it can have gone
    void follow(const Pose2& counted, double most);

  private:
    Pose2 counted_;  // by the robot since its start
    Pose2 origin_;   // of the client's frame, in the frame of that
};

/// A Pioneer's end of a dialogue: three SYNC packets, then commands; status packets every tenth of
/// a simulated second once the client has opened it. The robot is held as long as the session
/// lives; one that is held already closes the session at once.
///
/// The watchdog stands the robot still once the client has been silent for kWatchdog of wall time
/// and of simulated time, so that neither a slow world nor a fast one trips it.
class P2osSession : public WireSession {
  public:
    static constexpr std::chrono::milliseconds kWatchdog{2000}, kCycle{100};
    /// Of wall time: a packet that is not whole by then is none.
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
    /// Odometry as of now.
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

    WireHost* host_;
    std::string id_;
    P2osType type_;
    WallClock wall_clock_;
    std::optional<std::int64_t> hold_;
    Pose2 start_;
    std::int64_t changes_ = 0;        // of the world, that are known
    Pose2 seen_;                      // where the robot stood by then
    std::optional<Pose2> new_place_;  // where it is to be put
    P2osParser parser_;
    P2osDrive drive_;
    P2osOdometer odometer_;
    bool greeted_ = false, opened_ = false, sonars_ = true;
    std::size_t first_sonar_ = 0;
    std::uint16_t bumpers_ = 0;
    P2osLaser laser_;
    bool tells_sim_ = false;
    SimTime next_{};  // status
    SimTime fed_{};   // the watchdog, in simulated time
    std::chrono::steady_clock::time_point fed_wall_;
    std::chrono::steady_clock::time_point begun_;  // the packet that is not whole yet
};

/// The row of `--p2os`.
extern const WireProtocol kP2os;

}  // namespace ispace
