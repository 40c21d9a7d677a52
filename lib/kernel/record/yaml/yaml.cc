// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/yaml/yaml.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/message.h"
#include "record/record.h"
#include "record/schema.h"
#include "record/text.h"

namespace ispace {

namespace {

/// Reads a YAML file and its includes into items. Reports invalid records and unreadable includes
/// as findings of the collector.
class YamlReader {
  public:
    /// \param operand the file read; its includes are relative to its folder
    /// \param read, where see YamlIncludes
    YamlReader(RecordCollector& collector, const std::string& operand, FileReader read,
               IncludeFiles where)
        : collector_(&collector), includes_(operand, std::move(read), where) {}

    /// \throws FormatError with the findings if the operand is invalid YAML or empty, if aliases
    ///         expand beyond the limit, or if there are too many includes
    YamlScene read(std::string_view bytes);
    /// Reads the items below a node of the operand, with parts and defaults that hold below it.
    YamlScene read(const YamlNode& node);
    /// Raises the limits of aliases for the operand's size.
    void grant(std::size_t bytes) { values_.grant(bytes); }
    /// Returns the included files, each once, as opened.
    [[nodiscard]] const std::vector<std::string>& files() const { return includes_.files(); }

  private:
    using Items = std::vector<YamlItem>;
    /// A placement; its part is looked up after the whole file is read.
    struct Pending {
        Items* items;
        std::size_t index;
    };
    /// State of one file being read.
    struct File {
        SourcePosition place;
        YamlDefaults defaults;
        std::map<std::string, const YamlPart*, std::less<>> parts;
        std::vector<Pending> pending;
    };

    void readTop(const YamlNode& top, Items& items);
    void readItems(const YamlNode& node, LineColumn at, Items& items);
    void readListItem(const YamlNode& item, Items& items);
    bool readDirective(const YamlNode& key, const YamlNode& value, LineColumn at, Items& items);
    void readRecords(const YamlNode& keyword, const YamlNode& value, LineColumn at, Items& items);
    void readRecord(const YamlNode& keyword, LineColumn at, const YamlNode& keys,
                    LineColumn keys_at, Items& items);
    const Schema* schemaOf(const YamlNode& keyword);

    void readIncludes(const YamlNode& value, LineColumn at, Items& items);
    void include(const std::string& name, LineColumn at, Items& items);
    void readIncluded(std::string_view bytes, Items& items);
    void addRecords(std::vector<Record> records, Items& items);
    void rebaseFiles(Record& record) const;

    void readParts(const YamlNode& value, LineColumn at);
    void readPart(const YamlNode& name, const YamlNode& value, LineColumn at);
    void addPart(const YamlPart& part, const SourcePosition& at);
    void resolveParts();

