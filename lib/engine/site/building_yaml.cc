// SPDX-License-Identifier: GPL-3.0-or-later
// Buildings in YAML, with the rooms of their storeys inline, and as files of records.
#include <algorithm>
#include <map>
#include <utility>

#include "base/error.h"
#include "record/text.h"
#include "record/yaml/yaml.h"
#include "scene/placement_schemas.h"
#include "site/building_schemas.h"
#include "site/storeys.h"

namespace ispace {

namespace {

constexpr std::string_view kRecords = "records";
using Kind = YamlNode::Kind;

/// Reads records of a building; the records of rooms are left as nodes.
class BuildingYaml {
  public:
    BuildingYaml(RecordCollector& collector, std::size_t bytes) : collector_(&collector) {
        values_.grant(bytes);
    }

    void read(const YamlNode& top) {
        values_.visit(top);
        if (top.kind == Kind::List)
            for (const YamlNode* item : top.items) readItem(*item);
        else if (top.kind == Kind::Map)
            readMap(top, true);
        else
            values_.unexpected(top, spotOf(top), "a list or map of records");
    }

    std::vector<Record> records;
    std::vector<const YamlNode*> rooms;  ///< by record; null: none inline

  private:
    void readItem(const YamlNode& item) {
        values_.visit(item);
        if (item.kind != Kind::Map || item.items.size() != 2)
            return values_.unexpected(item, spotOf(item),
                                      "a record such as `storey: {id: ground, file: ground.env}`");
        readMap(item, false);
    }

    /// Reads `storey: {…}`, or with `lists` also `storey: [{…}, …]`.
    void readMap(const YamlNode& map, bool lists) {
        values_.forEachPair(
            map, "a keyword", [&](const YamlNode& keyword, const YamlNode& value, LineColumn spot) {
                const Schema* const schema = collector_->schemas().find(keyword.scalar);
                if (schema == nullptr) return unknown(keyword);
                if (!lists || value.kind != Kind::List)
                    return readRecord(*schema, spotOf(keyword), value, spot);
                for (const YamlNode* item : value.items) {
                    values_.visit(*item);
                    readRecord(*schema, spotOf(*item), *item, spotOf(*item));
                }
            });
    }

    void unknown(const YamlNode& keyword) {
        collector_->finding(spotOf(keyword), [&] {
            return "unknown keyword " + excerpt(keyword.scalar) +
                   spellingHint(keyword.scalar, collector_->schemas().keywords()) +
                   (sceneSchemas().find(keyword.scalar) == nullptr
                        ? ""
                        : "; records of a room stand in `records` of its storey");
        });
    }

    void readRecord(const Schema& schema, LineColumn at, const YamlNode& keys, LineColumn keys_at) {
        YamlNode plain = keys;
        const YamlNode* room = nullptr;
        for (std::size_t i = 0; keys.kind == Kind::Map && i + 1 < plain.items.size(); i += 2) {
            if (plain.items[i]->scalar != kRecords || schema.keyword != "storey") continue;
            room = plain.items[i + 1];
            plain.items.erase(plain.items.begin() + static_cast<std::ptrdiff_t>(i),
                              plain.items.begin() + static_cast<std::ptrdiff_t>(i) + 2);
            break;
        }
        auto item = items_.read(schema, at, plain, keys_at);
        if (!item) return;
        if (item->repeat)
            collector_->finding(at, [] { return std::string("`repeat` is not for storeys"); });
        records.push_back(std::move(item->record));
        rooms.push_back(room);
    }

