// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/wire/device_bridge.h"

#include <algorithm>
#include <chrono>
#include <vector>

#include "base/error.h"
#include "server/server.h"
#include "server/session.h"

namespace ispace::wire {

std::string DeviceBridge::open(const WireProtocol& protocol, const std::string& id,
                               const Endpoint& endpoint) {
    const auto [state, name, is_known] = host_.state.find(id);
    if (!is_known) {
        std::vector<std::string> known;
        for (const auto& [room, world] : host_.state.worlds())
            for (const auto& ids : {idsOf(world->robots()), idsOf(world->sensors())})
                for (const std::string& one : ids) known.push_back(nameAcross(room, one));
        throw UsageError(unknownThing("robot or sensor", id, known));
    }
    const std::string refusal = protocol.refusal(state->simulation().world(), name);
    if (!refusal.empty()) throw UsageError(refusal);
    DeviceHost& device = hosts_.emplace_back(*state, std::string(name), pictures_);
    return ports_
        .emplace_back(host_.io, device, host_.limits, protocol, std::string(name), endpoint)
        .address();
}

void DeviceBridge::stepped() {
    for (DevicePort& port : ports_) port.stepped();
}

void DeviceBridge::serve(bool has_made) {
    for (DevicePort& port : ports_) {
        port.serve(std::chrono::steady_clock::now());
        if (has_made) port.stepped();
    }
}

bool DeviceBridge::waitsToChange() const {
    return std::any_of(ports_.begin(), ports_.end(),
                       [](const DevicePort& port) { return port.waitsToChange(); });
}

void DeviceBridge::end() {
    for (DevicePort& port : ports_) port.end();
}

bool DeviceBridge::busy() {
    return std::any_of(ports_.begin(), ports_.end(), [](DevicePort& port) { return port.busy(); });
}

void DeviceBridge::closeAll() {
    for (DevicePort& port : ports_) port.closeAll();
}

}  // namespace ispace::wire
