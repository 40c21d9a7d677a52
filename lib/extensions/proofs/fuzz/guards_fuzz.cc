// SPDX-License-Identifier: GPL-3.0-or-later
// Certificates of the fewest guards, as `arrange --verify` reads them. Whatever the weights are, a
// check that does not refuse them proves no more guards than a known cover has.
#include "extensions/proofs/check_guards.h"

#include <vector>

#include "fuzz.h"

namespace {

using namespace ispace;

// Two guards see all of it: one in each arm.
const Region kArms{{{0, 0}, {6, 0}, {6, 6}, {5, 6}, {5, 1}, {1, 1}, {1, 6}, {0, 6}}, {}};
const std::vector<Point2> kGuards = {{0.5, 0.5}, {5.5, 0.5}};

}  // namespace

void ispace::fuzz::tryInput(std::string_view bytes) {
    constexpr double kRounding = 1e-9;
    require(!proofs::isOfGuards(bytes) || bytes.find("guards ") != bytes.npos,
            "no number of guards");
    const proofs::GuardCertificate read = proofs::readGuardCertificate(bytes, "c");
    const std::string text = proofs::certificateText(read, {"arrange"});
    const proofs::GuardCertificate again =
        readBack([&] { return proofs::readGuardCertificate(text, "c"); });
    require(proofs::certificateText(again, {"arrange"}) == text,
            "another certificate after writing it");
    const proofs::GuardCheck check = proofs::checkGuards({&kArms, 1}, kGuards, read, "c");
    require(check.bound <= kGuards.size(), "a bound above a cover");
    require(check.missed < kRounding, "a cover misses floor");
}
