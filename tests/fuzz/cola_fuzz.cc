// SPDX-License-Identifier: GPL-3.0-or-later
// A laser's CoLa: whatever comes, in whatever pieces, is answered by the same telegrams.
#include "fuzz.h"
#include "wire/cola_session.h"
#include "wire_host.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace ispace;
    static fuzz::RoomHost host("laser id=l1 at=0,0 fov=270 step=0.5 range=20 rate=50\n");
    return fuzz::guarded(data, size, [](std::string_view bytes) {
        if (bytes.empty()) return;
        const std::size_t piece = 1 + static_cast<unsigned char>(bytes.front()) % 32;
        bytes.remove_prefix(1);
        ColaSession whole(host, "l1"), cut(host, "l1");
        const std::string wanted = fuzz::answered(whole, bytes, std::string_view::npos);
        fuzz::require(fuzz::answered(cut, bytes, piece) == wanted, "other answers to pieces");
        if (whole.closing()) return;
        constexpr int kSteps = 3;
        for (int i = 0; i < kSteps; ++i) {
            host.world().step();
            whole.stepped(0);
            cut.stepped(0);
            fuzz::require(cut.take() == whole.take(), "another scan after pieces");
        }
    });
}
