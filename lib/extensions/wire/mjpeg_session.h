// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of cameras over HTTP, as network cameras serve them: MJPEG (multipart/x-mixed-replace,
// RFC 2046 with the replacement of Netscape) at /, /stream, /stream.mjpg and /video, single
// pictures at /snapshot with any suffix and /?action=snapshot. A Host that is neither an address
// nor a name without a dot is refused, against DNS rebinding. Slow readers skip pictures, never
// parts of one.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "extensions/wire/wire_session.h"

namespace ispace::wire {

/// A parsed HTTP request for a picture.
struct PictureRequest {
    enum class Kind { Stream, Snapshot } kind = Kind::Stream;
    bool head = false;  ///< the headers alone
    int refusal = 0;    ///< status of an answer without a picture, or 0
};

/// Parses the head of an HTTP request, without its empty line.
PictureRequest parsePictureRequest(std::string_view head);

/// An HTTP connection to a camera or a ranger: a stream of pictures in the format of network
/// cameras (multipart/x-mixed-replace), or a single picture. One request per connection. Slow
/// readers skip whole pictures.
class MjpegSession : public WireSession {
  public:
    static constexpr std::size_t kMaxHead = 8192;

    /// \pre the sensor exists
    MjpegSession(WireHost& host, std::string sensor);

    void receive(std::string_view bytes) override;
    void stepped(std::size_t unsent) override;
    /// Pictures continue after the client has closed its sending side.
    void ended() override;
    [[nodiscard]] bool isEngaged() const override { return request_.has_value(); }

  private:
    void answer(const PictureRequest& request);
    void refuse(int status, std::string_view reason);
    /// Sends the newest picture unless it was sent last.
    void show();

    WireHost* host_;
    std::string id_;
    std::string head_;
    std::optional<PictureRequest> request_;
    std::shared_ptr<const PictureFiles::PendingPicture> coming_;  // requested picture
    std::shared_ptr<const PictureFile> sent_;                     // picture sent last
};

/// The row of `--mjpeg`.
extern const WireProtocol kMjpeg;

}  // namespace ispace::wire
