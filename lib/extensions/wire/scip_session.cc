// SPDX-License-Identifier: GPL-3.0-or-later
// Answers of a laser of Hokuyo: two-letter commands, statuses of two digits, and streams that the
// world's periods feed.
#include "extensions/wire/scip.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace ispace::wire {

namespace {

constexpr std::uint32_t kTimeMask = 0xFFFFFF;
constexpr int kIntensity = 1000;
constexpr int kMaxOfTwo = 4095;
constexpr std::string_view kUnknown = "0E";  // status: unknown command

std::uint32_t milliseconds(std::chrono::nanoseconds time) {
    const auto count = std::chrono::duration_cast<std::chrono::milliseconds>(time).count();
    return static_cast<std::uint32_t>(count) & kTimeMask;
}

/// A seven-digit serial number computed from the id (FNV-1a).
std::string serialOf(std::string_view id) {
    constexpr std::uint32_t kBasis = 2166136261U, kPrime = 16777619U, kDigits = 10'000'000;
    std::uint32_t hash = kBasis;
    for (const char c : id) hash = (hash ^ static_cast<unsigned char>(c)) * kPrime;
    std::string digits = std::to_string(hash % kDigits);
    return "H" + std::string(7 - digits.size(), '0') + digits;
}

std::string scipLine(std::string_view content) {
    std::string out;
    appendScipLine(out, content);
    return out;
}

std::string refusalOfScip(const World& world, std::string_view id) {
    std::string refusal = refusalOfSensor(world, "laser", id);
    if (!refusal.empty()) return refusal;
    const auto& sensor = world.sensors()[*world.sensorNamed(id)];
    refusal = ScipModel::refusal(*sensor.tryAs<Laser>());
    return refusal.empty() ? "" : sensor.id + ": " + refusal;
}

std::unique_ptr<WireSession> openScip(WireHost& host, const std::string& id) {
    return std::make_unique<ScipSession>(host, id);
}

}  // namespace

const WireProtocol kScip{
    .name = "scip",
    .device = "LASER",
    .help = "let programs for Hokuyo's lasers (SCIP 2.0) connect to it there, by convention 10940",
    .port = 10940,
    .clients = 8,
    .refusal = refusalOfScip,
    .open = openScip};

ScipSession::ScipSession(WireHost& host, std::string id) : host_(&host), id_(std::move(id)) {
    static_cast<void>(follow());
}

/// Follows changes of the world. \returns false once the laser was removed or replaced
bool ScipSession::follow() {
    World& world = host_->world();
    if (changes_ == host_->changes()) return true;
    changes_ = host_->changes();
    if (!refusalOfScip(world, id_).empty()) {
        close();
        return false;
    }
    sensor_ = *world.sensorNamed(id_);
    model_ = ScipModel::of(*world.sensors()[sensor_].tryAs<Laser>());
    if (stream_.sweep.end > model_.last) rest();
    // Periods restart with another rate and after a replay's seek.
    stream_.next = std::min(stream_.next, world.period(sensor_) + 1 + stream_.sweep.interval);
    return true;
}

void ScipSession::receive(std::string_view bytes) {
    lines_.append(bytes);
    while (!closing()) {
        const auto line = lines_.next();
        if (!line || !follow()) return;
        answer(*line);
    }
}

/// Writes echo, status, data and an empty line.
void ScipSession::reply(std::string_view line, std::string_view status, std::string_view data) {
    std::string out(line.substr(0, ScipLines::kMaxLength));
    out += '\n';
    appendScipLine(out, status);
    send(out.append(data).append("\n"));
}

/// Laser off, no stream, awake.
void ScipSession::rest() {
    stream_.on = false;
    laser_on_ = false;
    asleep_ = false;
}

void ScipSession::answer(const std::string& line) {
    const ScipRequest request = ScipRequest::of(line);
    if (request.command != "RB") rebooting_ = false;
    if (!request.fault.empty()) return reply(line, request.fault);
    if (isSweep(request)) return takeSweep(request, line);
    const bool is_bare = request.parameters.empty();
    const auto tell = [&](const std::string& data) {
        setUnderstood();
        reply(line, "00", data);
    };
    if (is_bare && request.command == "VV") return tell(product());
    if (is_bare && request.command == "PP") return tell(parameters());
    if (is_bare && request.command == "II") return tell(state());
    if (is_bare && request.command == "%ST") return tell(scipLine(stateCode()));
    const std::string_view status = statusOf(request);
    if (status != kUnknown) setUnderstood();
    const bool tells_time = request.command == "TM" && request.parameters == "1" && status == "00";
    reply(line, status, tells_time ? timeLine(host_->clock()) : "");
    if (request.command == "RB" && status == "00") close();
}

