// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

namespace ispace {

/// What of a DXF file a plan is made of, checked, and written so that dxflib reads it without harm.
///
/// dxflib trusts its input: group 42 before the first vertex writes beside its array, counts are
/// allocated as they stand, a line of more than 1024 characters is read for ever, and the value of
/// a number that is none is left to chance. So only groups that are needed are handed on, with
/// numbers that are numbers and counts that were counted; polylines of both kinds as LWPOLYLINE,
/// and group 5 (the handle) of each entity holds the line of the file it began on.
struct DxfText {
    std::string text;
    std::map<std::string, std::size_t> left_out;  ///< entities not handed on, by type or reason
};

/// True if the bytes begin like ASCII DXF: a section, perhaps behind comments.
bool isDxf(std::string_view bytes);

/// \throws FormatError with its line: no group code, a number that is none, a missing coordinate,
///         an end before `EOF`
DxfText checkedDxf(std::string_view bytes, const std::string& name);

}  // namespace ispace
