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
using Value = std::variant<bool, double, std::string, Tuple, TupleList>;

}  // namespace ispace
