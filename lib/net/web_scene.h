// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "layout/scene.h"

namespace ispace {

/// What browsers need to know once about a scene, as share/schemas/web-scene.json says: the plan
/// (see writePlan), what moves in it and how large that is, its sensors, the colours.
/// \param version names it in state frames \param title e.g. base name of ENV
std::string webScene(const Scene& scene, std::int64_t version, const std::string& title);

}  // namespace ispace
