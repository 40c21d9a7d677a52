// SPDX-License-Identifier: GPL-3.0-or-later
// lifts.csv of a recorded run of a building, read forwards and backwards.
#include <array>
#include <chrono>
#include <string>

#include "extensions/passages/lift_record.h"
#include "fuzz.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    const std::string file = scratchFolder() + "/lifts.csv";
    writeFile(file, std::string(bytes));
    passages::LiftReader reader(
        file, {{"l1", {"ground", "upper"}}, {"", {}}, {"l2", {"upper", "attic"}}});
    constexpr std::array kTimes = {0, 1, 5, 2, 1000};
    for (const int time : kTimes)
        for (const passages::Lift::State& state : reader.at(std::chrono::seconds(time))) {
            require(state.stop < 2 && state.next < 2, "a lift at an unknown stop");
            require(state.since <= std::chrono::seconds(time), "a phase of a later time");
        }
}
