// SPDX-License-Identifier: GPL-3.0-or-later
// Tags as lines of text, one for each tag and report.
#include "extensions/wire/zps_session.h"

#include <utility>

#include "base/number.h"

namespace ispace::wire {

namespace {

constexpr int kDecimals = 3;

std::string lineOf(const std::string& tag, const SensorReading& reading) {
    const auto& burst = std::get<Burst>(reading.value);
    std::string out = formatMilliseconds(reading.time) + "," + tag;
    const auto add = [&out](double value) {
        out.append(",").append(formatFixed(value, kDecimals));
    };
    if (burst.fix) {
        add(burst.fix->position.x);
        add(burst.fix->position.y);
        add(burst.fix->position.z);
    } else if (burst.simple) {
        add(burst.simple->x);
        add(burst.simple->y);
        out += ',';
    } else {
        out += ",,,";
    }
    out.append(",").append(std::to_string(burst.heard.size())).append(",");
    if (burst.fix) out += formatFixed(burst.fix->residual, kDecimals);
    return out += '\n';
}

}  // namespace

ZpsSession::ZpsSession(WireHost& host, std::string sensor) : host_(&host), id_(std::move(sensor)) {
    send("# zps-3d 1: t,tag,x,y,z,receivers,residual (s, m)\n");
    follow();
}

/// Looks up the tags to report.
void ZpsSession::follow() {
    const World& world = host_->world();
    changes_ = host_->changes();
    tags_.clear();
    const auto named = world.sensorNamed(id_);
    if (!named) return close();
    const bool all = world.sensors()[*named].tryAs<Tag>() == nullptr;
    for (std::size_t i = 0; i < world.sensors().size(); ++i)
        if (world.sensors()[i].tryAs<Tag>() != nullptr && (all || i == *named))
            tags_.push_back({.sensor = i, .seq = world.reading(i).seq});
}

void ZpsSession::stepped(std::size_t unsent) {
    const World& world = host_->world();
    if (changes_ != host_->changes()) follow();
    constexpr std::size_t kMaxUnsent = 4096;
    for (Followed& tag : tags_) {
        const SensorReading& reading = world.reading(tag.sensor);
        if (reading.seq == tag.seq) continue;
        tag.seq = reading.seq;
        if (unsent <= kMaxUnsent) send(lineOf(world.sensors()[tag.sensor].id, reading));
    }
}

namespace {

std::string refusalOfZps(const World& world, std::string_view id) {
    const auto sensor = world.sensorNamed(id);
    if (sensor && world.sensors()[*sensor].tryAs<Receiver>() != nullptr) return "";
    return refusalOfSensor(world, "tag", id);
}

std::unique_ptr<WireSession> openZps(WireHost& host, const std::string& id) {
    return std::make_unique<ZpsSession>(host, id);
}

}  // namespace

const WireProtocol kZps{
    .name = "zps",
    .device = "TAG",
    .help = "positions of an ultrasonic tag (of all: a receiver), as lines of text",
    .port = 8200,
    .clients = 32,
    .refusal = refusalOfZps,
    .open = openZps};

}  // namespace ispace::wire
