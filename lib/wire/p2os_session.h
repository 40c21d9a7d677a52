// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "wire/p2os_drive.h"
#include "wire/p2os_packet.h"
#include "wire/wire_session.h"

namespace ispace {

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
