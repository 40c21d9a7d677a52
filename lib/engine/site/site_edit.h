// SPDX-License-Identifier: GPL-3.0-or-later
// Edits of a whole building, by ids across it.
//
//     editSite(building, parseEdits("SET ground/d1.open=yes"));
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "record/edit.h"
#include "site/site_scene.h"
#include "site/storeys.h"

namespace ispace {

/// Applies edits to the records of the rooms, which have their ids across the building
/// ("ground/d1"), and to the passages; of an only storey the plain ids do, too. Added records are
/// of rooms, and their ids begin with the storey. Records keep automatic ids where the edits do not
/// shift them. Rooms without a change stay shared; a room that storeys share is changed for the
/// storeys of the edited ids alone. \throws FormatError as edited(), for added records without a
/// storey, and as makeBuilding()
void editSite(StoreyedDocument& building, std::span<const Edit> edits);

/// Returns the scene of a storey with the ids of all its records across the building; that of a
/// room alone.
std::shared_ptr<const Scene> sceneOfSite(const SiteScene& building, std::size_t storey);

}  // namespace ispace
