// SPDX-License-Identifier: GPL-3.0-or-later
#include "simrun/serving.h"

#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <memory>

#include "base/file.h"
#include "base/json_writer.h"
#include "cli/scene_folder.h"
#include "net/token.h"

namespace ispace {

namespace {

/// A client takes a file descriptor: as many as this process may have, less what it needs itself.
ServerLimits withinFileLimit(ServerLimits limits, std::size_t of_devices) {
    const rlim_t own = 32 + of_devices;
    rlimit files{};
    if (::getrlimit(RLIMIT_NOFILE, &files) != 0) return limits;
    files.rlim_cur = files.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &files);
    const rlim_t most = files.rlim_cur > own ? files.rlim_cur - own : 1;
    limits.clients = static_cast<std::size_t>(std::min<rlim_t>(limits.clients, most));
    return limits;
}

}  // namespace

ServerLimits limitsOf(const SimrunOptions& options, const SceneInput& input) {
    ServerLimits limits = withinFileLimit(options.limits, options.devices.connections());
    if (!options.token_file.empty()) {
        limits.token = readToken(options.token_file);
        if (isOpenToOthers(options.token_file))
            warn(options.common, "simrun",
                 options.token_file + " can be read by other users: chmod 600 makes it yours");
    }
    const std::string& folder = options.load_folder;
    limits.source = std::make_shared<SceneFolder>(folder.empty() ? SceneFolder::of(input) : folder,
                                                  options.rules);
    return limits;
}

void announce(const Server& server, const std::string& web, const DeviceAddresses& devices) {
    JsonWriter json;
    json.beginObject().key("schema").value("ispace-simrun/1");
    json.key("listen").value(server.address());
    for (const WireProtocol* const protocol : wireProtocols()) {
        const auto found = devices.find(protocol);
        const bool is_used = found != devices.end();
        // The first two are there in any case; those that came later would surprise old readers.
        if (!is_used && protocol->name != "p2os" && protocol->name != "scip") continue;
        json.key(std::string(protocol->name)).beginObject();
        if (is_used)
            for (const auto& [id, address] : found->second) json.key(id).value(address);
        json.endObject();
    }
    if (!web.empty()) json.key("web").value(web);
    json.endObject();
    writeAll("-", json.take() + '\n');
    // Clients are not cut off because nobody reads the warnings any more.
    std::signal(SIGPIPE, SIG_IGN);
}

}  // namespace ispace
