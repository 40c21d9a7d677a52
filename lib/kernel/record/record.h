// SPDX-License-Identifier: GPL-3.0-or-later
// Records: readers produce them, all other folders interpret them. Each value is valid by its
// schema; readers also check that the required keys are there. A record keeps the file, line and
// column of each value for messages. Copies share data, and a change copies it first: different
// copies may be used by different threads, one record by one thread at a time unless all of them
// read.
//
//     const Record desk = readRecord("desk at=2,3 heading=30", "--add", schemas);
//     const Tuple& at = desk.tuple("at");            // {2, 3}, metres
//     const Angle heading = desk.angle("heading");   // 30 degrees
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

/// Line and column in a file, from 1, columns in bytes; 0: unknown.
struct LineColumn {
    int line = 0, column = 0;
};

/// Source location of a record or value.
struct SourcePosition {
    std::shared_ptr<const std::string> file;  ///< null: not read from a file
    int line = 0, column = 0;
    /// The include that names the file; null: the file is an operand.
    std::shared_ptr<const SourcePosition> included_from = nullptr;

    /// Creates a finding at this location; appends the chain of includes, nearest first:
    /// " (included from b.yaml:2:3, from a.yaml:1:1)".
    [[nodiscard]] Diagnostic finding(std::string message) const;
    /// Returns another location in the same file.
    [[nodiscard]] SourcePosition at(LineColumn spot) const {
        return {file, spot.line, spot.column, included_from};
    }
    /// " (included from …)", empty for an operand.
    [[nodiscard]] std::string inclusion() const;
};

/// Triangles of a mesh file, in the file's units and axes. Stores floats, as the file formats and
/// their readers do. Indices lie within `vertices`.
struct TriangleMesh {
    std::vector<std::array<float, 3>> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::string digest;  ///< sha256 over both, see meshDigest
};

/// One line `keyword key=value …`: validated against its schema, values in file units. Copies are
/// copy-on-write; a moved-from record can only be assigned to.
class Record {
  public:
    /// \param keys estimated number of keys to allocate for
    explicit Record(const Schema& schema, SourcePosition place = {}, std::size_t keys = 0);

    [[nodiscard]] const Schema& schema() const { return *schema_; }
    [[nodiscard]] const std::string& keyword() const { return schema_->keyword; }
    [[nodiscard]] const SourcePosition& place() const { return data_->place; }

    /// Returns the written id, or "" if assignIds numbers the record.
    [[nodiscard]] std::string writtenId() const;

    /// Returns true if the key is written. A value equal to the schema's default counts as omitted,
    /// as in the canonical form, so a key that matters by its presence must have no default.
    [[nodiscard]] bool has(std::string_view key) const;
    /// Inserts or replaces a value. \pre the schema has the key and the value its type
    /// \throws FormatError at the value's location if the value is out of the key's bounds
    void set(std::string_view key, Value value, const SourcePosition& place = {});
    /// Inserts a checked value from the record's file while a reader builds the record.
    /// \pre `key` is in the schema, the value passes checkValue, and the record has no copies
    void setRead(const KeySpec& key, Value value, LineColumn spot);
    void erase(std::string_view key);

    /// Returns the written value, else the default. \pre one of them exists and has this type
    [[nodiscard]] bool flag(std::string_view key) const;
    [[nodiscard]] double number(std::string_view key) const;
    [[nodiscard]] const std::string& text(std::string_view key) const;
    [[nodiscard]] const Tuple& tuple(std::string_view key) const;
    [[nodiscard]] const TupleList& list(std::string_view key) const;
    [[nodiscard]] Angle angle(std::string_view key) const { return Angle::degrees(number(key)); }
    /// Returns the written value, else the default, else null.
    [[nodiscard]] const Value* find(std::string_view key) const;
    /// Calls visit(const KeySpec&, const Value&) for each written value, in the schema's order.
    template <typename Visit>
    void forEachWritten(Visit visit) const {
        for (const Entry& entry : data_->entries) visit(schema_->keys[entry.key], entry.value);
    }

    /// Returns the source location of the key's value, else of the record.
    [[nodiscard]] SourcePosition keyPlace(std::string_view key) const;
    /// Creates a finding at the source location of this record, or of a key's written value.
    [[nodiscard]] Diagnostic finding(std::string message) const;
    [[nodiscard]] Diagnostic finding(std::string_view key, std::string message) const;

    /// Sets the location of the include that names the record's file.
    void setIncludedFrom(std::shared_ptr<const SourcePosition> place) {
        own().place.included_from = std::move(place);
    }

    /// Returns true if the record was expanded from a repetition or a part, false if written.
    [[nodiscard]] bool isMade() const { return data_->made; }
    void setMade() { own().made = true; }

    /// Returns the content of the record's mesh file; null until it is loaded.
    [[nodiscard]] std::shared_ptr<const TriangleMesh> mesh() const {
        return data_->rare ? data_->rare->mesh : nullptr;
    }
    void setMesh(std::shared_ptr<const TriangleMesh> mesh);

    /// Compares keywords and written values, not source locations.
    friend bool operator==(const Record& a, const Record& b);

