// SPDX-License-Identifier: GPL-3.0-or-later
// Packets of a Pioneer as bytes: FA FB, length, id, data, checksum (ActivMedia, Pioneer 2
// Operations Manual, "Client commands and server information packets").
#include "extensions/wire/p2os_packet.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "extensions/wire/wire_session.h"

namespace ispace::wire {

namespace {

constexpr char kFirst = '\xFA', kSecond = '\xFB';
/// FA, FB and the length; then id and checksum at least.
constexpr std::size_t kHeadBytes = 3, kMinValue = 3, kChecksum = 2;
/// Maximum value of the length byte.
constexpr std::size_t kMaxLength = 200;
constexpr std::uint8_t kNegative = 0x1B;

unsigned byteAt(std::string_view bytes, std::size_t at) {
    return static_cast<std::uint8_t>(bytes[at]);
}

}  // namespace

std::uint16_t p2osChecksum(std::string_view body) {
    unsigned sum = 0;
    std::size_t i = 0;
    for (; i + 1 < body.size(); i += 2) sum += byteAt(body, i) << 8U | byteAt(body, i + 1);
    sum &= 0xFFFFU;
    if (i < body.size()) sum ^= byteAt(body, i);
    return static_cast<std::uint16_t>(sum);
}

std::string p2osBytes(std::uint8_t id, std::string_view data) {
    assert(data.size() <= kMaxP2osData);
    std::string body(1, static_cast<char>(id));
    body += data;
    const std::uint16_t sum = p2osChecksum(body);
    std::string bytes = {kFirst, kSecond, static_cast<char>(body.size() + kChecksum)};
    bytes += body;
    bytes += static_cast<char>(sum >> 8U);
    bytes += static_cast<char>(sum & 0xFFU);
    return bytes;
}

void P2osParser::append(std::string_view bytes) { bytes_ += bytes; }

std::optional<P2osPacket> P2osParser::take() {
    std::size_t at = 0;
    std::optional<P2osPacket> packet;
    while (!packet) {
        at = std::min(bytes_.find(kFirst, at), bytes_.size());
        const std::string_view rest = std::string_view(bytes_).substr(at);
        if (rest.size() > 1 && rest[1] != kSecond) {
            ++at;
            continue;
        }
        if (rest.size() < kHeadBytes) break;
        const std::size_t length = byteAt(rest, 2);
        if (length < kMinValue || length > kMaxLength) {
            ++at;
            continue;
        }
        if (rest.size() < kHeadBytes + length) break;
        const std::string_view body = rest.substr(kHeadBytes, length - kChecksum);
        const std::size_t sum = kHeadBytes + body.size();
        const unsigned wanted = byteAt(rest, sum) << 8U | byteAt(rest, sum + 1);
        if (p2osChecksum(body) == wanted) {
            packet = P2osPacket{static_cast<std::uint8_t>(body[0]), std::string(body.substr(1))};
            at += kHeadBytes + length;
        } else {
            ++at;
        }
    }
    drop(at);
    return packet;
}

void P2osParser::skip() {
    if (!bytes_.empty()) drop(1);
}

P2osWriter& P2osWriter::number(std::int64_t value, int bytes) {
    auto rest = static_cast<std::uint64_t>(value);
    for (int i = 0; i < bytes; ++i, rest >>= 8U) data_ += static_cast<char>(rest & 0xFFU);
    return *this;
}

std::int32_t p2osInteger(std::string_view data, std::size_t at, std::size_t bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) value |= byteAt(data, at + i) << (8 * i);
    const auto unused = static_cast<unsigned>(8 * (sizeof value - bytes));
    return static_cast<std::int32_t>(value << unused) >> unused;
}

std::optional<int> p2osNumber(const P2osPacket& command) {
    constexpr std::size_t kSize = 3;
    if (command.data.size() < kSize) return std::nullopt;
    const int magnitude = p2osInteger(command.data, 1, 2) & 0xFFFF;
    return byteAt(command.data, 0) == kNegative ? -magnitude : magnitude;
}

namespace {

constexpr std::array<P2osType, 5> kTypes = {{
    {"p3dx-sh", 1, 1, 0.0056, 2200, 500, 21, 0},
    {"p3dx", 0.485, 1, 0.0056, 2200, 500, 18, 0},
    {"p2dx", 0.84, 0.268, 0.0056, 2200, 500, 17, 8},
    {"p3at-sh", 1, 1, 0.0034, 1200, 300, 125, 0},
    {"p3at", 0.465, 1, 0.0034, 1200, 300, 160, 0},
}};

}  // namespace

std::span<const P2osType> p2osTypes() { return kTypes; }

const P2osType* p2osTypeNamed(std::string_view name) {
    const auto* const found = std::find_if(
        kTypes.begin(), kTypes.end(), [name](const P2osType& type) { return type.name == name; });
    return found == kTypes.end() ? nullptr : found;
}

