// SPDX-License-Identifier: GPL-3.0-or-later
// Rules of a run about files: no output replaces an input, no request reads outside of its folders,
// no signal leaves half a set of files. The guards are global, one at a time per process, and
// thread-safe.
//
//     const FileGuard guard;                   // runTool holds it
//     const std::string room = readAll("room.env");
//     OutputFile file("./room.env");           // UsageError: it is an input
#pragma once

#include <csignal>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

namespace ispace {

/// Prevents a run from overwriting its inputs. While this lives, each regular file read by readAll
/// or InputFile or passed to noteInput is recorded by device and inode, independent of links, and
/// so is each target of OutputFile and claimOutput. If two are the same file, the second is
/// rejected with a UsageError.
///
/// One at a time per process; runTool holds it. It is global on purpose, so that no reader can omit
/// it. Without a FileGuard files are neither recorded nor rejected.
class FileGuard {
  public:
    FileGuard();
    ~FileGuard();
    FileGuard(const FileGuard&) = delete;
    FileGuard& operator=(const FileGuard&) = delete;
};

/// Records a file that is read by other means than readAll and InputFile; call it before opening
/// the file. Streams, devices and missing files are skipped.
/// \throws UsageError if the file is an output
void noteInput(const std::string& name);
/// Records an open file.
void noteInput(int descriptor);

/// Reserves an output early, before work is wasted; "-" and "" are skipped.
/// \param role for messages: `--report`
/// \throws UsageError if it is an input, or the target of another reservation
void claimOutput(const std::string& target, const std::string& role);

/// Records that a reserved output is complete, so that this command may read it.
void completeOutput(const std::string& target);

/// An output being written; OutputFile holds one.
class OpenOutput {
  public:
    /// \param target its final path, with links resolved; "-" is standard output
    /// \param name as the user wrote it
    /// \throws UsageError if it is an input, or another output that is open or was claimed and
    ///         written
    OpenOutput(std::string target, std::string name);
    ~OpenOutput();
    OpenOutput(const OpenOutput&) = delete;
    OpenOutput& operator=(const OpenOutput&) = delete;

    /// Checks again, right before the target is replaced. \throws UsageError
    void check() const;
    /// Records that the target has been replaced.
    void done();

  private:
    std::string target_, name_;
    bool is_kept_ = false;  // by FileGuard
    bool is_done_ = false;
};

/// Resolves a chain of links; the file at its end need not exist. Relative paths stay relative.
/// \throws std::system_error for a circle of links
std::string followLinks(const std::string& target);

/// While this lives, readers of inputs (readAll, InputFile, openRegular, includes) find only
/// regular files in or below these folders, after resolving links, and skip hidden files (`.name`)
/// and hidden folders; other files appear missing.
///
/// One at a time per process. It is global on purpose, as FileGuard is, so that no reader can omit
/// it.
class InputSandbox {
  public:
    /// \throws std::system_error if a folder is missing
    explicit InputSandbox(const std::vector<std::string>& folders);
    ~InputSandbox();
    InputSandbox(const InputSandbox&) = delete;
    InputSandbox& operator=(const InputSandbox&) = delete;
};

/// True if no InputSandbox forbids reading this file; call it before opening the file.
bool mayBeRead(const std::string& name);
/// \throws std::system_error, as for a missing file, if it may not be read
void mustBeReadable(const std::string& name);

/// True if the file lies in or below the folder. \pre both are canonical
bool liesIn(const std::filesystem::path& folder, const std::filesystem::path& file);

/// True if `name`, after resolving links, is a regular file in or below this folder and no part of
/// the path below the folder is hidden.
bool liesOpenlyIn(const std::string& folder, const std::string& name);

/// Delays TERM, INT and HUP in all threads while this lives: for the few system calls between which
/// a process must not end. Handlers then receive their signals; ignored signals stay ignored. One
/// lives at a time; others wait.
class DeferredSignals {
  public:
    DeferredSignals();
    ~DeferredSignals();
    DeferredSignals(const DeferredSignals&) = delete;
    DeferredSignals& operator=(const DeferredSignals&) = delete;

  private:
    static constexpr int kSignals[] = {SIGTERM, SIGINT, SIGHUP};

    std::lock_guard<std::mutex> one_at_a_time_;
    struct sigaction before_[std::size(kSignals)] = {};
};

}  // namespace ispace
