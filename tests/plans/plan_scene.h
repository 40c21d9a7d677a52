// SPDX-License-Identifier: GPL-3.0-or-later
// For the tests of this folder.
#pragma once

#include <string>

#include "env/element_schemas.h"
#include "env/environment.h"
#include "record/text.h"

namespace ispace::testing {

inline Environment environmentOf(const std::string& text) {
    static const Schemas kSchemas(environmentSchemas());
    const Document document = readRecordText(text, "plan.env", kSchemas);
    return {document.records, assignIds(document.records)};
}

}  // namespace ispace::testing
