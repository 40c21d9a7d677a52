// SPDX-License-Identifier: GPL-3.0-or-later
// lib/kernel/record: the language of .env and .3dm: values, schemas, records, YAML, canonical form,
// digest. Uses base, geom; yaml-cpp and OpenSSL inside.
//
// A schema states each key once: name, type, unit, bounds, default, help and role. Readers,
// writers, edits, manual pages and completions follow from it. Values are in the units of files;
// parsing is independent of the locale, and written values read back as the same bits.
//
//     const KeySpec width{.name = "width", .unit = Unit::Length, .lower = 0, .lower_open = true};
//     const double metres = std::get<double>(parseValue(width, "80cm"));  // 0.8
#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/number.h"

namespace ispace {

/// Numbers in the units of files: metres, degrees, square metres, fractions, hertz.
using Tuple = std::vector<double>;
/// A `;` list of tuples.
using TupleList = std::vector<Tuple>;

/// The value of a key; the type of the key in its schema fixes the alternative.
///
/// Copying survives running out of memory: libstdc++ 12 would destroy a copy that it failed to
/// construct (it treats std::string and std::vector as "never valueless").
class Value : public std::variant<bool, double, std::string, Tuple, TupleList> {
  public:
    using variant::variant;
    using variant::operator=;
    Value() = default;
    Value(const Value& other) : variant() { variant::operator=(other); }  // NOLINT
    Value(Value&&) noexcept = default;
    Value& operator=(const Value&) = default;
    Value& operator=(Value&&) noexcept = default;
    ~Value() = default;
};

/// Returns true for a plain word: one or more of ASCII letters, digits and _ - . / + : @
bool isWord(std::string_view text);

/// Syntax of a key's text, and the alternative of Value that holds it.
enum class KeyType {
    Flag,       ///< yes/no (also true/false, on/off, in any case); bool
    Number,     ///< double
    Text,       ///< any UTF-8 string without control characters other than tab and newline
    Word,       ///< a plain word: an id, a name; letters, digits and _ - . / + : @
    Choice,     ///< one of KeySpec::choices; string
    Tuple,      ///< `a,b[,c]`, blanks around numbers allowed in quotes; lengths also as
                ///< sizes, "8 × 8", "8x8x2.5", "8 * 8"; Tuple
    TupleList,  ///< `a,b;c,d;…`, not empty; TupleList
};

/// Role of a key in the geometry and references of a record. Code that moves or converts records
/// uses roles and need not know the keys.
enum class Role {
    None,
    Place,       ///< x,y[,z] or a list of them: moves with the record
    MotionPlan,  ///< path that the record follows, besides its position; moves with the record
    Heading,     ///< turns with the record
    Tilt,        ///< angle above level; --tilt changes it
    Carrier,     ///< id of the record that defines the frame of this record's coordinates
    Reference,   ///< id of another record
    File,        ///< a path, relative to the folder of the file that names it
};

/// A key of a record, or the value of an option.
struct KeySpec {
    std::string name;  ///< empty for an option's value: messages already name the option
    KeyType type = KeyType::Number;
    Unit unit = Unit::None;
    std::string help;                          ///< one phrase, for man page and messages
    std::optional<Value> default_value = {};   ///< never stored as written; empty: no default
    std::size_t min_count = 1, max_count = 1;  ///< numbers of a tuple, or of each tuple of a list
    double lower = -std::numeric_limits<double>::infinity();  ///< of each number
    double upper = std::numeric_limits<double>::infinity();
    bool lower_open = false;  ///< rejects `lower` itself ("must be above 0")
    bool whole = false;       ///< rejects fractions
    std::vector<std::string> choices = {};
    bool required = false;
    Role role = Role::None;
    double standard_z = 0;  ///< height of a point written with two of three coordinates
};

/// Record types after the menus of the thesis, then placements and metadata.
enum class RecordType { Space, Floor, Wall, Infra, Other, Placement, Meta };

/// One keyword and its keys, in canonical order. Every schema has the key `id` first.
struct Schema {
    std::string keyword;
    RecordType type = RecordType::Other;
    std::string help;
    std::vector<KeySpec> keys;

    [[nodiscard]] const KeySpec* find(std::string_view name) const;
    [[nodiscard]] std::vector<std::string> keyNames() const;
    /// Returns true for Space, Floor, Wall, Infra and Other: part of the environment and its
    /// digest.
    [[nodiscard]] bool isEnvironment() const { return type < RecordType::Placement; }
};

/// The keywords that a reader accepts. Each folder defines its list; sceneSchemas() merges them.
/// Records point into it, so it must outlive them; the merged lists are constants.
class Schemas {
  public:
    Schemas() = default;
    /// \pre keywords are unique, each schema has the key `id` (a word) first, keys are unique,
    ///      defaults fit their keys (std::logic_error and FormatError otherwise)
    explicit Schemas(std::vector<Schema> schemas);
    [[nodiscard]] const Schema* find(std::string_view keyword) const;
    [[nodiscard]] const std::vector<Schema>& all() const { return schemas_; }
    [[nodiscard]] std::vector<std::string> keywords() const;

  private:
    std::vector<Schema> schemas_;
};

/// Parses one value of a key from its text, without quotes.
/// \throws FormatError with only a message, "`height`: `tall` is not a number"; the caller adds the
///         source location
Value parseValue(const KeySpec& key, std::string_view text);

/// Writes the canonical text: SI, shortest doubles, quotes where needed.
std::string formatValue(const KeySpec& key, const Value& value);
/// Appends formatValue(key, value).
void appendValue(std::string& out, const KeySpec& key, const Value& value);

/// Validates count, bounds, choices and characters of a value from any source.
/// \pre the value has the key's type \throws as parseValue
void checkValue(const KeySpec& key, const Value& value);

/// Expands a manual page in man(7) format: replaces each line `@RECORDS TYPE…@` by the keywords of
/// these types (space, floor, wall, infra, other, placement, meta), each with its keys, their
/// values, units, bounds and defaults. A keyword with a section in the page is left out.
/// \throws FormatError for an unknown type
std::string expandManual(std::string_view page, const Schemas& schemas);

/// Writes one keyword as a subsection of a manual page.
std::string manualOf(const Schema& schema);

/// Parses one number of the key, with the suffixes its unit allows; bounds are not checked.
/// \throws as parseValue
double parseNumber(const KeySpec& key, std::string_view text);

/// Writes a number in the key's canonical form: a share in per cent, else the shortest double.
std::string formatNumber(const KeySpec& key, double number);
/// Appends formatNumber(key, number).
void appendNumber(std::string& out, const KeySpec& key, double number);

/// Throws "`key`: …", an error about a value; the caller adds its source location.
[[noreturn]] void refuseValue(const KeySpec& key, const std::string& what);

}  // namespace ispace
