// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/written_ids.h"

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <unordered_set>
#include <utility>

#include "record/collector.h"
#include "record/text.h"

namespace ispace {

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
    const bool is_missing = std::any_of(records.begin(), records.end(),
                                        [](const Record& record) { return !record.has("id"); });
    const WrittenIds taken(is_missing ? std::span(records) : std::span<const Record>());
    // Automatic ids are unlike each other but where a keyword ends in a digit ("a" 11, "a1" 1).
    const bool may_meet = std::any_of(records.begin(), records.end(), [](const Record& record) {
        return record.keyword().back() >= '0' && record.keyword().back() <= '9';
    });
    std::unordered_set<std::string> made;
    std::map<std::string_view, std::size_t> count;
    std::vector<std::string> ids;
    ids.reserve(records.size());
    for (const Record& record : records) {
        std::string id = record.writtenId();
        while (id.empty()) {
            id = record.keyword() + std::to_string(++count[record.keyword()]);
            if (taken.contains(id) || (may_meet && !made.insert(id).second)) id.clear();
        }
        ids.push_back(std::move(id));
    }
    return ids;
}

}  // namespace ispace
