// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "server/device/wire_session.h"

namespace ispace {

/// What a request for a picture asks for.
struct PictureRequest {
    enum class Kind { Stream, Snapshot } kind = Kind::Stream;
    bool head = false;  ///< the headers alone
    int refusal = 0;    ///< status of an answer without a picture, or 0
};

/// Reads the head of an HTTP request, without its empty line.
PictureRequest parsePictureRequest(std::string_view head);

/// An HTTP connection to a camera or a ranger: a stream of pictures as network cameras send it
/// (multipart/x-mixed-replace), or a single one. One request a connection. Who reads slowly misses
/// whole pictures.
class MjpegSession : public WireSession {
  public:
    static constexpr std::size_t kMaxHead = 8192;

    /// \pre the sensor exists
    MjpegSession(WireHost& host, std::string sensor);

    void receive(std::string_view bytes) override;
    void stepped(std::size_t unsent) override;
    /// Pictures go on to who has asked.
    void ended() override;
    [[nodiscard]] bool isEngaged() const override { return request_.has_value(); }

  private:
    void answer(const PictureRequest& request);
    void refuse(int status, std::string_view reason);
    /// Sends the newest picture if it is not the one sent last.
    void show();

    WireHost* host_;
    std::string id_;
    std::string head_;
    std::optional<PictureRequest> request_;
    std::shared_ptr<const PictureFiles::Asked> coming_;  // a picture that is being made
    std::shared_ptr<const PictureFile> sent_;            // the newest one
};

/// The row of `--mjpeg`.
extern const WireProtocol kMjpeg;

}  // namespace ispace
