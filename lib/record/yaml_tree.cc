// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/yaml_tree.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "base/error.h"
#include "base/utf8.h"

namespace ispace {

/// Builds the tree from the parser's events. YAML::LoadAll will not do: stray text between
/// documents keeps it busy until memory ends.
class YamlTreeBuilder final : public YAML::EventHandler {
  public:
    YamlTreeBuilder(YamlTree& tree, const std::string& name) : tree_(tree), name_(name) {}

    void OnDocumentStart(const YAML::Mark& mark) override {
        if (++documents_ > 1) fail(mark, "the YAML document has ended, but more text follows");
    }
    void OnDocumentEnd() override {}

    void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        add(YamlNode::Kind::Null, mark, "", anchor);
    }
    void OnAlias(const YAML::Mark& /*mark*/, YAML::anchor_t anchor) override {
        put(anchors_.at(anchor));
    }
    void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  const std::string& value) override {
        add(YamlNode::Kind::Scalar, mark, tag, anchor).scalar = value;
    }
    void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                         YAML::EmitterStyle::value /*style*/) override {
        open(YamlNode::Kind::List, mark, tag, anchor);
    }
    void OnSequenceEnd() override { open_.pop_back(); }
    void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                    YAML::EmitterStyle::value /*style*/) override {
        open(YamlNode::Kind::Map, mark, tag, anchor);
    }
    void OnMapEnd() override { open_.pop_back(); }

    [[noreturn]] void fail(const YAML::Mark& mark, const std::string& message) const {
        throw FormatError({name_, mark.line + 1, mark.column + 1, message});
    }

  private:
    void put(const YamlNode* node) {
        if (open_.empty())
            tree_.top_ = node;
        else
            open_.back()->items.push_back(node);
    }

    YamlNode& add(YamlNode::Kind kind, const YAML::Mark& mark, const std::string& tag,
                  YAML::anchor_t anchor) {
        YamlNode& node = tree_.nodes_.emplace_back();
        node.kind = kind;
        node.line = mark.line + 1;
        node.column = mark.column + 1;
        node.tag = tag;
        if (anchor != YAML::NullAnchor) anchors_[anchor] = &node;
        put(&node);
        return node;
    }

    void open(YamlNode::Kind kind, const YAML::Mark& mark, const std::string& tag,
              YAML::anchor_t anchor) {
        if (open_.size() >= YamlTree::kMostDepth)
            fail(mark, "lists and maps are nested too deep, more than " +
                           std::to_string(YamlTree::kMostDepth) + " in each other");
        open_.push_back(&add(kind, mark, tag, anchor));
    }

    YamlTree& tree_;
    const std::string& name_;
    int documents_ = 0;
    std::vector<YamlNode*> open_;
    std::map<YAML::anchor_t, const YamlNode*> anchors_;
};

YamlTree::YamlTree(std::string_view bytes, const std::string& name) {
    if (bytes.size() > kMostBytes)
        throw FormatError({name, 0, 0,
                           std::to_string(bytes.size()) + " bytes of YAML, wanted at most " +
                               std::to_string(kMostBytes) + "; records in .env may have more"});
    // yaml-cpp takes the end of the file for the end of an open quote, but not a document's end.
    const std::string text =
        std::string(bytes) + (bytes.empty() || bytes.ends_with('\n') ? "...\n" : "\n...\n");
    const auto lines = std::count(text.begin(), text.end(), '\n') - 1;
    YamlTreeBuilder builder(*this, name);
    std::istringstream stream(text);
    try {
        YAML::Parser parser(stream);
        while (parser.HandleNextDocument(builder)) {
        }
    } catch (const YAML::Exception& error) {
        if (error.mark.line >= lines && error.msg == YAML::ErrorMsg::DOC_IN_SCALAR)
            throw FormatError(
                {name, static_cast<int>(lines), 0, "bad YAML: the file ends inside a quoted text"});
        builder.fail(error.mark, "bad YAML: " + printable(error.msg));
    }
    if (top_ == nullptr) top_ = &nodes_.emplace_back();
}

}  // namespace ispace
