// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/edit.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <unordered_set>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "geom/point.h"
#include "geom/pose.h"
#include "record/text.h"

namespace ispace {

namespace {

/// Calls visit(key) for each written key with the role.
template <typename Visit>
void forEachWritten(const Record& record, Role role, Visit visit) {
    for (const KeySpec& key : record.schema().keys)
        if (key.role == role && record.has(key.name)) visit(key);
}

const KeySpec* keyOf(const Schema& schema, Role role) {
    const auto found = std::find_if(schema.keys.begin(), schema.keys.end(),
                                    [role](const KeySpec& key) { return key.role == role; });
    return found == schema.keys.end() ? nullptr : &*found;
}

/// Returns the keys that hold the record's position: the written ones, else the one with a default.
std::vector<const KeySpec*> placeKeys(const Record& record) {
    std::vector<const KeySpec*> keys;
    forEachWritten(record, Role::Place, [&keys](const KeySpec& key) { keys.push_back(&key); });
    if (!keys.empty()) return keys;
    for (const KeySpec& key : record.schema().keys)
        if (key.role == Role::Place && key.default_value) keys.push_back(&key);
    return keys;
}

/// File name in the source locations of added records.
constexpr const char* kAdded = "--add";

/// Parses the record of an edit that adds one.
Record addedRecord(const Edit& edit, const Schemas& schemas) {
    if (edit.kind == Edit::Kind::Add) return readRecord(edit.text, kAdded, schemas);
    const Schema* const schema = schemas.find("fence");
    if (schema == nullptr) throw std::logic_error("no schema of fences");
    Record fence(*schema);
    try {
        fence.set("path", parseValue(*schema->find("path"), edit.text));
    } catch (const FormatError& error) {
        throw FormatError(Diagnostic{
            "", 0, 0,
            optionOf(edit.kind) + ' ' + edit.text + ": " + error.diagnostics().front().message});
    }
    fence.set("closed", edit.closed);
    return fence;
}

class Editor {
  public:
    Editor(std::vector<Record> records, std::vector<std::string> ids, const Schemas& schemas)
        : records_(std::move(records)), ids_(std::move(ids)), schemas_(schemas) {}

    void apply(const Edit& edit) {
        edit_ = &edit;
        switch (edit.kind) {
            case Edit::Kind::Add:
            case Edit::Kind::Fence:
                return add(addedRecord(edit, schemas_));
            case Edit::Kind::Delete:
                return erase();
            default:
                break;
        }
        std::vector<std::size_t> places = found();
        // A glob skips records that the edit cannot change; they follow their carrier or wall, or
        // stay.
        if (places.size() > 1) {
            const std::vector<std::size_t> all = places;
            std::erase_if(places, [&](std::size_t i) { return !isMeant(records_[i], all); });
            if (places.empty()) fail("nothing of what matches can be changed so");
        }
        for (const std::size_t i : places) change(i);
    }

    /// \throws FormatError if a record references a removed one
    std::vector<Record> finish() {
        checkReferences();
        std::erase_if(records_, [](const Record& r) { return r.keyword() == "result"; });
        return std::move(records_);
    }

    /// Writes the automatic ids that would otherwise shift to other records.
    void keepIds() {
        if (keeps_ids_) return;
        const std::vector<std::string> now = assignIds(records_);
        std::set<std::string> shifted;  // keywords
        for (std::size_t i = 0; i < records_.size(); ++i)
            if (now[i] != ids_[i]) shifted.insert(records_[i].keyword());
        if (shifted.empty()) return;
        for (std::size_t i = 0; i < records_.size(); ++i)
            if (shifted.count(records_[i].keyword()) > 0) records_[i].set("id", ids_[i]);
    }

  private:
    /// Returns true if the edit changes this record, one of several that match its glob.
    [[nodiscard]] bool isMeant(const Record& record, const std::vector<std::size_t>& all) const {
        const Schema& schema = record.schema();
        switch (edit_->kind) {
            case Edit::Kind::Move:
                return placeOf(record) && !isOnOneOf(record, all);
            case Edit::Kind::Forward:
                return placeOf(record) && keyOf(schema, Role::Heading) != nullptr &&
                       !isOnOneOf(record, all);
            case Edit::Kind::Rotate:
                return placeOf(record) && !isOnOneOf(record, all);
            case Edit::Kind::Tilt:
                return keyOf(schema, Role::Tilt) != nullptr;
            default:
                return true;
        }
    }

    [[nodiscard]] bool isOnOneOf(const Record& record, const std::vector<std::size_t>& all) const {
        bool is_on = false;
        forEachWritten(record, Role::Carrier, [&](const KeySpec& key) {
            is_on = std::any_of(all.begin(), all.end(),
                                [&](std::size_t i) { return ids_[i] == record.text(key.name); });
        });
        return is_on;
    }

