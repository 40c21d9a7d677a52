// SPDX-License-Identifier: GPL-3.0-or-later
// Products of a tool: large ones, sets of files, and rules for make. A tool claims all of them
// before its work, so that a product that would overwrite an input, or another product, is an error
// before an hour of computing, not after it.
//
//     claimOutputs(options.common);                // before any work
//     FileStream product(options.common.output);
//     writeRows(product.stream());
//     product.commit();                            // until here an old file stays
//     writeDependencies(options.common, sources);  // -MD
#pragma once

#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "base/file.h"
#include "cli/common_options.h"

namespace ispace {

/// A stream into an OutputFile, for products that are too large for memory; buffers 1 MiB. Failed
/// writes throw from the operation that flushes them. Without commit() the target stays as it was.
class FileStream : private std::streambuf {
  public:
    /// \throws std::system_error if the file cannot be created there
    explicit FileStream(const std::string& target);

    [[nodiscard]] std::ostream& stream() { return stream_; }
    /// Writes the rest and renames the file to its target. \throws std::system_error naming the
    /// target, a full disk included, whenever it happened
    void commit();

  private:
    int overflow(int c) override;
    int sync() override;

    OutputFile file_;
    std::string buffer_;
    std::ostream stream_;
};

/// Returns a rule for make: `target` depends on `sources`, each named once, in their order, without
/// streams. Each source is also a target without recipe, so that make continues if a file that is
/// no longer used was deleted. Special characters are escaped for make. \throws UsageError for
/// names that make cannot read: with = ; control characters, two %, ~ at the beginning, or a blank,
/// backslash or ) at the end. Quoting follows GNU make, which differs for targets and
/// prerequisites.
std::string dependencyRule(const std::string& target, std::span<const std::string> sources);

/// Validates -MD and -MF against -o. \throws UsageError for -MF alone and without a product's name
void checkDependencies(const DependencyOptions& options, const std::string& output);

/// Claims the product and its rule, see claimOutput(); a tool calls it first.
void claimOutputs(const CommonOptions& options);

/// Writes the rule of -o on request. \param files all sources of the product
void writeDependencies(const CommonOptions& options, std::span<const std::string> files);

/// Names of the files of a run that writes many: `-o` names a folder (one that exists, or with / at
/// its end), or is a pattern with %d or %04d for the frame's number and %s for the sensor's id; %%
/// is a percent sign. In a folder files are called ID-0000. Characters unfit for names, as / in an
/// id, control characters and a leading dot or dash, become _.
class OutputSet {
  public:
    /// Returns nullopt if `output` is one file or stdout.
    static std::optional<OutputSet> of(const std::string& output);

    /// Rejects equal file names, and creates the folder; for a pattern, those of the first frame.
    /// \param several_frames names must differ by frame
    /// \param endings of the files of one reading; all but the first accompany it
    /// \throws UsageError for a bad pattern, and for equal names; std::system_error if the folder
    /// cannot be created
    void prepare(const std::vector<std::string>& ids, bool several_frames,
                 const std::vector<std::string>& endings) const;
    /// Returns the file name of a reading: the suffix of a pattern replaces that of the format.
    [[nodiscard]] std::string fileOf(const std::string& id, int frame,
                                     const std::string& ending) const;
    /// Returns the name of an accompanying file.
    [[nodiscard]] std::string fileBeside(const std::string& id, int frame,
                                         const std::string& ending) const;

  private:
    [[nodiscard]] std::string stem(const std::string& id, int frame) const;

    std::string folder_;   // "" for a pattern
    std::string pattern_;  // without its suffix; "" for a folder
    std::string suffix_;   // of the pattern, with its dot
};

/// Returns true for "-" and the other names of standard output.
bool isStdout(const std::string& output);
/// Returns true for "-" and for other names of streams: /dev/stdin, <(…), a named pipe.
bool isStream(const std::string& operand);

/// Returns the part of a file's name before its suffix.
std::string withoutSuffix(const std::string& file);

}  // namespace ispace
