// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "geom/pose.h"
#include "record/schema.h"

namespace ispace {

/// Line and column in a file, from 1, columns in bytes; 0: none.
struct LineColumn {
    int line = 0, column = 0;
};

/// Where a record or value was read.
struct Place {
    std::shared_ptr<const std::string> file;  ///< null: made by a program
    int line = 0, column = 0;
    /// The include that brought the file in; null: the file is an operand.
    std::shared_ptr<const Place> included_from = nullptr;

    /// A finding at this place. The message is followed by the chain of includes, nearest first:
    /// " (included from b.yaml:2:3, from a.yaml:1:1)".
    [[nodiscard]] Diagnostic finding(std::string message) const;
    /// Another spot in the same file.
    [[nodiscard]] Place at(LineColumn spot) const {
        return {file, spot.line, spot.column, included_from};
    }
    /// " (included from …)", or nothing for an operand.
    [[nodiscard]] std::string inclusion() const;
};

/// Triangles as a file of meshes holds them, in the file's own units and axes. Floats, as all those
/// formats and their readers have them. Indices lie within `vertices`.
struct TriangleMesh {
    std::vector<std::array<float, 3>> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::string digest;  ///< sha256 over both, see meshDigest
};

/// One line `keyword key=value …`: checked against its schema, values in file units. Copies share
/// what they hold until one of them is changed; a record that was moved from is only assigned to.
class Record {
  public:
    /// \param keys how many are to be written; only a guess
    explicit Record(const Schema& schema, Place place = {}, std::size_t keys = 0);

    [[nodiscard]] const Schema& schema() const { return *schema_; }
    [[nodiscard]] const std::string& keyword() const { return schema_->keyword; }
    [[nodiscard]] const Place& place() const { return data_->place; }

    /// The id as written, or "" if it is left to be numbered (see assignIds).
    [[nodiscard]] std::string writtenId() const;

    /// True if the key is written. A value equal to the schema's default counts as left out, as in
    /// the canonical form, so a key whose mere presence matters must have no default.
    [[nodiscard]] bool has(std::string_view key) const;
    /// Sets or replaces a value. \pre the schema has the key and the value its type
    /// \throws FormatError with the value's place if the value is out of the key's bounds
    void set(std::string_view key, Value value, const Place& place = {});
    /// The same for a checked value read from the record's own file, while the record is made.
    /// \pre `key` is one of the schema's, the value passes checkValue, nobody has copied the record
    void setRead(const KeySpec& key, Value value, LineColumn spot);
    void erase(std::string_view key);

    /// The written value, else the schema's default. \pre one of them exists and has this type
    [[nodiscard]] bool flag(std::string_view key) const;
    [[nodiscard]] double number(std::string_view key) const;
    [[nodiscard]] const std::string& text(std::string_view key) const;
    [[nodiscard]] const Tuple& tuple(std::string_view key) const;
    [[nodiscard]] const TupleList& list(std::string_view key) const;
    [[nodiscard]] Angle angle(std::string_view key) const { return Angle::degrees(number(key)); }
    /// Written or default, or nothing.
    [[nodiscard]] const Value* find(std::string_view key) const;
    /// Calls visit(const KeySpec&, const Value&) for each written value, in the schema's order.
    template <typename Visit>
    void forEachWritten(Visit visit) const {
        for (const Entry& entry : data_->entries) visit(schema_->keys[entry.key], entry.value);
    }

    /// Where the key's value was read, or else the record.
    [[nodiscard]] Place keyPlace(std::string_view key) const;
    /// A finding at the place of this record, or of the written value of one of its keys.
    [[nodiscard]] Diagnostic finding(std::string message) const;
    [[nodiscard]] Diagnostic finding(std::string_view key, std::string message) const;

    /// Says where the record's file was included.
    void setIncludedFrom(std::shared_ptr<const Place> place) {
        own().place.included_from = std::move(place);
    }

    /// True if a repetition or a part made it; false if it is written.
    [[nodiscard]] bool isMade() const { return data_->made; }
    void setMade() { own().made = true; }

    /// The content of the file that the record names; null until it is loaded.
    [[nodiscard]] std::shared_ptr<const TriangleMesh> mesh() const {
        return data_->rare ? data_->rare->mesh : nullptr;
    }
    void setMesh(std::shared_ptr<const TriangleMesh> mesh);

    /// Same keyword and same written values; places do not matter.
    friend bool operator==(const Record& a, const Record& b);

  private:
    struct Entry {
        LineColumn spot;    // in the record's file; none: that of the record
        std::uint32_t key;  // index in the schema
        Value value;
    };
    /// What few records have.
    struct Rare {
        std::vector<std::pair<std::uint32_t, Place>> elsewhere;  // of values of other files, by key
        std::shared_ptr<const TriangleMesh> mesh;
    };
    struct Data {
        Place place;
        std::vector<Entry> entries;        // in the order of the schema's keys
        std::shared_ptr<const Rare> rare;  // may be null
        bool made = false;
    };
    /// What is to be changed: shared with no other record from here on.
    [[nodiscard]] Data& own();
    static void put(Data& data, const KeySpec& spec, Entry entry);
    [[nodiscard]] std::uint32_t indexOf(std::string_view key) const;
    [[nodiscard]] const Entry* written(std::string_view key) const;
    template <typename T>
    [[nodiscard]] const T& get(std::string_view key) const;

