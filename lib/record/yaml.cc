// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/yaml.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/utf8.h"
#include "record/collector.h"
#include "record/lexer.h"
#include "record/scalar.h"
#include "record/yaml_tree.h"

namespace ispace {

namespace {

using Kind = YamlNode::Kind;

constexpr std::string_view kMagic = "# ispace yaml ", kVersion = "1";
/// Nodes that aliases may add to what is written; a file without aliases is never refused.
constexpr std::size_t kMostExpanded = 1'000'000;

/// The list behind a magic first line, if there is one.
History readHistory(std::string_view bytes, const std::string& name) {
    LineReader lines(bytes);
    const auto first = lines.next();
    if (!first || !first->starts_with(kMagic)) return {};
    if (first->substr(kMagic.size()) != kVersion)
        throw FormatError({name, 1, static_cast<int>(kMagic.size()) + 1,
                           "version " + excerpt(first->substr(kMagic.size())) +
                               " found, wanted `# ispace yaml 1`"});
    History history;
    for (auto line = lines.next(); line && line->starts_with("# "); line = lines.next())
        history.emplace_back(line->substr(2));
    return history;
}

const char* wantedForm(const KeySpec& key) {
    switch (key.type) {
        case KeyType::Flag:
            return "yes or no";
        case KeyType::Number:
            return "a number";
        case KeyType::Tuple:
            return "a list of numbers such as [2, 3]";
        case KeyType::TupleList:
            return "a list of lists such as [[0, 0], [8, 0]]";
        case KeyType::Text:
        case KeyType::Word:
        case KeyType::Choice:
            break;
    }
    return "a text";
}

std::string foundForm(const YamlNode& node) {
    switch (node.kind) {
        case Kind::Scalar:
            return excerpt(node.scalar);
        case Kind::List:
            return "a list";
        case Kind::Map:
            return "a map with " + std::to_string(node.items.size() / 2) +
                   (node.items.size() == 2 ? " key" : " keys");
        case Kind::Null:
            break;
    }
    return "nothing (null)";
}

bool isKnownTag(std::string_view tag) {
    constexpr std::string_view kStandard[] = {"str", "int", "float", "bool", "seq", "map", "null"};
    constexpr std::string_view kPrefix = "tag:yaml.org,2002:";
    if (tag.empty() || tag == "?" || tag == "!") return true;
    return tag.starts_with(kPrefix) && std::find(std::begin(kStandard), std::end(kStandard),
                                                 tag.substr(kPrefix.size())) != std::end(kStandard);
}

/// yaml-cpp takes a tab for an end of indentation and reads something else than was meant.
void checkIndentation(std::string_view bytes, RecordCollector& collector) {
    LineReader lines(bytes);
    while (const auto line = lines.next()) {
        const std::size_t text = line->find_first_not_of(" \t");
        const std::size_t tab = line->find('\t');
        if (text == std::string_view::npos || tab > text || (*line)[text] == '#') continue;
        collector.finding(collector.place(lines.number(), static_cast<int>(tab) + 1), [] {
            return std::string("a tab in the indentation, YAML wants blanks");
        });
    }
}

class YamlReader {
  public:
    /// \param bytes size of the file: what may be visited without aliases
    YamlReader(const Schemas& schemas, RecordCollector& collector, std::size_t bytes)
        : schemas_(schemas), collector_(collector), most_visits_(bytes + kMostExpanded) {}

    void readTop(const YamlNode& top) {
        visit(top);
        if (top.kind == Kind::List) return readList(top);
        if (top.kind != Kind::Map) return unexpected(top, place(top), "a list or map of records");
        std::map<std::string_view, int> lines;
        for (std::size_t i = 0; i + 1 < top.items.size(); i += 2) {
            const YamlNode &key = *top.items[i], &value = *top.items[i + 1];
            visit(key);
            visit(value);
            if (key.kind != Kind::Scalar) {
                unexpected(key, place(key), "a keyword");
                continue;
            }
            const auto seen = lines.try_emplace(key.scalar, key.line);
            if (!seen.second) {
                collector_.finding(place(key), [&] {
                    return "doubled key " + excerpt(key.scalar) + ", first in line " +
                           std::to_string(seen.first->second);
                });
            } else if (key.scalar != "records") {
                readRecords(key, value);
            } else if (value.kind == Kind::List) {
                readList(value);
            } else {
                unexpected(value, place(value.kind == Kind::Null ? key : value),
                           "a list of records");
            }
        }
    }

  private:
    [[nodiscard]] Place place(const YamlNode& node) const {
        return collector_.place(node.line, node.column);
    }

    /// Counts a node; aliases can make a small file endless.
    void visit(const YamlNode& node) {
        if (++visited_ > most_visits_)
            throw FormatError(place(node).finding("aliases expand to more than " +
                                                  std::to_string(kMostExpanded) + " nodes"));
        if (!isKnownTag(node.tag))
            collector_.finding(place(node), [&] { return "unknown tag " + excerpt(node.tag); });
    }

