// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace ispace {

/// The token in a file: its first line, of 1 to 256 characters without blanks.
/// \throws FormatError, std::system_error
std::string readToken(const std::string& file);

/// True if others than its owner may read or replace what the file holds.
bool isOpenToOthers(const std::string& file);

/// Takes as long for any `given` of a length.
bool isSameSecret(std::string_view given, std::string_view secret);

}  // namespace ispace
