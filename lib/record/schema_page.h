// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "record/schema.h"

namespace ispace {

/// A page of the manual, written for man(7): lines `@RECORDS TYPE…@` of the template give way to
/// the keywords of these types (space, floor, wall, infra, other, placement, meta), each with its
/// keys, their values, units, bounds and defaults.
/// \throws FormatError for a type that is none
std::string expandManual(std::string_view page, const Schemas& schemas);

/// One keyword as a subsection.
std::string manualOf(const Schema& schema);

}  // namespace ispace
