// SPDX-License-Identifier: GPL-3.0-or-later
// What a folder of lib/extensions adds to an option of a tool that takes a word, as --objective:
// the word, and options that go with it. An option without its word is an error, and so is the word
// of an extension that the build lacks, which the error names. See cli/extension.h.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "cli/command_line.h"

namespace ispace {

/// A word and its options: an object is made for each command line.
class WordGroup {
  public:
    virtual ~WordGroup() = default;
    /// Returns the word that asks for it, as help shows it ("track", "path:FROM,TO"); "" if an
    /// option of its own does.
    [[nodiscard]] virtual std::string_view word() const = 0;
    /// Returns true if the text asks for it, and keeps what follows the word. \throws UsageError
    [[nodiscard]] virtual bool takes(std::string_view text) {
        return !text.empty() && text == word();
    }
    /// Returns that option ("--presence"), and whether it is given.
    [[nodiscard]] virtual std::string_view option() const { return ""; }
    [[nodiscard]] virtual bool isAsked() const { return false; }
    /// Says what the word means, for the help of the option.
    [[nodiscard]] virtual std::string_view help() const = 0;
    /// Declares the options, bound to members; as OptionGroup::declare().
    virtual void declare(CommandLine& line) = 0;
};

/// A row of Extensions, see cli/extensions.h. \tparam Group a WordGroup with what it does
template <typename Group>
struct WordRow {
    std::string_view extension;
    std::unique_ptr<Group> (*make)();  ///< null for a word that this build lacks
    std::string_view missing = {};     ///< that word
};

/// The words that extensions add to an option of one command line.
template <typename Group>
class WordExtensions {
  public:
    /// \param option "--objective" \param rows in the order of `--help`
    WordExtensions(std::string option, std::span<const WordRow<Group>> rows)
        : option_(std::move(option)) {
        members_.reserve(rows.size());
        for (const WordRow<Group>& row : rows) {
            if (row.make == nullptr)
                missing_.push_back(row);
            else
                members_.push_back({std::string(row.extension), row.make()});
        }
    }

    /// Returns "; WORD, HELP" for each of them.
    [[nodiscard]] std::string help() const {
        std::string text;
        for (const Member& member : members_)
            if (!member.group->word().empty())
                text.append("; ")
                    .append(member.group->word())
                    .append(", ")
                    .append(member.group->help());
        return text;
    }
    /// Returns their words, those that this build lacks last.
    [[nodiscard]] std::vector<std::string> all() const {
        std::vector<std::string> words;
        for (const Member& member : members_)
            if (!member.group->word().empty()) words.emplace_back(member.group->word());
        for (const WordRow<Group>& row : missing_) words.emplace_back(row.missing);
        return words;
    }
    /// Returns ", WORD" for each of those that this build has.
    [[nodiscard]] std::string words() const {
        std::string text;
        for (const Member& member : members_)
            if (!member.group->word().empty()) text.append(", ").append(member.group->word());
        return text;
    }
    void declare(CommandLine& line) {
        for (Member& member : members_) {
            const std::size_t before = line.names().size();
            line.extension(member.extension);
            member.group->declare(line);
            line.extension("");
            const std::vector<std::string> names = line.names();
            member.options.assign(names.begin() + static_cast<std::ptrdiff_t>(before), names.end());
        }
    }
    /// Returns the group that takes the text; null for another word. \throws UsageError for one
    /// that this build lacks, with its extension
    [[nodiscard]] std::shared_ptr<Group> find(std::string_view word) const {
        for (const Member& member : members_)
            if (member.group->takes(word)) return member.group;
        for (const WordRow<Group>& row : missing_)
            if (row.missing == word.substr(0, word.find(':')))
                throw UsageError('`' + std::string(word) + "`: it belongs to the extension " +
                                 std::string(row.extension) + ", which this build lacks");
        return nullptr;
    }
    /// Returns the group of which the own option is given; null if none is.
    [[nodiscard]] std::shared_ptr<Group> asked() const {
        for (const Member& member : members_)
            if (member.group->isAsked()) return member.group;
        return nullptr;
    }
    /// Checks that the options of a word are given with it alone.
    /// \param asked null: another word \throws UsageError
    void check(const CommandLine& line, const Group* asked) const {
        for (const Member& member : members_)
            for (const std::string& name : member.options)
                if (member.group.get() != asked && name != member.group->option() &&
                    line.given(name))
                    throw UsageError(name + " goes with " + option_ + ' ' +
                                     std::string(member.group->word()) + ": give that, too");
    }

  private:
    struct Member {
        std::string extension;
        std::shared_ptr<Group> group;
        std::vector<std::string> options = {};  ///< declared by the group
    };
    std::string option_;
    std::vector<Member> members_;
    std::vector<WordRow<Group>> missing_;
};

}  // namespace ispace
