// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/glob.h"
#include "geom/point.h"
#include "record/record.h"

namespace ispace {

/// One change of a list of records, as the options of envc write it. `ids` is a glob (* ? [a-z]),
/// which also matches the / in the ids of parts.
struct Edit {
    enum class Kind {
        Add,      ///< RECORD: a line of the record language, put behind all others
        Fence,    ///< PATH: adds a fence with this path
        Set,      ///< ID.KEY=VALUE; without VALUE the key is left out again
        Move,     ///< ID:DX,DY[,DZ] metres along the axes; of a mounted sensor, its carrier's axes
        Forward,  ///< ID:M metres along its heading
        Rotate,   ///< ID:DEG counter-clockwise about its place, or the middle of its path
        Tilt,     ///< ID:DEG up
        Delete,   ///< ID
    };
    Kind kind = Kind::Add;
    std::string text;  ///< as written
    Glob ids;
    std::string key, value;
    Vec3 by;              ///< of Move; x of Forward
    Angle angle;          ///< of Rotate and Tilt
    bool closed = false;  ///< of Fence
};

/// Name of the option: "--move".
std::string optionOf(Edit::Kind kind);

/// Parses an edit's text. \throws UsageError, FormatError for numbers, both without the option's
/// name
Edit parseEdit(Edit::Kind kind, std::string_view text);

/// "the id `door1` is taken by the door in room.env:3"
std::string takenText(const std::string& id, const Record& holder);

/// The records that --add and --fence add, in order. \throws FormatError as edited
std::vector<Record> addedRecords(std::span<const Edit> edits, const Schemas& schemas);

/// The records after all edits in their order.
///
/// Ids are those before the first edit (assignIds), written or automatic; where an edit would
/// change an automatic id that later records or layouts may name, it is written from then on. A
/// new id (`--set l1.id=west`) is followed by the records that name the old one. Where a glob moves
/// several records, what is mounted on one of them, or has no place of its own, follows by
/// itself. `result` records are dropped by any edit: they tell of another layout.
/// \throws FormatError, each message beginning with the edit ("--move l9:1,0: no record has the id
///         …"): an id that no record has, a key that the record has not, a value out of bounds, a
///         move of what has no place of its own, a record removed that another one names
std::vector<Record> edited(std::vector<Record> records, std::span<const Edit> edits,
                           const Schemas& schemas);

}  // namespace ispace
