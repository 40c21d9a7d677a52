// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace ispace {

/// What a run reads and writes, so that no output replaces an input: while this lives, every
/// regular file that readAll, InputFile or noteInput meet is known by device and inode, whatever
/// link it goes by, and so is every target of OutputFile and claimOutput. The second of two that
/// are the same file is refused by a UsageError.
///
/// One at a time in a process; runTool has it. It is global on purpose: a reader that had to be
/// handed it could do without. Without one nothing is kept and nothing refused.
class RunFiles {
  public:
    RunFiles();
    ~RunFiles();
    RunFiles(const RunFiles&) = delete;
    RunFiles& operator=(const RunFiles&) = delete;
};

/// Tells of a file that is read by other means than readAll and InputFile: call it before the
/// file is opened. Streams, devices and what is not there do not count.
/// \throws UsageError if an output goes there
void noteInput(const std::string& name);
/// The same of a file that is open.
void noteInput(int descriptor);

/// Tells early of an output, before work is spent on what it cannot hold; "-" and "" do not count.
/// \param role for messages: `--report`
/// \throws UsageError if it is an input, or the target of another claim
void claimOutput(const std::string& target, const std::string& role);

/// An output that is being written; OutputFile has one.
class OpenOutput {
  public:
    /// \param target where the file is going to be, its links resolved; "-" is standard output
    /// \param name as the user wrote it
    /// \throws UsageError if it is an input, or another output that is open or was claimed and
    ///         written
    OpenOutput(std::string target, std::string name);
    ~OpenOutput();
    OpenOutput(const OpenOutput&) = delete;
    OpenOutput& operator=(const OpenOutput&) = delete;

    /// Looks again, right before the target is replaced. \throws UsageError
    void check() const;
    /// It is in its place: what it replaced is no output any more.
    void done();

  private:
    std::string target_, name_;
    bool is_kept_ = false;  // by RunFiles
    bool is_done_ = false;
};

/// The file that a chain of links names, which need not exist. Keeps relative paths relative.
/// \throws std::system_error for a circle of links
std::string followLinks(const std::string& target);

}  // namespace ispace
