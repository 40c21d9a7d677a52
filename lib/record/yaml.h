// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "record/record.h"

namespace ispace {

/// Reads the records of an environment from YAML.
///
/// The top is a list of records, or a map from keywords to a record or a list of records, or a
/// map with such a list under `records`; these forms may be mixed and file order counts. In a
/// list a record is a map with one keyword (`- desk: {at: [2, 3], heading: 30}`). A value is a
/// scalar in the language of `.env` (`1.5`, `30deg`, `"0,0;8,0"`, `yes`), a list of numbers for a
/// tuple, or a list of lists for a list of tuples. History is taken from the comment lines that
/// follow a first line `# ispace yaml 1`.
/// \throws FormatError with file:line:column and hints, several at once; also for anchors that
///         add more than a million nodes, more than 64 lists and maps in each other, tabs as
///         indentation, doubled keys, null values, tags of one's own, NaN, and a second document
Document readYaml(std::string_view bytes, const std::string& name, const Schemas& schemas);

}  // namespace ispace
