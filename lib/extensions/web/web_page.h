// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/web: the page that shows and drives a running world.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "extensions/web/web_dialogue.h"
#include "extensions/web/web_files.h"
#include "extensions/web/web_frames.h"
#include "scene/run/run_marks.h"
#include "server/server.h"
#include "server/server_state.h"

namespace ispace::web {

/// Parts of the page that depend on the options of the run.
struct WebPageOptions {
    bool edits = false;               ///< the page offers to change the room
    std::vector<RunMark> marks = {};  ///< on the slider of a replay
    /// Writes the mesh of a room as GLB, in the background; null: the page has no view in 3-D.
    std::function<std::string(const Scene& scene)> mesh = {};
};

/// Serves the running world to browsers at a separate endpoint. Call before Server::run().
/// \param title of the page \returns "http://127.0.0.1:40124/"
/// \throws std::system_error naming the endpoint
std::string serveWeb(Server& server, const Endpoint& endpoint, const std::string& title,
                     const WebPageOptions& options = {});

/// The page that shows a running world: its files, and the dialogues of its WebSockets.
///
/// Each message there holds one or more requests of the Simulator TCP Protocol, answered by a
/// Session, and one addition: FRAME is answered by the next frame, a JSON object, as soon as it is
/// newer than the last one; a new scene is sent before it. ROOM is answered by the mesh of the
/// scene, see WebPageOptions, behind a line, once it is computed. In a run with several worlds,
/// /ws/N is about that of room N.
class WebPage final : public WebSite {
  public:
    /// \param title of the page, e.g. base name of ENV
    WebPage(ServerState& state, const std::string& title, const WebPageOptions& options);

    void settle(const std::string& host, std::uint16_t port) override {
        origin_.emplace(host, port);
    }
    [[nodiscard]] bool isHost(std::string_view host) const override {
        return origin_->isHost(host);
    }
    [[nodiscard]] const WebFile* file(std::string_view path) const override {
        return webFile(path);
    }
    WebAdmission open(const WebRequest& request) override;
    WallTime look(WallTime now) override;
    void lookAtEnd() override;

  private:
    struct Room {
        ServerState* state;
        WebFrames frames;
    };
    std::vector<Room> rooms_;  // at least one
    std::optional<WebOrigin> origin_;
};

}  // namespace ispace::web
