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
ServerLimits withinFileLimit(ServerLimits limits) {
    constexpr rlim_t kOwn = 32;
    rlimit files{};
    if (::getrlimit(RLIMIT_NOFILE, &files) != 0) return limits;
    files.rlim_cur = files.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &files);
    const rlim_t most = files.rlim_cur > kOwn ? files.rlim_cur - kOwn : 1;
    limits.clients = static_cast<std::size_t>(std::min<rlim_t>(limits.clients, most));
    return limits;
}

}  // namespace

ServerLimits limitsOf(const SimrunOptions& options, const SceneInput& input) {
    ServerLimits limits = withinFileLimit(options.limits);
    if (!options.token_file.empty()) {
        limits.token = readToken(options.token_file);
        if (isOpenToOthers(options.token_file))
            warn(options.common, "simrun",
                 options.token_file + " can be read by other users: chmod 600 makes it yours");
    }
    const std::string& folder = options.load_folder;
    limits.source = std::make_shared<SceneFolder>(folder.empty() ? SceneFolder::of(input) : folder,
                                                  options.any_environment);
    return limits;
}

void announce(const Server& server, const std::string& web) {
    JsonWriter json;
    json.beginObject().key("schema").value("ispace-simrun/1");
    json.key("listen").value(server.address());
    json.key("p2os").beginObject().endObject();
    json.key("scip").beginObject().endObject();
    if (!web.empty()) json.key("web").value(web);
    json.endObject();
    writeAll("-", json.take() + '\n');
    // Clients are not cut off because nobody reads the warnings any more.
    std::signal(SIGPIPE, SIG_IGN);
}

}  // namespace ispace
