// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of lib/kernel/env: environments from text.
#pragma once

#include <string>

#include "env/element_schemas.h"
#include "env/environment.h"
#include "geom/arrangement.h"
#include "record/text.h"

namespace ispace::testing {

inline const Schemas& schemas() {
    static const Schemas kSchemas(environmentSchemas());
    return kSchemas;
}

inline Record record(const std::string& line) { return readRecord(line, "line", schemas()); }

inline Document document(const std::string& lines) {
    return readRecordText("#env 1\n" + lines, "room.env", schemas());
}

inline Environment environment(const std::vector<Record>& records) {
    return {records, assignIds(records)};
}

/// Line 1 is the magic line, so the first of `lines` is line 2.
inline Environment environment(const std::string& lines) {
    return environment(document(lines).records);
}

/// Returns all findings of reading or building, one per line; "" if there are no findings.
inline std::string findings(const std::string& lines) {
    try {
        static_cast<void>(environment(lines));
    } catch (const FormatError& error) {
        std::string out;
        for (const Diagnostic& diagnostic : error.diagnostics()) out += diagnostic.text() + '\n';
        return out;
    }
    return "";
}

inline double areaOf(const std::vector<Polygon>& solids) {
    double area = 0;
    for (const Polygon& solid : solids) area += signedArea(solid);
    return area;
}

}  // namespace ispace::testing