    RecordCollector* collector_;
    YamlValues values_{*collector_};
    YamlItemReader item_reader_{*collector_, values_};
    YamlIncludes includes_;
    YamlScene scene_;
    File file_;             // the current file
    bool in_part_ = false;  // the reader is inside a part of the current file
};

using Kind = YamlNode::Kind;

constexpr std::string_view kInclude = "include", kDefaults = "defaults", kParts = "parts",
                           kPlace = "place", kRecords = "records";

/// Rejects tabs in indentation: yaml-cpp ends the indentation at a tab and misreads the structure.
void checkIndentation(std::string_view bytes, const std::string& name) {
    LineReader lines(bytes);
    Diagnostics findings;
    while (const auto line = lines.next()) {
        const std::size_t text = line->find_first_not_of(" \t");
        const std::size_t tab = line->find('\t');
        if (text == std::string_view::npos || tab > text || (*line)[text] == '#') continue;
        findings.add({name, lines.number(), static_cast<int>(tab) + 1,
                      "a tab in the indentation, YAML wants blanks"});
    }
    findings.throwIfAny();
}

YamlScene YamlReader::read(std::string_view bytes) {
    values_.grant(bytes.size());
    const auto tree = parseYaml(bytes, *collector_->file().file);
    return read(tree->top());
}

YamlScene YamlReader::read(const YamlNode& node) {
    file_ = {collector_->file(), {}, {}, {}};
    item_reader_.defaults().clear();
    readTop(node, scene_.items);
    return std::exchange(scene_, {});
}

void YamlReader::readTop(const YamlNode& top, Items& items) {
    values_.visit(top);
    readItems(top, spotOf(top), items);
    resolveParts();
}

void YamlReader::readItems(const YamlNode& node, LineColumn at, Items& items) {
    if (node.kind == Kind::List) {
        for (const YamlNode* item : node.items) readListItem(*item, items);
    } else if (node.kind == Kind::Map) {
        values_.forEachPair(node, "a keyword",
                            [&](const YamlNode& key, const YamlNode& value, LineColumn spot) {
                                if (key.scalar == kRecords && value.kind != Kind::List)
                                    values_.unexpected(value, spot, "a list of records");
                                else if (key.scalar == kRecords)
                                    readItems(value, spot, items);
                                else if (!readDirective(key, value, spot, items))
                                    readRecords(key, value, spot, items);
                            });
    } else {
        values_.unexpected(node, at, "a list or map of records");
    }
}

/// Reads `- desk: {…}`, a map with one keyword.
void YamlReader::readListItem(const YamlNode& item, Items& items) {
    values_.visit(item);
    if (item.kind != Kind::Map || item.items.size() != 2)
        return values_.unexpected(item, spotOf(item), "a record such as `desk: {at: [2, 3]}`");
    values_.forEachPair(item, "a keyword",
                        [&](const YamlNode& key, const YamlNode& value, LineColumn at) {
                            if (!readDirective(key, value, at, items))
                                readRecord(key, spotOf(key), value, at, items);
                        });
}

/// \return false if `key` is a keyword
bool YamlReader::readDirective(const YamlNode& key, const YamlNode& value, LineColumn at,
                               Items& items) {
    const std::string& name = key.scalar;
    if (name == kInclude) {
        readIncludes(value, at, items);
        return true;
    }
    if (name != kDefaults && name != kParts) return false;
    if (in_part_)
        collector_->finding(spotOf(key), [&] {
            return '`' + name + "` in a part, it is wanted beside `parts`, at the top of the file";
        });
    else if (name == kDefaults)
        item_reader_.readDefaults(value, at);
    else
        readParts(value, at);
    return true;
}

/// Reads `desk: {…}` or `desk: [{…}, …]`.
void YamlReader::readRecords(const YamlNode& keyword, const YamlNode& value, LineColumn at,
                             Items& items) {
    const bool known =
        keyword.scalar == kPlace || collector_->schemas().find(keyword.scalar) != nullptr;
    if (!known || value.kind != Kind::List)
        return readRecord(keyword, spotOf(keyword), value, at, items);
    for (const YamlNode* item : value.items) {
        values_.visit(*item);
        readRecord(keyword, spotOf(*item), *item, spotOf(*item), items);
    }
}

void YamlReader::readRecord(const YamlNode& keyword, LineColumn at, const YamlNode& keys,
                            LineColumn keys_at, Items& items) {
    const Schema* const schema = schemaOf(keyword);
    if (schema == nullptr) return;
    auto item = item_reader_.read(*schema, at, keys, keys_at);
    if (!item) return;
    if (schema == &yamlPlaceSchema())
        file_.pending.push_back({&items, items.size()});
    else
        rebaseFiles(item->record);
    items.push_back(*std::move(item));
}

/// Finds the schema of a keyword; returns null and reports a finding if it is unknown.
const Schema* YamlReader::schemaOf(const YamlNode& keyword) {
    const std::string& name = keyword.scalar;
    if (name == kPlace) return &yamlPlaceSchema();
    const Schema* const schema = collector_->schemas().find(name);
    if (schema == nullptr)
        collector_->finding(spotOf(keyword), [&] {
            return "unknown keyword " + excerpt(name) +
                   (file_.parts.contains(name)
                        ? ", write `place: {part: " + name + "}` to place the part"
                        : spellingHint(name, collector_->schemas().keywords()));
        });
    return schema;
}

// Includes

void YamlReader::readIncludes(const YamlNode& value, LineColumn at, Items& items) {
    if (value.kind == Kind::Scalar) return include(value.scalar, at, items);
    if (value.kind != Kind::List)
        return values_.unexpected(value, at, "the name of a file or a list of them");
    for (const YamlNode* file : value.items) {
        values_.visit(*file);
        if (file->kind == Kind::Scalar)
            include(file->scalar, spotOf(*file), items);
        else
            values_.unexpected(*file, spotOf(*file), "the name of a file");
    }
}

void YamlReader::include(const std::string& name, LineColumn at, Items& items) {
    const SourcePosition place = file_.place.at(at);
    std::string bytes;
    try {
        bytes = includes_.enter(name);
    } catch (const FormatError& error) {
        collector_->finding(place, [&] { return error.diagnostics().front().message; });
        if (includes_.isExhausted()) collector_->findings().throwIfAny();
        return;
    }
    values_.grant(bytes.size());
    File outer = std::exchange(file_, {});
    const bool in_part = std::exchange(in_part_, false);
    outer.defaults = std::exchange(item_reader_.defaults(), {});
    file_.place.file = std::make_shared<const std::string>(includes_.name());
    file_.place.included_from = std::make_shared<const SourcePosition>(place);
    collector_->setFile(file_.place);
    readIncluded(bytes, items);
    includes_.leave();
    const auto parts = std::exchange(file_, std::move(outer)).parts;
    collector_->setFile(file_.place);
    item_reader_.defaults() = std::move(file_.defaults);
    in_part_ = in_part;
    for (const auto& part : parts) addPart(*part.second, place);
}

/// Reads the included file, YAML or `.env`.
void YamlReader::readIncluded(std::string_view bytes, Items& items) {
    const std::string& name = *file_.place.file;
    std::unique_ptr<const YamlTree> tree;
    try {
        if (isRecordText(bytes))
            return addRecords(readRecordText(bytes, name, collector_->schemas()).records, items);
        tree = parseYaml(bytes, name);
    } catch (const FormatError& error) {
        std::vector<Diagnostic> findings = error.diagnostics();
        for (Diagnostic& finding : findings) finding.message += file_.place.inclusion();
        return collector_->findings().add(FormatError(std::move(findings)));
    }
    readTop(tree->top(), items);
}

void YamlReader::addRecords(std::vector<Record> records, Items& items) {
    items.reserve(items.size() + records.size());
    for (Record& record : records) {
        record.setIncludedFrom(file_.place.included_from);
        rebaseFiles(record);
        items.push_back({std::move(record), nullptr});
    }
}

/// Converts the record's file names, relative to the current file, to names relative to the
/// operand's folder.
void YamlReader::rebaseFiles(Record& record) const {
    if (file_.place.included_from == nullptr) return;
    for (const KeySpec& key : record.schema().keys)
        if (key.role == Role::File && record.has(key.name))
            record.set(key.name, includes_.rebased(record.text(key.name)),
                       record.keyPlace(key.name));
}

// Parts

void YamlReader::readParts(const YamlNode& value, LineColumn at) {
    if (value.kind != Kind::Map)
        return values_.unexpected(value, at, "a map such as {workplace: [desk: {}, chair: {}]}");
    values_.forEachPair(value, "the name of a part",
                        [&](const YamlNode& name, const YamlNode& items, LineColumn spot) {
                            readPart(name, items, spot);
                        });
}

void YamlReader::readPart(const YamlNode& name, const YamlNode& value, LineColumn at) {
    const auto refuse = [&](const char* what) {
        collector_->finding(spotOf(name), [&] { return excerpt(name.scalar) + what; });
    };
    if (!isWord(name.scalar))
        return refuse(" is not the name of a part: letters, digits and _-./+:@ are wanted");
    if (name.scalar == kPlace || collector_->schemas().find(name.scalar) != nullptr)
        return refuse(" is a keyword, a part needs another name");
    YamlPart& part = scene_.parts.emplace_back();
    part.name = name.scalar;
    part.place = file_.place.at(spotOf(name));
    addPart(part, part.place);
    in_part_ = true;
    readItems(value, at, part.items);
    in_part_ = false;
}

/// Adds a part to those of the current file. Including the same part twice is no error; two parts
/// with one name are.
void YamlReader::addPart(const YamlPart& part, const SourcePosition& at) {
    const auto [known, is_new] = file_.parts.try_emplace(part.name, &part);
    if (is_new) return;
    const SourcePosition &first = known->second->place, &second = part.place;
    if (*first.file == *second.file && first.line == second.line && first.column == second.column)
        return;
    collector_->finding(
        at, [&] { return "doubled part `" + part.name + "`, first in " + otherPlace(first, at); });
}

void YamlReader::resolveParts() {
    for (const Pending& pending : file_.pending) {
        YamlItem& item = (*pending.items)[pending.index];
        if (!item.record.has("part")) continue;
        const std::string& name = item.record.text("part");
        const auto found = file_.parts.find(name);
        if (found != file_.parts.end()) {
            item.part = found->second;
            continue;
        }
        collector_->finding(item.record.keyPlace("part"), [&] {
            std::vector<std::string> known;
            known.reserve(file_.parts.size());
            for (const auto& part : file_.parts) known.push_back(part.first);
            return "unknown part " + excerpt(name) +
                   (known.empty() ? ", `parts` has none" : spellingHint(name, known));
        });
    }
    file_.pending.clear();
}

}  // namespace

std::unique_ptr<const YamlTree> parseYaml(std::string_view bytes, const std::string& name) {
    bytes = withoutBom(bytes);
    checkTextBytes(bytes, name);
    checkIndentation(bytes, name);
    auto tree = std::make_unique<const YamlTree>(bytes, name);
    if (tree->top().kind == YamlNode::Kind::Null)
        throw FormatError({name, 0, 0, "no records found, wanted a list or map of records"});
    return tree;
}

Document readYamlHead(std::string_view bytes, const std::string& name) {
    Document document;
    LineReader lines(withoutBom(bytes));
    const auto first = lines.next();
    if (!first || !first->starts_with(kYamlMagic)) return document;
    const std::string_view version = first->substr(kYamlMagic.size());
    if (version == kYamlLayoutVersion) {
        document.kind = DocumentKind::Layout;
    } else if (version != kYamlVersion) {
        throw FormatError({name, 1, static_cast<int>(kYamlMagic.size()) + 1,
                           "version " + excerpt(version) +
                               " found, wanted `# ispace yaml 1` or `# ispace yaml 1 layout`"});
    }
    for (auto line = lines.next(); line && line->starts_with("# "); line = lines.next())
        document.history.emplace_back(line->substr(2));
    return document;
}

Document readYaml(std::string_view bytes, const std::string& name, const Schemas& schemas,
                  const FileReader& read, const WorkLimit& max_work, IncludeFiles includes) {
    RecordCollector collector(name, schemas);
    YamlReader reader(collector, name, read, includes);
    YamlScene scene = reader.read(bytes);
    Document document = readYamlHead(bytes, name);
    document.records = expandItems(std::move(scene), collector, Budget(bytes.size(), max_work));
    document.sources = reader.files();
    findDoubledIds(document.records, collector.findings());
    collector.findings().throwIfAny();
    return document;
}

std::vector<Document> readYamlNodes(std::span<const YamlNode* const> nodes,
                                    const YamlSource& source) {
    RecordCollector collector(source.name, source.schemas);
    YamlReader reader(collector, source.name, {}, source.includes);
    reader.grant(source.bytes);
    std::vector<Document> documents(nodes.size());
    Budget whole(source.bytes, source.max_work);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        Document& document = documents[i];
        document.records =
            expandItems(reader.read(*nodes[i]), collector, Budget(0, {whole.limit(), &whole}));
        findDoubledIds(document.records, collector.findings());
    }
    collector.findings().throwIfAny();
    if (!documents.empty()) documents.front().sources = reader.files();
    return documents;
}

}  // namespace ispace
