// SPDX-License-Identifier: GPL-3.0-or-later
// The main function of all tools, alone or as a server of jobs.
//
//     return runTool("coverage", argc, argv, [](int count, char** words) {
//         cover(parseCoverageOptions(count, words));
//     });
#pragma once

#include <functional>
#include <string>

namespace ispace {

/// Runs a tool as runTool() does, with its command line. As `TOOL --serve-jobs` the process reads
/// command lines from stdin instead, and works off each in a copy of itself: ispace-sweep runs
/// thousands of short jobs so, which begin without loading a program. They run in the loop of lists
/// (cli/job_loop.h) and share the rooms that their operands name. A job has its own memory, folder
/// and status, as if it had been started alone, and its output is the same.
///
/// A request is a number and a newline, then that many bytes: the job's folder, its files for
/// stdout and stderr ("" discards) and its words without the tool, each ended by NUL. The answer on
/// stdout, once the job has ended, is its status and a newline: the exit status, or 128 plus the
/// number of the signal that ended it. Ends with stdin; jobs end with it.
///
/// A job is a copy (fork) as long as the server has one thread, else the program begun anew. It is
/// killed if the server ends. A server runs one job at a time; ispace-sweep starts several servers.
///
/// \param body reads the command line and does the work; it throws as bodies of runTool() do
int runTool(const std::string& tool, int argc, char** argv,
            const std::function<void(int, char**)>& body);

}  // namespace ispace
