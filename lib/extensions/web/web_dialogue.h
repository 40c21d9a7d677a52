// SPDX-License-Identifier: GPL-3.0-or-later
// The interface between a port for WebSockets and the languages spoken there: the page here,
// Foxglove and rosbridge in lib/extensions/ros. A dialogue is the server's side of one client
// without transport; it makes output on request, so that a slow reader costs no memory.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "extensions/web/web_files.h"
#include "sim/simulation.h"

namespace ispace::web {

/// A message of a WebSocket in pieces, so that connections can share the large one.
struct WebMessage {
    std::string head = {};
    std::shared_ptr<const std::string> body = {};  ///< null: empty
    std::string tail = {};
    bool is_text = true;

    [[nodiscard]] std::size_t size() const {
        return head.size() + (body ? body->size() : 0) + tail.size();
    }
};

/// The server's side of one WebSocket, without transport.
class WebDialogue {
  public:
    WebDialogue() = default;
    virtual ~WebDialogue() = default;
    WebDialogue(const WebDialogue&) = delete;
    WebDialogue& operator=(const WebDialogue&) = delete;

    /// Longest message that it reads, in bytes.
    [[nodiscard]] virtual std::size_t longest() const = 0;
    /// Processes a message. \pre hasRoom()
    virtual void receive(std::string_view message, bool is_text) = 0;
    /// False while too much is unanswered or unread: the client's messages have to wait.
    [[nodiscard]] virtual bool hasRoom() const = 0;
    /// Call after each step or change of the world.
    virtual void stepped() = 0;
    /// Continues pending requests between steps.
    virtual void proceed() = 0;
    /// True while a request waits for its answer, and while one waits until the world may change.
    [[nodiscard]] virtual bool waiting() const = 0;
    [[nodiscard]] virtual bool waitsToChange() const = 0;
    /// Returns and removes the next message to send; empty if there is none.
    virtual std::optional<WebMessage> next() = 0;
    /// True if the client leaves more unread than it may: the connection ends at once.
    [[nodiscard]] virtual bool isOverfull() const = 0;
    /// True once the dialogue is over: the connection ends when all output is sent.
    [[nodiscard]] virtual bool closing() const = 0;
    /// True while the client has a role; others leave when newcomers find no room.
    [[nodiscard]] virtual bool isEngaged() const = 0;
    /// True if a client that is not engaged leaves after a minute even if there is room.
    [[nodiscard]] virtual bool expires() const { return false; }
    /// True if the client has asked for the state of the world, see WebSite::look().
    [[nodiscard]] virtual bool wantsFrame() const { return false; }
    /// True if the world waits for this reader on request, see ServerLimits::waits_for_readers.
    [[nodiscard]] virtual bool isAwaited() const { return false; }
    /// Replaces pending output by the reason of the end: the client was idle.
    virtual void dismiss() = 0;
    /// Ends pending requests at the end of the run.
    virtual void finish() = 0;
};

/// A request to open a WebSocket. Its texts belong to the connection.
struct WebRequest {
    std::string_view target, origin;
    std::string_view protocols;  ///< the client offers these, separated by commas
    std::string_view peer = {};  ///< address of the client
};

/// The answer to a WebRequest.
struct WebAdmission {
    std::unique_ptr<WebDialogue> dialogue = {};  ///< null: rejected
    std::string_view protocol = {};              ///< the chosen one, "" without
    unsigned status = 0;                         ///< of a rejection: 401, 403, 404, 429
    std::string_view why = {};                   ///< valid for the whole run
};

/// The content of a port: files and dialogues.
class WebSite {
  public:
    WebSite() = default;
    virtual ~WebSite() = default;
    WebSite(const WebSite&) = delete;
    WebSite& operator=(const WebSite&) = delete;

    /// Call once, before all else, with the address where the port is, IPv6 in brackets.
    virtual void settle(const std::string& host, std::uint16_t port) = 0;
    /// True if a request may have this Host header.
    [[nodiscard]] virtual bool isHost(std::string_view host) const = 0;
    /// Returns the file at a path; null if there is none.
    [[nodiscard]] virtual const WebFile* file(std::string_view /*path*/) const { return nullptr; }
    /// Opens a dialogue, or rejects the request: an unknown path, origin or token, or too many.
    virtual WebAdmission open(const WebRequest& request) = 0;
    /// Call after each step or change of the world, before the dialogues.
    virtual void stepped() {}
    /// Updates the state of the world that clients wait for. \returns the time of the next call
    virtual WallTime look(WallTime now) { return now; }
    /// Call before the end of the run: look() at the last state.
    virtual void lookAtEnd() {}
};

}  // namespace ispace::web
