// SPDX-License-Identifier: GPL-3.0-or-later
// lib/layout: placements, device catalogue, Scene = environment + layout. Uses env, record, geom.
#pragma once

#include <vector>

#include "record/schema.h"

namespace ispace {

/// The keywords of what is placed, and environment and result.
std::vector<Schema> layoutSchemas();

/// The keywords of device files: the parameters of a laser, ranger, ultrasound, tag or robot
/// record,
/// with model, source and confidence required, and without a place.
std::vector<Schema> deviceSchemas();

/// Every keyword of `.env` and `.3dm`: environmentSchemas() and layoutSchemas(). A constant.
const Schemas& sceneSchemas();

}  // namespace ispace
