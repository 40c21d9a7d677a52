// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/collector.h"

#include <algorithm>

#include "base/suggest.h"
#include "base/utf8.h"

namespace ispace {

namespace {

/// "line 3", or with the file where that is another one.
std::string otherPlace(const Place& other, const Place& here) {
    const bool same = !other.file || !here.file || *other.file == *here.file;
    return (same ? "" : *other.file + ' ') + "line " + std::to_string(other.line);
}

/// The nearest of the known words, or all of them.
std::string hint(std::string_view word, const std::vector<std::string>& known) {
    std::string near = didYouMean(word, known);
    if (!near.empty()) return near;
    std::string all;
    for (const std::string& name : known) all += (all.empty() ? ", known: " : ", ") + name;
    return all;
}

}  // namespace

std::optional<Diagnostic> IdTable::add(const Record& record) {
    std::string id = record.writtenId();
    if (id.empty()) return std::nullopt;
    const Place& place = record.keyPlace("id");
    const auto [first, is_new] = places_.try_emplace(id, place);
    if (is_new) return std::nullopt;
    const bool placed = first->second.line > 0;
    return place.finding("doubled id `" + id + '`' +
                         (placed ? ", first used in " + otherPlace(first->second, place) : ""));
}

bool RecordCollector::begin(std::string_view keyword, const Place& place) {
    const Schema* const schema = schemas_->find(keyword);
    if (schema == nullptr) {
        finding(place, [&] {
            return "unknown keyword " + excerpt(keyword) + hint(keyword, schemas_->keywords());
        });
        return false;
    }
    current_.emplace(*schema, place);
    seen_.assign(schema->keys.size(), Place{});
    sound_ = true;
    return true;
}

const KeySpec* RecordCollector::key(std::string_view name, const Place& place) {
    const Schema& schema = current_->schema();
    const KeySpec* const spec = schema.find(name);
    if (spec == nullptr) {
        finding(place,
                [&] { return "unknown key " + excerpt(name) + hint(name, schema.keyNames()); });
        return nullptr;
    }
    Place& first = seen_[static_cast<std::size_t>(spec - schema.keys.data())];
    if (first.file != nullptr) {
        finding(place, [&] {
            return "doubled key `" + spec->name + "`, first in " +
                   (first.line == place.line ? "column " + std::to_string(first.column)
                                             : otherPlace(first, place));
        });
        return nullptr;
    }
    first = place;
    return spec;
}

void RecordCollector::text(const KeySpec& key, std::string_view text, const Place& place) {
    try {
        current_->set(key.name, parseValue(key, text), place);
    } catch (const FormatError& error) {
        finding(place, [&] { return error.diagnostics().front().message; });
    }
}

void RecordCollector::value(const KeySpec& key, Value value, const Place& place) {
    try {
        current_->set(key.name, std::move(value), place);
    } catch (const FormatError& error) {
        finding(place, [&] { return error.diagnostics().front().message; });
    }
}

void RecordCollector::end() {
    Record& record = *current_;
    const std::vector<KeySpec>& keys = record.schema().keys;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (!keys[i].required || seen_[i].file != nullptr) continue;
        finding(record.place(), [&] {
            return '`' + record.keyword() + "` wants the key `" + keys[i].name + "` (" +
                   keys[i].help + ')';
        });
    }
    if (auto doubled = ids_.add(record)) {
        sound_ = false;
        findings_.add(*std::move(doubled));
    }
    if (sound_) records_.push_back(std::move(record));
    current_.reset();
}

std::vector<Record> RecordCollector::take() {
    findings_.throwIfAny();
    return std::move(records_);
}

}  // namespace ispace
