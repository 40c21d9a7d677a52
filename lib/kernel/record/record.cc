// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/record.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "base/message.h"
#include "record/missing_keywords.h"
#include "record/text.h"

namespace ispace {

namespace {

std::string noKey(const Schema& schema, std::string_view key) {
    return schema.keyword + " has no key or value " + std::string(key);
}

}  // namespace

std::string SourcePosition::inclusion() const {
    constexpr int kMaxShown = 5;
    std::string text;
    int left = 0;
    for (const SourcePosition* place = included_from.get(); place != nullptr;
         place = place->included_from.get()) {
        if (++left > kMaxShown) continue;
        text += left == 1 ? " (included from " : ", from ";
        text += place->file ? displayName(*place->file) : "a program";
        text += ':' + std::to_string(place->line) + ':' + std::to_string(place->column);
    }
    if (left > kMaxShown) text += " and " + std::to_string(left - kMaxShown) + " more";
    return text.empty() ? text : text + ')';
}

Diagnostic SourcePosition::finding(std::string message) const {
    Diagnostic diagnostic;
    if (file) diagnostic.file = *file;
    diagnostic.line = line;
    diagnostic.column = column;
    diagnostic.message = std::move(message) + inclusion();
    return diagnostic;
}

Record::Record(const Schema& schema, SourcePosition place, std::size_t keys)
    : schema_(&schema), data_(std::make_shared<Data>()) {
    data_->place = std::move(place);
    data_->entries.reserve(std::min(keys, schema.keys.size()));
}

std::uint32_t Record::indexOf(std::string_view key) const {
    const KeySpec* const spec = schema_->find(key);
    if (spec == nullptr) throw std::logic_error(noKey(*schema_, key));
    return static_cast<std::uint32_t>(spec - schema_->keys.data());
}

Record::Data& Record::own() {
    // The temporary copy's release synchronizes with owners that dropped their reference, so their
    // reads happen before our writes.
    const bool is_shared = std::shared_ptr(data_).use_count() > 2;
    if (is_shared) data_ = std::make_shared<Data>(*data_);
    return *data_;
}

const Record::Entry* Record::written(std::string_view key) const {
    for (const Entry& entry : data_->entries)
        if (schema_->keys[entry.key].name == key) return &entry;
    return nullptr;
}

std::string Record::writtenId() const {
    // For bulk queries: `id` is the first key of most schemas, so the first entry tells.
    const std::vector<Entry>& entries = data_->entries;
    if (!entries.empty() && entries.front().key > 0 && schema_->keys.front().name == "id")
        return "";
    const Entry* const entry = written("id");
    return entry == nullptr ? "" : std::get<std::string>(entry->value);
}

bool Record::has(std::string_view key) const { return written(key) != nullptr; }

void Record::set(std::string_view key, Value value, const SourcePosition& place) {
    const std::uint32_t index = indexOf(key);
    const KeySpec& spec = schema_->keys[index];
    try {
        checkValue(spec, value);
    } catch (const FormatError& error) {
        throw FormatError(
            (place.file ? place : data_->place).finding(error.diagnostics()[0].message));
    }
    Entry entry{{}, index, std::move(value)};
    const SourcePosition& own_place = data_->place;
    const bool is_here = own_place.file && place.file && *place.file == *own_place.file &&
                         place.included_from == own_place.included_from;
    if (is_here) entry.spot = {place.line, place.column};
    std::optional<SourcePosition> elsewhere;
    if (place.file && !is_here) elsewhere = place;
    // Read the argument before this: it may refer into the data that own() and put() free.
    Data& data = own();
    if (data.rare || elsewhere) {
        Rare rare = data.rare ? *data.rare : Rare();
        std::erase_if(rare.elsewhere, [&](const auto& other) { return other.first == index; });
        if (elsewhere) rare.elsewhere.emplace_back(index, *std::move(elsewhere));
        data.rare = std::make_shared<const Rare>(std::move(rare));
    }
    put(data, spec, std::move(entry));
}

void Record::setMesh(std::shared_ptr<const TriangleMesh> mesh) {
    Data& data = own();
    Rare rare = data.rare ? *data.rare : Rare();
    rare.mesh = std::move(mesh);
    data.rare = std::make_shared<const Rare>(std::move(rare));
}

void Record::setRead(const KeySpec& key, Value value, LineColumn spot) {
    const auto index = static_cast<std::uint32_t>(&key - schema_->keys.data());
    put(*data_, key, {spot, index, std::move(value)});
}

void Record::put(Data& data, const KeySpec& spec, Entry entry) {
    std::vector<Entry>& entries = data.entries;
    const auto at = std::find_if(entries.begin(), entries.end(),
                                 [&](const Entry& other) { return other.key >= entry.key; });
    const bool replaces = at != entries.end() && at->key == entry.key;
    if (spec.default_value && *spec.default_value == entry.value) {
        if (replaces) entries.erase(at);
    } else if (replaces) {
        *at = std::move(entry);
    } else {
        entries.insert(at, std::move(entry));
    }
}

void Record::erase(std::string_view key) {
    const std::uint32_t index = indexOf(key);
    if (written(key) != nullptr)
        std::erase_if(own().entries, [&](const Entry& entry) { return entry.key == index; });
}

const Value* Record::find(std::string_view key) const {
    if (const Entry* const entry = written(key)) return &entry->value;
    const auto& standard = schema_->keys[indexOf(key)].default_value;
    return standard ? &*standard : nullptr;
}

template <typename T>
const T& Record::get(std::string_view key) const {
    const Value* const value = find(key);
    const T* const held = value == nullptr ? nullptr : std::get_if<T>(value);
    if (held == nullptr) throw std::logic_error(noKey(*schema_, key));
    return *held;
}

bool Record::flag(std::string_view key) const { return get<bool>(key); }
double Record::number(std::string_view key) const { return get<double>(key); }
const std::string& Record::text(std::string_view key) const { return get<std::string>(key); }
const Tuple& Record::tuple(std::string_view key) const { return get<Tuple>(key); }
const TupleList& Record::list(std::string_view key) const { return get<TupleList>(key); }

Diagnostic Record::finding(std::string message) const {
    return data_->place.finding(std::move(message));
}

SourcePosition Record::keyPlace(std::string_view key) const {
    const Entry* const entry = written(key);
    if (entry == nullptr) return data_->place;
    if (data_->rare)
        for (const auto& [other, place] : data_->rare->elsewhere)
            if (other == entry->key) return place;
    return entry->spot.line == 0 ? data_->place : data_->place.at(entry->spot);
}

Diagnostic Record::finding(std::string_view key, std::string message) const {
    return keyPlace(key).finding(std::move(message));
}

bool operator==(const Record& a, const Record& b) {
    if (a.data_ == b.data_ && a.schema_ == b.schema_) return true;
    const std::vector<Record::Entry>&x_entries = a.data_->entries, &y_entries = b.data_->entries;
    return a.keyword() == b.keyword() &&
           std::equal(x_entries.begin(), x_entries.end(), y_entries.begin(), y_entries.end(),
                      [&](const Record::Entry& x, const Record::Entry& y) {
                          return a.schema_->keys[x.key].name == b.schema_->keys[y.key].name &&
                                 x.value == y.value;
                      });
}

namespace {

std::uint64_t hashOf(std::string_view id) { return std::hash<std::string_view>{}(id); }

Diagnostic doubledId(const Record& record, const Record& first) {
    const SourcePosition place = record.keyPlace("id"), other = first.keyPlace("id");
    std::string message = "doubled id `" + record.writtenId() + '`';
    const bool same_line =
        place.file && other.file && *place.file == *other.file && place.line == other.line;
    if (same_line && place.column == other.column)
        message += ", read from here a second time";
    else if (other.line > 0)
        message += ", first used in " + otherPlace(other, place);
    return place.finding(std::move(message));
}

/// Indices of a record that repeats an id and of the first record with that id.
struct Doubled {
    std::size_t record, first;
};

/// Finds all records with repeated ids, in order. Sorts hashes, which is much faster than building
/// a tree or hash table of strings. O(n log n)
std::vector<Doubled> doubledIds(std::span<const Record> records) {
    std::vector<std::pair<std::uint64_t, std::size_t>> ids;  // hash and record
    ids.reserve(records.size());
    for (std::size_t i = 0; i < records.size(); ++i)
        if (records[i].has("id")) ids.emplace_back(hashOf(records[i].text("id")), i);
    std::sort(ids.begin(), ids.end());
    std::vector<Doubled> doubled;
    for (std::size_t begin = 0, end = 0; begin < ids.size(); begin = end) {
        while (end < ids.size() && ids[end].first == ids[begin].first) ++end;
        if (end - begin < 2) continue;
        std::map<std::string_view, std::size_t> first;  // among equal hashes
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t record = ids[i].second;
            const auto [known, is_new] = first.try_emplace(records[record].text("id"), record);
            if (!is_new) doubled.push_back({record, known->second});
        }
    }
    std::sort(doubled.begin(), doubled.end(),
              [](const Doubled& a, const Doubled& b) { return a.record < b.record; });
    return doubled;
}

}  // namespace

