// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geom/pose.h"
#include "layout/scene.h"
#include "record/edit.h"

namespace ispace {

/// The edits that a request for a change of a world asks for: `SET ID.KEY=VALUE`, `ADD RECORD`,
/// `DELETE ID…`. \throws UsageError, FormatError as parseEdit, UsageError for another request
std::vector<Edit> parseEdits(std::string_view request);

/// True if an edit is about this id. \pre it does not add
bool isAbout(const Edit& edit, const std::string& id);

/// The key of a record that names a file; null if none does.
const char* fileKeyOf(const Record& record);

/// True if records that these edits are about, or have added, name files. \param scene as they left
/// it
bool touchFiles(const std::vector<Edit>& edits, const Scene& scene);

/// Where robots and people are now, by id; nothing for those who are not known.
using MoverPlaces = std::function<std::optional<Pose2>(const std::string& id)>;

/// The records of a scene after these edits. Robots and people whose place or heading is set are
/// where they are now but for that. \throws FormatError as edited()
std::vector<Record> editedRecords(const Scene& scene, const std::vector<Edit>& edits,
                                  const MoverPlaces& where);

/// Records that editedRecords() made earlier, with robots and people whose place or heading is set
/// where they are now but for that. \param ids of the records
void placeAgain(std::vector<Record>& records, std::span<const std::string> ids,
                const std::vector<Edit>& edits, const MoverPlaces& where);

/// Ids of those whom these edits put somewhere, where they may stand already.
std::vector<std::string> placedBy(const std::vector<Edit>& edits, const Scene& scene);

}  // namespace ispace
