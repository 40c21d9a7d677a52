// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/record.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "record/collector.h"
#include "record/id_table.h"
#include "record/text.h"

namespace ispace {

namespace {

std::string noKey(const Schema& schema, std::string_view key) {
    return schema.keyword + " has no key or value " + std::string(key);
}

}  // namespace

std::string Place::inclusion() const {
    constexpr int kMaxShown = 5;
    std::string text;
    int left = 0;
    for (const Place* place = included_from.get(); place != nullptr;
         place = place->included_from.get()) {
        if (++left > kMaxShown) continue;
        text += left == 1 ? " (included from " : ", from ";
        text += place->file ? displayName(*place->file) : "a program";
        text += ':' + std::to_string(place->line) + ':' + std::to_string(place->column);
    }
    if (left > kMaxShown) text += " and " + std::to_string(left - kMaxShown) + " more";
    return text.empty() ? text : text + ')';
}

Diagnostic Place::finding(std::string message) const {
    Diagnostic diagnostic;
    if (file) diagnostic.file = *file;
    diagnostic.line = line;
    diagnostic.column = column;
    diagnostic.message = std::move(message) + inclusion();
    return diagnostic;
}

std::size_t Record::indexOf(std::string_view key) const {
    const KeySpec* const spec = schema_->find(key);
    if (spec == nullptr) throw std::logic_error(noKey(*schema_, key));
    return static_cast<std::size_t>(spec - schema_->keys.data());
}

const Record::Entry* Record::written(std::string_view key) const {
    for (const Entry& entry : entries_)
        if (schema_->keys[entry.key].name == key) return &entry;
    return nullptr;
}

std::string Record::writtenId() const {
    const Entry* const entry = written("id");
    return entry == nullptr ? "" : std::get<std::string>(entry->value);
}

bool Record::has(std::string_view key) const { return written(key) != nullptr; }

void Record::set(std::string_view key, Value value, const Place& place) {
    const std::size_t index = indexOf(key);
    const KeySpec& spec = schema_->keys[index];
    try {
        checkValue(spec, value);
    } catch (const FormatError& error) {
        throw FormatError((place.file ? place : place_).finding(error.diagnostics()[0].message));
    }
    Entry entry{index, {}, nullptr, std::move(value)};
    const bool here = place_.file && place.file && *place.file == *place_.file &&
                      place.included_from == place_.included_from;
    if (here)
        entry.spot = {place.line, place.column};
    else if (place.file)
        entry.elsewhere = std::make_shared<const Place>(place);
    put(std::move(entry));
}

void Record::setRead(const KeySpec& key, Value value, Spot spot) {
    put({static_cast<std::size_t>(&key - schema_->keys.data()), spot, nullptr, std::move(value)});
}

void Record::put(Entry entry) {
    const KeySpec& spec = schema_->keys[entry.key];
    const auto at = std::find_if(entries_.begin(), entries_.end(),
                                 [&](const Entry& other) { return other.key >= entry.key; });
    const bool replaces = at != entries_.end() && at->key == entry.key;
    if (spec.default_value && *spec.default_value == entry.value) {
        if (replaces) entries_.erase(at);
    } else if (replaces) {
        *at = std::move(entry);
    } else {
        entries_.insert(at, std::move(entry));
    }
}

void Record::erase(std::string_view key) {
    const std::size_t index = indexOf(key);
    std::erase_if(entries_, [&](const Entry& entry) { return entry.key == index; });
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

Diagnostic Record::finding(std::string message) const { return place_.finding(std::move(message)); }

Place Record::keyPlace(std::string_view key) const {
    const Entry* const entry = written(key);
    if (entry == nullptr) return place_;
    if (entry->elsewhere) return *entry->elsewhere;
    return entry->spot.line == 0 ? place_ : place_.at(entry->spot);
}

Diagnostic Record::finding(std::string_view key, std::string message) const {
    return keyPlace(key).finding(std::move(message));
}

bool operator==(const Record& a, const Record& b) {
    return a.keyword() == b.keyword() &&
           std::equal(a.entries_.begin(), a.entries_.end(), b.entries_.begin(), b.entries_.end(),
                      [&](const Record::Entry& x, const Record::Entry& y) {
                          return a.schema_->keys[x.key].name == b.schema_->keys[y.key].name &&
                                 x.value == y.value;
                      });
}

namespace {

std::uint64_t hashOf(std::string_view id) { return std::hash<std::string_view>{}(id); }

Diagnostic doubledId(const Record& record, const Record& first) {
    const Place place = record.keyPlace("id"), other = first.keyPlace("id");
    std::string message = "doubled id `" + record.writtenId() + '`';
    const bool same_line =
        place.file && other.file && *place.file == *other.file && place.line == other.line;
    if (same_line && place.column == other.column)
        message += ", read from here a second time";
    else if (other.line > 0)
        message += ", first used in " + otherPlace(other, place);
    return place.finding(std::move(message));
}

}  // namespace

WrittenIds::WrittenIds(std::span<const Record> records) : records_(records) {
    entries_.reserve(records.size());
    for (std::size_t i = 0; i < records.size(); ++i)
        if (records[i].has("id")) entries_.push_back({hashOf(records[i].text("id")), i});
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
        return std::tie(a.hash, a.record) < std::tie(b.hash, b.record);
    });
}