    const Schema* schema_;
    std::shared_ptr<Data> data_;
};

/// What a text holds, told by its content.
enum class DocumentKind { Environment, Layout };

/// A file of records.
struct Document {
    DocumentKind kind = DocumentKind::Environment;
    History history;              ///< from the lines after the magic line
    std::vector<Record> records;  ///< in file order
    /// Files read besides the operand, each once: includes, pictures, meshes. Paths as opened.
    std::vector<std::string> sources = {};
    /// Decisions of an importer, a sentence each, for people.
    std::vector<std::string> notes = {};
    /// Warnings of an importer.
    std::vector<Diagnostic> warnings = {};
};

/// Ids of all records, in order: the written one, else keyword and number. Numbers count from 1
/// within each keyword in file order and skip ids that are written anywhere in the list.
std::vector<std::string> assignIds(const std::vector<Record>& records);

/// Adds a finding for each record whose written id an earlier one has.
void findDoubledIds(std::span<const Record> records, Diagnostics& findings);

/// Finds things by their ids, for who asks very often: a table with open addressing, at most half
/// full. `IdOf` is called with a thing's index and gives its id, "" for none.
template <typename IdOf>
class IdTable {
  public:
    /// \pre count < 2^32 - 1, and ids stay as they are. O(count)
    IdTable(std::size_t count, IdOf id_of) : id_of_(std::move(id_of)) {
        slots_.assign(std::bit_ceil(2 * count + 1), kFree);
        for (std::size_t i = 0; i < count; ++i) {
            const std::string_view id = id_of_(i);
            if (id.empty()) continue;
            std::size_t slot = slotOf(id);
            while (slots_[slot] != kFree) slot = next(slot);
            slots_[slot] = static_cast<std::uint32_t>(i);
        }
    }

    /// The first thing with this id.
    [[nodiscard]] std::optional<std::size_t> find(std::string_view id) const {
        std::size_t slot = slotOf(id);
        while (slots_[slot] != kFree && id_of_(slots_[slot]) != id) slot = next(slot);
        if (slots_[slot] == kFree) return std::nullopt;
        return slots_[slot];
    }

  private:
    static constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();

    [[nodiscard]] std::size_t slotOf(std::string_view id) const {
        return std::hash<std::string_view>{}(id) & (slots_.size() - 1);
    }
    [[nodiscard]] std::size_t next(std::size_t slot) const {
        return (slot + 1) & (slots_.size() - 1);
    }

    IdOf id_of_;
    std::vector<std::uint32_t> slots_;
};

/// "line 3", with the file's name where that is not the file of `here`.
std::string otherPlace(const Place& other, const Place& here);

/// ", did you mean …?" with the nearest of the known words, or ", known: " and all of them.
std::string spellingHint(std::string_view word, const std::vector<std::string>& known);

/// Builds checked records from keywords, keys and values and collects errors: the common part of
/// the readers of text and of YAML.
///
///     if (collector.begin("desk", spot)) {
///         if (const KeySpec* key = collector.key("height", spot)) collector.text(*key, "5cm",
///         spot); collector.end();
///     }
class RecordCollector {
  public:
    /// Most records of one input: some gigabytes.
    static constexpr std::size_t kMaxRecords = 1'000'000;

    RecordCollector(const std::string& name, const Schemas& schemas)
        : file_{std::make_shared<const std::string>(name)}, schemas_(&schemas) {}

    /// Sets the file of what follows; the line and column of `file` do not count.
    void setFile(Place file) { file_ = std::move(file); }
    [[nodiscard]] const Place& file() const { return file_; }
    [[nodiscard]] const Schemas& schemas() const { return *schemas_; }

    /// Starts a record. False, and a finding, if the keyword is unknown.
    /// \param keys how many it seems to give
    bool begin(std::string_view keyword, LineColumn spot, std::size_t keys = 0);
    void begin(const Schema& schema, LineColumn spot, std::size_t keys = 0);
    /// A key of the current record; null, and a finding, if it is unknown or doubled.
    const KeySpec* key(std::string_view name, LineColumn spot);
    /// True if the current record gives the key, even with its default or a bad value.
    [[nodiscard]] bool isGiven(const KeySpec& key) const;
    /// Sets a key from its text.
    void text(const KeySpec& key, std::string_view text, LineColumn spot);
    /// Sets a key. \pre the value is good
    void value(const KeySpec& key, Value value, LineColumn spot);
    /// Ends the record and checks that required keys are there. \return it, even with findings
    Record finish();
    /// finish(), and keeps the record. \throws FormatError for more than kMaxRecords
    void end();

    /// Takes the records of another that read what follows, which has no findings.
    /// \throws FormatError as end() does
    void append(RecordCollector&& next);

    /// Adds a finding. `message` is a function that makes its text, called only if the finding is
    /// kept: hints take time, and a hostile file has many errors.
    template <typename Message>
    void finding(const Place& place, Message message) {
        findings_.add(findings_.full() ? Diagnostic{} : place.finding(message()));
    }
    template <typename Message>
    void finding(LineColumn spot, Message message) {
        finding(file_.at(spot), std::move(message));
    }
    void add(const FormatError& error) { findings_.add(error); }
    [[nodiscard]] Diagnostics& findings() { return findings_; }

    /// The records, in order. \throws FormatError with all findings, those of doubled ids last
    std::vector<Record> take();

  private:
    void checkCount() const;

    Place file_;
    const Schemas* schemas_;
    Diagnostics findings_;
    std::vector<Record> records_;   // also those with findings
    std::vector<LineColumn> seen_;  // keys of the current record, by their index; line 0: not seen
    std::optional<Record> current_;
};

}  // namespace ispace
