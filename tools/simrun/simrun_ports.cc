// SPDX-License-Identifier: GPL-3.0-or-later
#include "simrun/simrun_ports.h"

#include <csignal>
#include <cstdint>
#include <utility>

#include "base/file.h"
#include "base/json_writer.h"
#include "cli/common_options.h"
#include "extensions.h"

namespace ispace {

void servePorts(Server& server, Simulation& simulation, const SimrunOptions& options,
                const std::string& title, std::vector<std::string> replayed) {
    for (const std::string& note : server.serveRoles(extensions().roles()))
        report(options.common, "simrun", note);
    options.bridges->open(server, simulation,
                          {options.common, title, std::move(replayed), options.max_recorded});
}

void reportLosses(const Server& server, const SimrunOptions& options) {
    const ReaderLosses losses = server.readerLosses();
    std::string what;
    if (losses.readings > 0) what = std::to_string(losses.readings) + " readings of streams";
    if (losses.messages > 0)
        what +=
            (what.empty() ? "" : " and ") + std::to_string(losses.messages) + " messages of topics";
    if (what.empty()) return;
    const bool may_wait =
        options.clock.kind != Clock::Kind::Real && !options.limits.waits_for_readers;
    report(options.common, "simrun",
           "slow readers lost " + what + (may_wait ? " (--wait-for-readers keeps them)" : ""));
}

void announce(const Server& server, const SimrunOptions& options) {
    JsonWriter json;
    json.beginObject().key("schema").value("ispace-simrun/1");
    json.key("listen").value(server.address());
    options.bridges->announce(json);
    json.endObject();
    writeAll("-", json.take() + '\n');
    // Clients stay connected when the reader of the warnings has gone.
    std::signal(SIGPIPE, SIG_IGN);
}

}  // namespace ispace
