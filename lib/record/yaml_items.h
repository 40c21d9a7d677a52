// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "record/collector.h"
#include "record/yaml_tree.h"

namespace ispace {

/// Memory a value takes beside its own size, about.
std::size_t heapSizeOf(const Value& value);

inline Spot spotOf(const YamlNode& node) { return {node.line, node.column}; }

/// Walks the nodes of YAML files and reads values. What is wrong becomes a finding of the
/// collector, in the file it is set to.
class YamlValues {
  public:
    /// Nodes, and bytes of values, that aliases and defaults may add to what is written; files
    /// without them are never refused.
    static constexpr std::size_t kMaxNodes = 1'000'000, kMaxBytes = 64'000'000;

    explicit YamlValues(RecordCollector& collector) : collector_(&collector) {}

    /// Another file of so many bytes will be walked.
    void grant(std::size_t bytes);
    /// Counts a node; aliases can make a small file endless. A tag of one's own is a finding.
    /// \throws FormatError, with all findings so far, if aliases add more than kMaxNodes or
    /// kMaxBytes, in all files together
    void visit(const YamlNode& node);
    /// Counts the copy of a default. \throws as visit
    void visit(const Value& value, Spot at);

    /// "a list is given, `wanted` is wanted".
    void unexpected(const YamlNode& node, Spot at, const char* wanted);

    /// Calls read(key, value, spot) for the pairs of a map: `spot` is where the value is, or its
    /// key if it is null, which stands where the next line begins. Keys are scalars; others and
    /// doubled ones are findings.
    template <typename Read>
    void forEachPair(const YamlNode& map, const char* wanted_key, Read read) {
        std::map<std::string_view, Spot> seen;
        for (std::size_t i = 0; i + 1 < map.items.size(); i += 2) {
            const YamlNode &key = *map.items[i], &value = *map.items[i + 1];
            visit(key);
            visit(value);
            if (key.kind != YamlNode::Kind::Scalar) {
                unexpected(key, spotOf(key), wanted_key);
                continue;
            }
            const auto [first, is_new] = seen.try_emplace(key.scalar, spotOf(key));
            if (is_new)
                read(key, value, spotOf(value.kind == YamlNode::Kind::Null ? key : value));
            else
                doubledKey(key, first->second);
        }
    }

    /// The value of a key; nothing, and a finding, if it is not what the key wants.
    std::optional<Value> read(const KeySpec& key, const YamlNode& node, Spot at);

  private:
    void spend(std::size_t nodes, std::size_t bytes, Spot at);
    void doubledKey(const YamlNode& key, Spot first);
    void refuseForm(const KeySpec& key, const YamlNode& node, Spot at);
    std::optional<Tuple> readTuple(const KeySpec& key, const YamlNode& node);
    std::optional<TupleList> readTupleList(const KeySpec& key, const YamlNode& node);

    RecordCollector* collector_;
    std::size_t most_nodes_ = kMaxNodes, most_bytes_ = kMaxBytes;
    std::size_t nodes_ = 0, bytes_ = 0;
};

struct YamlPart;

/// A record as a YAML file has it, before parts are placed and copies are made.
struct YamlItem {
    Record record;                   ///< of the schema of `place` where a part is placed
    std::unique_ptr<Record> repeat;  ///< of the schema of `repeat`; null: not repeated
    const YamlPart* part = nullptr;  ///< what is placed; null also where it is not known
};

/// Records that are placed together.
struct YamlPart {
    std::string name;
    Place place;
    std::vector<YamlItem> items;
};

/// What YAML files hold: the items of the operand and of what it includes, in order.
struct YamlScene {
    std::vector<YamlItem> items;
    std::deque<YamlPart> parts;  ///< addresses stay
};

/// The keys of `place`: id, part, at, heading.
const Schema& yamlPlaceSchema();
/// The keys of `repeat`: count, rows, cols, step, heading, turn, about.
const Schema& yamlRepeatSchema();

/// Values for the keys of records that follow in a file.
using YamlDefaults = std::map<const KeySpec*, std::pair<Value, Spot>>;

/// Reads single records, placements and defaults. What is wrong becomes a finding of the
/// collector.
class YamlItemReader {
  public:
    YamlItemReader(RecordCollector& collector, YamlValues& values)
        : collector_(&collector), values_(&values) {}

    /// Defaults of the file read at present.
    [[nodiscard]] YamlDefaults& defaults() { return defaults_; }

    /// The record or placement of the schema that stands at `at` and has these keys; nothing if
    /// that is no map. It may lack what is wrong with it.
    std::optional<YamlItem> read(const Schema& schema, Spot at, const YamlNode& keys, Spot keys_at);
    /// `defaults: {desk: {height: 0.72}, …}`: adds to those there are.
    void readDefaults(const YamlNode& value, Spot at);

  private:
    /// \return false if something is wrong with it
    bool readKey(const YamlNode& name, const YamlNode& value, Spot at);
    void addDefaults(const Schema& schema);
    /// Null if something is wrong with it.
    std::unique_ptr<Record> readRepeat(const YamlNode& keys, Spot at, const Record& what);
    bool checkRepeat(const Record& repeat, const Record& what);
    void readDefaultKeys(const Schema& schema, const YamlNode& keys);

    RecordCollector* collector_;
    YamlValues* values_;
    YamlDefaults defaults_;
};

}  // namespace ispace
