// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/collector.h"

#include "base/message.h"
#include "record/record.h"

namespace ispace {

std::string otherPlace(const Place& other, const Place& here) {
    const bool same = !other.file || !here.file || *other.file == *here.file;
    return (same ? "" : displayName(*other.file) + ' ') + "line " + std::to_string(other.line);
}

std::string knownWords(std::string_view word, const std::vector<std::string>& known) {
    std::string near = didYouMean(word, known);
    if (!near.empty()) return near;
    std::string all;
    for (const std::string& name : known) {
        all += all.empty() ? ", known: " : ", ";
        all += name;
    }
    return all;
}

bool RecordCollector::begin(std::string_view keyword, Spot spot, std::size_t keys) {
    const Schema* const schema = schemas_->find(keyword);
    if (schema == nullptr) {
        finding(spot, [&] {
            return "unknown keyword " + excerpt(keyword) +
                   knownWords(keyword, schemas_->keywords());
        });
        return false;
    }
    begin(*schema, spot, keys);
    return true;
}

void RecordCollector::begin(const Schema& schema, Spot spot, std::size_t keys) {
    current_.emplace(schema, file_.at(spot), keys);
    seen_.assign(schema.keys.size(), Spot{});
}

const KeySpec* RecordCollector::key(std::string_view name, Spot spot) {
    const Schema& schema = current_->schema();
    const KeySpec* const spec = schema.find(name);
    if (spec == nullptr) {
        finding(spot, [&] {
            return "unknown key " + excerpt(name) + knownWords(name, schema.keyNames());
        });
        return nullptr;
    }
    Spot& first = seen_[static_cast<std::size_t>(spec - schema.keys.data())];
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

void RecordCollector::text(const KeySpec& key, std::string_view text, Spot spot) {
    try {
        current_->setRead(key, parseValue(key, text), spot);
    } catch (const FormatError& error) {
        finding(spot, [&] { return error.diagnostics().front().message; });
    }
}

void RecordCollector::value(const KeySpec& key, Value value, Spot spot) {
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
