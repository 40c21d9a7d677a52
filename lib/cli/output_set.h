// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace ispace {

/// Names of files that a run writes many of: `-o` names a folder (one that exists, or with / at its
/// end), or is a pattern with %d or %04d for the frame's number and %s for the sensor's id; %% is a
/// percent sign. In a folder files are called ID-0000. What a
/// file's name should not hold, a / in an id, control characters, a dot or dash at its beginning,
/// is written _.
class OutputSet {
  public:
    /// Nothing if `output` is one file or stdout.
    static std::optional<OutputSet> of(const std::string& output);

    /// Checks that no two files have the same name, and makes the folder.
    /// \param several_frames whether frames must be told apart
    /// \param endings of the files of one reading; all but the first stand beside it
    /// \throws UsageError for a bad pattern, and where files would have one name; std::system_error
    ///         if the folder cannot be made
    void prepare(const std::vector<std::string>& ids, bool several_frames,
                 const std::vector<std::string>& endings) const;
    /// Name of the file of a reading: the suffix of a pattern stands in place of its format's own.
    [[nodiscard]] std::string fileOf(const std::string& id, int frame,
                                     const std::string& ending) const;
    /// Name of a file that stands beside it.
    [[nodiscard]] std::string fileBeside(const std::string& id, int frame,
                                         const std::string& ending) const;

  private:
    [[nodiscard]] std::string stem(const std::string& id, int frame) const;

    std::string folder_;   // "" for a pattern
    std::string pattern_;  // without its suffix; "" for a folder
    std::string suffix_;   // of the pattern, with its dot
};

/// The part of a file's name before its suffix.
std::string withoutSuffix(const std::string& file);

}  // namespace ispace
