// SPDX-License-Identifier: GPL-3.0-or-later
// Recognises and reads buildings: records, YAML, compiled files, sites of Open-RMF.
//
// Recognition takes O(bytes): words, the first line of content, and the top of the YAML tree; a
// file that is broken is left to the reader, whose error tells where. The budget of the building
// pays for all its rooms, so that small files cannot name much work.
#include "site/storeys.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

#include "base/budget.h"
#include "base/error.h"
#include "base/file.h"
#include "base/glob.h"
#include "base/message.h"
#include "base/number.h"
#include "base/run_files.h"
#include "drawing/plan/found_rooms.h"
#include "io/exporters.h"
#include "io/glb/glb_read.h"
#include "io/import_records.h"
#include "io/mesh_files.h"
#include "io/plan/layer_names.h"
#include "record/text.h"
#include "record/yaml/yaml.h"
#include "scene/placement_schemas.h"
#include "site/building_imports.h"
#include "site/building_schemas.h"

namespace ispace {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kStorey = "storey";

/// Returns true if a line of records begins with the keyword.
bool hasStoreyLine(std::string_view bytes) {
    LineReader lines(bytes);
    while (const auto line = lines.next()) {
        const std::string_view text = trimmed(*line);
        if (text.starts_with(kStorey) &&
            (text.size() == kStorey.size() || text[kStorey.size()] == ' ' ||
             text[kStorey.size()] == '\t'))
            return true;
    }
    return false;
}

/// Returns true if the first line of content may begin a list or map of YAML. Meshes in text hold
/// words of buildings in comments, and are large.
bool beginsAsYaml(std::string_view bytes) {
    LineReader lines(bytes);
    while (const auto line = lines.next()) {
        const std::string_view text = trimmed(*line);
        if (text.empty() || text.starts_with('#') || text.starts_with('%') || text == "---")
            continue;
        return std::string_view("-[{?&!").find(text.front()) != std::string_view::npos ||
               text.ends_with(':') || text.find(": ") != std::string_view::npos ||
               text.find(":\t") != std::string_view::npos;
    }
    return false;
}

/// Returns true for YAML with the keyword at its top, and for sites of Open-RMF.
bool hasStoreyNode(std::string_view bytes) {
    try {
        const auto tree = parseYaml(bytes, "");
        const YamlNode& top = tree->top();
        if (isRmfSite(top)) return true;
        const auto has_key = [](const YamlNode& map) {
            if (map.kind != YamlNode::Kind::Map) return false;
            for (std::size_t i = 0; i + 1 < map.items.size(); i += 2)
                if (map.items[i]->scalar == kStorey) return true;
            return false;
        };
        if (top.kind == YamlNode::Kind::List)
            return std::any_of(top.items.begin(), top.items.end(),
                               [&](const YamlNode* item) { return has_key(*item); });
        return has_key(top);
    } catch (const FormatError&) {
        return false;  // the reader of rooms reports the error
    }
}

/// Ids of storeys in `storeys=`.
std::vector<std::string> namesIn(const std::string& list) {
    std::vector<std::string> names(1);
    for (const char c : list) {
        if (c == ',')
            names.emplace_back();
        else if (c != ' ')
            names.back() += c;
    }
    return names;
}

std::vector<std::string> idsOf(const std::vector<Storey>& storeys) {
    std::vector<std::string> ids;
    ids.reserve(storeys.size());
    for (const Storey& storey : storeys) ids.push_back(storey.id);
    return ids;
}

/// Reports an id that is not one component of paths: of `storey/id` and of records' folders.
void checkRoomId(const Record& record, const std::string& id, Diagnostics& findings) {
    if (id.find('/') != std::string::npos)
        findings.add(record.finding("id", "`/` in the id of a " + record.keyword() +
                                              ": it separates the " + record.keyword() +
                                              " from ids in its room"));
    else if (id == "." || id == "..")
        findings.add(record.finding(
            "id", "`" + id + "` is a name of folders, not of a " + record.keyword()));
}

/// Returns the greatest load of a lift in kilograms; nullopt if `capacity` is not a load.
std::optional<double> capacityOf(const Record& record) {
    if (record.schema().find("capacity") == nullptr || !record.has("capacity"))
        return StoreyPassage::kNoLimit;
    std::string load = record.text("capacity");
    if (load.ends_with("kg")) load.resize(load.size() - 2);
    const auto kilograms = parseDouble(load);
    return kilograms && *kilograms > 0 ? kilograms : std::nullopt;
}

/// Resolves the storeys of a passage. Reports unknown, doubled and missing ones.
std::vector<std::size_t> storeysOf(const Record& record, const std::vector<Storey>& storeys,
                                   Diagnostics& findings) {
    std::vector<std::size_t> found;
    const auto report = [&](const std::string& message) {
        findings.add(record.finding("storeys", record.keyword() + ": " + message));
    };
    for (const std::string& name : namesIn(record.text("storeys"))) {
        const auto at = std::find_if(storeys.begin(), storeys.end(),
                                     [&](const Storey& storey) { return storey.id == name; });
        if (at == storeys.end()) {
            report("the building has no storey " + excerpt(name) +
                   spellingHint(name, idsOf(storeys)));
            return {};
        }
        found.push_back(static_cast<std::size_t>(at - storeys.begin()));
    }
    std::sort(found.begin(), found.end());
    if (std::adjacent_find(found.begin(), found.end()) != found.end())
        report("a storey is named twice");
    else if (found.size() < 2)
        report("it joins one storey, two or more are wanted");
    return found;
}

/// Reads the rooms of files, each once.
class RoomFiles {
  public:
    /// \param options of the rooms \param work of the building, which pays for its rooms
    RoomFiles(const std::string& operand, const ImportOptions& options, Budget& work)
        : operand_(operand), options_(options), work_(work) {}

