// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "io/import_options.h"
#include "record/record.h"

namespace ispace {

/// How a tool that takes any number of environments and layouts reads them as one.
struct InputRequest {
    std::vector<std::string> inputs;  ///< "-" for stdin
    ImportOptions import;
    std::vector<Record> added;  ///< that edits will add: plans are imported in their light
    bool compiles = true;       ///< a layout's digest must match, unless any_environment
    bool any_environment = false;
    bool may_be_empty = false;  ///< an empty stdin is an environment without records
};

/// All inputs as one document: environments in their order, then layouts, whose records take the
/// place of those with the same id. Layouts alone bring the environment along that they name, if it
/// is to be compiled. Names of files are relative to the current folder; history,
/// notes, warnings and sources are those of all.
/// \throws as parseDocument; FormatError for doubled ids and for a digest that differs
Document readInputs(const InputRequest& request);

/// Makes the names of files in the records, which are relative to `from`, relative to `to`; "" is
/// the current folder. Absolute names stay.
void rebaseFiles(std::vector<Record>& records, const std::string& from, const std::string& to);

}  // namespace ispace
