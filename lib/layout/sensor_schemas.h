// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/layout only: the records of sensors and of what they listen to.
#pragma once

#include <vector>

#include "record/schema.h"

namespace ispace {

/// laser, ranger, camera, ultrasound, tag.
std::vector<Schema> sensorSchemas();

// The figures that a model gives too; none has a default, as its absence means "as the model".
void addLaserFigures(std::vector<KeySpec>& keys);
void addRangerFigures(std::vector<KeySpec>& keys);
void addUltrasoundFigures(std::vector<KeySpec>& keys);
void addTagFigures(std::vector<KeySpec>& keys);

}  // namespace ispace
