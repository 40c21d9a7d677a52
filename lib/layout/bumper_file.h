// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/layout: a table of a record that has a row whenever something changes.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "layout/run_reader.h"
#include "layout/table_lines.h"

namespace ispace {

/// What robots' bumpers felt in a run, t,id,hit, where hit is 0 or 1 of each, with semicolons.
class BumperFile {
  public:
    /// \throws FormatError for other columns, and as read()
    BumperFile(std::string name, LineSource lines);
    /// Appends the rows up to a time that were not read yet. \throws FormatError with the line
    void read(double time, std::vector<RunBumpers>& bumpers);

  private:
    void readLine();
    [[noreturn]] void fail(const std::string& what) const;

    std::string name_;
    LineSource lines_;
    std::vector<std::string_view> fields_;
    double time_ = 0;                // of the row
    std::optional<RunBumpers> row_;  // read ahead
};

}  // namespace ispace