    RecordCollector* collector_;
    YamlValues values_{*collector_};
    YamlItemReader items_{*collector_, values_};
};

/// Returns the lines of records in YAML, without history.
std::vector<std::string> yamlLines(std::vector<Record> records) {
    Document document;
    document.records = std::move(records);
    const std::string text = writeYaml(document);
    std::vector<std::string> lines;
    LineReader reader(text);
    while (const auto line = reader.next())
        if (line->starts_with("- ")) lines.emplace_back(line->substr(2));
    return lines;
}

/// Records of loaded meshes name their content by digest, as in compiled files.
std::vector<Record> withDigests(std::vector<Record> records) {
    for (Record& record : records)
        if (record.mesh() != nullptr) record.set("digest", record.mesh()->digest);
    return records;
}

}  // namespace

std::vector<Record> readBuildingYaml(std::string_view bytes, const std::string& operand,
                                     const ImportOptions& options, Budget& work,
                                     std::vector<std::shared_ptr<const Document>>& rooms) {
    RecordCollector collector(operand, buildingSchemas());
    const auto tree = parseYaml(bytes, operand);
    BuildingYaml reader(collector, bytes.size());
    reader.read(tree->top());
    collector.findings().throwIfAny();
    std::vector<const YamlNode*> nodes;
    for (const YamlNode* room : reader.rooms)
        if (room != nullptr && std::find(nodes.begin(), nodes.end(), room) == nodes.end())
            nodes.push_back(room);
    std::vector<Document> documents = readYamlNodes(
        nodes, {bytes.size(), operand, sceneSchemas(), {work.limit(), &work}, options.includes});
    std::map<const YamlNode*, std::shared_ptr<const Document>> made;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        made[nodes[i]] = std::make_shared<const Document>(std::move(documents[i]));
    for (const YamlNode* room : reader.rooms)
        rooms.push_back(room == nullptr ? nullptr : made[room]);
    return std::move(reader.records);
}

std::string writeBuildingYaml(const StoreyedDocument& building, bool compiled) {
    Document head;
    head.history = building.history;
    std::string text = writeYaml(head);
    text.resize(text.find("[]") == std::string::npos ? text.size() : text.find("[]"));
    std::map<const Document*, std::string> anchors;
    for (const Storey& storey : building.storeys) {
        Record record = storey.record;
        record.set("id", storey.id);
        std::string line = yamlLines({record}).front();  // storey: {…}
        line.pop_back();
        const auto [anchor, is_new] =
            anchors.try_emplace(storey.room.get(), "room" + std::to_string(anchors.size() + 1));
        const auto uses =
            std::count_if(building.storeys.begin(), building.storeys.end(),
                          [&](const Storey& other) { return other.room == storey.room; });
        text += "- " + line + ", records: ";
        if (!is_new) {
            text += '*' + anchor->second + "}\n";
            continue;
        }
        if (uses > 1) text += '&' + anchor->second + ' ';
        text += "[\n";
        const std::vector<std::string> lines =
            yamlLines(compiled ? withDigests(storey.room->records) : storey.room->records);
        for (std::size_t i = 0; i < lines.size(); ++i)
            text += "    {" + lines[i] + (i + 1 < lines.size() ? "},\n" : "}");
        text += "]}\n";
    }
    std::vector<Record> passages;
    for (const StoreyPassage& passage : building.passages) passages.push_back(passage.record);
    for (const std::string& line : yamlLines(std::move(passages))) text += "- " + line + '\n';
    return text;
}

std::vector<BuildingPart> writeBuildingRecords(const StoreyedDocument& building,
                                               const std::string& stem) {
    std::vector<BuildingPart> parts;
    Document whole;
    whole.history = building.history;
    std::map<const Document*, std::string> files;
    for (const Storey& storey : building.storeys) {
        const auto [file, is_new] =
            files.try_emplace(storey.room.get(), stem + '-' + storey.id + ".env");
        if (is_new) {
            Document room = *storey.room;
            room.kind = DocumentKind::Environment;
            parts.push_back({file->second, writeRecordText(room)});
        }
        Record record = storey.record;
        record.set("id", storey.id);
        record.set("file", file->second);
        whole.records.push_back(std::move(record));
    }
    for (const StoreyPassage& passage : building.passages) whole.records.push_back(passage.record);
    parts.push_back({"", writeRecordText(whole)});
    return parts;
}

}  // namespace ispace
