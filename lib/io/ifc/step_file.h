// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ispace {

/// Number of an instance in a STEP file: 12 for `#12`; 0: no reference.
using StepId = std::uint64_t;

/// An argument of an instance, as its text in the file. Views of the file's bytes.
class StepValue {
  public:
    StepValue() = default;
    explicit StepValue(std::string_view text) : text_(text) {}

    /// True for `$`, `*` and arguments that are missing.
    [[nodiscard]] bool isNull() const;
    /// The id of `#12`; 0 for other values.
    [[nodiscard]] StepId reference() const;
    /// An integer or real, also in a typed value: IFCLENGTHMEASURE(2.).
    [[nodiscard]] std::optional<double> number() const;
    /// A string in UTF-8, on one line, also in a typed value; "" for other values.
    [[nodiscard]] std::string text() const;
    /// `AREA` of `.AREA.`; "" for other values.
    [[nodiscard]] std::string_view word() const;
    /// `IFCLABEL` of a typed value; "" for other values.
    [[nodiscard]] std::string_view type() const;
    /// The elements of a list, or the arguments of a typed value; empty for other values. O(length)
    [[nodiscard]] std::vector<StepValue> list() const;

  private:
    [[nodiscard]] StepValue untyped() const;

    std::string_view text_;
};

/// An instance: its type in capitals and its arguments by position.
struct StepInstance {
    std::string_view type;
    std::vector<StepValue> arguments;

    /// Null beyond the last argument.
    [[nodiscard]] StepValue operator[](std::size_t i) const {
        return i < arguments.size() ? arguments[i] : StepValue();
    }
};

/// An index of the instances of a STEP file (ISO 10303-21), in any order, whatever their schema.
/// Arguments are parsed when they are asked for. Comments and instances that are not `#ID =
/// TYPE(...)` are skipped. Keeps a view of the bytes; takes 16 bytes an instance.
class StepFile {
  public:
    /// O(bytes + instances log instances)
    explicit StepFile(std::string_view bytes);

    /// Type of an instance; "" where the id is missing. O(log instances)
    [[nodiscard]] std::string_view typeOf(StepId id) const;
    /// An instance with its arguments; without type and arguments where the id is missing.
    /// \throws std::runtime_error after kMaxReads calls
    [[nodiscard]] StepInstance read(StepId id) const;
    /// Ids of all instances of a type, ascending.
    [[nodiscard]] std::span<const StepId> ofType(std::string_view type) const;
    /// All types with the ids of their instances, in the order of the types.
    [[nodiscard]] const std::map<std::string_view, std::vector<StepId>>& types() const {
        return by_type_;
    }
    [[nodiscard]] std::size_t size() const { return entries_.size(); }
    [[nodiscard]] std::size_t bytes() const { return bytes_.size(); }

    /// Bounds the work on any file: far more than a building of 1 GB takes.
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
    std::vector<Entry> entries_;
    std::map<std::string_view, std::vector<StepId>> by_type_;
    mutable std::size_t reads_ = 0;
};

}  // namespace ispace
