// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of importers: their notes and warnings, and robustness against damaged files.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"
#include "support/test_damage.h"

namespace ispace {

inline Environment environmentOf(const Document& document) {
    return makeScene(document, nullptr, DeviceCatalogue()).environment;
}

/// Returns all notes, one per line.
inline std::string notesOf(const Document& document) {
    std::string all;
    for (const std::string& note : document.notes) all += note + '\n';
    return all;
}

/// Returns all warnings in the form that tools print, one per line.
inline std::string warningsOf(const Document& document) {
    std::string all;
    for (const Diagnostic& warning : document.warnings) all += warning.text() + '\n';
    return all;
}

inline std::size_t countOf(const Document& document, const std::string& keyword) {
    return static_cast<std::size_t>(
        std::count_if(document.records.begin(), document.records.end(),
                      [&](const Record& record) { return record.keyword() == keyword; }));
}

}  // namespace ispace
