// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/edit.h"

#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/suggest.h"
#include "geom/box.h"
#include "geom/pose.h"
#include "record/placing.h"
#include "record/text.h"

namespace ispace {

namespace {

/// a + b as a person adds decimals: where the nanometre next to the sum is within the rounding of
/// the operands, that is what is meant (0.1 + 0.2 is 0.3).
double decimalSum(double a, double b) {
    const double sum = a + b;
    const double near = std::round(sum * 1e9) / 1e9;
    const double slack =
        4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(a), std::abs(b));
    return std::abs(near - sum) <= slack ? near : sum;
}

/// Calls visit(key) for each key with the role that the record has written.
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

/// The keys that say where the record is: those written, else the one that has a default.
std::vector<const KeySpec*> placeKeys(const Record& record) {
    std::vector<const KeySpec*> keys;
    forEachWritten(record, Role::Place, [&keys](const KeySpec& key) { keys.push_back(&key); });
    if (!keys.empty()) return keys;
    for (const KeySpec& key : record.schema().keys)
        if (key.role == Role::Place && key.default_value) keys.push_back(&key);
    return keys;
}

class Editor {
  public:
    Editor(std::vector<Record> records, const Schemas& schemas)
        : records_(std::move(records)), ids_(assignIds(records_)), schemas_(schemas) {}

    void apply(const Edit& edit) {
        edit_ = &edit;
        switch (edit.kind) {
            case Edit::Kind::Add:
                return add(readRecord(edit.text, "--add", schemas_));
            case Edit::Kind::Fence:
                return addFence();
            case Edit::Kind::Delete:
                return erase();
            default:
                break;
        }
        for (const std::size_t i : found()) change(i);
    }

    std::vector<Record> finish() {
        std::erase_if(records_, [](const Record& r) { return r.keyword() == "result"; });
        return std::move(records_);
    }

    /// Writes the automatic ids that the edits would give to other records.
    void keepIds() {
        const std::vector<std::string> now = assignIds(records_);
        std::set<std::string> shifted;  // keywords
        for (std::size_t i = 0; i < records_.size(); ++i)
            if (now[i] != ids_[i]) shifted.insert(records_[i].keyword());
        for (std::size_t i = 0; i < records_.size(); ++i)
            if (shifted.count(records_[i].keyword()) > 0) records_[i].set("id", ids_[i]);
    }

  private:
    [[noreturn]] void fail(const std::string& message) const {
        throw FormatError(
            Diagnostic{"", 0, 0, optionOf(edit_->kind) + ' ' + edit_->text + ": " + message});
    }

    /// The records that the glob names, in their order. \throws FormatError if there are none
    [[nodiscard]] std::vector<std::size_t> found() const {
        std::vector<std::size_t> places;
        for (std::size_t i = 0; i < ids_.size(); ++i)
            if (ids_[i] == edit_->ids || ::fnmatch(edit_->ids.c_str(), ids_[i].c_str(), 0) == 0)
                places.push_back(i);
        if (places.empty())
            fail("nothing has the id `" + edit_->ids + '`' + didYouMean(edit_->ids, ids_));
        return places;
    }

    void add(Record record) {
        std::string id = record.writtenId();
        if (id.empty()) {
            for (std::size_t n = 1; id.empty() || isTaken(id); ++n)
                id = record.keyword() + std::to_string(n);
        } else if (isTaken(id)) {
            fail("the id `" + id + "` is taken");
        }
        records_.push_back(std::move(record));
        ids_.push_back(std::move(id));
    }

    void addFence() {
        const Schema* const schema = schemas_.find("fence");
        if (schema == nullptr) throw std::logic_error("no schema of fences");
        Record fence(*schema);
        fence.set("path", parseValue(*schema->find("path"), edit_->text));
        fence.set("closed", edit_->closed);
        add(std::move(fence));
    }

    [[nodiscard]] bool isTaken(const std::string& id) const {
        return std::find(ids_.begin(), ids_.end(), id) != ids_.end();
    }

    void erase() {
        const std::vector<std::size_t> places = found();
        for (auto i = places.rbegin(); i != places.rend(); ++i) {
            records_.erase(records_.begin() + static_cast<std::ptrdiff_t>(*i));
            ids_.erase(ids_.begin() + static_cast<std::ptrdiff_t>(*i));
        }
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
            if (key->required) fail("a " + record.keyword() + " must have `" + edit_->key + '`');
            record.erase(edit_->key);
        } else {
            if (key->role == Role::File) forgetContent(record);
            record.set(edit_->key, parseValue(*key, edit_->value));
        }
        if (edit_->key == "id") rename(i);
    }

    /// Another file is named: what was loaded, and its digest, go.
    static void forgetContent(Record& record) {
        record.setMesh(nullptr);
        if (record.schema().find("digest") != nullptr) record.erase("digest");
    }

    void rename(std::size_t i) {
        const std::string id = records_[i].writtenId();
        if (id.empty() || id == ids_[i]) return;
        if (isTaken(id)) fail("the id `" + id + "` is taken");
        for (Record& record : records_)
            for (const Role role : {Role::Carrier, Role::Reference})
                forEachWritten(record, role, [&](const KeySpec& key) {
                    if (record.text(key.name) == ids_[i]) record.set(key.name, id);
                });
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
        // Two ends, or a path; everything else has one place and a heading.
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
        const double sum = decimalSum(record.number(key->name), edit_->angle.degrees());
        const bool wraps = role == Role::Heading && std::abs(sum) > 180;
        record.set(key->name, wraps ? wrapped(Angle::degrees(sum)).degrees() : sum);
    }

    std::vector<Record> records_;
    std::vector<std::string> ids_;  // kept through all edits
    const Schemas& schemas_;
    const Edit* edit_ = nullptr;
};

}  // namespace

std::vector<Record> edited(std::vector<Record> records, std::span<const Edit> edits,
                           const Schemas& schemas) {
    if (edits.empty()) return records;
    Editor editor(std::move(records), schemas);
    for (const Edit& edit : edits) editor.apply(edit);
    editor.keepIds();
    return editor.finish();
}

}  // namespace ispace