void findDoubledIds(std::span<const Record> records, Diagnostics& findings) {
    for (const auto& [record, first] : doubledIds(records))
        findings.add(findings.full() ? Diagnostic{} : doubledId(records[record], records[first]));
}

void checkIds(const std::vector<Record>& records) {
    Diagnostics findings;
    findDoubledIds(records, findings);
    findings.throwIfAny();
}

std::vector<std::string> assignIds(const std::vector<Record>& records) {
    std::vector<std::string> ids;
    ids.reserve(records.size());
    for (const Record& record : records) ids.push_back(record.writtenId());
    const IdTable taken(ids.size(), [&ids](std::size_t i) { return std::string_view(ids[i]); });
    // Automatic ids can only collide if a keyword ends in a digit ("a" 11, "a1" 1).
    const bool may_meet = std::any_of(records.begin(), records.end(), [](const Record& record) {
        return record.keyword().back() >= '0' && record.keyword().back() <= '9';
    });
    std::unordered_set<std::string> made;
    std::unordered_map<std::string_view, std::size_t> count;
    for (std::size_t i = 0; i < records.size(); ++i) {
        if (!ids[i].empty()) continue;
        std::size_t& number = count[records[i].keyword()];
        std::string id;
        while (id.empty()) {
            id = records[i].keyword();
            id += std::to_string(++number);
            if (taken.find(id) || (may_meet && !made.insert(id).second)) id.clear();
        }
        ids[i] = std::move(id);
    }
    return ids;
}