/// Carries out commands without data.
std::string_view ScipSession::statusOf(const ScipRequest& request) {
    const std::string_view command = request.command;
    if (command == "TM") return timeMode(request);
    if (command == "CR") return motor(request.parameters);
    if (command == "HS") return sensitivity(request.parameters);
    if (command == "SS") return bitRate(request.parameters);
    if (!request.parameters.empty()) return kUnknown;
    if (command == "RB") return reboot();
    if (command == "SCIP2.0") return "00";
    if (command == "RS" || command == "RT") {
        rest();
        time_mode_ = false;
        return "00";
    }
    if (command == "QT" && !time_mode_) {
        rest();
        return "00";
    }
    if (command == "%SL" && !time_mode_) {
        rest();
        asleep_ = true;
        return "00";
    }
    if (command == "BM" && !time_mode_) {
        asleep_ = false;
        return std::exchange(laser_on_, true) ? "02" : "00";
    }
    return kUnknown;
}

/// Handles time mode, in which the laser does not measure.
std::string_view ScipSession::timeMode(const ScipRequest& request) {
    if (request.parameters == "0") {
        if (time_mode_) return "02";
        rest();
        time_mode_ = true;
        return "00";
    }
    if (request.parameters == "1") return time_mode_ ? "00" : "04";
    if (request.parameters == "2") return std::exchange(time_mode_, false) ? "00" : "03";
    return "01";
}

std::string_view ScipSession::reboot() {
    if (!std::exchange(rebooting_, true)) return "01";
    rest();
    return "00";
}

/// Handles the bit rate of a serial line: stored without effect.
std::string_view ScipSession::bitRate(std::string_view parameters) {
    constexpr std::array<std::string_view, 7> kRates{"019200", "038400", "057600", "115200",
                                                     "250000", "500000", "750000"};
    const bool numeric = parameters.size() == kRates[0].size() &&
                         parameters.find_first_not_of("0123456789") == std::string_view::npos;
    if (!numeric) return "01";
    if (std::find(kRates.begin(), kRates.end(), parameters) == kRates.end()) return "02";
    if (bit_rate_ == parameters) return "03";
    bit_rate_ = parameters;
    return "00";
}

/// Handles the motor speed: only the record's rate is valid.
std::string_view ScipSession::motor(std::string_view parameters) const {
    if (parameters.size() != 2 ||
        parameters.find_first_not_of("0123456789") != std::string_view::npos)
        return "01";
    if (parameters == "00" || parameters == "99") return "00";
    return parameters <= "10" ? "04" : "02";
}

/// Handles the sensitivity: no effect here.
std::string_view ScipSession::sensitivity(std::string_view parameters) {
    if (parameters != "0" && parameters != "1") return "01";
    const bool wanted = parameters == "1";
    return std::exchange(sensitive_, wanted) == wanted ? "02" : "00";
}

bool ScipSession::isSweep(const ScipRequest& request) const {
    const std::string_view command = request.command;
    if (time_mode_ || command.size() != 2) return false;
    if (command[0] == 'H' || command[0] == 'N')
        return model_.has_echoes && (command[1] == 'D' || command[1] == 'E');
    const bool known = command[0] == 'M' || command[0] == 'G';
    return known &&
           (command[1] == 'D' || command[1] == 'S' || (command[1] == 'E' && model_.has_intensity));
}

void ScipSession::takeSweep(const ScipRequest& request, std::string_view line) {
    const bool streams = request.command[0] == 'M' || request.command[0] == 'N';
    std::string status;
    const ScipSweep sweep = parseScipSweep(request.parameters, streams, model_.last, status);
    if (status != "00") return reply(line, status);
    setUnderstood();
    if (!streams) {
        if (!laser_on_) return reply(line, "10");
        return reply(line, status, scan(request.command, sweep));
    }
    laser_on_ = true;
    asleep_ = false;
    stream_ = {.command = std::string(request.command),
               .parameters = std::string(request.parameters),
               .text = std::string(request.text),
               .sweep = sweep,
               .next = host_->world().period(sensor_) + 1,
               .on = true,
               .endless = sweep.count == 0};
    reply(line, status);
}

