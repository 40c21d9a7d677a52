// SPDX-License-Identifier: GPL-3.0-or-later
// Checks landings of stairs before a run: crowds jam where those that wait block those that come.
#pragma once

#include <vector>

#include "base/error.h"
#include "site/site_scene.h"

namespace ispace::passages {

/// Reports landings of stairs at which movers hinder each other in runs: those that are less deep
/// than one mover needs to walk freely, and those where all that wait stand in the way of those
/// that come off. It judges the widest mover that climbs, a person at least, by the ways and the
/// spots of BuildingRun. Computes the ways over all storeys.
std::vector<Diagnostic> landingFindings(const SiteScene& building);

}  // namespace ispace::passages