    /// \throws FormatError, std::system_error
    std::shared_ptr<const Document> read(const Record& record) {
        const std::string& name = record.text("file");
        const std::string path = sideFilePath(operand_, name);
        checkPlace(record, name, path);
        const auto [known, is_new] = rooms_.try_emplace(fs::canonical(path).string());
        auto& [room, plans] = known->second;
        const std::size_t before = options_.found == nullptr ? 0 : options_.found->rooms.size();
        if (is_new) room = readRoom(record, name, path);
        if (options_.found != nullptr) listRooms(record.writtenId(), before, is_new, plans);
        return room;
    }
    [[nodiscard]] std::vector<std::string> takeSources() { return std::move(sources_); }
    /// Returns true if the building has no work left for further rooms.
    [[nodiscard]] bool isOver() const { return work_.isExceeded(); }

  private:
    [[noreturn]] static void refuse(const Record& record, const std::string& message) {
        throw FormatError(record.finding("file", message));
    }

    void checkPlace(const Record& record, const std::string& name, const std::string& path) const {
        std::error_code error;
        const fs::path file = fs::canonical(path, error);
        if (error || !mayBeRead(file.string()))
            refuse(record, "the room " + excerpt(name) + " cannot be opened: " +
                               (error ? error.message() : "it may not be read"));
        const fs::path parent = fs::path(operand_ == "-" ? "" : operand_).parent_path();
        const fs::path folder = fs::canonical(parent.empty() ? fs::path(".") : parent);
        if (options_.includes != IncludeFiles::Anywhere && !liesIn(folder, file))
            refuse(record, "the room " + excerpt(name) +
                               " lies outside the folder of the building: put it there, or allow "
                               "it with --include-files anywhere");
    }

    std::shared_ptr<const Document> readRoom(const Record& record, const std::string& name,
                                             const std::string& path) {
        const std::string bytes = readAll(path, InputKind::Regular);
        work_.grant(bytes.size());
        if (isBuilding(bytes))
            refuse(record, "a storey is one room, and " + excerpt(name) + " is a building");
        Document room = parseDocument(bytes, path, options_, sceneSchemas());
        if (room.kind != DocumentKind::Environment)
            refuse(record, "a storey is a room, and " + excerpt(name) + " is a layout");
        sources_.push_back(path);
        sources_.insert(sources_.end(), room.sources.begin(), room.sources.end());
        const fs::path folder = fs::path(name).parent_path();
        for (Record& inner : room.records)
            for (const KeySpec& key : inner.schema().keys)
                if (key.role == Role::File && inner.has(key.name) && !folder.empty())
                    inner.set(key.name, (folder / inner.text(key.name)).lexically_normal().string(),
                              inner.keyPlace(key.name));
        return std::make_shared<const Document>(std::move(room));
    }

    /// Names the storey of the rooms that its plan has, of one read before those again.
    void listRooms(const std::string& storey, std::size_t before, bool is_new,
                   std::vector<FoundRoom>& plans) const {
        std::vector<FoundRoom>& all = options_.found->rooms;
        const auto first = all.begin() + static_cast<std::ptrdiff_t>(before);
        if (is_new) plans.assign(first, all.end());
        all.erase(first, all.end());
        for (FoundRoom room : plans) {
            room.storey = storey;
            all.push_back(std::move(room));
        }
    }

    /// A room, and those that its plan has.
    using Read = std::pair<std::shared_ptr<const Document>, std::vector<FoundRoom>>;

