// SPDX-License-Identifier: GPL-3.0-or-later
// Words of extensions that a program was built without, for messages. Added by one thread before
// records are read; constant and thread-safe from then on.
#pragma once

#include <string_view>

namespace ispace {

/// States a keyword of records, or a key of others as KEYWORD.KEY, that an extension would read,
/// which this program was built without: the error about it names the extension. Called before
/// records are read, as addSceneSchemas() is.
/// \param keyword, extension literals
void addMissingKeyword(std::string_view keyword, std::string_view extension);

/// Returns the extension that would read a keyword; "" for others.
[[nodiscard]] std::string_view missingExtension(std::string_view keyword);

}  // namespace ispace
