// SPDX-License-Identifier: GPL-3.0-or-later
// Packets of Pioneer robots (P2OS, ARCOS), in both directions: FA FB, a length, an id, data and a
// checksum. Numbers are little-endian. Published in the operations manuals of these robots; the
// clients that were looked at are ARIA (AriaCoda) and the p2os driver of Player.
// What a Pioneer tells its client, as packets.
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

namespace ispace {

/// A packet without its frame.
struct P2osPacket {
    std::uint8_t id = 0;
    std::string data;
    friend bool operator==(const P2osPacket&, const P2osPacket&) = default;
};

/// Bytes of a packet's data at most: clients drop what is longer than 200 in all.
constexpr std::size_t kMaxP2osData = 194;

/// The checksum of id and data: the sum of their big-endian words, and a last single byte xor-ed
/// into it.
std::uint16_t p2osChecksum(std::string_view body);
/// The packet in its frame. \pre at most kMaxP2osData bytes of data
std::string p2osBytes(std::uint8_t id, std::string_view data = {});

/// Finds packets in a stream of bytes, however it is cut. What is no packet, or has a wrong
/// checksum, is passed over up to the next FA FB.
class P2osParser {
  public:
    void append(std::string_view bytes);
    /// The next whole packet; nothing if more bytes are needed. Call it until it gives nothing.
    std::optional<P2osPacket> take();
    /// Bytes that wait for the rest of their packet.
    [[nodiscard]] std::size_t pending() const { return bytes_.size(); }
    /// Gives up a packet that began but does not go on: its bytes may hold others.
    void skip();

  private:
    void drop(std::size_t count) { bytes_.erase(0, count); }

    std::string bytes_;  // begins with FA, or is empty, after take()
};

/// Data of a packet to be sent, field by field.
class P2osWriter {
  public:
    P2osWriter& u8(std::int64_t value) { return number(value, 1); }
    P2osWriter& u16(std::int64_t value) { return number(value, 2); }
    P2osWriter& u32(std::int64_t value) { return number(value, 4); }
    /// With its NUL.
    P2osWriter& text(std::string_view text) {
        data_.append(text).push_back('\0');
        return *this;
    }
    [[nodiscard]] std::size_t size() const { return data_.size(); }
    [[nodiscard]] std::string packet(std::uint8_t id) const { return p2osBytes(id, data_); }

  private:
    /// The low bytes of a number, so that negative ones are in two's complement.
    P2osWriter& number(std::int64_t value, int bytes);

    std::string data_;
};

/// The number a command carries: a type byte (3B, or 1B for one below 0) and two bytes of
/// magnitude; nothing if they are not all there.
std::optional<int> p2osNumber(const P2osPacket& command);
/// A little-endian number of two's complement within data. \pre the bytes are there
std::int32_t p2osInteger(std::string_view data, std::size_t at, std::size_t bytes);

/// A type of Pioneer as clients know it: by its name they look up how to read its numbers.
struct P2osType {
    std::string_view name;
    double distance;  ///< millimetres of a unit of x and y
    double range;     ///< millimetres of a unit of a sonar's range
    double turn;      ///< radians a second that a millimetre a second of (right - left) / 2 makes
    int top_speed, top_rotspeed;  ///< mm/s and deg/s that clients never exceed
    double laser_x, laser_y;      ///< millimetres, where clients take the laser to be
};

/// All types, the usual one first. Figures: parameters of ARIA, the same in Player's p2os driver
/// (but for the laser of the p3dx-sh, 18 mm there).
std::span<const P2osType> p2osTypes();
/// Null if there is none of that name.
const P2osType* p2osTypeNamed(std::string_view name);
/// That of a robot: what its record says, else that of its model. \pre the scene has it
const P2osType& p2osTypeOf(const Scene& scene, std::string_view robot);

/// Clients count 4096 units of heading in a turn.
constexpr int kP2osTurn = 4096;

/// Contents of a standard status packet.
struct P2osStatus {
    Pose2 pose;                   ///< by odometry, metres
    double speed = 0;             ///< m/s
    Angle rotspeed;               ///< a second, counter-clockwise
    bool stall = false;           ///< a motor is blocked
    bool motors = false;          ///< they are on
    bool sonars = false;          ///< they are on
    bool stopped = false;         ///< by an emergency stop that lasts
    std::vector<float> ranges;    ///< of the sonars, metres; +infinity for no echo
    std::size_t first_sonar = 0;  ///< where a packet begins that cannot hold all of them
    std::uint16_t bumpers = 0;    ///< see p2osBumpers()
};

/// Sonars that fit into one packet.
constexpr std::size_t kMaxP2osSonars = 32;

std::string p2osStatusPacket(const P2osType& type, const P2osStatus& status);

/// Pressed bumpers as clients have them, clockwise: the front ones in bits 9 to 15, the rear ones
/// in bits 1 to 7. Bits 0 and 8 are left for stalled motors. \pre as many as the model has
std::uint16_t p2osBumpers(const RobotModel& model, const std::vector<bool>& pressed);
/// How many of a model's bumpers are in front or at the rear.
int p2osBumperCount(const RobotModel& model, bool front);

/// What can be set of the way a robot moves: mm/s, mm/s^2, deg/s, deg/s^2.
struct P2osLimits {
    double speed = 0, accel = 0, decel = 0;
    double rotspeed = 0, rotaccel = 0, rotdecel = 0;
    friend bool operator==(const P2osLimits&, const P2osLimits&) = default;
};
/// As it starts; and the most that can be set.
P2osLimits p2osUsualLimits(const RobotModel& model);
P2osLimits p2osTopLimits(const P2osType& type, const RobotModel& model);

/// What the robot is and can do, and how it is set.
struct P2osConfig {
    std::string name;
    P2osLimits top, now;
    bool sonars = false;
    int front_bumpers = 0, rear_bumpers = 0;
    std::chrono::milliseconds cycle{}, watchdog{};
};

std::string p2osConfigPacket(const P2osType& type, const P2osConfig& config);

/// The true pose, and steps of that length.
std::string p2osSimPacket(const Pose2& pose, SimTime step);

/// A laser that the simulator has in place of a device: what clients ask of it.
struct P2osLaser {
    Angle first = Angle::degrees(-90), last = Angle::degrees(90), step = Angle::degrees(1);
    int mode = 0;  ///< 0: off; 1: ranges alone; 2: with reflectance and flags
    friend bool operator==(const P2osLaser&, const P2osLaser&) = default;

    /// Readings of a scan; 0 if it is none that can be, or has more than kMaxReadings.
    [[nodiscard]] int readings() const;
    static constexpr int kMaxReadings = 3601;
};

/// A scan in as many packets as it needs. \param ranges metres; +infinity is `max_range`
/// \param pose of the robot, by odometry
std::string p2osLaserPackets(int mode, const P2osType& type, const Pose2& pose,
                             std::span<const float> ranges, double max_range);

}  // namespace ispace
