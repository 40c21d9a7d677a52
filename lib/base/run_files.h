// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace ispace {

/// Keeps a run from overwriting its inputs. While this lives, every regular file that readAll,
/// InputFile or noteInput meet is known by device and inode, whatever links lead to it, and so is
/// every target of OutputFile and claimOutput. If two are the same file, the second is refused with
/// a UsageError.
///
/// One at a time per process; runTool holds it. It is global on purpose, so that no reader can
/// forget it. Without one nothing is recorded and nothing refused.
class RunFiles {
  public:
    RunFiles();
    ~RunFiles();
    RunFiles(const RunFiles&) = delete;
    RunFiles& operator=(const RunFiles&) = delete;
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
    bool is_kept_ = false;  // by RunFiles
    bool is_done_ = false;
};

/// The file at the end of a chain of links; it need not exist. Relative paths stay relative.
/// \throws std::system_error for a circle of links
std::string followLinks(const std::string& target);

}  // namespace ispace
