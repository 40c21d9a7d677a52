// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/extensions/ifc: STEP files (ISO 10303-21), the text form of IFC, as
// instances by number. Values are views of the file's bytes, which outlive them.
//
//     const StepFile file(bytes);
//     for (const StepId wall : file.ofType("IFCWALL")) {
//         const std::string name = file.read(wall)[2].text();
//     }
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/budget.h"

namespace ispace::ifc {

/// Returns true if a STEP file begins with its magic, after blanks, comments and a byte order mark.
bool beginsAsStep(std::string_view bytes);

/// Number of an instance in a STEP file: 12 for `#12`; 0: no reference.
using StepId = std::uint64_t;

/// An argument of an instance, stored as its text in the file. Views of the file's bytes.
class StepValue {
  public:
    StepValue() = default;
    explicit StepValue(std::string_view text) : text_(text) {}

    /// Returns true for `$`, `*` and missing arguments.
    [[nodiscard]] bool isNull() const;
    /// Returns the id of `#12`; 0 for other values.
    [[nodiscard]] StepId reference() const;
    /// Parses an integer or real, also in a typed value: IFCLENGTHMEASURE(2.).
    [[nodiscard]] std::optional<double> number() const;
    /// Returns a string in UTF-8, on one line, also in a typed value; "" for other values.
    [[nodiscard]] std::string text() const;
    /// Returns `AREA` of `.AREA.`; "" for other values.
    [[nodiscard]] std::string_view word() const;
    /// Returns `IFCLABEL` of a typed value; "" for other values.
    [[nodiscard]] std::string_view type() const;
    /// Returns the elements of a list, or the arguments of a typed value; empty for other values.
    /// O(length)
    [[nodiscard]] std::vector<StepValue> list() const;

  private:
    [[nodiscard]] StepValue untyped() const;

    std::string_view text_;
};

/// An instance: its type in capitals and its arguments by position.
struct StepInstance {
    std::string_view type;
    std::vector<StepValue> arguments;

    /// Returns the argument; null beyond the last one.
    [[nodiscard]] StepValue operator[](std::size_t i) const {
        return i < arguments.size() ? arguments[i] : StepValue();
    }
};

/// An index of the instances of a STEP file (ISO 10303-21), in any order, for any schema. Parses
/// arguments on demand and skips comments and instances that are not `#ID = TYPE(...)`. Keeps a
/// view of the bytes; takes 16 bytes an instance.
class StepFile {
  public:
    /// Builds the index. O(bytes + instances log instances)
    /// \param work pays for long instances, which many references may have read again; null for
    /// none; outlives this object
    explicit StepFile(std::string_view bytes, Budget* work = nullptr);

    /// Returns the type of an instance; "" if the id is missing. O(log instances)
    [[nodiscard]] std::string_view typeOf(StepId id) const;
    /// Returns an instance with its arguments; without type and arguments if the id is missing.
    /// \throws std::runtime_error after kMaxReads calls, and for more work than is left
    [[nodiscard]] StepInstance read(StepId id) const;
    /// Returns ids of all instances of a type, ascending.
    [[nodiscard]] std::span<const StepId> ofType(std::string_view type) const;
    /// Returns all types with the ids of their instances, in the order of the types.
    [[nodiscard]] const std::map<std::string_view, std::vector<StepId>>& types() const {
        return by_type_;
    }
    [[nodiscard]] std::size_t size() const { return entries_.size(); }

    /// Bounds the work on any file: far more than a building of 1 GB requires.
    static constexpr std::size_t kMaxReads = 2'000'000'000;

  private:
    struct Entry {
        StepId id;
        std::size_t offset;  ///< of the type
    };
    [[nodiscard]] const Entry* find(StepId id) const;
    [[nodiscard]] std::string_view typeAt(std::size_t offset) const;
    void addStatement(std::string_view statement, std::size_t offset);

    std::string_view bytes_;
    Budget* work_;
    std::vector<Entry> entries_;
    std::map<std::string_view, std::vector<StepId>> by_type_;
    mutable std::size_t reads_ = 0;
};

}  // namespace ispace::ifc
