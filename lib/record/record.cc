// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/record.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

namespace ispace {

namespace {

std::string noKey(const Schema& schema, std::string_view key) {
    return schema.keyword + " has no key or value " + std::string(key);
}

}  // namespace

Diagnostic Place::finding(std::string message) const {
    Diagnostic diagnostic;
    if (file) diagnostic.file = *file;
    diagnostic.line = line;
    diagnostic.column = column;
    diagnostic.message = std::move(message);
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

void Record::set(std::string_view key, Value value, Place place) {
    const std::size_t index = indexOf(key);
    const KeySpec& spec = schema_->keys[index];
    try {
        checkValue(spec, value);
    } catch (const FormatError& error) {
        throw FormatError((place.file ? place : place_).finding(error.diagnostics()[0].message));
    }
    if (spec.default_value && *spec.default_value == value) {
        erase(key);
        return;
    }
    const auto at = std::find_if(entries_.begin(), entries_.end(),
                                 [&](const Entry& entry) { return entry.key >= index; });
    if (at != entries_.end() && at->key == index)
        *at = {index, std::move(value), std::move(place)};
    else
        entries_.insert(at, {index, std::move(value), std::move(place)});
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

const Place& Record::keyPlace(std::string_view key) const {
    const Entry* const entry = written(key);
    return entry != nullptr && entry->place.file != nullptr ? entry->place : place_;
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

std::vector<std::string> assignIds(const std::vector<Record>& records) {
    std::vector<std::string> ids;
    ids.reserve(records.size());
    std::set<std::string> taken;
    for (const Record& record : records) {
        ids.push_back(record.writtenId());
        if (!ids.back().empty()) taken.insert(ids.back());
    }
    std::map<std::string, std::size_t> count;
    for (std::size_t i = 0; i < records.size(); ++i) {
        if (!ids[i].empty()) continue;
        const std::string& keyword = records[i].keyword();
        do {
            ids[i] = keyword + std::to_string(++count[keyword]);
        } while (!taken.insert(ids[i]).second);
    }
    return ids;
}

}  // namespace ispace
