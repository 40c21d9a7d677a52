// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ispace {

/// A file of the page that --web serves; it is part of the program.
struct WebFile {
    std::string_view path;  ///< in a request, e.g. "/map.js"
    std::string_view type;  ///< MIME type
    std::string_view bytes;
};

/// Null if there is none of that path.
const WebFile* webFile(std::string_view path);

/// Who may ask a web server on this machine.
///
/// A page of a stranger can make a browser connect to 127.0.0.1, by its number or by a name that a
/// stranger's DNS server suddenly gives that address (DNS rebinding). Both show: in the header
/// Origin, which browsers set whenever they open a WebSocket, and in Host.
class WebOrigin {
  public:
    /// \param address as a URL has it: an IPv6 one in brackets
    WebOrigin(const std::string& address, std::uint16_t port);

    /// True if a request of this header Host is meant for this server.
    [[nodiscard]] bool isHost(std::string_view host) const;
    /// True if a WebSocket may be opened for a page of this origin. Programs that are no browser
    /// have none.
    [[nodiscard]] bool mayConnect(std::string_view origin) const;

  private:
    std::vector<std::string> hosts_;
};

/// The Content-Security-Policy of all that such a server sends: scripts, styles and connections of
/// its own, nothing else, and never within another page. \pre the host was accepted
std::string contentPolicy(std::string_view host);

}  // namespace ispace
