// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/net.
#pragma once

#include <algorithm>
#include <optional>

#include "sim/simulation.h"

namespace ispace {

/// When clients that hold no place by what they do have to go, for all listeners: those without a
/// role, and programs that let a device send nothing. See ServerLimits::roleless.
///
/// Of connections with `std::optional<WallTime> idleSince() const`, nothing for those that are not
/// idle, the one that has been idle longest, if that is so since then; else the end.
template <typename Connections>
auto longestIdle(const Connections& connections, WallTime since) {
    const auto time = [](const auto& connection) {
        return connection->idleSince().value_or(WallTime::max());
    };
    const auto found =
        std::min_element(connections.begin(), connections.end(),
                         [&](const auto& a, const auto& b) { return time(a) < time(b); });
    return found != connections.end() && time(*found) <= since ? found : connections.end();
}

}  // namespace ispace