    const std::string& operand_;
    const ImportOptions& options_;
    Budget& work_;
    std::map<std::string, Read> rooms_;  // by canonical path
    std::vector<std::string> sources_;
};

/// Reads the rooms that records name; `rooms` has those inline.
void readRooms(const std::vector<Record>& records, RoomFiles& files,
               std::vector<std::shared_ptr<const Document>>& rooms) {
    Diagnostics findings;
    for (std::size_t i = 0; i < records.size(); ++i) {
        const Record& record = records[i];
        if (record.keyword() != kStorey) continue;
        const bool is_inline = rooms[i] != nullptr, has_file = record.has("file");
        if (is_inline == has_file)
            findings.add(
                record.finding(is_inline ? "storey: `file` and `records` are given, one is wanted"
                                         : "storey: its room is missing, wanted `file=ROOM` or, "
                                           "in YAML, `records`"));
        else if (has_file)
            try {
                rooms[i] = files.read(record);
            } catch (const FormatError& error) {
                findings.add(error);
                if (files.isOver()) break;
            }
    }
    findings.throwIfAny();
}

}  // namespace

bool isBuilding(std::string_view bytes) {
    if (isGlb(bytes)) return glbOtherText(bytes).has_value();
    constexpr std::string_view kVertices = "vertices";  // of Open-RMF
    if (bytes.find(kStorey) == std::string_view::npos &&
        bytes.find(kVertices) == std::string_view::npos)
        return false;
    bytes = withoutBom(bytes);
    if (isRecordText(bytes)) return hasStoreyLine(bytes);
    constexpr std::size_t kLooked = 4096;
    if (bytes.substr(0, kLooked).find('\0') != std::string_view::npos ||
        buildingImporter(bytes) != nullptr)
        return false;
    return xmlRootName(bytes).empty() && beginsAsYaml(bytes) && hasStoreyNode(bytes);
}

std::string StoreyedDocument::digest() const {
    if (isRoomAlone()) return environmentDigest(storeys.front().room->records);
    std::string text;
    for (const Storey& storey : storeys)
        text += formatRecord(storey.record) + ' ' + environmentDigest(storey.room->records) + '\n';
    for (const StoreyPassage& passage : passages) text += formatRecord(passage.record) + '\n';
    return sha256(text);
}

std::string StoreyedDocument::storeyList() const {
    std::string list;
    for (const Storey& storey : storeys) list += (list.empty() ? "" : ", ") + storey.id;
    return list;
}

bool callsStorey(const std::string& word, const std::string& id, const std::string& name) {
    const std::string folded = lowerCased(word);
    return lowerCased(id) == folded || (!name.empty() && lowerCased(name) == folded);
}

const Storey& StoreyedDocument::storey(const std::string& called) const {
    for (const Storey& storey : storeys)
        if (storey.id == called) return storey;
    for (const Storey& storey : storeys)
        if (storey.record.has("name") && storey.record.text("name") == called) return storey;
    for (const Storey& storey : storeys)
        if (callsStorey(called, storey.id,
                        storey.record.has("name") ? storey.record.text("name") : ""))
            return storey;
    if (called.starts_with("door:"))
        throw UsageError("the building has no storey " + excerpt(called) +
                         ": the storey comes first, as in " + storeys.front().id + "/door:NAME (" +
                         storeyList() + ')');
    throw UsageError("the building has no storey " + excerpt(called) +
                     didYouMean(called, idsOf(storeys)) + " (" + storeyList() + ')');
}

