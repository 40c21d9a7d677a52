// SPDX-License-Identifier: GPL-3.0-or-later
// Options of `envc` that an importer of an extension reads, and no other. Their values travel in
// ImportOptions::own. See cli/extension.h.
//
//     class PointOptions final : public ImportGroup {
//         void declare(CommandLine& line, ImportOptions& import) override {
//             line.group("ARIA maps");
//             line.flag("--points", import.own.edit<AriaPoints>().are_obstacles, "...",
//                       Enters::History);
//         }
//     };
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command_line.h"
#include "io/importers.h"

namespace ispace {

/// The options of the importers of one extension: an object is made for each command line.
class ImportGroup {
  public:
    virtual ~ImportGroup() = default;
    /// Declares the options, bound to values of `import`, which outlives the line. The group begins
    /// with line.group(HEADING).
    virtual void declare(CommandLine& line, ImportOptions& import) = 0;
    /// Returns what a command that reads the same input again needs, but no history has:
    /// " --models DIR". \param import as parsed
    [[nodiscard]] virtual std::string repeated(const ImportOptions& /*import*/) const { return ""; }
};

/// A row of Extensions, see cli/extensions.h.
struct ImportRow {
    std::string_view extension;
    std::unique_ptr<ImportGroup> (*make)();
};

/// The groups that extensions add to one command line.
class ImportExtensions {
  public:
    /// \param rows in the order of `--help`
    explicit ImportExtensions(std::span<const ImportRow> rows);
    void declare(CommandLine& line, ImportOptions& import) const;
    /// Returns that of all groups.
    [[nodiscard]] std::string repeated(const ImportOptions& import) const;

  private:
    std::span<const ImportRow> rows_;
    std::vector<std::unique_ptr<ImportGroup>> groups_;
};

}  // namespace ispace
