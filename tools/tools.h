// SPDX-License-Identifier: GPL-3.0-or-later
// tools: the command lines. Each folder is a tool, which this program runs by its name.
#pragma once

namespace ispace {

// Each runs a tool by the words of its command line, the first of which is its name, and returns
// its exit status, see runTool(). Once in a process, before it has threads.

int runEnvc(int argc, char** argv);
int runArrange(int argc, char** argv);
int runScan(int argc, char** argv);
int runCoverage(int argc, char** argv);
int runSimrun(int argc, char** argv);
int runGoldenDiff(int argc, char** argv);

}  // namespace ispace
