// SPDX-License-Identifier: GPL-3.0-or-later
// The roles LASER and SENSOR, and the sensors of a robot.
#include <algorithm>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "raster/codec.h"
#include "server/session.h"
#include "server/session_sensors.h"

namespace ispace {

namespace {

/// Reply form for clients that have not chosen one.
ReplyForm defaultForm(const Sensor& sensor) {
    const auto formats = formatsOf(sensor);
    if (formats.empty()) return {};
    return {.stream = false, .binary = true, .format = formats.front()};
}

}  // namespace

std::string Session::unknownSensor(std::string_view kind, std::string_view id) const {
    if (role_ != Role::Robot)
        return unknownThing(kind, id, idsOfAll(kind == "laser" ? Role::Laser : Role::Sensor));
    std::vector<std::string> known;
    for (const Sensor& sensor : world().sensors())
        if (sensor.isOn(subject_)) known.push_back(sensor.id);
    return unknownThing(kind, id, known, " on this robot");
}

void Session::takeLaser(Words words) {
    const std::string_view id = enter(words[1]);
    const auto found = world().sensorNamed(id);
    if (!found || !world().sensors()[*found].is<Laser>())
        return error(404, {unknownSensor("laser", words[1])});
    role_ = Role::Laser;
    id_ = id;
    keyword_ = "laser";
    subject_ = *found;
    form_ = {};
    out_.append("OK LASER ")
        .append(words[1])
        .append(figuresOf(world().sensors()[*found]))
        .append("\n");
}

void Session::takeSensor(Words words) {
    const std::string_view id = enter(words[1]);
    const auto found = world().sensorNamed(id);
    if (!found) return error(404, {unknownSensor("sensor", words[1])});
    role_ = Role::Sensor;
    id_ = id;
    subject_ = *found;
    const Sensor& sensor = world().sensors()[subject_];
    keyword_ = kindOf(sensor.model).keyword;
    form_ = defaultForm(sensor);
    out_.append("OK SENSOR ").append(words[1]).append(" kind=").append(keyword_);
    out_.append(figuresOf(sensor)).append("\n");
}

void Session::scanOfRobot(Words words) {
    const auto found = world().sensorNamed(words[1]);
    if (!found) return error(404, {unknownSensor("sensor", words[1])});
    const Sensor& sensor = world().sensors()[*found];
    if (!sensor.isOn(subject_))
        return error(404, {kindOf(sensor.model).keyword, " ", words[1],
                           " is not on this robot: open another connection and take the role ",
                           sensor.tryAs<Laser>() != nullptr ? "LASER " : "SENSOR ", words[1]});
    ReplyForm form = defaultForm(sensor);
    form.binary = false;
    sendReading(*found, form);
}

/// Sends a reading now, or once it is computed.
void Session::sendReading(std::size_t sensor, const ReplyForm& form) {
    wanted_ = state_->ask(sensor, form);
    receiveAsked();
}

void Session::receiveAsked() {
    if (wanted_ && wanted_->bytes) receiveChange(*std::exchange(wanted_, nullptr));
    if (!coming_ || !coming_->bytes) return;
    const auto come = std::exchange(coming_, nullptr);
    // Streamed readings are unsolicited: skip the error, the next one may succeed.
    if (come->is_error) return;
    scan_ = come->bytes;
    // Sent before the pending answer.
    if (!held_.empty()) out_ += *std::exchange(scan_, nullptr);
}

void Session::sonar(Words /*words*/) {
    const std::vector<float> ranges = world().sonar(subject_);
    std::string places, values;
    for (const Pose2& place : world().robots()[subject_].model.sonar.places) {
        places.append(places.empty() ? "" : ";").append(formatDouble(place.position.x));
        places.append(",").append(formatDouble(place.position.y));
        places.append(",").append(formatDouble(place.heading.degrees()));
    }
    for (const float range : ranges) {
        if (!values.empty()) values += ',';
        appendRange(values, range);
    }
    out_.append("OK SONAR t=").append(formatMilliseconds(world().time()));
    out_.append(" n=").append(std::to_string(ranges.size()));
    out_.append(" at=").append(places).append(" r=").append(values).append("\n");
}

void Session::bumper(Words /*words*/) {
    const std::vector<bool> pressed = world().bumper(subject_);
    std::string hit;
    for (const bool one : pressed) hit.append(hit.empty() ? "" : ",").append(one ? "1" : "0");
    out_.append("OK BUMPER t=").append(formatMilliseconds(world().time()));
    out_.append(" n=").append(std::to_string(pressed.size()));
    std::string places;
    for (const Bumper& bumper : world().movers()[subject_].model.bumpers)
        places.append(places.empty() ? "" : ";")
            .append(formatDouble(bumper.from.degrees()))
            .append(",")
            .append(formatDouble(bumper.to.degrees()));
    out_.append(" hit=").append(hit).append(" at=").append(places).append("\n");
}

void Session::scan(Words words) {
    if (!sendsPendingScan(words)) return;
    sendReading(subject_, form_);
}

void Session::stream(Words words) {
    std::int64_t every = 1;
    if (words.size() > 1) {
        constexpr std::string_view kKey = "every=";
        if (!words[1].starts_with(kKey))
            return error(400, {"unexpected ", excerpt(words[1]), " behind STREAM [every=k]"});
        const Count count = parseCount(words[1].substr(kKey.size()), "every");
        if (count.code != 0) return error(count.code, {count.message});
        every = count.value;
    }
    if (!sendsPendingScan(words)) return;
    if (every_ == 0) seq_ = world().period(subject_);
    every_ = every;
    out_.append("OK STREAM every=").append(std::to_string(every)).append("\n");
}

/// Checks for a new reading to send. A heavy sensor is not captured while its previous reading is
/// being computed or waits for a slow reader, nor while a request waits for that.
void Session::streamSensor() {
    const std::int64_t seq = world().period(subject_);
    if (seq != seq_ && seq % every_ == 0 && held_.empty()) {
        ReplyForm form = form_;
        form.stream = true;
        const bool is_heavy = isHeavy(world().sensors()[subject_]);
        // The reader has left the last one, which another one replaces.
        if (scan_ && (!is_heavy || is_stale_)) ++state_->losses().readings;
        if (scan_ && is_heavy)
            is_stale_ = true;
        else if (!coming_)
            coming_ = state_->ask(subject_, form);
        receiveAsked();
    }
    seq_ = seq;
}

std::shared_ptr<const std::string> Session::takeScan() {
    sync();
    if (scan_ && is_stale_ && every_ > 0 && world().period(subject_) % every_ != 0) {
        scan_ = nullptr;  // the next one is due with a later period
        ++state_->losses().readings;
    } else if (scan_ && is_stale_) {
        ReplyForm form = form_;
        form.stream = true;
        scan_ = nullptr;
        coming_ = state_->ask(subject_, form);
        receiveAsked();
    }
    is_stale_ = false;
    return std::exchange(scan_, nullptr);
}

/// Sends a scan that was due before a request. \returns false if the scan must still be computed,
/// e.g. for a slow reader: then the request is held until it is
bool Session::sendsPendingScan(Words words) {
    if (const auto scan = takeScan()) out_ += *scan;
    if (coming_) hold(words, &Session::hasCome);
    return !coming_;
}

void Session::stopStream(Words words) {
    if (!sendsPendingScan(words)) return;
    every_ = 0;
    out_ += "OK STOP\n";
}

void Session::binary(Words words) {
    if (words[1] != "on" && words[1] != "off")
        return error(400, {"BINARY is on or off, found ", excerpt(words[1])});
    const Sensor& sensor = world().sensors()[subject_];
    if (words[1] == "on" && !hasBytes(sensor))
        return error(400, {"readings of ", sensor.id, " are lines of text alone"});
    if (!sendsPendingScan(words)) return;
    form_.binary = words[1] == "on";
    out_.append("OK BINARY ").append(words[1]).append("\n");
}

void Session::format(Words words) {
    const Sensor& sensor = world().sensors()[subject_];
    const auto formats = formatsOf(sensor);
    if (formats.empty()) return error(400, {"readings of ", sensor.id, " have one format alone"});
    const auto found = std::find_if(formats.begin(), formats.end(),
                                    [&](FrameFormat format) { return nameOf(format) == words[1]; });
    if (found == formats.end()) {
        std::vector<std::string> names;
        for (const FrameFormat format : formats) names.emplace_back(nameOf(format));
        const std::string hint = didYouMean(words[1], names);
        return error(400,
                     {"a ", kindOf(sensor.model).keyword, " has no format ", excerpt(words[1]),
                      hint.empty() ? ", it has " : hint, hint.empty() ? joined(names, ", ") : ""});
    }
    if (*found == FrameFormat::Jpeg) {
        // Report the error now rather than with the first picture.
        try {
            static_cast<void>(jpegOfRgb(1, 1, std::vector<std::uint8_t>(3)));
        } catch (const FormatError& missing) {
            return error(400, {missing.what()});
        }
    }
    if (!sendsPendingScan(words)) return;
    form_.format = *found;
    out_.append("OK FORMAT ").append(words[1]).append("\n");
}

}  // namespace ispace
