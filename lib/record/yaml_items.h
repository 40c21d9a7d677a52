// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "record/collector.h"
#include "record/yaml_values.h"

namespace ispace {

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
