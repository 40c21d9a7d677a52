// SPDX-License-Identifier: GPL-3.0-or-later
// A laser's CoLa: whatever comes, in whatever pieces, is answered by the same telegrams.
#include "extensions/wire/cola.h"
#include "fuzz.h"
#include "wire_host.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    static RoomHost host("laser id=l1 at=0,0 fov=270 step=0.5 range=20 rate=50\n");
    const std::size_t piece = takePieceSize(bytes);
    wire::ColaSession whole(host, "l1"), cut(host, "l1");
    const std::string wanted = answered(whole, bytes, std::string_view::npos);
    require(answered(cut, bytes, piece) == wanted, "other answers to pieces");
    if (whole.closing()) return;
    constexpr int kSteps = 3;
    for (int i = 0; i < kSteps; ++i) {
        host.world().step();
        whole.stepped(0);
        cut.stepped(0);
        require(cut.take() == whole.take(), "another scan after pieces");
    }
}
