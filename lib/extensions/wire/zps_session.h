// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of text with positions of ultrasonic tags, as a positioning system would send them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "extensions/wire/wire_session.h"

namespace ispace::wire {

/// Sends positions of ultrasonic tags as lines of text, for programs that read a Furukawa ZPS-3D.
/// Its native format is not public; ispace-wire(7) defines this one. Input is ignored.
class ZpsSession : public WireSession {
  public:
    /// \param sensor a tag, or a receiver for all its tags. \pre it exists
    ZpsSession(WireHost& host, std::string sensor);

    void receive(std::string_view /*bytes*/) override {}
    void stepped(std::size_t unsent) override;
    /// Lines continue after the client has closed its sending side.
    void ended() override {}
    [[nodiscard]] bool isEngaged() const override { return true; }

  private:
    struct Followed {
        std::size_t sensor = 0;
        std::int64_t seq = -1;  // burst sent last
    };
    void follow();

    WireHost* host_;
    std::string id_;
    std::vector<Followed> tags_;
    std::int64_t changes_ = 0;  // change count of the world at the last lookup
};

/// The row of `--zps`.
extern const WireProtocol kZps;

}  // namespace ispace::wire
