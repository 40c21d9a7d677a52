// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "record/yaml.h"

namespace ispace {

/// Finds and reads the files that YAML files include, and keeps their number, size and depth
/// within bounds.
class YamlIncludes {
  public:
    static constexpr std::size_t kMostDepth = 32, kMostFiles = 1000, kMostBytes = 256'000'000;
    /// Of files that are included once more.
    static constexpr std::size_t kMostAgain = 16'000'000;

    /// \param operand the file read first; "-" lies in the current folder
    /// \param read gives the content of files; without it they are read from the disk
    YamlIncludes(const std::string& operand, FileReader read);

    /// Reads the file that the file read at present names; it is the one read from now on.
    /// \return its bytes
    /// \throws FormatError whose diagnostic has only a message: no such file, no regular file, one
    ///         that is being read already (the cycle is named), or too many
    std::string enter(const std::string& file);
    /// True once enter() has refused what would be too many files or bytes.
    [[nodiscard]] bool isExhausted() const { return is_exhausted_; }
    /// Back to the file that includes it.
    void leave();

    /// The file read at present, as opened.
    [[nodiscard]] const std::string& name() const { return open_.back().name; }
    /// A path in the file read at present, relative to the folder of the operand.
    [[nodiscard]] std::string rebased(const std::string& path) const;
    /// What was entered so far, each file once.
    [[nodiscard]] const std::vector<std::string>& files() const { return files_; }

  private:
    struct Open {
        std::string name;
        std::string folder;    // from the folder of the operand; "": the same
        std::string identity;  // without links and detours; "-" for stdin
    };
    void checkCycle(const Open& next) const;
    [[nodiscard]] std::string identityOf(const std::string& name) const;
    [[nodiscard]] std::string read(const std::string& name) const;
    void spend(const Open& file, std::size_t size);
    [[noreturn]] void exhaust(const std::string& message);

    FileReader read_;
    std::vector<Open> open_;
    std::vector<std::string> files_;
    std::set<std::string> identities_;  // of those
    std::size_t count_ = 0, bytes_ = 0, again_ = 0;
    bool is_exhausted_ = false;
};

}  // namespace ispace
