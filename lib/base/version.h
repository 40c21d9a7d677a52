// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace ispace {

class JsonWriter;

/// Version of the project, as CMake's project() has it.
std::string_view version();

/// Begins the object of a report: {"schema","tool","version", and the rest follows.
JsonWriter& beginReport(JsonWriter& json, std::string_view schema, std::string_view tool);

}  // namespace ispace