  private:
    struct Entry {
        LineColumn spot;    // in the record's file; line 0: the record's location
        std::uint32_t key;  // index in the schema
        Value value;
    };
    /// Members that few records need.
    struct Rare {
        std::vector<std::pair<std::uint32_t, SourcePosition>>
            elsewhere;  // of values of other files, by key
        std::shared_ptr<const TriangleMesh> mesh;
    };
    struct Data {
        SourcePosition place;
        std::vector<Entry> entries;        // in the order of the schema's keys
        std::shared_ptr<const Rare> rare;  // may be null
        bool made = false;
    };
    /// Returns the data for modification, copied first if other records share it.
    [[nodiscard]] Data& own();
    static void put(Data& data, const KeySpec& spec, Entry entry);
    [[nodiscard]] std::uint32_t indexOf(std::string_view key) const;
    [[nodiscard]] const Entry* written(std::string_view key) const;
    template <typename T>
    [[nodiscard]] const T& get(std::string_view key) const;

    const Schema* schema_;
    std::shared_ptr<Data> data_;
};

/// Type of a document, detected from its content.
enum class DocumentKind { Environment, Layout };

/// A file of records.
struct Document {
    DocumentKind kind = DocumentKind::Environment;
    History history;              ///< from the lines after the magic line
    std::vector<Record> records;  ///< in file order
    /// Files read besides the operand, each once: includes, pictures, meshes. Paths as opened.
    std::vector<std::string> sources = {};
    /// Decisions of an importer, a sentence each, for the user.
    std::vector<std::string> notes = {};
    /// Warnings of an importer.
    std::vector<Diagnostic> warnings = {};
};

/// Returns the ids of all records, in order: the written one, else keyword and number. Numbers
/// count from 1 within each keyword in file order and skip ids written anywhere in the list.
std::vector<std::string> assignIds(const std::vector<Record>& records);

/// Reports each record that repeats the written id of an earlier one.
void findDoubledIds(std::span<const Record> records, Diagnostics& findings);

/// Finds objects by id, for frequent lookups: a hash table with open addressing, at most half full.
/// `IdOf` maps an object's index to its id, "" for an object without id.
template <typename IdOf>
class IdTable {
  public:
    /// \pre count < 2^32 - 1, and ids do not change. O(count)
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

    /// Returns the index of the first object with this id.
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

/// "line 3", with the file's name if it differs from that of `here`.
std::string otherPlace(const SourcePosition& other, const SourcePosition& here);

/// ", did you mean …?" with the nearest of the known words, or ", known: " and all of them.
std::string spellingHint(std::string_view word, const std::vector<std::string>& known);

/// Builds checked records from keywords, keys and values and collects errors; shared by the
/// readers of text and of YAML.
///
///     if (collector.begin("desk", spot)) {
///         const KeySpec* const key = collector.key("height", spot);
///         if (key != nullptr) collector.text(*key, "5cm", spot);
///         collector.end();
///     }
class RecordCollector {
  public:
    /// Maximum number of records of one input; they take some gigabytes.
    static constexpr std::size_t kMaxRecords = 1'000'000;

    RecordCollector(const std::string& name, const Schemas& schemas)
        : file_{std::make_shared<const std::string>(name)}, schemas_(&schemas) {}

    /// Sets the file of the records that follow; ignores the line and column of `file`.
    void setFile(SourcePosition file) { file_ = std::move(file); }
    [[nodiscard]] const SourcePosition& file() const { return file_; }
    [[nodiscard]] const Schemas& schemas() const { return *schemas_; }

    /// Starts a record. Returns false and reports a finding if the keyword is unknown.
    /// \param keys estimated number of keys
    bool begin(std::string_view keyword, LineColumn spot, std::size_t keys = 0);
    void begin(const Schema& schema, LineColumn spot, std::size_t keys = 0);
    /// Finds a key of the current record; if it is unknown or doubled, returns null and reports a
    /// finding.
    const KeySpec* key(std::string_view name, LineColumn spot);
    /// Returns true if the current record has the key, even with its default or a bad value.
    [[nodiscard]] bool isGiven(const KeySpec& key) const;
    /// Parses a key's text and stores the value.
    void text(const KeySpec& key, std::string_view text, LineColumn spot);
    /// Stores a key's value. \pre the value passes checkValue
    void value(const KeySpec& key, Value value, LineColumn spot);
    /// Ends the record and checks that required keys are present. \return it, even with findings
    Record finish();
    /// Calls finish() and stores the record. \throws FormatError for more than kMaxRecords
    void end();

    /// Moves in the records of the collector for the text that follows. \pre `next` has no findings
    /// \throws FormatError as end() does
    void append(RecordCollector&& next);

    /// Reports a finding. `message` is a function that builds its text, called only if the finding
    /// is kept: hints take time, and a hostile file has many errors.
    template <typename Message>
    void finding(const SourcePosition& place, Message message) {
        findings_.add(findings_.full() ? Diagnostic{} : place.finding(message()));
    }
    template <typename Message>
    void finding(LineColumn spot, Message message) {
        finding(file_.at(spot), std::move(message));
    }
    void add(const FormatError& error) { findings_.add(error); }
    [[nodiscard]] Diagnostics& findings() { return findings_; }

    /// Returns the records, in order. \throws FormatError with all findings, doubled ids last
    std::vector<Record> take();

  private:
    void checkCount() const;

    SourcePosition file_;
    const Schemas* schemas_;
    Diagnostics findings_;
    std::vector<Record> records_;   // also those with findings
    std::vector<LineColumn> seen_;  // keys of the current record, by their index; line 0: not seen
    std::optional<Record> current_;
};

}  // namespace ispace
