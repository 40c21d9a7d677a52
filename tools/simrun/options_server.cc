// SPDX-License-Identifier: GPL-3.0-or-later
// Options about who is served, and what they may do.
#include <chrono>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "simrun/options.h"

namespace ispace {

void SimrunCommand::declareServer() {
    SimrunOptions& o = options_;
    constexpr int kMaxClients = 100'000;
    line_.parsed(
        "--listen", "ADDR:PORT", [&o](const std::string& text) { o.listen = parseEndpoint(text); },
        "where clients connect; port 0 takes any free one (default 127.0.0.1:0)", Enters::Nothing);
    line_.parsed(
        "--web", "ADDR:PORT",
        [&o](const std::string& text) {
            o.web = parseEndpoint(text);
            if (!o.web->is_loopback)
                throw UsageError(excerpt(text) +
                                 ": the page is for browsers of this machine; use 127.0.0.1");
        },
        "show the running world to browsers there; port 0 takes any free one", Enters::Nothing);
    o.devices.declare(line_);
    line_.file("--port-file", "FILE", o.port_file,
               "write the port number there when clients can connect", Enters::Nothing);
    line_.parsed(
        "--max-clients", "N",
        [&o](const std::string& text) {
            const auto count = parseInteger(text);
            if (!count || *count < 1 || *count > kMaxClients)
                throw UsageError(excerpt(text) + " is not a whole number from 1 to " +
                                 std::to_string(kMaxClients));
            o.limits.clients = static_cast<std::size_t>(*count);
        },
        "clients served at once; rejects more (default 256)", Enters::Nothing);
    line_.file("--token-file", "FILE", o.token_file,
               "its first line is the token that clients need to change the world or end the run, "
               "and for any role if they may connect from other machines",
               Enters::Nothing);
    line_.parsed(
        "--watchdog", "TIME",
        [&o](const std::string& text) {
            o.limits.watchdog =
                timeOption(text, std::chrono::milliseconds(1), std::chrono::hours(24));
        },
        "stop the robot or person of a client that is silent for this long (wall time)",
        Enters::Nothing);
    line_.file("--load", "DIR", o.load_folder,
               "folder from which the request LOAD reads (default that of ENV)", Enters::Nothing);
    line_.switchFlag("--changes", "--no-changes", o.changes,
                     "let clients change the world (default)", "reject it", Enters::Nothing);
    line_.switchFlag("--shutdown", "--no-shutdown", o.shutdown,
                     "let the request SHUTDOWN end the run (default)", "reject it",
                     Enters::Nothing);
}

void SimrunCommand::takeServer() {
    SimrunOptions& o = options_;
    o.limits.shutdown = o.shutdown.value_or(true);
    o.limits.changes = o.changes.value_or(true);
    o.limits.token_first = !o.listen.is_loopback;
    o.devices.take(line_, o.limits);
    if (!o.listen.is_loopback && o.token_file.empty())
        throw UsageError("--listen: `" + o.listen.address +
                         "`: other machines are served only with --token-file; or listen on "
                         "127.0.0.1");
}

}  // namespace ispace
