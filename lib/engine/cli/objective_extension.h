// SPDX-License-Identifier: GPL-3.0-or-later
// What a folder of lib/extensions adds to the objectives of arrange: a word of --objective,
// options, and the demand that counts instead of the floor. See cli/extension.h.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command_line.h"
#include "cli/common_options.h"
#include "cli/site_operands.h"

namespace ispace {

class Demand;
struct ArrangeOptions;
struct RoomGoals;

/// An objective of arrange and its options: an object is made for each command line.
class ObjectiveGroup {
  public:
    virtual ~ObjectiveGroup() = default;
    /// Returns the word of --objective that asks for it ("track").
    [[nodiscard]] virtual std::string_view word() const = 0;
    /// Returns what the layout maximises, for the help of --objective.
    [[nodiscard]] virtual std::string_view help() const = 0;
    /// Declares the options, bound to members; as OptionGroup::declare().
    virtual void declare(CommandLine& line) = 0;
    /// Returns what counts, for refusals of options about the floor, and those of them that hold
    /// for it, too.
    struct Counted {
        std::string_view what = "ways of people instead of floor";
        std::span<const std::string_view> options = {};  ///< of --zone, --weight, ...
    };
    [[nodiscard]] virtual Counted counted() const { return {}; }
    /// Makes the demand in each room of a site, all of one class.
    /// \param goals of the rooms \param files receives those that were read \throws UsageError,
    /// UnmetError, FormatError
    [[nodiscard]] virtual std::vector<std::shared_ptr<const Demand>> demandsIn(
        const SiteInput& site, std::span<const RoomGoals> goals, const ArrangeOptions& how,
        const CommonOptions& common, std::vector<std::string>& files) const = 0;
};

/// A row of Extensions, see cli/extension.h.
struct ObjectiveRow {
    std::string_view extension;
    std::unique_ptr<ObjectiveGroup> (*make)();  ///< null for an objective that this build lacks
    std::string_view missing = {};              ///< its word
};

/// The objectives that extensions add to one command line.
class ObjectiveExtensions {
  public:
    /// \param rows in the order of `--help`
    explicit ObjectiveExtensions(std::span<const ObjectiveRow> rows);

    /// Returns "; WORD, HELP" for each of them.
    [[nodiscard]] std::string help() const;
    /// Returns ", WORD" for each of them.
    [[nodiscard]] std::string words() const;
    void declare(CommandLine& line);
    /// Returns null for the word of another objective. \throws UsageError for one that this build
    /// lacks, with its extension
    [[nodiscard]] std::shared_ptr<const ObjectiveGroup> find(std::string_view word) const;
    /// Checks that options of an objective are given with it alone.
    /// \param asked null: an objective of the core \throws UsageError
    void check(const CommandLine& line, const ObjectiveGroup* asked) const;

  private:
    struct Member {
        std::string extension;
        std::shared_ptr<ObjectiveGroup> group;
        std::vector<std::string> options = {};  ///< declared by the group
    };
    std::vector<Member> members_;
    std::vector<ObjectiveRow> missing_;
};

}  // namespace ispace
