// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "record/schema.h"

namespace ispace {

/// True for a plain word: one or more of ASCII letters, digits and _ - . / + : @
bool isWord(std::string_view text);

/// One number of the key, with the suffixes its unit allows; bounds are not checked.
/// \throws as parseValue
double parseNumber(const KeySpec& key, std::string_view text);

/// The number as the key's canonical text has it: a share in per cent, else the shortest double.
std::string formatNumber(const KeySpec& key, double number);
/// Appends formatNumber(key, number).
void appendNumber(std::string& out, const KeySpec& key, double number);

/// "`key`: what": an error about a value that has no place yet.
[[noreturn]] void refuseValue(const KeySpec& key, const std::string& what);

}  // namespace ispace