    void checkReferences() {
        if (removed_.empty()) return;
        Diagnostics findings;
        for (std::size_t i = 0; i < records_.size(); ++i)
            for (const Role role : {Role::Carrier, Role::Reference})
                forEachWritten(records_[i], role, [&](const KeySpec& key) {
                    const std::string& named = records_[i].text(key.name);
                    if (removed_.count(named) == 0 || taken().count(named) > 0) return;
                    std::string message = "--delete " + named + ": `";
                    for (const std::string& part :
                         {ids_[i], std::string("` has `"), key.name, std::string("="), named})
                        message += part;
                    message += "`; delete it, too, or set that anew";
                    findings.add(Diagnostic{"", 0, 0, std::move(message)});
                });
        findings.throwIfAny();
    }

    [[noreturn]] void fail(const std::string& message) const {
        throw FormatError(
            Diagnostic{"", 0, 0, optionOf(edit_->kind) + ' ' + edit_->text + ": " + message});
    }

    /// Finds the records that match the glob, in order. \throws FormatError without a match
    [[nodiscard]] std::vector<std::size_t> found() const {
        std::vector<std::size_t> places;
        for (std::size_t i = 0; i < ids_.size(); ++i)
            if (edit_->ids.matches(ids_[i])) places.push_back(i);
        if (places.empty()) fail("no record has the id `" + edit_->ids.text() + '`' + knownIds());
        return places;
    }

    /// Suggests a similar id, else lists the known ids: the last ones if there are many, as layouts
    /// follow rooms.
    [[nodiscard]] std::string knownIds() const {
        constexpr std::size_t kMaxNames = 20;
        std::string text = edit_->ids.isPattern() ? "" : didYouMean(edit_->ids.text(), ids_);
        if (!text.empty() || ids_.empty()) return text;
        const bool is_cut = ids_.size() > kMaxNames;
        text = "; there are ";
        if (is_cut) text += std::to_string(ids_.size()) + " ids, among them ";
        const std::size_t first = is_cut ? ids_.size() - kMaxNames : 0;
        for (std::size_t i = first; i < ids_.size(); ++i)
            text.append(i == first ? "" : ", ").append(ids_[i]);
        return text;
    }

    [[nodiscard]] const Record& holderOf(const std::string& id) const {
        const auto found = std::find(ids_.begin(), ids_.end(), id);
        return records_.at(static_cast<std::size_t>(found - ids_.begin()));
    }

    /// Returns the set of the ids, which most edits do not read.
    [[nodiscard]] std::unordered_set<std::string>& taken() {
        if (!taken_) taken_.emplace(ids_.begin(), ids_.end(), 2 * ids_.size());
        return *taken_;
    }

    void add(Record record) {
        keeps_ids_ = false;
        std::string id = record.writtenId();
        if (id.empty()) {
            std::size_t& n = count_[record.keyword()];
            do {
                id = record.keyword() + std::to_string(++n);
            } while (!taken().insert(id).second);
        } else if (!taken().insert(id).second) {
            fail(takenText(id, holderOf(id)));
        }
        records_.push_back(std::move(record));
        ids_.push_back(std::move(id));
    }

    void erase() {
        keeps_ids_ = false;
        std::vector<Record> records;
        std::vector<std::string> ids;
        records.reserve(records_.size());
        ids.reserve(ids_.size());
        const std::vector<std::size_t> places = found();
        auto next = places.begin();
        for (std::size_t i = 0; i < records_.size(); ++i) {
            if (next != places.end() && *next == i) {
                if (taken_) taken_->erase(ids_[i]);
                removed_.insert(std::move(ids_[i]));
                ++next;
                continue;
            }
            records.push_back(std::move(records_[i]));
            ids.push_back(std::move(ids_[i]));
        }
        records_ = std::move(records);
        ids_ = std::move(ids);
    }

    void change(std::size_t i) {
        Record& record = records_[i];
        try {
            switch (edit_->kind) {
                case Edit::Kind::Set:
                    return set(i);
                case Edit::Kind::Move:
                    return shift(record, edit_->by);
                case Edit::Kind::Forward:
                    return forward(record);
                case Edit::Kind::Rotate:
                    return rotate(record);
                case Edit::Kind::Tilt:
                    return turn(record, Role::Tilt, "cannot be tilted");
                default:
                    break;
            }
        } catch (const FormatError& error) {
            const std::string& message = error.diagnostics().front().message;
            if (message.starts_with("--")) throw;
            fail('`' + ids_[i] + "`: " + message);
        }
    }

    void set(std::size_t i) {
        Record& record = records_[i];
        const KeySpec* const key = record.schema().find(edit_->key);
        if (key == nullptr)
            fail("a " + record.keyword() + " has no key `" + edit_->key + '`' +
                 didYouMean(edit_->key, record.schema().keyNames()));
        if (edit_->value.empty()) {
            if (edit_->key == "id") fail("an id cannot be left out, others may name it");
            if (key->required) fail("a " + record.keyword() + " must have `" + edit_->key + '`');
            record.erase(edit_->key);
        } else {
            if (key->role == Role::File) forgetContent(record);
            record.set(edit_->key, parseValue(*key, edit_->value));
        }
        if (edit_->key == "id") rename(i);
    }

    /// Removes the loaded content and its digest after a change of the file name.
    static void forgetContent(Record& record) {
        record.setMesh(nullptr);
        if (record.schema().find("digest") != nullptr) record.erase("digest");
    }

