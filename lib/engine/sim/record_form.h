// SPDX-License-Identifier: GPL-3.0-or-later
// Which moments and columns of a run are recorded, and whether the files are compressed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/sim_time.h"

namespace ispace {

/// Moments and columns of a record, and its compression. The defaults record everything, plain.
struct RecordForm {
    /// Time from one moment in robots.csv, people.csv and odometry.csv to the next: a multiple of
    /// the step. 0: each step.
    SimTime every{};
    /// Columns of robots.csv and people.csv besides t,id,x,y,heading_deg; empty optional: all.
    std::optional<std::vector<std::string>> columns = {};
    /// Compresses robots.csv, people.csv, odometry.csv, sonars.csv and scans.jsonl by zstd, into
    /// files whose names end in .zst.
    bool packs = false;

    /// Returns the steps from one recorded moment to the next. \throws UsageError if `every` is no
    /// whole number of steps
    [[nodiscard]] std::int64_t stride(SimTime step) const;
};

/// Returns the columns that RecordForm::columns may name.
const std::vector<std::string>& optionalColumns();

/// The columns of a table that a record holds.
struct TableColumns {
    /// \param whole the header with all columns, which begins with t,id
    TableColumns(std::string_view whole, const RecordForm& form);
    std::string head;
    /// Bit i: the i-th column after t,id is held.
    std::uint32_t kept = ~std::uint32_t{0};
};

}  // namespace ispace
