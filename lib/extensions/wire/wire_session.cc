// SPDX-License-Identifier: GPL-3.0-or-later
// The table of protocols: a new one is added here.
#include <array>
#include <exception>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/message.h"
#include "extensions/wire/cola.h"
#include "extensions/wire/mjpeg_session.h"
#include "extensions/wire/p2os_session.h"
#include "extensions/wire/scip.h"
#include "extensions/wire/wire_session.h"
#include "extensions/wire/zps_session.h"

namespace ispace::wire {

std::span<const WireProtocol* const> wireProtocols() {
    static constexpr std::array kProtocols{&kP2os, &kScip, &kCola, &kMjpeg, &kZps};
    return kProtocols;
}

namespace {

std::string unknown(std::string_view kind, std::string_view id,
                    const std::vector<std::string>& known) {
    std::string out = "no " + std::string(kind) + " " + excerpt(id);
    if (known.empty()) return out.append(": the scene has none");
    const std::string hint = didYouMean(id, known);
    if (!hint.empty()) return out + hint;
    out += ", there is ";
    for (const std::string& name : known) out.append(&name == &known[0] ? "" : ", ").append(name);
    return out;
}

}  // namespace

void WireHost::runInBackground(std::function<void()> work,
                               std::function<void(const std::exception_ptr& failure)> deliver) {
    std::exception_ptr failure;
    try {
        std::exchange(work, nullptr)();
    } catch (...) {
        failure = std::current_exception();
    }
    std::exchange(deliver, nullptr)(failure);
}

std::string refusalOfSensor(const World& world, std::string_view keyword, std::string_view id) {
    std::vector<std::string> known;
    for (const Sensor& sensor : world.sensors()) {
        if (kindOf(sensor.model).keyword != keyword) continue;
        if (sensor.id == id) return "";
        known.push_back(sensor.id);
    }
    return unknown(keyword, id, known);
}

std::string refusalOfRobot(const World& world, std::string_view id) {
    std::vector<std::string> known;
    for (const PlacedRobot& robot : world.robots()) {
        if (robot.id == id) return "";
        known.push_back(robot.id);
    }
    return unknown("robot", id, known);
}

}  // namespace ispace::wire
