// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace ispace {

/// Names of files that a run writes many of: `-o` names a folder (one that exists, or with / at its
/// end), or is a pattern with %d or %04d for the frame's number and %s for the sensor's id; %% is a
/// percent sign. In a folder files are called ID-0000.
class OutputSet {
  public:
    /// Nothing if `output` is one file or stdout.
    static std::optional<OutputSet> of(const std::string& output);

    /// Checks that no two files have the same name, and makes the folder.
    /// \param several_frames whether frames must be told apart
    /// \throws UsageError if the pattern does not tell readings apart, FormatError for ids that
    /// make
    ///         no names of files, std::system_error if the folder cannot be made
    void prepare(const std::vector<std::string>& ids, bool several_frames) const;
    /// Name without the ending of its format (".png").
    [[nodiscard]] std::string stem(const std::string& id, int frame) const;

  private:
    std::string folder_;   // "" for a pattern
    std::string pattern_;  // "" for a folder
};

/// The part of a file's name before its suffix.
std::string withoutSuffix(const std::string& file);

}  // namespace ispace
