// SPDX-License-Identifier: GPL-3.0-or-later
// lib/layout: placements, device catalogue, Scene = environment + layout. Uses env, record, geom.
#pragma once

#include <vector>

#include "record/schema.h"

namespace ispace {

/// laser, environment, result.
std::vector<Schema> layoutSchemas();

/// The `laser` of a device file: the figures of a laser record, with model, source and confidence
/// required, and without a place.
Schema laserDeviceSchema();

/// Every keyword of `.env` and `.3dm`: environmentSchemas() and layoutSchemas(). A constant.
const Schemas& sceneSchemas();

}  // namespace ispace
