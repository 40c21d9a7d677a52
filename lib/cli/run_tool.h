// SPDX-License-Identifier: GPL-3.0-or-later
// lib/cli: option tables, operands, progress bar, runTool. The only folder that prints. Uses all
// of the library and CLI11.
//
// A program that holds this file's object ends with status 1 and one line, and not by an abort,
// where memory or a thread is refused and nobody can catch an exception: in libraries' threads, in
// functions that must not throw, and before main(). Without such a reason it stays an abort, which
// is a mistake in the program.
#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>

namespace ispace {

/// What `--help` and `--version` ask for: text for stdout, exit status 0.
struct TextRequested {
    std::string text;
};

/// Runs a tool's body, prints what it throws to stderr, one line an error, and returns the exit
/// status: 0 done; 1 bad data or failed I/O; 2 usage; 3 a stated requirement not met. A closed
/// pipe ends the process silently.
int runTool(const std::string& tool, const std::function<void()>& body);

/// Writes the pieces and a newline to stderr. Needs no memory, and waits where stderr is
/// non-blocking. May be called at any time, also before main().
void sayLine(std::initializer_list<std::string_view> pieces) noexcept;

/// What is said where memory ran out, once: libraries may find it out again at the end. Needs none.
void sayMemoryIsOut(std::string_view tool) noexcept;

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
