// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "io/ifc/building.h"

namespace ispace {

/// readBuilding() in lib/ispace/read-mesh, confined as meshes are: bounds on memory and time, no
/// files, no rights. \param name of the file, for messages \throws FormatError
Building readBuildingInChild(std::string_view bytes, const std::string& name,
                             std::optional<double> slice);

}  // namespace ispace
