// SPDX-License-Identifier: GPL-3.0-or-later
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

/// a + b + c in decimal arithmetic: 0.1 + 0.2 is 0.3. A sum within rounding errors (a picometre for
/// terms of up to a kilometre, more for larger ones) of a number with at most nine decimals is that
/// number. Never minus zero.
double decimalSum(double a, double b, double c = 0);

/// A turned heading: the decimalSum of both in (-180, 180], in degrees.
double turnedHeading(double degrees, Angle turn);

/// Puts a record that stands in a frame into the frame's parent, by the roles of its keys.
///
/// Places that are written move: tuples and lists of them. If none is written, the one that has a
/// default (`at`, 0,0) moves from there and becomes written; without a default, as for a sensor
/// still to be placed or a door placed by its wall, the record stays. A heading turns, and becomes
/// written where it has a default, if `at` moved: that of a wall by its ends says nothing. Courses
/// move always. What has a carrier stays: its places are in the carrier's frame.
///
/// `dz` is added to the third number of places that have one; two numbers become three where the
/// key allows three and dz is not 0 (from KeySpec::standard_z). Other places stay on the floor, see
/// canRise.
///
/// Numbers stay as a person would write them. A coordinate that nothing is added to, turned by
/// multiples of 90 degrees, is exact. Any other is a decimalSum: 1.2 + 0.5 is 1.7, and a move there
/// and back changes nothing. A heading that turns becomes its turnedHeading. \throws FormatError
/// with the record's place if a number leaves its bounds; the record may be
///         moved in part then
void placeIn(Record& record, const Pose2& parent_from_record, double dz = 0);

/// The same for a move within the frame the record's places are in: that of the carrier, if it has
/// one. A carried record without place stands at 0,0.
void moveInFrame(Record& record, const Pose2& motion, double dz = 0);

/// Where the record stands, in the frame of its places: `at`, else the first point of the first
/// place that is written, else the default of `at` (for carried records 0,0); nothing if it has no
/// place.
std::optional<Point2> placeOf(const Record& record);

/// False if placeIn and moveInFrame can move the record but not lift it.
bool canRise(const Record& record);

/// The motion that turns about a point and then moves by an offset.
Pose2 turnAbout(Point2 centre, Angle turn, Vec2 offset);

}  // namespace ispace
