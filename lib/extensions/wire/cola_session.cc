// SPDX-License-Identifier: GPL-3.0-or-later
// Answers of a laser of SICK. Where drivers disagree with the telegram listing, answers follow
// recorded telegrams.
#include "extensions/wire/cola.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <span>
#include <utility>

namespace ispace::wire {

namespace {

constexpr double kAngleUnits = 10'000;  // per degree
constexpr double kAhead = 90;           // degrees
constexpr std::uint32_t kRemission = 200;
constexpr std::uint32_t kMaxWord = 0xFFFF;  // of the range of a beam, too
/// Codes of sFA.
constexpr std::uint32_t kUnknownMethod = 2, kUnknownVariable = 3, kInvalid = 5;
/// Events of evaluation fields, outputs and inputs. They can be switched on and never happen.
constexpr std::array<std::string_view, 3> kSilentEvents{"LFErec", "LIDoutputstate",
                                                        "LIDinputstate"};

/// "field000" is the first evaluation field.
bool isField(std::string_view name) {
    constexpr std::string_view kPrefix = "field";
    constexpr std::size_t kDigits = 3;
    return name.size() == kPrefix.size() + kDigits && name.starts_with(kPrefix) &&
           name.find_first_not_of("0123456789", kPrefix.size()) == std::string_view::npos;
}

std::int32_t angleNumber(Angle angle) {
    return static_cast<std::int32_t>(std::lround(angle.degrees() * kAngleUnits));
}

std::uint32_t microseconds(std::chrono::nanoseconds time) {
    return static_cast<std::uint32_t>(
        std::chrono::duration_cast<std::chrono::microseconds>(time).count());
}

/// Date shown by a clock that started in 1970.
std::chrono::year_month_day dateOf(std::chrono::nanoseconds time) {
    return std::chrono::floor<std::chrono::days>(
        std::chrono::sys_time<std::chrono::nanoseconds>(time));
}

std::chrono::hh_mm_ss<std::chrono::microseconds> timeOfDay(std::chrono::nanoseconds time) {
    using std::chrono::microseconds;
    return std::chrono::hh_mm_ss(
        std::chrono::duration_cast<microseconds>(time % std::chrono::days(1)));
}

std::string refusalOfCola(const World& world, std::string_view id) {
    std::string refusal = refusalOfSensor(world, "laser", id);
    if (!refusal.empty()) return refusal;
    const auto& sensor = world.sensors()[*world.sensorNamed(id)];
    const Laser& laser = *sensor.tryAs<Laser>();
    if (laser.sweep != SweepAxis::None) return sensor.id + ": it sweeps, which CoLa cannot tell";
    const double step = std::round(laser.step.degrees() * kAngleUnits);
    if (step >= 1 && step <= kMaxWord) return "";
    return sensor.id + ": its step is not from 0.0001 to 6.5535 degrees, as CoLa wants it";
}

std::unique_ptr<WireSession> openCola(WireHost& host, const std::string& id) {
    return std::make_unique<ColaSession>(host, id);
}

}  // namespace

const WireProtocol kCola{
    .name = "cola",
    .device = "LASER",
    .help = "let programs for SICK's LMS1xx and TiM (CoLa) connect to it there, by convention 2111",
    .port = 2111,
    .clients = 8,
    .refusal = refusalOfCola,
    .open = openCola};

ColaFigures ColaFigures::of(const Laser& laser) {
    constexpr double kHundred = 100;
    ColaFigures out;
    out.name = laser.model.empty() ? "laser" : laser.model;
    for (char& c : out.name)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    out.start = angleNumber(laser.first + Angle::degrees(kAhead));
    out.stop = angleNumber(laser.last() + Angle::degrees(kAhead));
    out.step = angleNumber(laser.step);
    out.frequency = static_cast<std::uint32_t>(std::lround(laser.rate * kHundred));
    const double beams = laser.rate * 360 / laser.step.degrees();
    out.measurements = static_cast<std::uint32_t>(std::lround(beams / kHundred));
    while (laser.max_range * kMmPerMetre / static_cast<double>(out.scale) > kMaxWord)
        out.scale *= 2;
    return out;
}

std::uint32_t ColaFigures::number(float range) const {
    if (!std::isfinite(range)) return 0;
    const double steps = static_cast<double>(range) * kMmPerMetre / static_cast<double>(scale);
    return static_cast<std::uint32_t>(std::clamp(std::round(steps), 0.0, double{kMaxWord}));
}

ColaSession::ColaSession(WireHost& host, std::string id) : host_(&host), id_(std::move(id)) {
    static_cast<void>(follow());
}

const Laser& ColaSession::laser() const {
    return *host_->world().sensors()[sensor_].tryAs<Laser>();
}

/// Follows changes of the world. \returns false once the laser was removed
bool ColaSession::follow() {
    World& world = host_->world();
    if (changes_ == host_->changes()) return true;
    changes_ = host_->changes();
    if (!refusalOfCola(world, id_).empty()) {
        close();
        return false;
    }
    sensor_ = *world.sensorNamed(id_);
    const ColaFigures before = std::exchange(figures_, ColaFigures::of(laser()));
    // Another laser in its place begins with its whole sector.
    if (before.start != figures_.start || before.stop != figures_.stop ||
        before.step != figures_.step)
        sector_ = {};
    // Periods restart with another rate and after a replay's seek.
    next_ = std::min(next_, world.period(sensor_) + content_.every);
    return true;
}

void ColaSession::receive(std::string_view bytes) {
    telegrams_.append(bytes);
    while (!closing()) {
        const auto telegram = telegrams_.next();
        if (!telegram || !follow()) return;
        setUnderstood();
        answer(*telegram);
    }
}

void ColaSession::answer(const ColaTelegram& telegram) {
    constexpr std::size_t kKind = 3;  // "sRN"
    const std::string_view content = telegram.content;
    const bool binary = telegram.is_binary;
    const std::string_view kind = content.substr(0, kKind);
    std::string_view rest = content.substr(kind.size());
    if (kind == "sRI") {
        // Requests by number: 0 is the identification. Some drivers omit the blank.
        while (rest.starts_with(' ')) rest.remove_prefix(1);
        if (!rest.empty() && (rest == "0" || rest.find_first_not_of('\0') == rest.npos))
            return read("DeviceIdent", "0", binary);
        return refuse(kUnknownVariable, binary);
    }
    if (!rest.starts_with(' ')) return refuse(kUnknownMethod, binary);
    rest.remove_prefix(1);
    const std::string_view name = rest.substr(0, rest.find(' '));
    rest.remove_prefix(std::min(name.size() + 1, rest.size()));
    if (kind == "sRN") return read(name, name, binary);
    if (kind == "sWN") return set(name, rest, binary);
    if (kind == "sMN") return call(name, rest, binary);
    if (kind == "sEN") return listenTo(name, rest, binary);
    refuse(kUnknownMethod, binary);
}

/// The only answer without a blank before its number in B.
void ColaSession::refuse(std::uint32_t code, bool is_binary) {
    if (!is_binary) return send(ColaWriter("sFA", false).u16(code).frame());
    std::string content = "sFA";
    content += '\0';
    content += static_cast<char>(code);
    send(colaFrame(content, true));
}

/// Answers with the value of a variable. \param echo its name or number
void ColaSession::read(std::string_view name, std::string_view echo, bool is_binary) {
    constexpr std::string_view kVersion = "V1.00";
    const std::string begin = "sRA " + std::string(echo);
    ColaWriter out(begin, is_binary);
    if (name == "LMDscandata") return send(scan("sRA", is_binary));
    if (name == "STlms") return state(is_binary);
    if (name == "DeviceIdent") {
        out.text(figures_.name).text(kVersion);
    } else if (name == "FirmwareVersion") {
        out.text(kVersion);
    } else if (name == "SerialNumber" || name == "LocationName") {
        out.text(id_);
    } else if (name == "SCdevicestate") {
        out.u8(1);
    } else if (name == "ODoprh" || name == "ODpwrc") {
        // Tenths of hours of work, times it was switched on.
        const auto minutes = std::chrono::duration_cast<std::chrono::minutes>(host_->clock());
        out.u32(name == "ODpwrc" ? 1 : static_cast<std::uint32_t>(minutes.count() / 6));
    } else if (name == "LMPscancfg") {
        out.u32(figures_.frequency).u16(1).u32(static_cast<std::uint32_t>(figures_.step));
        out.i32(figures_.start).i32(figures_.stop);
    } else if (name == "LMPoutputRange") {
        out.u16(1).u32(static_cast<std::uint32_t>(figures_.step));
        out.i32(angleOf(sector_.first)).i32(angleOf(sector_.last));
    } else if (name == "LMDscandatacfg") {
        out.u8(1).u8(0).u8(content_.remission ? 1 : 0).u8(content_.wide_remission ? 1 : 0);
        out.u8(0).u8(0).u8(0).u8(0).u8(0).u8(0).u8(content_.time ? 1 : 0);
        out.u16(static_cast<std::uint32_t>(content_.every));
    } else if (name == "LIDinputstate") {
        // Version, time, four inputs that are off, no date.
        out.u16(0).u32(microseconds(host_->clock())).u8(0).u8(0).u8(0).u8(0).u16(0);
    } else if (isField(name)) {
        appendField(out);
    } else {
        return refuse(kUnknownVariable, is_binary);
    }
    send(out.frame());
}

/// An evaluation field without an outline: scale and offset of distances and of angles; its type
/// and number; no points, rectangle, radial or dynamic shape; an empty name, no comment. Drivers
/// read as far as the shapes, beyond the end of the one byte that SICK's lasers send for a field
/// that was never defined.
void ColaSession::appendField(ColaWriter& out) const {
    constexpr std::uint32_t kSegmented = 2;
    out.f32(figures_.scale).f32(0).u32(static_cast<std::uint32_t>(figures_.step));
    out.i32(figures_.start).u8(kSegmented).u8(0);
    out.u16(0).u16(0).u16(0).u16(0).u16(1).u16(0).u16(0);
}

void ColaSession::set(std::string_view name, std::string_view arguments, bool is_binary) {
    if (name == "LMDscandatacfg") {
        takeContent(arguments, is_binary);
    } else if (name == "LMPoutputRange") {
        if (!takeSector(arguments, is_binary)) return refuse(kInvalid, is_binary);
    } else if (name != "EIHstCola") {
        return refuse(kUnknownVariable, is_binary);
    }
    send(ColaWriter("sWA " + std::string(name), is_binary).frame());
}

/// Returns the angle of a beam; that of the last one for any after it.
std::int32_t ColaSession::angleOf(std::int64_t beam) const {
    const std::int64_t last = std::max(1, laser().beams - 1);
    if (beam >= last) return figures_.stop;
    const double share = static_cast<double>(beam) / static_cast<double>(last);
    return static_cast<std::int32_t>(std::lround(
        figures_.start + share * (static_cast<double>(figures_.stop) - figures_.start)));
}

/// Reads LMPoutputRange: a sector, its resolution, start and stop, which are cut to beams. \returns
/// false, and changes no sector, without a beam between them, and for another resolution
bool ColaSession::takeSector(std::string_view arguments, bool is_binary) {
    ColaReader in(arguments, is_binary);
    const auto sectors = in.u16(), step = in.u32();
    const auto start = in.i32(), stop = in.i32();
    if (sectors != 1 || step != static_cast<std::uint32_t>(figures_.step) || !start || !stop)
        return false;
    // The steps of most lasers are not whole ten-thousandths: beams lie evenly between the ends.
    const double beams = laser().beams - 1;
    const double exact = static_cast<double>(figures_.stop - figures_.start) / std::max(beams, 1.0);
    constexpr double kNear = 5e-4;
    const double first =
        std::max(0.0, std::ceil(static_cast<double>(*start - figures_.start) / exact - kNear));
    const double last =
        std::min(beams, std::floor(static_cast<double>(*stop - figures_.start) / exact + kNear));
    if (!(first <= last)) return false;
    sector_ = {static_cast<std::int64_t>(first), static_cast<std::int64_t>(last)};
    return true;
}

/// Reads LMDscandatacfg: channel (two numbers), remission, its resolution, unit, encoder (two),
/// position, name, comment, time, divisor of scans.
void ColaSession::takeContent(std::string_view arguments, bool is_binary) {
    ColaReader in(arguments, is_binary);
    static_cast<void>(in.u8());
    static_cast<void>(in.u8());
    Content content;
    content.remission = in.u8().value_or(0) != 0;
    content.wide_remission = in.u8().value_or(0) != 0;
    constexpr int kIgnored = 6;
    for (int i = 0; i < kIgnored; ++i) static_cast<void>(in.u8());
    content.time = in.u8().value_or(0) != 0;
    content.every = std::max<std::int64_t>(1, in.u16().value_or(1));
    content_ = content;
}

void ColaSession::call(std::string_view name, std::string_view arguments, bool is_binary) {
    const std::string begin = "sAN " + std::string(name);
    ColaWriter out(begin, is_binary);
    if (name == "SetAccessMode" || name == "Run" || name == "mEEwriteall") {
        out.u8(1);
    } else if (name == "LMCstartmeas" || name == "LMCstopmeas") {
        measures_ = name == "LMCstartmeas";
        out.u8(0);
    } else if (name == "mLMPsetscancfg") {
        out.u8(scanSettings(arguments, is_binary));
        out.u32(figures_.frequency).u16(1).u32(static_cast<std::uint32_t>(figures_.step));
        out.i32(figures_.start).i32(figures_.stop);
    } else if (name == "mSCreboot") {
        close();
    } else {
        return refuse(kUnknownMethod, is_binary);
    }
    send(out.frame());
}

/// Checks requested settings. \returns 0 if they match the laser; else the unsupported ones: 1 the
/// frequency, 2 the resolution, 3 both, 4 the sector
std::uint32_t ColaSession::scanSettings(std::string_view arguments, bool is_binary) const {
    ColaReader in(arguments, is_binary);
    const auto frequency = in.u32(), sectors = in.u16(), step = in.u32();
    const auto start = in.i32(), stop = in.i32();
    const bool other_frequency = frequency != figures_.frequency;
    const bool other_step = step != figures_.step;
    if (other_frequency || other_step) return (other_frequency ? 1U : 0U) + (other_step ? 2U : 0U);
    return sectors == 1 && start == figures_.start && stop == figures_.stop ? 0 : 4;
}

void ColaSession::listenTo(std::string_view name, std::string_view arguments, bool is_binary) {
    const auto on = ColaReader(arguments, is_binary).u8();
    const bool is_scan = name == "LMDscandata";
    if (!is_scan &&
        std::find(kSilentEvents.begin(), kSilentEvents.end(), name) == kSilentEvents.end())
        return refuse(kUnknownVariable, is_binary);
    if (!on || *on > 1) return refuse(kInvalid, is_binary);
    if (is_scan) {
        streams_ = *on == 1;
        binary_stream_ = is_binary;
        next_ = host_->world().period(sensor_) + 1;
    }
    const std::string begin = "sEA " + std::string(name);
    send(ColaWriter(begin, is_binary).u8(static_cast<std::uint32_t>(*on)).frame());
}

/// 7 is ready, 3 idle; temperature in range; time and date with their lengths; three lamps.
void ColaSession::state(bool is_binary) {
    const auto date = dateOf(host_->clock());
    const auto time = timeOfDay(host_->clock());
    std::array<char, 16> clock{}, day{};
    std::snprintf(clock.data(), clock.size(), "%02d:%02d:%02d",
                  static_cast<int>(time.hours().count()), static_cast<int>(time.minutes().count()),
                  static_cast<int>(time.seconds().count()));
    std::snprintf(day.data(), day.size(), "%02u.%02u.%04d", static_cast<unsigned>(date.day()),
                  static_cast<unsigned>(date.month()), static_cast<int>(date.year()));
    ColaWriter out("sRA STlms", is_binary);
    out.u16(measures_ ? 7 : 3).u8(0).text(clock.data()).text(day.data()).u16(0).u16(0).u16(0);
    send(out.frame());
}

/// Sends the stream's scan if one is due; skips it if too many bytes are unsent.
void ColaSession::stepped(std::size_t unsent) {
    if (closing() || !follow() || !streams_ || !measures_) return;
    const std::int64_t period = host_->world().period(sensor_);
    if (period < next_ || unsent > kMaxUnsentBytes) return;
    next_ = period + content_.every;
    send(scan("sSN", binary_stream_));
}

/// Formats the newest scan.
std::string ColaSession::scan(std::string_view kind, bool is_binary) {
    const SensorReading& reading = host_->world().reading(sensor_);
    const auto taken = host_->clock() - (host_->world().time() - reading.time);
    ColaWriter out(std::string(kind) + " LMDscandata", is_binary);
    out.u16(1).u16(1).u32(1);                                     // version, device, serial number
    out.u8(0).u8(0);                                              // state: no error
    out.u16(++sent_ & kMaxWord);                                  // telegrams
    out.u16(static_cast<std::uint32_t>(reading.seq) & kMaxWord);  // scans
    out.u32(microseconds(taken)).u32(microseconds(host_->clock()));
    out.u8(0).u8(0).u8(0).u8(0).u16(0);                             // inputs, outputs, reserved
    out.u32(figures_.frequency).u32(figures_.measurements).u16(0);  // no encoder
    const bool wide = content_.remission && content_.wide_remission;
    out.u16(wide ? 2 : 1);
    appendChannel(out, "DIST1", true);
    if (wide) appendChannel(out, "RSSI1", true);
    const bool narrow = content_.remission && !wide;
    out.u16(narrow ? 1 : 0);
    if (narrow) appendChannel(out, "RSSI1", false);
    out.u16(0).u16(0).u16(0);  // position, name, comment
    out.u16(content_.time ? 1 : 0);
    if (content_.time) appendDate(out);
    out.u16(0);  // event
    return out.frame();
}

/// Appends distances, or remissions of one or two bytes.
void ColaSession::appendChannel(ColaWriter& out, std::string_view name, bool wide) const {
    const std::vector<float>& ranges = host_->world().reading(sensor_).scan().ranges;
    const bool is_distance = name == "DIST1";
    out.name(name).f32(is_distance ? figures_.scale : 1).f32(0);
    const auto count = static_cast<std::int64_t>(ranges.size());
    const std::int64_t first = std::min(sector_.first, count),
                       last = std::min(sector_.last, count - 1);
    const auto sent = std::span(ranges).subspan(
        static_cast<std::size_t>(first),
        static_cast<std::size_t>(std::max<std::int64_t>(0, last + 1 - first)));
    out.i32(angleOf(sector_.first)).u16(static_cast<std::uint32_t>(figures_.step));
    out.u16(static_cast<std::uint32_t>(sent.size()));
    for (const float range : sent) {
        const std::uint32_t remission = std::isfinite(range) ? kRemission : 0;
        const std::uint32_t value = is_distance ? figures_.number(range) : remission;
        wide ? out.u16(value) : out.u8(value);
    }
}

void ColaSession::appendDate(ColaWriter& out) const {
    const auto date = dateOf(host_->clock());
    const auto time = timeOfDay(host_->clock());
    out.u16(static_cast<std::uint32_t>(static_cast<int>(date.year())));
    out.u8(static_cast<unsigned>(date.month())).u8(static_cast<unsigned>(date.day()));
    out.u8(static_cast<std::uint32_t>(time.hours().count()));
    out.u8(static_cast<std::uint32_t>(time.minutes().count()));
    out.u8(static_cast<std::uint32_t>(time.seconds().count()));
    out.u32(static_cast<std::uint32_t>(time.subseconds().count()));
}

}  // namespace ispace::wire
