// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace ispace {

/// Keeps files of lines whole when this process is killed: a write that SIGKILL interrupts leaves
/// part of a line, which this process cannot undo. A second process (in its own session, out of
/// reach of signals to a group or terminal) waits for the end of this one and truncates each file
/// after its last newline. It cannot help if a batch system kills both at once.
class LineGuard {
  public:
    /// Takes existing regular files and ignores others. `lock`: a descriptor that locks the files,
    /// kept open until they are done, or -1. \throws std::system_error if no process can be started
    explicit LineGuard(const std::vector<std::string>& files, int lock = -1);
    /// Waits until the files are done.
    ~LineGuard();
    LineGuard(const LineGuard&) = delete;
    LineGuard& operator=(const LineGuard&) = delete;

  private:
    int life_ = -1;  // open while this process lives
    pid_t guard_ = -1;
};

}  // namespace ispace
