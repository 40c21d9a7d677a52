// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "io/ros_map.h"
#include "record/record.h"

namespace ispace {

/// Reads any environment or layout the library knows, told apart by content: GLB, `#env`, `#3dm`,
/// ROS map YAML, other YAML. `operand` is a file name or "-".
/// \throws FormatError (also: empty input, or no format we know, with a hint), std::system_error
Document readDocument(const std::string& operand, const ImportOptions& options,
                      const Schemas& schemas);

/// The same for bytes already read.
Document parseDocument(std::string_view bytes, const std::string& operand,
                       const ImportOptions& options, const Schemas& schemas);

}  // namespace ispace
