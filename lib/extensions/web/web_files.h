// SPDX-License-Identifier: GPL-3.0-or-later
// The files of the page, and the origins that may use it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ispace::web {

/// A file of the page that --web serves; embedded in the program.
struct WebFile {
    std::string_view path;  ///< in a request, e.g. "/map.js"
    std::string_view type;  ///< MIME type
    std::string_view bytes;
};

/// Finds a file by path; null if unknown.
const WebFile* webFile(std::string_view path);

/// Checks the origin of requests to a web server on this machine.
///
/// A foreign page can make a browser connect to 127.0.0.1, by its number or by a name that a DNS
/// server suddenly resolves to that address (DNS rebinding). Both are detected: by the header
/// Origin, which browsers send whenever they open a WebSocket, and by Host.
class WebOrigin {
  public:
    /// \param address in the form of a URL: IPv6 in brackets
    WebOrigin(const std::string& address, std::uint16_t port);

    /// True if this Host header names the server.
    [[nodiscard]] bool isHost(std::string_view host) const;
    /// True if a page of this origin may open a WebSocket. Programs other than browsers send no
    /// origin.
    [[nodiscard]] bool mayConnect(std::string_view origin) const;

  private:
    std::vector<std::string> hosts_;
};

/// Returns the Content-Security-Policy of all responses: scripts, styles and connections of this
/// server only, and no embedding in other pages. \pre the host was accepted
std::string contentPolicy(std::string_view host);

}  // namespace ispace::web
