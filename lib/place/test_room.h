// SPDX-License-Identifier: GPL-3.0-or-later
// For the tests of this folder: environments from text.
#pragma once

#include <string>

#include "env/environment.h"
#include "env/schemas.h"
#include "record/text.h"

namespace ispace {

/// Of a whole file.
inline Environment environmentOf(const std::string& text) {
    static const Schemas kSchemas(environmentSchemas());
    const Document document = readRecordText(text, "room.env", kSchemas);
    return {document.records, assignIds(document.records)};
}

/// Of lines without the magic one.
inline Environment roomOf(const std::string& lines) { return environmentOf("#env 1\n" + lines); }

}  // namespace ispace
