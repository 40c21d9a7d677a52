// SPDX-License-Identifier: GPL-3.0-or-later
// lib/record: the language of .env and .3dm: values, schemas, records, YAML, canonical form,
// digest. Uses base, geom; yaml-cpp and OpenSSL inside.
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace ispace {

/// Numbers in the units of files: metres, degrees, square metres, fractions, hertz.
using Tuple = std::vector<double>;
/// A `;` list of tuples.
using TupleList = std::vector<Tuple>;

/// What a key holds; which alternative is fixed by the key's type in its schema.
///
/// A variant that can be copied when memory runs out: libstdc++ 12 destroys the copy that it could
/// not make as if it had been made (std::string and std::vector are "never valueless" to it).
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

}  // namespace ispace
