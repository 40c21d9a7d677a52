// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

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
    static constexpr int kMostDepth = 64;
    /// Of a file: more take minutes.
    static constexpr std::size_t kMostBytes = 64'000'000;

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

}  // namespace ispace
