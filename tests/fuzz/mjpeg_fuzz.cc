// SPDX-License-Identifier: GPL-3.0-or-later
// A 3-D ranger read over HTTP: whatever is asked, in whatever pieces, has one answer.
#include <string>

#include "fuzz.h"
#include "wire/mjpeg_session.h"
#include "wire_host.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace ispace;
    static fuzz::RoomHost host("ranger id=d1 at=0,0,1 pixels=8,6 fov=60 range=0.3,7\n");
    return fuzz::guarded(data, size, [](std::string_view bytes) {
        if (bytes.empty()) return;
        const std::size_t piece = 1 + static_cast<unsigned char>(bytes.front()) % 32;
        bytes.remove_prefix(1);
        MjpegSession whole(host, "d1"), cut(host, "d1");
        const std::string wanted = fuzz::answered(whole, bytes, std::string_view::npos);
        fuzz::require(wanted.empty() || wanted.starts_with("HTTP/1.1 "), "no HTTP");
        fuzz::require(fuzz::answered(cut, bytes, piece) == wanted, "other answers to pieces");
        fuzz::require(whole.closing() == cut.closing(), "one is closed");
    });
}
