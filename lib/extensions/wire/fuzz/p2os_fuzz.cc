// SPDX-License-Identifier: GPL-3.0-or-later
// A Pioneer's packets: whatever comes, in whatever pieces, is answered by whole packets.
#include "extensions/wire/p2os_session.h"
#include "fuzz.h"
#include "wire_host.h"

namespace {

using namespace ispace;

void checkWhole(const std::string& out) {
    wire::P2osParser parser;
    parser.append(out);
    std::size_t bytes = 0;
    while (const auto packet = parser.take())
        bytes += wire::p2osBytes(packet->id, packet->data).size();
    fuzz::require(bytes == out.size(), "bytes that are no packet");
}

}  // namespace

void ispace::fuzz::tryInput(std::string_view bytes) {
    const std::size_t piece = takePieceSize(bytes);
    // Where it has gone must not depend on earlier inputs.
    RoomHost host(
        "robot id=r1 at=0,0 sonar=0.1,0,0;0,0.1,90 sonar_range=3 bumpers=-30,30;150,210\n"
        "laser id=l1 on=r1 at=0.1,0,0.3 range=0.02,3\n");
    wire::P2osSession whole(host, "r1"), cut(host, "r1");
    const std::string wanted = answered(whole, bytes, std::string_view::npos);
    checkWhole(wanted);
    require(answered(cut, bytes, piece) == wanted, "other answers to pieces");
    constexpr int kSteps = 5;
    for (int i = 0; i < kSteps && !whole.closing(); ++i) {
        host.world().step();
        whole.stepped(0);
        checkWhole(whole.take());
    }
}
