// SPDX-License-Identifier: GPL-3.0-or-later
// The schemas of placements: sensors, robots, people, furniture that a layout adds.
//
// sceneSchemas() is built at its first call and constant from then on: schemas and keys that are
// added later have no effect. Records point into it. Thread-safe after that.
//
//     const Schemas& schemas = sceneSchemas();
//     const Record laser = readRecord("laser id=l1 at=2,1,0.3 model=urg-04lx", "-", schemas);
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "record/record.h"
#include "record/schema.h"
#include "scene/devices.h"

namespace ispace {

/// Returns the schemas of placement records, `environment` and `result`.
std::vector<Schema> layoutSchemas();

/// Returns the schemas of device files: the parameters of a laser, ranger, ultrasound, tag or robot
/// record. Model, source and confidence are required; a position is rejected.
std::vector<Schema> deviceSchemas();

/// Returns true if other records may carry those of a schema: a key `on` of others is no carrier.
bool mayBeCarried(const Schema& schema);
/// Returns the id of the record that carries this one; "" if it stands by itself.
std::string carrierOf(const Record& record);

/// Adds keywords of an extension to those of `.3dm`; the program does so before it first calls
/// sceneSchemas(). Such records are placements, which the core keeps and writes, and no more; or
/// elements of the room with a body, see addBodyShape().
void addSceneSchemas(std::vector<Schema> schemas);

/// Adds keys of an extension to the records of a keyword, behind those that it has: states, and
/// what these need. The program does so before it first calls sceneSchemas().
/// \pre the keyword is known, and has no such keys
void addSceneKeys(std::string_view keyword, std::vector<KeySpec> keys);

/// Returns the schema of every keyword of `.env` and `.3dm`: environmentSchemas(), layoutSchemas()
/// and those of extensions. A constant.
const Schemas& sceneSchemas();

}  // namespace ispace
