// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/extensions/passages: lifts.csv of a recorded run.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "extensions/passages/lift.h"
#include "scene/run/run_changes.h"
#include "sim/record_files.h"
#include "sim/sim_time.h"

namespace ispace::passages {

/// The words for a lift in lifts.csv.
struct LiftNames {
    std::string id;                    ///< "": stairs, which are not recorded
    std::vector<std::string> storeys;  ///< by stop
};

/// Writes lifts.csv: t,id,phase,storey,to,calls. Each lift begins at its lowest stop, waiting; it
/// has a row for each later phase, at the time at which that begins, and for each change of its
/// calls. Calls are storeys, with semicolons; `to` is empty unless it rides. A phase that a restart
/// interrupts and that begins again at once has a row of waiting before.
class LiftRecorder {
  public:
    /// \throws as LineFile
    LiftRecorder(std::string file, std::vector<LiftNames> names);
    /// Writes rows of the lifts that have changed. \throws std::system_error
    void record(SimTime time, const std::vector<Lift>& lifts);

  private:
    void write(SimTime time, std::size_t lift, const Lift::State& state);

    LineFile file_;
    std::vector<LiftNames> names_;
    std::vector<Lift::State> written_;
};

/// Reads lifts.csv in constant memory, row by row.
class LiftReader {
  public:
    /// \throws FormatError for other columns, std::system_error
    LiftReader(std::string file, std::vector<LiftNames> names);
    /// Returns the states after the last step that ends at this time or before. Restarts the file
    /// for an earlier time than before. Skips lifts that are not among the names.
    /// \throws FormatError with the line: times that decrease, unknown phases and storeys
    const std::vector<Lift::State>& at(SimTime time);

  private:
    void open();
    void readRow();
    [[nodiscard]] std::size_t stopOf(std::size_t lift, std::string_view storey) const;
    [[noreturn]] void fail(const std::string& text) const;

    std::string file_;
    std::vector<LiftNames> names_;
    LineSource lines_;
    std::vector<Lift::State> states_;
    SimTime time_{}, row_time_{};
    std::optional<std::pair<std::size_t, Lift::State>> row_;  // read ahead; since: not set
};

}  // namespace ispace::passages
