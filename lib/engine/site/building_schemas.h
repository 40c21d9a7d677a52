// SPDX-License-Identifier: GPL-3.0-or-later
// The vocabulary of buildings: keywords that join rooms.
#pragma once

#include "record/schema.h"

namespace ispace {

/// Returns the schemas of a building file: `storey`, `stairs`, `lift` and `shaft`. A constant. The
/// rooms of its storeys have those of sceneSchemas().
const Schemas& buildingSchemas();

}  // namespace ispace
