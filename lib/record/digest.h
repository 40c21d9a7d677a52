// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "record/record.h"

namespace ispace {

/// "sha256:" and 64 hex digits of the bytes.
std::string sha256(std::string_view bytes);

/// sha256 over the vertices, then the triangles, as little-endian 32-bit numbers.
std::string meshDigest(const TriangleMesh& mesh);

/// Digest of an environment: sha256 over the canonical lines (each with its newline) of the
/// environment records, in file order; placements, results and history do not count. A file that is
/// loaded counts by its content: its name gives way to `digest`.
std::string environmentDigest(std::span<const Record> records);

}  // namespace ispace
