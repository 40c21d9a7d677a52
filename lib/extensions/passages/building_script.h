// SPDX-License-Identifier: GPL-3.0-or-later
// Scripts of a building's run: those of a room, and trips between storeys.
//
//     BuildingScript script(text, "moves.txt", run);       // throws FormatError with all findings
//     run.simulation().beforeStep([&] { script.give(run); });
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "extensions/passages/building_run.h"
#include "sim/command.h"

namespace ispace::passages {

/// Commands of a script to the robots and people of a building.
///
/// Lines as those of readScript(), with the ids across the building, and besides them
/// `GOTO STOREY/X,Y`, `PATH STOREY/X,Y;…` and `RIDE LIFT STOREY`. A command that cannot be carried
/// out when its time has come is skipped; a mark in the events of the room gives the reason.
class BuildingScript {
  public:
    /// \throws FormatError with all findings (file:line:column)
    BuildingScript(std::string_view text, const std::string& file, const BuildingRun& run);
    /// Gives the commands that are due, before each step.
    void give(BuildingRun& run);

  private:
    struct Line {
        SimTime time{};
        std::string mover;
        Command command;           // unless it is a trip
        TripPlan plan;             // of a trip
        std::string lift, storey;  // of a ride
    };
    static std::string give(const Line& line, BuildingRun& run, std::size_t room);

    std::vector<Line> lines_;
    std::size_t next_ = 0;
};

}  // namespace ispace::passages
