// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/record.h"

#include <algorithm>
#include <stdexcept>

namespace ispace {

namespace {

std::string noKey(const Schema& schema, std::string_view key) {
    return schema.keyword + " has no key or value " + std::string(key);
}

}  // namespace

std::string Place::inclusion() const {
    constexpr int kMostShown = 5;
    std::string text;
    int left = 0;
    for (const Place* place = included_from.get(); place != nullptr;
         place = place->included_from.get()) {
        if (++left > kMostShown) continue;
        text += left == 1 ? " (included from " : ", from ";
        text += place->file ? displayName(*place->file) : "a program";
        text += ':' + std::to_string(place->line) + ':' + std::to_string(place->column);
    }
    if (left > kMostShown) text += " and " + std::to_string(left - kMostShown) + " more";
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

}  // namespace ispace
