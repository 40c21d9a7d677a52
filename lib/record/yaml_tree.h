// SPDX-License-Identifier: GPL-3.0-or-later
// The first line of a YAML file of records, which it may lack.
#pragma once

#include <cstddef>
#include <deque>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "record/yaml.h"

namespace ispace {

/// One node of a YAML document. An alias is the node it stands for, so that nodes may be reached
/// on many ways, even from themselves: who walks must count.
struct YamlNode {
    enum class Kind { Null, Scalar, List, Map };
    Kind kind = Kind::Null;
    int line = 0, column = 0;  ///< from 1, columns in bytes
    std::string scalar = {};   ///< text of a scalar
    std::string tag = {};      ///< as YAML resolves it; "?" or "!" where none is written
    std::vector<const YamlNode*> items = {};  ///< of a list; of a map key, value, key, value …
};

/// The one document of a YAML file.
class YamlTree {
  public:
    /// Lists and maps in each other, at most: far more than records have, far less than a stack.
    static constexpr int kMaxDepth = 64;
    /// Of a file: more take minutes.
    static constexpr std::size_t kMaxBytes = 64'000'000;

    /// \throws FormatError with one finding, also for a second document. O(bytes)
    YamlTree(std::string_view bytes, const std::string& name);
    YamlTree(const YamlTree&) = delete;
    YamlTree& operator=(const YamlTree&) = delete;

    /// The top of the document; a null for an empty file.
    [[nodiscard]] const YamlNode& top() const { return *top_; }

  private:
    friend class YamlTreeBuilder;
    std::deque<YamlNode> nodes_;  // addresses stay
    const YamlNode* top_ = nullptr;
};

/// Finds and reads the files that YAML files include, and keeps their number, size and depth
/// within bounds.
class YamlIncludes {
  public:
    static constexpr std::size_t kMaxDepth = 32, kMaxFiles = 1000, kMaxBytes = 256'000'000;
    /// Of files that are included once more.
    static constexpr std::size_t kMaxAgain = 16'000'000;

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

constexpr std::string_view kYamlMagic = "# ispace yaml ", kYamlVersion = "1",
                           kYamlLayoutVersion = "1 layout";

}  // namespace ispace