const P2osType& p2osTypeOf(const Scene& scene, std::string_view robot) {
    const auto index = static_cast<std::size_t>(
        std::find(scene.ids.begin(), scene.ids.end(), robot) - scene.ids.begin());
    const Record& record = scene.records[index];
    if (record.has("p2os")) return *p2osTypeNamed(record.text("p2os"));
    const std::string model = record.has("model") ? record.text("model") : "";
    if (model == "pioneer-2dx") return *p2osTypeNamed("p2dx");
    if (model == "pioneer-3at" || model == "pioneer-2at") return *p2osTypeNamed("p3at-sh");
    return kTypes.front();
}

namespace {

constexpr double kMax16 = 65535;
/// 12.5 V, a charged battery.
constexpr int kBattery = 125;
/// No echo within the sonars' range.
constexpr double kNoEcho = 5000;

// Ids of packets.
constexpr std::uint8_t kStatus = 0x32, kConfig = 0x20, kSim = 0x62, kScan = 0x60, kLongScan = 0x61;

std::int64_t rounded(double value) { return std::llround(value); }

/// Converts millimetres to 16 bits, saturating.
std::int64_t range16(double millimetres) { return rounded(std::clamp(millimetres, 0.0, kMax16)); }

/// Units of heading, in (-2048, 2048].
std::int64_t headingUnits(Angle heading) {
    const std::int64_t units = rounded(wrapped(heading).degrees() / 360 * kP2osTurn);
    return units <= -kP2osTurn / 2 ? units + kP2osTurn : units;
}

void addPose(P2osWriter& out, const P2osType& type, const Pose2& pose) {
    out.u16(rounded(pose.position.x * kMmPerMetre / type.distance));
    out.u16(rounded(pose.position.y * kMmPerMetre / type.distance));
    out.u16(headingUnits(pose.heading));
}

void addSonars(P2osWriter& out, const P2osType& type, const P2osStatus& status) {
    const std::size_t count = status.sonars ? status.ranges.size() : 0;
    const std::size_t sent = std::min(count, kMaxP2osSonars);
    out.u8(static_cast<std::int64_t>(sent));
    for (std::size_t k = 0; k < sent; ++k) {
        const std::size_t sonar = (status.first_sonar + k) % count;
        const float range = status.ranges[sonar];
        const double millimetres =
            std::isinf(range) ? kNoEcho : static_cast<double>(range) * kMmPerMetre;
        out.u8(static_cast<std::int64_t>(sonar)).u16(range16(millimetres / type.range));
    }
}

/// True if the middle of a bumper lies ahead of the robot's centre.
bool isFront(const Bumper& bumper) { return cos(0.5 * (bumper.from + bumper.to)) > 0; }

}  // namespace

std::uint16_t p2osBumpers(const RobotModel& model, const std::vector<bool>& pressed) {
    constexpr int kMaxOfASide = 7;
    unsigned bits = 0;
    // The model stores them counter-clockwise, so the last one of each side comes first.
    int front = 0, rear = 0;
    for (std::size_t k = pressed.size(); k-- > 0;) {
        const bool is_front = isFront(model.bumpers[k]);
        const int bit = is_front ? ++front : ++rear;
        if (pressed[k] && bit <= kMaxOfASide) bits |= 1U << (is_front ? bit + 8 : bit);
    }
    return static_cast<std::uint16_t>(bits);
}

int p2osBumperCount(const RobotModel& model, bool front) {
    return static_cast<int>(
        std::count_if(model.bumpers.begin(), model.bumpers.end(),
                      [front](const Bumper& bumper) { return isFront(bumper) == front; }));
}

std::string p2osStatusPacket(const P2osType& type, const P2osStatus& status) {
    constexpr unsigned kStalled = 0x0101, kMotors = 1, kSonars = 0x1E, kStopped = 1U << 5U;
    const double speed = status.speed * kMmPerMetre;
    const double difference = status.rotspeed.radians() / type.turn;
    P2osWriter out;
    addPose(out, type, status.pose);
    out.u16(rounded(speed - difference)).u16(rounded(speed + difference)).u8(kBattery);
    out.u16(status.bumpers | (status.stall ? kStalled : 0));
    out.u16(0);  // control
    out.u16((status.motors ? kMotors : 0) | (status.sonars ? kSonars : 0) |
            (status.stopped ? kStopped : 0));
    out.u8(0);  // compass
    addSonars(out, type, status);
    constexpr int kUnknown = -127;
    out.u8(0).u8(0).u8(0).u8(0).u8(0);  // gripper, analogue and digital ports
    out.u16(kBattery).u8(0);            // not charging
    out.u16(rounded(10 * status.rotspeed.degrees()));
    out.u16(0).u16(0).u8(kUnknown).u8(0);  // faults, sidespeed, temperature, state of charge
    return out.packet(kStatus);
}

