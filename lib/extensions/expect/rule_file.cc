// SPDX-License-Identifier: GPL-3.0-or-later
// A subset of YAML 1.2: a list of scalars or of maps with two known keys. All errors of a file are
// found at once. The column of an error is that of the word in the sentence, unless the scalar
// spans lines.
#include "extensions/expect/rule_file.h"

#include <algorithm>
#include <utility>

#include "base/message.h"
#include "record/yaml/yaml.h"

namespace ispace::expect {

namespace {

using Kind = YamlNode::Kind;

/// Reads the nodes of a file into rules.
class RuleReader {
  public:
    explicit RuleReader(const std::string& name) : name_(name) {}

    std::vector<Expectation> read(const YamlNode& top) {
        const YamlNode* list = &top;
        if (top.kind == Kind::Map) {
            list = nullptr;
            forEach(top, {"rules"},
                    [&](const std::string&, const YamlNode& value) { list = &value; });
            if (list == nullptr && findings_.empty())
                find(top, "wanted a list of sentences under `rules`");
        }
        if (list != nullptr && list->kind != Kind::List) {
            find(*list, "wanted a list of sentences, such as `- no collision`");
        } else if (list != nullptr) {
            for (const YamlNode* const item : list->items) readRule(*item);
        }
        findings_.throwIfAny();
        return std::move(rules_);
    }

  private:
    [[nodiscard]] Diagnostic at(const YamlNode& node) const {
        return {.file = name_, .line = node.line, .column = node.column};
    }
    void find(const YamlNode& node, std::string message) {
        Diagnostic finding = at(node);
        finding.message = std::move(message);
        findings_.add(std::move(finding));
    }

    /// Calls take(key, value) for the pairs of a map with known keys.
    template <typename Take>
    void forEach(const YamlNode& map, const std::vector<std::string>& known, Take take) {
        std::vector<std::string> seen;
        for (std::size_t i = 0; i + 1 < map.items.size(); i += 2) {
            const YamlNode& key = *map.items[i];
            if (std::find(known.begin(), known.end(), key.scalar) == known.end())
                find(key, "unknown key " + excerpt(key.scalar) + didYouMean(key.scalar, known));
            else if (std::find(seen.begin(), seen.end(), key.scalar) != seen.end())
                find(key, excerpt(key.scalar) + " is given twice");
            else
                take(seen.emplace_back(key.scalar), *map.items[i + 1]);
        }
    }

    void readRule(const YamlNode& node) {
        const YamlNode* sentence = node.kind == Kind::Scalar ? &node : nullptr;
        std::string name;
        if (node.kind == Kind::Map)
            forEach(node, {"name", "expect"}, [&](const std::string& key, const YamlNode& value) {
                if (value.kind != Kind::Scalar)
                    find(value, excerpt(key) + " is a line of text");
                else if (key == "name")
                    name = printable(value.scalar);
                else
                    sentence = &value;
            });
        if (sentence == nullptr)
            find(node, "wanted a sentence, or a map with `expect` and `name`");
        else
            readSentence(*sentence, std::move(name));
    }

    void readSentence(const YamlNode& node, std::string name) {
        // Quotes are no part of the text; folded lines and escapes make other columns.
        const bool is_quoted = node.tag == "!";
        Diagnostic source = at(node);
        source.column += is_quoted ? 1 : 0;
        const bool is_verbatim = node.scalar.find('\n') == std::string::npos;
        try {
            Expectation rule = parseExpectation(node.scalar);
            rule.name = std::move(name);
            rule.source = std::move(source);
            rule.is_verbatim = is_verbatim;
            rules_.push_back(std::move(rule));
        } catch (const SentenceError& error) {
            if (is_verbatim) source.column += static_cast<int>(error.offset());
            source.message = error.what();
            findings_.add(std::move(source));
        }
    }

    const std::string& name_;
    Diagnostics findings_;
    std::vector<Expectation> rules_;
};

}  // namespace

std::vector<Expectation> readRules(std::string_view bytes, const std::string& name) {
    const YamlTree tree(bytes, name);
    std::vector<Expectation> rules;
    if (tree.top().kind != Kind::Null) rules = RuleReader(name).read(tree.top());
    // A file that was cut short must not pass for one whose rules hold.
    if (rules.empty())
        throw FormatError(
            {.file = name, .message = "no rules, wanted sentences such as `- no collision`"});
    return rules;
}

}  // namespace ispace::expect
