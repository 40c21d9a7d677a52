// SPDX-License-Identifier: GPL-3.0-or-later
// --expect and --expect-report of simrun: sentences, files of sentences, and the report.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "cli/run_judge.h"
#include "extensions/expect/expect.h"

namespace ispace::expect {

/// Makes the options --expect and --expect-report of simrun.
std::unique_ptr<JudgeGroup> makeExpectations();

/// Returns the report of a judged run as JSON, schema ispace-expectations/1: each rule with its
/// verdict, and its failures with the states observed then. \param record folder of the run, "" if
/// it was not recorded: else each failure has the command that films it
std::string expectationsJson(std::span<const JudgedExpectation> results, const std::string& record);

/// Likewise as text.
std::string expectationsText(std::span<const JudgedExpectation> results, const std::string& record);

}  // namespace ispace::expect
