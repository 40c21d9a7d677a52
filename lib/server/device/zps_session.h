// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "server/device/wire_session.h"

namespace ispace {

/// Positions of ultrasonic tags as lines of text, for programs that read those of a Furukawa
/// ZPS-3D. That system's own format is not public: this one is ours, see ispace-wire(7). What a
/// client says is ignored.
class ZpsSession : public WireSession {
  public:
    /// \param sensor a tag, or a receiver: then of all tags. \pre it exists
    ZpsSession(WireHost& host, std::string sensor);

    void receive(std::string_view /*bytes*/) override {}
    void stepped(std::size_t unsent) override;
    /// Lines go on.
    void ended() override {}
    [[nodiscard]] bool isEngaged() const override { return true; }

  private:
    struct Followed {
        std::size_t sensor = 0;
        std::int64_t seq = -1;  // of the burst told last
    };
    void follow();

    WireHost* host_;
    std::string id_;
    std::vector<Followed> tags_;
    std::int64_t changes_ = 0;  // of the world, when they were looked up
};

/// The row of `--zps`.
extern const WireProtocol kZps;

}  // namespace ispace