StoreyedDocument makeBuilding(std::vector<StoreyInput> inputs, std::vector<Record> passages,
                              const std::string& file) {
    StoreyedDocument building;
    Diagnostics findings;
    std::vector<Record> all;
    all.reserve(inputs.size() + passages.size());
    for (const StoreyInput& input : inputs) all.push_back(input.record);
    all.insert(all.end(), passages.begin(), passages.end());
    const std::vector<std::string> ids = assignIds(all);
    findDoubledIds(all, findings);
    if (inputs.empty()) findings.add({displayName(file), 0, 0, "the building has no storey"});
    if (inputs.size() > kMaxStoreys)
        findings.add({displayName(file), 0, 0,
                      "the building has more than " + std::to_string(kMaxStoreys) + " storeys"});
    findings.throwIfAny();
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        Record& record = inputs[i].record;
        checkRoomId(record, ids[i], findings);
        record.erase("file");
        const Tuple& at = record.tuple("at");
        Storey storey{record,
                      ids[i],
                      {{at[0], at[1]}, record.angle("heading")},
                      record.number("z"),
                      {},
                      std::move(inputs[i].room)};
        if (record.has("height")) storey.height = record.number("height");
        building.storeys.push_back(std::move(storey));
    }
    std::stable_sort(building.storeys.begin(), building.storeys.end(),
                     [](const Storey& a, const Storey& b) { return a.floor < b.floor; });
    for (std::size_t i = 0; i < passages.size(); ++i) {
        checkRoomId(passages[i], ids[inputs.size() + i], findings);
        const auto capacity = capacityOf(passages[i]);
        if (!capacity)
            findings.add(passages[i].finding(
                "capacity", "`capacity`: " + excerpt(passages[i].text("capacity")) +
                                " is no load such as 630kg"));
        auto storeys = storeysOf(passages[i], building.storeys, findings);
        building.passages.push_back({std::move(passages[i]), ids[inputs.size() + i],
                                     std::move(storeys), capacity.value_or(0)});
    }
    findings.throwIfAny();
    std::vector<const Document*> told;
    for (const Storey& storey : building.storeys) {
        if (std::find(told.begin(), told.end(), storey.room.get()) != told.end()) continue;
        told.push_back(storey.room.get());
        const Document& room = *storey.room;
        for (const std::string& note : room.notes)
            building.notes.push_back(storey.id + ": " + note);
        building.warnings.insert(building.warnings.end(), room.warnings.begin(),
                                 room.warnings.end());
    }
    return building;
}

StoreyedDocument readBuilding(std::string_view bytes, const std::string& operand,
                              const ImportOptions& options) {
    const auto compiled = glbOtherText(bytes);
    const std::string_view text = compiled ? std::string_view(*compiled) : bytes;
    Budget work(text.size(), options.max_work);
    Document head;
    std::vector<std::shared_ptr<const Document>> rooms;
    if (isRecordText(text)) {
        head = readRecordText(text, operand, buildingSchemas());
        rooms.resize(head.records.size());
    } else {
        const auto tree = parseYaml(text, operand);
        if (isRmfSite(tree->top())) return readRmfSite(tree->top(), operand, options, work);
        head = readYamlHead(text, operand);
        head.records = readBuildingYaml(text, operand, options, work, rooms);
    }
    MeshFiles meshes;
    ImportOptions of_rooms = options;
    of_rooms.storey.clear();
    of_rooms.max_work.whole = &work;
    of_rooms.meshes = &meshes;
    RoomFiles files(operand, of_rooms, work);
    readRooms(head.records, files, rooms);
    std::map<const Document*, std::shared_ptr<const Document>> loaded;
    std::vector<StoreyInput> storeys;
    std::vector<Record> passages;
    std::vector<std::string> sources = files.takeSources();
    for (std::size_t i = 0; i < head.records.size(); ++i) {
        Record& record = head.records[i];
        if (record.keyword() != kStorey) {
            passages.push_back(std::move(record));
            continue;
        }
        if (!record.has("file")) {
            auto [room, is_new] = loaded.try_emplace(rooms[i].get());
            if (is_new) {
                auto copy = std::make_shared<Document>(*rooms[i]);
                if (compiled) attachGlbMeshes(bytes, operand, copy->records);
                if (options.load_files) loadFiles(*copy, operand, of_rooms);
                sources.insert(sources.end(), copy->sources.begin(), copy->sources.end());
                room->second = std::move(copy);
            }
            rooms[i] = room->second;
        }
        storeys.push_back({std::move(record), std::move(rooms[i])});
    }
    StoreyedDocument building = makeBuilding(std::move(storeys), std::move(passages), operand);
    building.history = std::move(head.history);
    building.sources = std::move(sources);
    return building;
}

std::vector<std::size_t> storeysNamed(const StoreyedDocument& building, const std::string& name) {
    std::vector<std::size_t> storeys;
    const Glob named(name);
    for (std::size_t i = 0; i < building.storeys.size(); ++i)
        if (named.matches(building.storeys[i].id)) storeys.push_back(i);
    if (!storeys.empty()) return storeys;
    const Storey& one = building.storey(name);
    return {static_cast<std::size_t>(&one - building.storeys.data())};
}

StoreyText splitStoreys(const StoreyedDocument& building, std::string_view option,
                        const std::string& text) {
    StoreyText split{{}, text};
    const std::size_t slash = text.find('/');
    if (slash != std::string::npos) split.text = text.substr(slash + 1);
    try {
        split.storeys =
            storeysNamed(building, slash == std::string::npos ? "*" : text.substr(0, slash));
    } catch (const UsageError& error) {
        throw UsageError(std::string(option) + ": " + error.what());
    }
    return split;
}

}  // namespace ispace
