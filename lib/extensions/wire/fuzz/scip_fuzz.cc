// SPDX-License-Identifier: GPL-3.0-or-later
// A laser's SCIP 2.0: whatever comes, in whatever pieces, is answered by whole packets.
#include <algorithm>

#include "extensions/wire/scip.h"
#include "fuzz.h"
#include "wire_host.h"

namespace {

using namespace ispace;

void checkWhole(const std::string& out) {
    fuzz::require(out.empty() || out.ends_with("\n\n"), "half a packet");
}

}  // namespace

void ispace::fuzz::tryInput(std::string_view bytes) {
    static RoomHost host(
        "laser id=l1 at=0,0 first=-119.53125 step=0.3515625 beams=682 range=0.06,4.095\n");
    const std::size_t piece = takePieceSize(bytes);
    wire::ScipSession whole(host, "l1"), cut(host, "l1");
    const std::string wanted = answered(whole, bytes, std::string_view::npos);
    checkWhole(wanted);
    require(answered(cut, bytes, piece) == wanted, "other answers to pieces");
    if (whole.closing()) return;
    constexpr int kSteps = 3;
    for (int i = 0; i < kSteps; ++i) {
        host.world().step();
        whole.stepped(0);
        cut.stepped(0);
        const std::string packet = whole.take();
        checkWhole(packet);
        require(cut.take() == packet, "another scan after pieces");
    }
}
