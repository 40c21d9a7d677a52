// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace ispace {

/// Turns TERM and INT into a request to end. While it lives neither ends the process by itself, but
/// for a second INT; after it both are ignored: what is left to do then is to exit. It needs no
/// thread: whoever works asks whether a signal came. One at a time in a process.
class StopSignals {
  public:
    /// \throws std::system_error
    StopSignals();
    ~StopSignals();
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;

    /// The number of the last signal that came, 0 if none did. From any thread.
    [[nodiscard]] int signal() const;
    /// A descriptor that can be read once a signal came, for who waits; it is not to be read.
    [[nodiscard]] int descriptor() const { return descriptor_; }

  private:
    int descriptor_ = -1;
};

}  // namespace ispace