    void unexpected(const YamlNode& node, const Place& at, const char* wanted) {
        collector_.finding(at,
                           [&] { return foundForm(node) + " is given, " + wanted + " is wanted"; });
    }

    /// `- desk: {…}`, each item a map with one keyword.
    void readList(const YamlNode& list) {
        for (const YamlNode* item : list.items) {
            visit(*item);
            if (item->kind != Kind::Map || item->items.size() != 2) {
                unexpected(*item, place(*item), "a record such as `desk: {at: [2, 3]}`");
                continue;
            }
            const YamlNode &key = *item->items[0], &value = *item->items[1];
            visit(key);
            visit(value);
            if (key.kind == Kind::Scalar)
                readRecord(key.scalar, place(key), value);
            else
                unexpected(key, place(key), "a keyword");
        }
    }

    /// `desk: {…}` or `desk: [{…}, …]`.
    void readRecords(const YamlNode& keyword, const YamlNode& value) {
        const bool known = schemas_.find(keyword.scalar) != nullptr;
        if (!known || value.kind != Kind::List)
            return readRecord(keyword.scalar, place(keyword), value);
        for (const YamlNode* item : value.items) {
            visit(*item);
            readRecord(keyword.scalar, place(*item), *item);
        }
    }

    void readRecord(const std::string& keyword, const Place& at, const YamlNode& keys) {
        if (!collector_.begin(keyword, at)) return;
        if (keys.kind != Kind::Map) {
            return unexpected(keys, keys.kind == Kind::Null ? at : place(keys),
                              "a map of keys such as {at: [2, 3]}");
        }
        for (std::size_t i = 0; i + 1 < keys.items.size(); i += 2) {
            const YamlNode &name = *keys.items[i], &value = *keys.items[i + 1];
            visit(name);
            visit(value);
            if (name.kind != Kind::Scalar) {
                unexpected(name, place(name), "a key");
                continue;
            }
            const KeySpec* const key = collector_.key(name.scalar, place(name));
            if (key == nullptr) continue;
            // A null stands where the next line begins; its key says more.
            readValue(*key, value, place(value.kind == Kind::Null ? name : value));
        }
        collector_.end();
    }

    void readValue(const KeySpec& key, const YamlNode& node, const Place& at) {
        if (node.kind == Kind::Scalar) return collector_.text(key, node.scalar, at);
        if (node.kind == Kind::List && key.type == KeyType::Tuple) {
            if (auto tuple = readTuple(key, node)) collector_.value(key, *std::move(tuple), at);
        } else if (node.kind == Kind::List && key.type == KeyType::TupleList) {
            if (auto list = readTupleList(key, node)) collector_.value(key, *std::move(list), at);
        } else {
            refuseForm(key, node, at);
        }
    }

    void refuseForm(const KeySpec& key, const YamlNode& node, const Place& at) {
        collector_.finding(at, [&] {
            return '`' + key.name + "`: " + foundForm(node) + " is given, " + wantedForm(key) +
                   " is wanted";
        });
    }

    std::optional<Tuple> readTuple(const KeySpec& key, const YamlNode& node) {
        Tuple tuple;
        for (const YamlNode* item : node.items) {
            visit(*item);
            if (item->kind != Kind::Scalar) {
                refuseForm(key, *item, place(*item));
                return std::nullopt;
            }
            try {
                tuple.push_back(parseNumber(key, item->scalar));
            } catch (const FormatError& error) {
                collector_.finding(place(*item),
                                   [&] { return error.diagnostics().front().message; });
                return std::nullopt;
            }
        }
        return tuple;
    }

    std::optional<TupleList> readTupleList(const KeySpec& key, const YamlNode& node) {
        TupleList list;
        for (const YamlNode* item : node.items) {
            visit(*item);
            if (item->kind != Kind::List) {
                refuseForm(key, *item, place(*item));
                return std::nullopt;
            }
            auto tuple = readTuple(key, *item);
            if (!tuple) return std::nullopt;
            list.push_back(*std::move(tuple));
        }
        return list;
    }

    const Schemas& schemas_;
    RecordCollector& collector_;
    std::size_t most_visits_, visited_ = 0;
};

}  // namespace

Document readYaml(std::string_view bytes, const std::string& name, const Schemas& schemas) {
    if (bytes.starts_with(kByteOrderMark)) bytes.remove_prefix(kByteOrderMark.size());
    checkTextBytes(bytes, name);
    Document document;
    document.history = readHistory(bytes, name);
    RecordCollector collector(name, schemas);
    checkIndentation(bytes, collector);
    (void)collector.take();
    const YamlTree tree(bytes, name);
    if (tree.top().kind == Kind::Null)
        throw FormatError({name, 0, 0, "no records found, wanted a list or map of records"});
    YamlReader(schemas, collector, bytes.size()).readTop(tree.top());
    document.records = collector.take();
    return document;
}

}  // namespace ispace
