// SPDX-License-Identifier: GPL-3.0-or-later
#include "simrun/simrun_record.h"

#include <algorithm>

#include "base/error.h"
#include "base/message.h"
#include "simrun/simrun_options.h"

namespace ispace {

namespace {

/// Parses `x,y,heading_deg,stall`. \throws UsageError
std::vector<std::string> columnsIn(const std::string& text) {
    std::vector<std::string> columns, known = optionalColumns();
    known.insert(known.end(), {"t", "id", "x", "y", "heading_deg"});
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::string name = text.substr(begin, end - begin);
        if (std::find(known.begin(), known.end(), name) == known.end())
            throw UsageError(excerpt(name) + " is no column of robots.csv or people.csv" +
                             didYouMean(name, known));
        columns.push_back(name);
        begin = end + 1;
    }
    return columns;
}

}  // namespace

void addRecordForm(CommandLine& line, RecordForm& form) {
    line.parsed(
        "--record-every", "TIME",
        [&form](const std::string& text) {
            form.every = timeOption(text, SimTime(1), World::kMaxStep);
        },
        "record the poses of robots and people so often in simulated time, e.g. 0.1s: a whole "
        "number of steps (default: each step)",
        Enters::Nothing);
    std::string names;
    for (const std::string& name : optionalColumns()) names += (names.empty() ? "" : ", ") + name;
    line.parsed(
        "--record-columns", "LIST",
        [&form](const std::string& text) { form.columns = columnsIn(text); },
        "columns of robots.csv and people.csv, with commas: some of x, y, heading_deg, which are "
        "always there, as t and id are, " +
            names + " (default: all)",
        Enters::Nothing);
    line.parsed(
        "--record-compression", "none|zstd",
        [&form](const std::string& text) {
            if (text != "none" && text != "zstd")
                throw UsageError(excerpt(text) + " is not one of none|zstd");
            form.packs = text == "zstd";
        },
        "compress the tables of steps and the readings into robots.csv.zst and the like (default "
        "none)",
        Enters::Nothing);
}

}  // namespace ispace
