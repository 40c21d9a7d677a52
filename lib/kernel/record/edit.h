// SPDX-License-Identifier: GPL-3.0-or-later
// Changes of records by options, as `envc --move desk*:1,0`, and records moved between frames.
// Decimal arithmetic: numbers stay as short as a user wrote them, and a move there and back
// restores the coordinates. Pure functions but for placeIn() and moveInFrame(), which change their
// record.
//
//     const std::vector<Edit> edits{parseEdit(Edit::Kind::Move, "desk*:1,0")};
//     records = edited(std::move(records), edits, schemas);
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/glob.h"
#include "geom/point.h"
#include "geom/pose.h"
#include "record/record.h"

namespace ispace {

/// One change of a list of records, in the syntax of envc's options. `ids` is a glob (* ? [a-z]),
/// which also matches the / in the ids of parts.
struct Edit {
    enum class Kind {
        Add,      ///< RECORD: appends a line of the record language
        Fence,    ///< PATH: adds a fence with this path
        Set,      ///< ID.KEY=VALUE; an empty VALUE removes the key
        Move,     ///< ID:DX,DY[,DZ] metres along the axes; a mounted sensor uses its carrier's axes
        Forward,  ///< ID:M metres along its heading
        Rotate,   ///< ID:DEG counter-clockwise about its position, or the middle of its path
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

/// Parses the records that --add and --fence add, in order. \throws FormatError as edited()
std::vector<Record> addedRecords(std::span<const Edit> edits, const Schemas& schemas);

/// Applies the edits in order and returns the records.
///
/// Records keep their ids from before the first edit (assignIds), written or automatic. If an edit
/// would change an automatic id, which other records or layouts may reference, the old one is
/// written into the record. A new id (`--set l1.id=west`) is updated in the records that reference
/// the old one. If a glob moves several records, it skips those mounted on another of them and
/// those without coordinates: they follow their carrier or wall. Any edit removes the `result`
/// records: they describe another layout.
/// \param ids assignIds(records), if they are known
/// \throws FormatError, each message beginning with the edit ("--move l9:1,0: no record has the id
///         …"): an unknown id or key, a value out of bounds, a move of a record without
///         coordinates, removal of a record that another one references
std::vector<Record> edited(std::vector<Record> records, std::span<const Edit> edits,
                           const Schemas& schemas, const std::vector<std::string>* ids = nullptr);

/// Computes a + b + c in decimal arithmetic: 0.1 + 0.2 is 0.3. The sum is rounded to a number with
/// at most nine decimals if one lies within the rounding error (a picometre for terms up to a
/// kilometre, more for larger ones). Never returns minus zero.
double decimalSum(double a, double b, double c = 0);

/// Returns the turned heading, a decimalSum in (-180, 180], in degrees.
double turnedHeading(double degrees, Angle turn);

/// Converts a record from its frame to the parent frame, by the roles of its keys.
///
/// Written coordinates are transformed: tuples and tuple lists. If the record has only a default
/// position (`at`, 0,0), the transformed default is written; without a default, as for an unplaced
/// sensor or a door located by its wall, the record stays. The heading is turned if `at` moved, and
/// written if it was a default; a wall given by its ends ignores its heading. Motion plans are
/// always transformed. A record with a carrier stays: its coordinates are in the carrier's frame.
///
/// `dz` is added to the third coordinate. Two coordinates become three if the key allows three and
/// dz is not 0 (starting from KeySpec::standard_z). Other records stay on the floor, see canRise.
///
/// Numbers stay short. A turn by multiples of 90 degrees without an offset is exact. Any other
/// coordinate is a decimalSum: 1.2 + 0.5 is 1.7, and a move there and back restores the record. A
/// heading becomes its turnedHeading.
/// \throws FormatError at the record's source location if a number leaves its bounds; the record
///         may then be partly moved
void placeIn(Record& record, const Pose2& parent_from_record, double dz = 0);

/// Moves a record within the frame of its coordinates: the carrier's frame, if it has a carrier. A
/// carried record without coordinates stands at 0,0.
void moveInFrame(Record& record, const Pose2& motion, double dz = 0);

/// Returns the record's position in the frame of its coordinates: `at`, else the first written
/// point, else the default of `at` (0,0 for carried records); empty if it has no position.
std::optional<Point2> placeOf(const Record& record);

/// Returns false if placeIn and moveInFrame can move the record but not lift it.
bool canRise(const Record& record);

/// Returns the motion that turns about a point and then moves by an offset.
Pose2 turnAbout(Point2 centre, Angle turn, Vec2 offset);

}  // namespace ispace
