// SPDX-License-Identifier: GPL-3.0-or-later
// Sentences of simrun --expect in a YAML file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "extensions/expect/sentence.h"

namespace ispace::expect {

/// Reads rules: a list of sentences, or a map with such a list under `rules`. A rule is a sentence
/// or a map with `expect`, the sentence, and, if it has one, a `name` for reports:
///
///     rules:
///       - no collision
///       - name: light for those that come
///         expect: lamp of kitchen on within 2s of anyone enters kitchen
///
/// \param name of the file, for messages \throws FormatError with all findings, each with its line
/// and column
std::vector<Expectation> readRules(std::string_view bytes, const std::string& name);

}  // namespace ispace::expect