std::string otherPlace(const SourcePosition& other, const SourcePosition& here) {
    const bool same = !other.file || !here.file || *other.file == *here.file;
    return (same ? "" : displayName(*other.file) + ' ') + "line " + std::to_string(other.line);
}

namespace {

/// Returns the hint for a keyword, or a key as KEYWORD.KEY, of an extension that is not built in;
/// "" for others.
std::string missingHint(std::string_view name) {
    const std::string_view extension = missingExtension(name);
    if (extension.empty()) return "";
    return ", which the extension " + std::string(extension) +
           " reads: this build lacks that extension";
}

}  // namespace

std::string spellingHint(std::string_view word, const std::vector<std::string>& known) {
    if (std::string missing = missingHint(word); !missing.empty()) return missing;
    std::string near = didYouMean(word, known);
    if (!near.empty()) return near;
    std::string all;
    for (const std::string& name : known) {
        all += all.empty() ? ", known: " : ", ";
        all += name;
    }
    return all;
}

bool RecordCollector::begin(std::string_view keyword, LineColumn spot, std::size_t keys) {
    const Schema* const schema = schemas_->find(keyword);
    if (schema == nullptr) {
        finding(spot, [&] {
            return "unknown keyword " + excerpt(keyword) +
                   spellingHint(keyword, schemas_->keywords());
        });
        return false;
    }
    begin(*schema, spot, keys);
    return true;
}

void RecordCollector::begin(const Schema& schema, LineColumn spot, std::size_t keys) {
    current_.emplace(schema, file_.at(spot), keys);
    seen_.assign(schema.keys.size(), LineColumn{});
}

const KeySpec* RecordCollector::key(std::string_view name, LineColumn spot) {
    const Schema& schema = current_->schema();
    const KeySpec* const spec = schema.find(name);
    if (spec == nullptr) {
        finding(spot, [&] {
            std::string full = schema.keyword + '.';
            const std::string missing = missingHint(full.append(name));
            return "unknown key " + excerpt(name) +
                   (missing.empty() ? spellingHint(name, schema.keyNames()) : missing);
        });
        return nullptr;
    }
    LineColumn& first = seen_[static_cast<std::size_t>(spec - schema.keys.data())];
    if (first.line > 0) {
        finding(spot, [&] {
            return "doubled key `" + spec->name + "`, first in " +
                   (first.line == spot.line ? "column " + std::to_string(first.column)
                                            : "line " + std::to_string(first.line));
        });
        return nullptr;
    }
    first = spot;
    return spec;
}

bool RecordCollector::isGiven(const KeySpec& key) const {
    return seen_[static_cast<std::size_t>(&key - current_->schema().keys.data())].line > 0;
}

void RecordCollector::text(const KeySpec& key, std::string_view text, LineColumn spot) {
    try {
        current_->setRead(key, parseValue(key, text), spot);
    } catch (const FormatError& error) {
        finding(spot, [&] { return error.diagnostics().front().message; });
    }
}

void RecordCollector::value(const KeySpec& key, Value value, LineColumn spot) {
    seen_[static_cast<std::size_t>(&key - current_->schema().keys.data())] = spot;
    current_->setRead(key, std::move(value), spot);
}

Record RecordCollector::finish() {
    const std::vector<KeySpec>& keys = current_->schema().keys;
    for (const KeySpec& key : keys) {
        if (!key.required || isGiven(key)) continue;
        finding(current_->place(), [&] {
            return '`' + current_->keyword() + "` wants the key `" + key.name + "` (" + key.help +
                   ')';
        });
    }
    Record record = *std::move(current_);
    current_.reset();
    return record;
}

void RecordCollector::end() {
    records_.push_back(finish());
    checkCount();
}

void RecordCollector::append(RecordCollector&& next) {
    records_.insert(records_.end(), std::move_iterator(next.records_.begin()),
                    std::move_iterator(next.records_.end()));
    checkCount();
}

void RecordCollector::checkCount() const {
    if (records_.size() > kMaxRecords)
        throw FormatError(
            records_.back().place().finding("more than " + std::to_string(kMaxRecords) +
                                            " records, the most that an input may have"));
}

std::vector<Record> RecordCollector::take() {
    findDoubledIds(records_, findings_);
    findings_.throwIfAny();
    return std::move(records_);
}

}  // namespace ispace
