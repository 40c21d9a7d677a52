// SPDX-License-Identifier: GPL-3.0-or-later
// What a folder of lib/extensions draws of a recorded run: options of simrun, and the picture that
// `--replay DIR -o FILE` writes. See cli/extension.h.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command_line.h"
#include "cli/common_options.h"
#include "scene/scene.h"
#include "sim/sim_time.h"

namespace ispace {

/// A run to be drawn.
struct DrawnRun {
    const Scene& scene;            ///< at the start of the run
    const std::string& record;     ///< its folder
    const std::string& title;      ///< "" for none
    SimTime from{};                ///< of a film
    std::optional<SimTime> until;  ///< empty: to the end of the record
    const CommonOptions& common;   ///< with the name of the product
};

/// Pictures of one extension, and their options: an object is made for each command line.
class DrawingGroup {
  public:
    virtual ~DrawingGroup() = default;
    /// Declares the options, bound to members. The group begins with line.group(HEADING).
    virtual void declare(CommandLine& line) = 0;
    /// Checks the options with the name of the product; opens no file. \throws UsageError
    virtual void take(const CommandLine& line, const std::string& output) = 0;
    /// Writes the product. \returns the number of pictures \throws UsageError for a film that
    /// begins after the record
    [[nodiscard]] virtual std::int64_t draw(const DrawnRun& run) const = 0;
};

/// A row of Extensions, see cli/extensions.h.
struct DrawingRow {
    std::string_view extension;
    std::unique_ptr<DrawingGroup> (*make)();  ///< null for one that this build lacks
    std::string_view missing = {};            ///< its product ("run")
};

/// The group that draws for one command line: that of the first extension with one.
class DrawingExtensions {
  public:
    explicit DrawingExtensions(std::span<const DrawingRow> rows);
    void declare(CommandLine& line);
    /// Returns the names of the options ("--width").
    [[nodiscard]] const std::vector<std::string>& options() const { return options_; }
    /// Returns the group with checked options. \throws UsageError as DrawingGroup::take(), and in a
    /// build that draws no record, with the extension that it lacks
    [[nodiscard]] std::shared_ptr<const DrawingGroup> take(const CommandLine& line,
                                                           const std::string& output) const;

  private:
    std::string extension_;
    std::shared_ptr<DrawingGroup> group_;  // null: this build has none
    std::vector<std::string> options_;
};

}  // namespace ispace
