// SPDX-License-Identifier: GPL-3.0-or-later
// lib/layout: placements, device catalogue, Scene = environment + layout. Uses env, record, geom.
#pragma once

#include <vector>

#include "record/schema.h"

namespace ispace {

/// laser, robot, environment, result.
std::vector<Schema> layoutSchemas();

/// The `laser` of a device file: the figures of a laser record, with model, source and confidence
/// required, and without a place.
Schema laserDeviceSchema();
/// The same for a `robot`.
Schema robotDeviceSchema();

/// True for the keywords of what sees: what arrange places, and scan and coverage read.
bool isSensor(const Schema& schema);

/// Every keyword of `.env` and `.3dm`: environmentSchemas() and layoutSchemas(). A constant.
const Schemas& sceneSchemas();

}  // namespace ispace