P2osLimits p2osUsualLimits(const RobotModel& model) {
    constexpr double kSpeed = 750, kRotspeed = 100;
    const double accel = model.accel * kMmPerMetre, rotaccel = model.rotaccel.degrees();
    return {std::min(kSpeed, model.max_speed * kMmPerMetre),   accel,    accel,
            std::min(kRotspeed, model.max_rotspeed.degrees()), rotaccel, rotaccel};
}

P2osLimits p2osTopLimits(const P2osType& type, const RobotModel& model) {
    constexpr double kAccel = 2000, kRotaccel = 300;
    const double accel = std::max(kAccel, model.accel * kMmPerMetre);
    const double rotaccel = std::max(kRotaccel, model.rotaccel.degrees());
    return {std::min<double>(type.top_speed, model.max_speed * kMmPerMetre),   accel,    accel,
            std::min<double>(type.top_rotspeed, model.max_rotspeed.degrees()), rotaccel, rotaccel};
}

std::string p2osConfigPacket(const P2osType& type, const P2osConfig& config) {
    constexpr int kLow = 115, kShutdown = 110;  // of the battery, a tenth of a volt
    const P2osLimits &top = config.top, &now = config.now;
    P2osWriter out;
    out.text("Pioneer").text(type.name).text("SIM").u8(0);
    out.u16(range16(top.rotspeed)).u16(range16(top.speed));
    out.u16(range16(top.rotaccel)).u16(range16(top.accel)).u16(500);
    out.text(config.name).u8(config.cycle.count()).u8(0).u8(0);
    out.u16(0).u16(config.sonars ? 1 : 0).u8(config.sonars ? 1 : 0).u16(kLow).u16(0);
    out.u16(config.watchdog.count()).u8(0).u16(200).u16(50);
    out.u16(range16(now.speed)).u16(range16(now.rotspeed));  // speeds of joysticks
    out.u16(range16(now.rotspeed)).u16(range16(now.speed));
    out.u16(range16(now.rotaccel)).u16(range16(now.rotdecel)).u16(0).u16(0).u16(0);
    out.u16(range16(now.accel)).u16(range16(now.decel)).u16(0).u16(0).u16(0);
    out.u8(config.front_bumpers).u8(config.rear_bumpers).u8(0).u8(2).u8(0).u8(0).u16(0);
    out.u8(0).u8(0).u16(0).u16(kShutdown).text("S.ispace");
    out.u16(0).u16(0).u8(0);  // gyroscope; no delay of motion
    out.u16(0).u16(0).u16(0).u16(0).u16(0).u16(0);
    return out.packet(kConfig);
}

std::string p2osSimPacket(const Pose2& pose, SimTime step) {
    const auto interval = std::chrono::duration_cast<std::chrono::milliseconds>(step).count();
    constexpr unsigned kHasMap = 1;
    P2osWriter out;
    out.u8(0).u8(0).u32(kHasMap).u16(interval).u16(interval).u16(interval);
    out.u32(rounded(pose.position.x * kMmPerMetre)).u32(rounded(pose.position.y * kMmPerMetre));
    out.u32(0).u32(rounded(wrapped(pose.heading).degrees()));
    out.u32(0).u32(0).u32(0).u32(-1);  // no geographic position
    out.u32(0).u32(0).u32(0);
    return out.packet(kSim);
}

int P2osLaser::readings() const {
    const double steps = std::abs((last - first).degrees()) / std::abs(step.degrees());
    if (!(steps < kMaxReadings)) return 0;
    return static_cast<int>(std::lround(steps)) + 1;
}

std::string p2osLaserPackets(int mode, const P2osType& type, const Pose2& pose,
                             std::span<const float> ranges, double max_range) {
    constexpr std::size_t kInPacket = 32;
    std::string out;
    for (std::size_t first = 0; first < ranges.size(); first += kInPacket) {
        const auto part = ranges.subspan(first, std::min(kInPacket, ranges.size() - first));
        P2osWriter packet;
        if (mode == 1) addPose(packet, type, pose);
        packet.u16(static_cast<std::int64_t>(ranges.size()));
        packet.u16(static_cast<std::int64_t>(first)).u8(static_cast<std::int64_t>(part.size()));
        for (const float range : part) {
            const double metres = std::isinf(range) ? max_range : static_cast<double>(range);
            packet.u16(range16(metres * kMmPerMetre));
            if (mode != 1) packet.u8(0).u8(0).u8(0);
        }
        if (mode != 1) packet.u8(0).u8(0);
        out += packet.packet(mode == 1 ? kScan : kLongScan);
    }
    return out;
}

}  // namespace ispace::wire
