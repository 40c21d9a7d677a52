// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace ispace {

/// Keeps files of lines whole when this process is killed: a write that SIGKILL cuts short leaves a
/// piece of a line, which nobody in the process can take back.
///
/// A process of its own (in a session of its own, so that signals to a group or a terminal pass it
/// by) waits for the end of this one and then cuts each file behind its last newline. Files that
/// end with one stay as they are. It dies with this process when everything of a batch job is
/// killed at once.
class LineGuard {
  public:
    /// Regular files that exist; others (devices, pipes) are left out. `lock`: a descriptor to be
    /// kept until they are looked after, or -1: what locks the files. \throws std::system_error if
    /// there can be no other process
    explicit LineGuard(const std::vector<std::string>& files, int lock = -1);
    /// Waits until the files are looked after.
    ~LineGuard();
    LineGuard(const LineGuard&) = delete;
    LineGuard& operator=(const LineGuard&) = delete;

  private:
    int life_ = -1;  // open while this process lives
    pid_t guard_ = -1;
};

}  // namespace ispace
