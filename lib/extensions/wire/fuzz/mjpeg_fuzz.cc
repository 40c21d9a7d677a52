// SPDX-License-Identifier: GPL-3.0-or-later
// A 3-D ranger read over HTTP: whatever is asked, in whatever pieces, has one answer.
#include <string>

#include "extensions/wire/mjpeg_session.h"
#include "fuzz.h"
#include "wire_host.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    static RoomHost host("ranger id=d1 at=0,0,1 pixels=8,6 fov=60 range=0.3,7\n");
    const std::size_t piece = takePieceSize(bytes);
    wire::MjpegSession whole(host, "d1"), cut(host, "d1");
    const std::string wanted = answered(whole, bytes, std::string_view::npos);
    require(wanted.empty() || wanted.starts_with("HTTP/1.1 "), "no HTTP");
    require(answered(cut, bytes, piece) == wanted, "other answers to pieces");
    require(whole.closing() == cut.closing(), "one is closed");
}
