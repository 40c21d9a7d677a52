// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <csignal>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

namespace ispace {

/// Keeps a run from overwriting its inputs. While this lives, every regular file that readAll,
/// InputFile or noteInput meet is known by device and inode, whatever links lead to it, and so is
/// every target of OutputFile and claimOutput. If two are the same file, the second is refused with
/// a UsageError.
///
/// One at a time per process; runTool holds it. It is global on purpose, so that no reader can
/// forget it. Without one nothing is recorded and nothing refused.
class FileGuard {
  public:
    FileGuard();
    ~FileGuard();
    FileGuard(const FileGuard&) = delete;
    FileGuard& operator=(const FileGuard&) = delete;
};

/// Records a file that is read by other means than readAll and InputFile; call it before opening
/// the file. Streams, devices and missing files do not count. \throws UsageError if an output goes
/// there
void noteInput(const std::string& name);
/// The same for an open file.
void noteInput(int descriptor);

/// Announces an output early, before work is spent in vain; "-" and "" do not count.
/// \param role for messages: `--report`
/// \throws UsageError if it is an input, or the target of another claim
void claimOutput(const std::string& target, const std::string& role);

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
    /// Says that the file is in its place.
    void done();

  private:
    std::string target_, name_;
    bool is_kept_ = false;  // by FileGuard
    bool is_done_ = false;
};

/// The file at the end of a chain of links; it need not exist. Relative paths stay relative.
/// \throws std::system_error for a circle of links
std::string followLinks(const std::string& target);

/// While this lives, readers of inputs (readAll, InputFile, openRegular, includes) find only
/// regular files in these folders and below, links followed, and none that is hidden (`.name`) or
/// below a hidden folder there; others seem not to exist.
///
/// One at a time per process. It is global on purpose, as FileGuard is, so that no reader can
/// forget it.
class InputSandbox {
  public:
    /// \throws std::system_error if one of the folders is not there
    explicit InputSandbox(const std::vector<std::string>& folders);
    ~InputSandbox();
    InputSandbox(const InputSandbox&) = delete;
    InputSandbox& operator=(const InputSandbox&) = delete;
};

/// True if no fence keeps this file from being read; call it before opening the file.
bool mayBeRead(const std::string& name);
/// \throws std::system_error, as for a missing file, if it may not be read
void mustBeReadable(const std::string& name);

/// True if the file lies in the folder or below. \pre both are canonical
bool liesIn(const std::filesystem::path& folder, const std::filesystem::path& file);

/// True if `name` leads, links followed, to a regular file in this folder or below, and no part of
/// the way below it is hidden.
bool liesOpenlyIn(const std::string& folder, const std::string& name);

/// Delays TERM, INT and HUP, whichever thread they reach, until its end: for the few system calls
/// between which a process must not end. Handlers then get their signals; ignored signals stay
/// ignored. One lives at a time; others wait.
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
