// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <thread>

namespace ispace {

/// Turns TERM and INT into a request to end. While it lives neither ends the process by itself, but
/// for a second INT; after it both are ignored: what is left
/// to do then is to exit. One at a time in a process.
class StopSignals {
  public:
    /// `stop` is called from another thread with the signal's number, at each. \throws
    /// std::system_error
    explicit StopSignals(std::function<void(int)> stop);
    ~StopSignals();
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;

  private:
    int read_end_ = -1;
    std::thread listener_;
};

}  // namespace ispace
