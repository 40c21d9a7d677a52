// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/cli: option tables, operands, progress bar, runTool. The only folder that prints. Uses
// all of the library and CLI11. A program linked with this file ends with status 1 and one line if
// memory or a thread is refused where no exception can be caught: in libraries' threads, in
// noexcept functions, and before main(). Any other std::terminate() remains an abort, a bug.
#pragma once

#include <sys/types.h>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace ispace {

/// Request of `--help` and `--version`: text for stdout, exit status 0.
struct TextRequested {
    std::string text;
};

/// Runs a tool's body, prints its exceptions to stderr, one line per error, and returns the exit
/// status: 0 done; 1 bad data or failed I/O; 2 usage; 3 a stated requirement not met. A closed pipe
/// ends the process silently.
///
///     int main(int argc, char** argv) {
///         return ispace::runTool("scan", [&] { ispace::scan(ispace::parseScan(argc, argv)); });
///     }
///
/// Changes the process: opens closed standard streams on /dev/null so that no file gets their
/// number, restores SIGPIPE and SIGCHLD, turns `ulimit -f` into an error of the write, and lets GMP
/// throw std::bad_alloc. Outputs of the body are guarded against its inputs (FileGuard).
int runTool(const std::string& tool, const std::function<void()>& body);

/// Form of messages on stderr: lines for people, or a line of JSON each (schema ispace-message/1).
enum class MessageForm { Text, Json };

/// Selects the form for the process. Call it before its first message, in one thread.
void selectMessageForm(MessageForm form);

/// Writes a message to stderr as one line: "TOOL: FILE:LINE:COLUMN: error: MESSAGE", or as JSON.
/// \param status the exit status that it leads to; 0: the tool goes on
void writeMessage(std::string_view tool, const Diagnostic& message, int status = 0);

/// Likewise, but lines for people lack the severity: for sentences about the work.
void writeSentence(std::string_view tool, const Diagnostic& sentence);

/// Writes a message of one job of many. A line for people begins with the place of the job; as JSON
/// the message has its own place, or that of the job if it has none.
void writeJobMessage(std::string_view tool, const Diagnostic& job, const Diagnostic& message);

/// Writes lines for people, each of which may begin with "TOOL: "; as JSON each is a note.
void writeLines(std::string_view tool, std::string_view text);

/// Exit status and messages of an exception.
struct ToolFailure {
    int status = 1;
    std::vector<Diagnostic> messages = {};

    /// Returns the messages as text, without the tool's name.
    [[nodiscard]] std::vector<std::string> lines() const;
};

/// Converts the exception being handled, for callers that go on after it. \pre within a handler
ToolFailure currentFailure();

/// Writes the pieces and a newline to stderr, in any form of messages: at once if they have up to
/// 4095 bytes, as lines of several threads or processes need. Requires no memory, and waits if
/// stderr is non-blocking. May be called at any time, also before main().
void writeErrorLine(std::initializer_list<std::string_view> pieces) noexcept;

/// Reports, once, that memory ran out; allocates no memory.
void sayMemoryIsOut(std::string_view tool) noexcept;

/// Turns TERM and INT into requests to stop. While it lives only a second INT ends the process;
/// afterwards both are ignored, since only exiting is left. No thread is involved: workers poll
/// signal(). One at a time in a process. Signals that were ignored, as in background jobs of
/// shells, are heeded as well.
class StopSignals {
  public:
    /// \throws std::system_error
    StopSignals();
    ~StopSignals();
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;

    /// Returns the last signal received, or 0. From any thread.
    [[nodiscard]] int signal() const;
    /// Returns a descriptor that becomes readable with a signal, to wait for; do not read it.
    [[nodiscard]] int descriptor() const { return descriptor_; }

  private:
    int descriptor_ = -1;
};

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
