// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/history.h"
#include "geom/pose.h"
#include "geom/triangle_mesh.h"
#include "record/schema.h"

namespace ispace {

/// Where a record or value was read.
struct Place {
    std::shared_ptr<const std::string> file;  ///< null: made by a program
    int line = 0, column = 0;

    [[nodiscard]] Diagnostic finding(std::string message) const;
};

/// One line `keyword key=value …`: checked against its schema, values in file units.
class Record {
  public:
    explicit Record(const Schema& schema, Place place = {})
        : schema_(&schema), place_(std::move(place)) {}

    [[nodiscard]] const Schema& schema() const { return *schema_; }
    [[nodiscard]] const std::string& keyword() const { return schema_->keyword; }
    [[nodiscard]] const Place& place() const { return place_; }

    /// The id as written, or "" if it is left to be numbered (see assignIds).
    [[nodiscard]] std::string writtenId() const;

    /// True if the key is written. A value equal to the schema's default counts as left out, as in
    /// the canonical form: a key whose mere presence means something must have no default.
    [[nodiscard]] bool has(std::string_view key) const;
    /// Sets or replaces a value. \pre the schema has the key and the value its type
    /// \throws FormatError with the value's place if the value is out of the key's bounds
    void set(std::string_view key, Value value, Place place = {});
    void erase(std::string_view key);

    /// The value written, else the schema's default. \pre one of them exists and has this type
    [[nodiscard]] bool flag(std::string_view key) const;
    [[nodiscard]] double number(std::string_view key) const;
    [[nodiscard]] const std::string& text(std::string_view key) const;
    [[nodiscard]] const Tuple& tuple(std::string_view key) const;
    [[nodiscard]] const TupleList& list(std::string_view key) const;
    [[nodiscard]] Angle angle(std::string_view key) const { return Angle::degrees(number(key)); }
    /// Written or default, or nothing.
    [[nodiscard]] const Value* find(std::string_view key) const;

    /// Where the key's value was read, else where the record was.
    [[nodiscard]] const Place& keyPlace(std::string_view key) const;
    /// A finding with the place of this record, or of the value of one of its keys if it is
    /// written. The message is taken as it is.
    [[nodiscard]] Diagnostic finding(std::string message) const;
    [[nodiscard]] Diagnostic finding(std::string_view key, std::string message) const;

    /// The content of the file that the record names, once somebody has loaded it; else null.
    [[nodiscard]] const std::shared_ptr<const TriangleMesh>& mesh() const { return mesh_; }
    void setMesh(std::shared_ptr<const TriangleMesh> mesh) { mesh_ = std::move(mesh); }

    /// Same keyword and same written values; places do not matter.
    friend bool operator==(const Record& a, const Record& b);

  private:
    struct Entry {
        std::size_t key;  // index in the schema
        Value value;
        Place place;
    };
    [[nodiscard]] std::size_t indexOf(std::string_view key) const;
    [[nodiscard]] const Entry* written(std::string_view key) const;
    template <typename T>
    [[nodiscard]] const T& get(std::string_view key) const;

    const Schema* schema_;
    Place place_;
    std::vector<Entry> entries_;  // in the order of the schema's keys
    std::shared_ptr<const TriangleMesh> mesh_;
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
};

/// Ids of all records, in order: the written one, else keyword and number, counting from 1 within
/// each keyword in file order and skipping every id that is written anywhere in the list.
std::vector<std::string> assignIds(const std::vector<Record>& records);

}  // namespace ispace