std::string_view WrittenIds::id(const Entry& entry) const {
    return records_[entry.record].text("id");
}

bool WrittenIds::contains(std::string_view id) const {
    const std::uint64_t hash = hashOf(id);
    const auto first = std::lower_bound(
        entries_.begin(), entries_.end(), hash,
        [](const Entry& entry, std::uint64_t wanted) { return entry.hash < wanted; });
    return std::any_of(first,
                       std::find_if(first, entries_.end(),
                                    [hash](const Entry& entry) { return entry.hash != hash; }),
                       [&](const Entry& entry) { return this->id(entry) == id; });
}

std::vector<WrittenIds::Doubled> WrittenIds::doubled() const {
    std::vector<Doubled> doubled;
    for (std::size_t begin = 0, end = 0; begin < entries_.size(); begin = end) {
        while (end < entries_.size() && entries_[end].hash == entries_[begin].hash) ++end;
        if (end - begin < 2) continue;
        std::map<std::string_view, std::size_t> first;  // of equal hashes
        for (std::size_t i = begin; i < end; ++i) {
            const auto [known, is_new] = first.try_emplace(id(entries_[i]), entries_[i].record);
            if (!is_new) doubled.push_back({entries_[i].record, known->second});
        }
    }
    std::sort(doubled.begin(), doubled.end(),
              [](const Doubled& a, const Doubled& b) { return a.record < b.record; });
    return doubled;
}

void findDoubledIds(std::span<const Record> records, Diagnostics& findings) {
    for (const auto& [record, first] : WrittenIds(records).doubled())
        findings.add(findings.full() ? Diagnostic{} : doubledId(records[record], records[first]));
}

void checkIds(const std::vector<Record>& records) {
    Diagnostics findings;
    findDoubledIds(records, findings);
    findings.throwIfAny();
}

std::vector<std::string> assignIds(const std::vector<Record>& records) {
    const IdTable taken(records.size(), [&records](std::size_t i) {
        return records[i].has("id") ? std::string_view(records[i].text("id")) : std::string_view();
    });
    // Automatic ids are unlike each other but where a keyword ends in a digit ("a" 11, "a1" 1).
    const bool may_meet = std::any_of(records.begin(), records.end(), [](const Record& record) {
        return record.keyword().back() >= '0' && record.keyword().back() <= '9';
    });
    std::unordered_set<std::string> made;
    std::unordered_map<std::string_view, std::size_t> count;
    std::vector<std::string> ids;
    ids.reserve(records.size());
    for (const Record& record : records) {
        std::string id = record.writtenId();
        while (id.empty()) {
            id = record.keyword();
            id += std::to_string(++count[record.keyword()]);
            if (taken.find(id) || (may_meet && !made.insert(id).second)) id.clear();
        }
        ids.push_back(std::move(id));
    }
    return ids;
}

}  // namespace ispace
