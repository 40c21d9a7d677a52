// SPDX-License-Identifier: GPL-3.0-or-later
// Options of the form of a record.
#pragma once

#include "cli/command_line.h"
#include "sim/record_form.h"

namespace ispace {

/// Declares --record-every, --record-columns and --record-compression.
void addRecordForm(CommandLine& line, RecordForm& form);

}  // namespace ispace