/// Sends the stream's scan if one is due. A scan that finds no room is skipped and not counted.
void ScipSession::stepped(std::size_t unsent) {
    if (closing() || !follow() || !stream_.on) return;
    const std::int64_t period = host_->world().period(sensor_);
    if (period < stream_.next || unsent > kMaxUnsentBytes) return;
    ScipSweep& sweep = stream_.sweep;
    stream_.next = period + 1 + sweep.interval;
    if (!stream_.endless) {
        --sweep.count;
        stream_.on = sweep.count > 0;
    }
    // The echo ends in the number of remaining scans.
    constexpr int kTen = 10;
    std::string& parameters = stream_.parameters;
    parameters[parameters.size() - 2] = static_cast<char>('0' + sweep.count / kTen);
    parameters[parameters.size() - 1] = static_cast<char>('0' + sweep.count % kTen);
    reply(stream_.command + parameters + stream_.text, "99", scan(stream_.command, sweep));
}

std::string ScipSession::timeLine(std::chrono::nanoseconds time) const {
    std::string digits;
    appendScipNumber(digits, milliseconds(time), 4);
    return scipLine(digits);
}

/// Of the UST and the UTM-30LX-EW, as %ST answers it.
std::string_view ScipSession::stateCode() const {
    if (time_mode_) return "002";
    if (asleep_) return "005";
    if (stream_.on) return "004";
    return laser_on_ ? "003" : "000";
}

/// Returns time stamp and data of the newest scan.
std::string ScipSession::scan(std::string_view command, const ScipSweep& sweep) const {
    const SensorReading& reading = host_->world().reading(sensor_);
    const int characters = command[1] == 'S' ? 2 : 3;
    std::string values;
    for (int value : model_.numbers(reading.scan().ranges, sweep.start, sweep.end, sweep.cluster)) {
        const bool is_distance = model_.isDistance(value);
        if (characters == 2) value = std::min(value, kMaxOfTwo);
        appendScipNumber(values, static_cast<std::uint32_t>(value), characters);
        if (command[1] == 'E') appendScipNumber(values, is_distance ? kIntensity : 0, characters);
    }
    // When it was taken.
    std::string out = timeLine(host_->clock() - (host_->world().time() - reading.time));
    appendScipData(out, values);
    return out;
}

std::string ScipSession::product() const {
    std::string out;
    appendScipField(out, "VEND", "Hokuyo Automatic Co.,Ltd.");
    appendScipField(out, "PROD", model_.product);
    appendScipField(out, "FIRM", "1.0.0(simulated)");
    appendScipField(out, "PROT", "SCIP 2.0");
    appendScipField(out, "SERI", serialOf(id_));
    return out;
}

std::string ScipSession::parameters() const {
    std::string out;
    appendScipField(out, "MODL", model_.name);
    appendScipField(out, "DMIN", std::to_string(model_.min_mm));
    appendScipField(out, "DMAX", std::to_string(model_.max_mm));
    appendScipField(out, "ARES", std::to_string(model_.turn));
    appendScipField(out, "AMIN", std::to_string(model_.first));
    appendScipField(out, "AMAX", std::to_string(model_.last));
    appendScipField(out, "AFRT", std::to_string(model_.front));
    appendScipField(out, "SCAN", std::to_string(model_.rpm));
    return out;
}

std::string ScipSession::state() const {
    std::array<char, 8> time{};
    std::snprintf(time.data(), time.size(), "%06X", milliseconds(host_->clock()));
    std::string out;
    appendScipField(out, "MODL", model_.name);
    appendScipField(out, "LASR", laser_on_ ? "ON" : "OFF");
    appendScipField(out, "SCSP", "Initial(" + std::to_string(model_.rpm) + "[rpm])");
    appendScipField(out, "MESM", stream_.on ? "Measuring" : "Idle");
    appendScipField(out, "SBPS", "Ethernet 100 [Mbps]");
    appendScipField(out, "TIME", time.data());
    appendScipField(out, "STAT", "Sensor works well.");
    return out;
}

}  // namespace ispace::wire