    void rename(std::size_t i) {
        const std::string id = records_[i].writtenId();
        keeps_ids_ = false;
        if (id == ids_[i]) return;
        if (!taken().insert(id).second) fail(takenText(id, holderOf(id)));
        for (Record& record : records_)
            for (const Role role : {Role::Carrier, Role::Reference})
                forEachWritten(record, role, [&](const KeySpec& key) {
                    if (record.text(key.name) == ids_[i]) record.set(key.name, id);
                });
        taken().erase(ids_[i]);
        ids_[i] = id;
    }

    static void shift(Record& record, Vec3 by) {
        if (!placeOf(record)) throw noPlace(record);
        if (by.z != 0 && !canRise(record))
            throw FormatError(Diagnostic{"", 0, 0, "has no height to move by"});
        moveInFrame(record, {{by.x, by.y}, {}}, by.z);
    }

    static FormatError noPlace(const Record& record) {
        std::string message = "has no place of its own";
        if (keyOf(record.schema(), Role::Reference) != nullptr && record.has("offset"))
            return FormatError(Diagnostic{
                "", 0, 0, message + ": it is in its wall, move it with --set ID.offset=M"});
        for (const KeySpec& key : record.schema().keys)
            if (key.role == Role::Place && !key.default_value) {
                message += ", give it one with --set ID." + key.name + "=X,Y";
                break;
            }
        return FormatError(Diagnostic{"", 0, 0, std::move(message)});
    }

    void forward(Record& record) const {
        const KeySpec* const heading = keyOf(record.schema(), Role::Heading);
        if (heading == nullptr || record.find(heading->name) == nullptr)
            throw FormatError(Diagnostic{"", 0, 0, "has no heading to go along"});
        const CosSin ahead = cosSin(record.angle(heading->name));
        shift(record, {edit_->by.x * ahead.cos, edit_->by.x * ahead.sin, 0});
    }

    void rotate(Record& record) const {
        const std::vector<const KeySpec*> keys = placeKeys(record);
        // Two ends, or a path; other records have one point and a heading.
        const bool by_points =
            keys.size() > 1 || (keys.size() == 1 && keys[0]->type == KeyType::TupleList);
        if (!by_points) return turn(record, Role::Heading, "cannot be rotated");
        Box2 box;
        const auto add = [&box](const Tuple& place) { box.add({place[0], place[1]}); };
        for (const KeySpec* key : keys) {
            const Value& value = *record.find(key->name);
            if (const Tuple* tuple = std::get_if<Tuple>(&value))
                add(*tuple);
            else
                for (const Tuple& place : std::get<TupleList>(value)) add(place);
        }
        moveInFrame(record, turnAbout(box.center(), edit_->angle, {}));
    }

    void turn(Record& record, Role role, const char* refusal) const {
        const KeySpec* const key = keyOf(record.schema(), role);
        if (key == nullptr || record.find(key->name) == nullptr)
            throw FormatError(
                Diagnostic{"", 0, 0, std::string("a ") + record.keyword() + ' ' + refusal});
        const double now = record.number(key->name);
        record.set(key->name, role == Role::Heading ? turnedHeading(now, edit_->angle)
                                                    : decimalSum(now, edit_->angle.degrees()));
    }

    std::vector<Record> records_;
    std::vector<std::string> ids_;  // by record, fixed except for --set ID.id
    std::optional<std::unordered_set<std::string>> taken_;  // the same ids, once required
    bool keeps_ids_ = true;                     // no edit so far may have shifted automatic ids
    std::set<std::string> removed_;             // by --delete
    std::map<std::string, std::size_t> count_;  // last number of added records, by keyword
    const Schemas& schemas_;
    const Edit* edit_ = nullptr;
};

}  // namespace

std::string takenText(const std::string& id, const Record& holder) {
    const bool is_written = holder.has("id");
    std::string text = "the id `" + id + "` is taken by the " + holder.keyword();
    const SourcePosition place = is_written ? holder.keyPlace("id") : holder.place();
    if (!place.file) return text;
    if (*place.file == kAdded) return text + " added before";
    text += " in " + displayName(*place.file);
    if (place.line > 0) text += ':' + std::to_string(place.line);
    return is_written ? text : text + ", which has no id written";
}

std::vector<Record> addedRecords(std::span<const Edit> edits, const Schemas& schemas) {
    std::vector<Record> records;
    for (const Edit& edit : edits)
        if (edit.kind == Edit::Kind::Add || edit.kind == Edit::Kind::Fence)
            records.push_back(addedRecord(edit, schemas));
    return records;
}

std::vector<Record> edited(std::vector<Record> records, std::span<const Edit> edits,
                           const Schemas& schemas, const std::vector<std::string>* ids) {
    if (edits.empty()) return records;
    std::vector<std::string> known = ids == nullptr ? assignIds(records) : *ids;
    Editor editor(std::move(records), std::move(known), schemas);
    for (const Edit& edit : edits) editor.apply(edit);
    editor.keepIds();
    return editor.finish();
}

}  // namespace ispace
