// SPDX-License-Identifier: GPL-3.0-or-later
// Options of an extension in a tool, and a task that they ask for instead of the tool's own. A tool
// declares the groups after its own options, parses, and runs task() if there is one; options that
// the task would ignore are errors.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command_line.h"
#include "cli/common_options.h"

namespace ispace {

/// The command that a task belongs to.
struct TaskInput {
    CommonOptions common;
    SceneRules rules;
    std::vector<std::string> operands;
    std::string history_line = {};  ///< for the product
};

/// A task of an extension, ready to run; empty: the command asks for the tool's own.
using ExtensionTask = std::function<void()>;

/// The options of one extension in one tool, and their values: an object is made for each command
/// line and kept until its task is done.
///
///     class Against : public OptionGroup {
///         void declare(CommandLine& line) override {
///             line.file("--against", "LOG", log_, "...", Enters::History);
///         }
///         bool isAsked() const override { return !log_.empty(); }
///         std::span<const std::string_view> honours() const override { return kHonoured; }
///         void take(const CommandLine& line) override { select_ = line.valuesOf("--select"); }
///         void run(const TaskInput& input) override;
///         std::string log_;
///     };
class OptionGroup {
  public:
    virtual ~OptionGroup() = default;
    /// Declares the options, bound to members. The group begins with line.group(HEADING), letters
    /// and blanks.
    virtual void declare(CommandLine& line) = 0;
    /// Returns true if the parsed options ask for the task of the group.
    [[nodiscard]] virtual bool isAsked() const = 0;
    /// Returns the options of the tool, by their long names ("--select"), that have a meaning for
    /// the task. Those of addCommonOptions() and addSceneRules() always have, and --storey.
    [[nodiscard]] virtual std::span<const std::string_view> honours() const = 0;
    /// Checks the options with each other, and takes what the tool's own say
    /// (CommandLine::valuesOf). \throws UsageError
    virtual void take(const CommandLine& line) = 0;
    /// Does the task. \throws as a tool does; UnmetError after all products are written
    virtual void run(const TaskInput& input) = 0;
};

/// A row of Extensions::options().
struct ToolExtension {
    std::string_view extension, tool;
    std::unique_ptr<OptionGroup> (*make)();  ///< null for an option that this build lacks
    std::string_view missing = {};           ///< that option, by its long name
};

/// The extensions of a tool's command line.
class ToolExtensions {
  public:
    /// \param rows of all tools, in the order of `--help`
    ToolExtensions(std::span<const ToolExtension> rows, std::string_view tool);

    /// Declares the groups. An option of an extension that this build lacks is an error that names
    /// the extension.
    void declare(CommandLine& line);

    /// Returns the task that the parsed options ask for, with its history line; empty for the
    /// tool's own. An option that has no meaning for the task is an error, and so is one of a group
    /// whose task is not asked for. \throws UsageError
    [[nodiscard]] ExtensionTask task(const CommandLine& line, TaskInput input) const;

  private:
    struct Member {
        std::string extension;
        std::shared_ptr<OptionGroup> group;
        std::vector<std::string> options = {};  ///< declared by the group
    };
    std::vector<Member> members_;
    std::vector<ToolExtension> missing_;
};

}  // namespace ispace
