// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "env/body.h"

namespace ispace {

/// The body of a `mesh` record; none while its file is not loaded.
///
/// The file's numbers are turned so that z is up (y-up: (x, -z, y); x-up: (y, z, x); `auto` and z:
/// as they are, since the loader resolves `auto`), multiplied by unit and `scale`, turned by
/// `heading` and moved to `at`: the file's origin stays the origin, also in height. Vertices at
/// the same place are one, so that triangles share edges though the file may not say so; triangles
/// with fewer than three corners are dropped. A closed mesh that is inside out is turned.
Body meshBody(const Record& record);

/// Metres one of the file's numbers is, by `unit` and `scale` of a `mesh` record.
double meshScale(const Record& record);

/// A finding about the file of a `mesh` record if it cannot be a body: not loaded, without any
/// triangle, or reaching too far.
void checkMesh(const Record& record, const Body& body, Diagnostics& findings);

}  // namespace ispace
