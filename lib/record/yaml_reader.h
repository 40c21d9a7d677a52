// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "record/yaml_include.h"
#include "record/yaml_items.h"

namespace ispace {

/// Reads a YAML file and what it includes into items. What is wrong with records becomes a finding
/// of the collector, as do included files that cannot be read.
class YamlReader {
  public:
    /// \param operand the file read, for the names of those it includes
    /// \param read see YamlIncludes
    YamlReader(RecordCollector& collector, const std::string& operand, FileReader read)
        : collector_(&collector), includes_(operand, std::move(read)) {}

    /// \throws FormatError with the findings if the operand is no YAML or holds nothing, and if
    ///         aliases expand without end or includes are too many
    YamlScene read(std::string_view bytes);
    /// Files included, each once, as opened.
    [[nodiscard]] const std::vector<std::string>& files() const { return includes_.files(); }

  private:
    using Items = std::vector<YamlItem>;
    /// A placement whose part is looked up once its file is read.
    struct Pending {
        Items* items;
        std::size_t index;
    };
    /// What belongs to one file.
    struct File {
        Place place;
        YamlDefaults defaults;
        std::map<std::string, const YamlPart*, std::less<>> parts;
        std::vector<Pending> pending;
    };

    void readTop(const YamlNode& top, Items& items);
    void readItems(const YamlNode& node, Spot at, Items& items);
    void readListItem(const YamlNode& item, Items& items);
    bool readDirective(const YamlNode& key, const YamlNode& value, Spot at, Items& items);
    void readRecords(const YamlNode& keyword, const YamlNode& value, Spot at, Items& items);
    void readRecord(const YamlNode& keyword, Spot at, const YamlNode& keys, Spot keys_at,
                    Items& items);
    const Schema* schemaOf(const YamlNode& keyword);

    void readIncludes(const YamlNode& value, Spot at, Items& items);
    void include(const std::string& name, Spot at, Items& items);
    void readIncluded(std::string_view bytes, Items& items);
    void addRecords(std::vector<Record> records, Items& items);
    void rebaseFiles(Record& record) const;

    void readParts(const YamlNode& value, Spot at);
    void readPart(const YamlNode& name, const YamlNode& value, Spot at);
    void addPart(const YamlPart& part, const Place& at);
    void resolveParts();

    RecordCollector* collector_;
    YamlValues values_{*collector_};
    YamlItemReader item_reader_{*collector_, values_};
    YamlIncludes includes_;
    YamlScene scene_;
    File file_;             // the file read at present
    bool in_part_ = false;  // of that file
};

}  // namespace ispace
