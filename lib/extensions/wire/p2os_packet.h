// SPDX-License-Identifier: GPL-3.0-or-later
// Packets of Pioneer robots (P2OS, ARCOS), in both directions: FA FB, a length, an id, data and a
// checksum. Numbers are little-endian. Source: the robots' operations manuals; checked against the
// clients ARIA (AriaCoda) and Player's p2os driver.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geom/pose.h"
#include "scene/robot.h"
#include "scene/scene.h"
#include "sim/sim_time.h"

namespace ispace::wire {

/// A packet without its frame.
struct P2osPacket {
    std::uint8_t id = 0;
    std::string data;
    friend bool operator==(const P2osPacket&, const P2osPacket&) = default;
};

/// Maximum bytes of a packet's data: clients drop packets longer than 200 bytes.
constexpr std::size_t kMaxP2osData = 194;

/// Computes the checksum of id and data: the sum of their big-endian words, xor-ed with a last
/// single byte.
std::uint16_t p2osChecksum(std::string_view body);
/// Frames a packet. \pre at most kMaxP2osData bytes of data
std::string p2osBytes(std::uint8_t id, std::string_view data = {});

/// Extracts packets from a byte stream, however it is split. Skips other bytes, and packets with a
/// wrong checksum, up to the next FA FB.
class P2osParser {
  public:
    void append(std::string_view bytes);
    /// Returns the next complete packet; empty if more bytes are needed. Call it until it is empty.
    std::optional<P2osPacket> take();
    /// Bytes of an incomplete packet.
    [[nodiscard]] std::size_t pending() const { return bytes_.size(); }
    /// Drops the start of a packet that does not continue: its bytes may hold other packets.
    void skip();

  private:
    void drop(std::size_t count) { bytes_.erase(0, count); }

    std::string bytes_;  // begins with FA, or is empty, after take()
};

/// Writes the data of a packet, field by field.
class P2osWriter {
  public:
    P2osWriter& u8(std::int64_t value) { return number(value, 1); }
    P2osWriter& u16(std::int64_t value) { return number(value, 2); }
    P2osWriter& u32(std::int64_t value) { return number(value, 4); }
    /// Writes the text and its NUL.
    P2osWriter& text(std::string_view text) {
        data_.append(text).push_back('\0');
        return *this;
    }
    [[nodiscard]] std::size_t size() const { return data_.size(); }
    [[nodiscard]] std::string packet(std::uint8_t id) const { return p2osBytes(id, data_); }

  private:
    /// Writes the low bytes of a number: two's complement if it is negative.
    P2osWriter& number(std::int64_t value, int bytes);

    std::string data_;
};

/// Reads the argument of a command: a type byte (3B, or 1B for negative numbers) and two bytes of
/// magnitude; empty if they are incomplete.
std::optional<int> p2osNumber(const P2osPacket& command);
/// Reads a little-endian two's complement integer from data. \pre the bytes are there
std::int32_t p2osInteger(std::string_view data, std::size_t at, std::size_t bytes);

/// A model of Pioneer as clients know it: they look up the units of its packets by name.
struct P2osType {
    std::string_view name;
    double distance;              ///< millimetres per unit of x and y
    double range;                 ///< millimetres per unit of a sonar's range
    double turn;                  ///< radians per second for 1 mm/s of (right - left) / 2
    int top_speed, top_rotspeed;  ///< mm/s and deg/s, upper limits in clients
    double laser_x, laser_y;      ///< millimetres, position of the laser assumed by clients
};

/// All models, the default first. Figures: parameters of ARIA, identical in Player's p2os driver
/// (except the laser of the p3dx-sh, 18 mm there).
std::span<const P2osType> p2osTypes();
/// Finds a model by name; null if unknown.
const P2osType* p2osTypeNamed(std::string_view name);
/// Returns the model of a robot: from its record, else from its robot model. \pre the scene has it
const P2osType& p2osTypeOf(const Scene& scene, std::string_view robot);

/// Units of heading per turn.
constexpr int kP2osTurn = 4096;

/// Contents of a standard status packet.
struct P2osStatus {
    Pose2 pose;                   ///< by odometry, metres
    double speed = 0;             ///< m/s
    Angle rotspeed;               ///< per second, counter-clockwise
    bool stall = false;           ///< a motor is blocked
    bool motors = false;          ///< switched on
    bool sonars = false;          ///< switched on
    bool stopped = false;         ///< by an active emergency stop
    std::vector<float> ranges;    ///< of the sonars, metres; +infinity for no echo
    std::size_t first_sonar = 0;  ///< first sonar of this packet, if one packet cannot hold all
    std::uint16_t bumpers = 0;    ///< see p2osBumpers()
};

/// Maximum number of sonars in one packet.
constexpr std::size_t kMaxP2osSonars = 32;

std::string p2osStatusPacket(const P2osType& type, const P2osStatus& status);

/// Converts pressed bumpers to the clients' order, clockwise: the front ones in bits 9 to 15, the
/// rear ones in bits 1 to 7. Bits 0 and 8 are reserved for stalled motors. \pre as many as the
/// model has
std::uint16_t p2osBumpers(const RobotModel& model, const std::vector<bool>& pressed);
/// Counts a model's front or rear bumpers.
int p2osBumperCount(const RobotModel& model, bool front);

/// Adjustable limits on a robot's motion: mm/s, mm/s^2, deg/s, deg/s^2.
struct P2osLimits {
    double speed = 0, accel = 0, decel = 0;
    double rotspeed = 0, rotaccel = 0, rotdecel = 0;
    friend bool operator==(const P2osLimits&, const P2osLimits&) = default;
};
/// Initial limits, and the maximum that can be set.
P2osLimits p2osUsualLimits(const RobotModel& model);
P2osLimits p2osTopLimits(const P2osType& type, const RobotModel& model);

/// Identity, features and settings of the robot.
struct P2osConfig {
    std::string name;
    P2osLimits top, now;
    bool sonars = false;
    int front_bumpers = 0, rear_bumpers = 0;
    std::chrono::milliseconds cycle{}, watchdog{};
};

std::string p2osConfigPacket(const P2osType& type, const P2osConfig& config);

/// Packet of the true pose and the step length.
std::string p2osSimPacket(const Pose2& pose, SimTime step);

/// The simulated laser, which stands for a device: settings requested by clients.
struct P2osLaser {
    Angle first = Angle::degrees(-90), last = Angle::degrees(90), step = Angle::degrees(1);
    int mode = 0;  ///< 0: off; 1: ranges alone; 2: with reflectance and flags
    friend bool operator==(const P2osLaser&, const P2osLaser&) = default;

    /// Readings per scan; 0 if the settings are invalid or exceed kMaxReadings.
    [[nodiscard]] int readings() const;
    static constexpr int kMaxReadings = 3601;
};

/// Splits a scan into packets. \param ranges metres; +infinity is sent as `max_range` \param pose
/// of the robot, by odometry
std::string p2osLaserPackets(int mode, const P2osType& type, const Pose2& pose,
                             std::span<const float> ranges, double max_range);

}  // namespace ispace::wire
