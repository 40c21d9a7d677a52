// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/edit.h"

#include <gtest/gtest.h>

#include "record/text.h"
#include "support/test_schemas.h"

namespace ispace {
namespace edit_test {

using Kind = Edit::Kind;

KeySpec placeKey(std::string name, KeyType type, std::size_t most) {
    KeySpec key = testKey(std::move(name), type, Unit::Length);
    key.min_count = 2;
    key.max_count = most;
    key.role = Role::Place;
    return key;
}

/// A body, a path, a line, a sensor and a door, as the real schemas have them.
const Schemas& schemas() {
    static const Schemas all = [] {
        const KeySpec id = testKey("id", KeyType::Word);
        KeySpec heading = testKey("heading", KeyType::Number, Unit::Angle);
        heading.default_value = 0.0;
        heading.role = Role::Heading;
        KeySpec at = placeKey("at", KeyType::Tuple, 3);
        at.default_value = Tuple{0, 0};
        KeySpec sensor_at = placeKey("at", KeyType::Tuple, 3);
        sensor_at.standard_z = 0.15;
        KeySpec tilt = testKey("tilt", KeyType::Number, Unit::Angle);
        tilt.default_value = 0.0;
        tilt.lower = -90;
        tilt.upper = 90;
        tilt.role = Role::Tilt;
        KeySpec on = testKey("on", KeyType::Word);
        on.role = Role::Carrier;
        KeySpec wall = testKey("wall", KeyType::Word);
        wall.role = Role::Reference;
        KeySpec closed = testKey("closed", KeyType::Flag);
        closed.default_value = false;
        KeySpec height = testKey("height", KeyType::Number, Unit::Length);
        height.default_value = 0.7;
        return Schemas({
            {"desk", RecordType::Other, "a desk", {id, at, heading, height}},
            {"fence",
             RecordType::Wall,
             "a fence",
             {id, placeKey("path", KeyType::TupleList, 2), closed}},
            {"wall",
             RecordType::Wall,
             "a wall",
             {id, placeKey("from", KeyType::Tuple, 2), placeKey("to", KeyType::Tuple, 2), at,
              heading}},
            {"door",
             RecordType::Wall,
             "a door",
             {id, wall, testKey("offset", KeyType::Number, Unit::Length)}},
            {"laser", RecordType::Placement, "a laser", {id, sensor_at, heading, tilt, on}},
            {"result", RecordType::Meta, "a result", {id}},
        });
    }();
    return all;
}

/// The canonical lines after the edits.
std::string edit(const std::string& lines, const std::vector<std::pair<Kind, std::string>>& edits) {
    std::vector<Edit> list;
    for (const auto& [kind, text] : edits) list.push_back(parseEdit(kind, text));
    const Document document = readRecordText("#env 1\n" + lines, "a.env", schemas());
    std::string out;
    for (const Record& record : edited(document.records, list, schemas()))
        out += formatRecord(record) + "\n";
    return out;
}

std::string errorOf(const std::string& lines, Kind kind, const std::string& text) {
    const auto texts = findingsOf([&] { (void)edit(lines, {{kind, text}}); });
    return texts.empty() ? "" : texts.front();
}

TEST(Edit, MovesABodyASensorAndAPath) {
    EXPECT_EQ(edit("desk id=d at=2.1,3\n", {{Kind::Move, "d:0.2,-3"}}), "desk id=d at=2.3,0\n");
    EXPECT_EQ(edit("desk\n", {{Kind::Move, "desk1:1,0"}}), "desk at=1,0\n");
    EXPECT_EQ(edit("laser id=l at=1,1\n", {{Kind::Move, "l:0,0,5cm"}}), "laser id=l at=1,1,0.2\n");
    EXPECT_EQ(edit("laser id=l at=1,1,2\n", {{Kind::Move, "l:1,1,-1"}}), "laser id=l at=2,2,1\n");
    EXPECT_EQ(edit("fence id=f path=0,0;4,0\n", {{Kind::Move, "f:1,1"}}),
              "fence id=f path=1,1;5,1\n");
    EXPECT_EQ(edit("wall id=w from=0,0 to=4,0\n", {{Kind::Move, "w:1,1"}}),
              "wall id=w from=1,1 to=5,1\n");
}

TEST(Edit, MovesAMountedSensorInItsCarriersFrame) {
    EXPECT_EQ(edit("laser id=l on=d\n desk id=d\n",
                   {{Kind::Set, "l.at=0.1,0"}, {Kind::Move, "l:0.1,0,0.2"}}),
              "laser id=l at=0.2,0,0.35 on=d\ndesk id=d\n");
}

TEST(Edit, SumsDecimalsAsAPersonDoes) {
    EXPECT_EQ(edit("desk id=d at=0.1,1.1\n", {{Kind::Move, "d:0.2,2.2"}}),
              "desk id=d at=0.3,3.3\n");
    // What has no short form is kept to the last digit.
    EXPECT_EQ(edit("desk id=d at=0.3333333333333333,0\n", {{Kind::Move, "d:1,0"}}),
              "desk id=d at=1.3333333333333333,0\n");
}

TEST(Edit, GoesForwardAlongTheHeading) {
    EXPECT_EQ(edit("desk id=d at=1,1 heading=90\n", {{Kind::Forward, "d:0.5"}}),
              "desk id=d at=1,1.5 heading=90\n");
    EXPECT_EQ(edit("desk id=d at=1,1 heading=180\n", {{Kind::Forward, "d:-50cm"}}),
              "desk id=d at=1.5,1 heading=180\n");
    EXPECT_EQ(errorOf("fence id=f path=0,0;1,0\n", Kind::Forward, "f:1"),
              "error: --forward f:1: `f`: has no heading to go along");
}

TEST(Edit, RotatesAboutItsPlaceOrTheMiddleOfItsPath) {
    EXPECT_EQ(edit("desk id=d at=1,1 heading=350\n", {{Kind::Rotate, "d:20"}}),
              "desk id=d at=1,1 heading=10\n");
    EXPECT_EQ(edit("fence id=f path=0,0;4,0;4,2\n", {{Kind::Rotate, "f:90"}}),
              "fence id=f path=3,-1;3,3;1,3\n");
    EXPECT_EQ(edit("wall id=w from=0,0 to=4,0\n", {{Kind::Rotate, "w:90"}}),
              "wall id=w from=2,-2 to=2,2\n");
    EXPECT_EQ(errorOf("door id=d wall=w offset=1\n", Kind::Rotate, "d:5"),
              "error: --rotate d:5: `d`: a door cannot be rotated");
}

TEST(Edit, TiltsWithinBounds) {
    EXPECT_EQ(edit("laser id=l at=1,1 tilt=-10\n", {{Kind::Tilt, "l:-20"}}),
              "laser id=l at=1,1 tilt=-30\n");
    EXPECT_NE(errorOf("laser id=l at=1,1 tilt=80\n", Kind::Tilt, "l:20").find("100 is above 90"),
              std::string::npos);
    EXPECT_EQ(errorOf("desk id=d\n", Kind::Tilt, "d:20"),
              "error: --tilt d:20: `d`: a desk cannot be tilted");
}

TEST(Edit, SetsAndUnsets) {
    EXPECT_EQ(edit("desk id=d\n", {{Kind::Set, "d.height=72cm"}}), "desk id=d height=0.72\n");
    EXPECT_EQ(edit("desk id=d height=1\n", {{Kind::Set, "d.height="}}), "desk id=d\n");
    EXPECT_EQ(errorOf("desk id=d\n", Kind::Set, "d.heigth=1"),
              "error: --set d.heigth=1: a desk has no key `heigth`, did you mean `height`?");
}

TEST(Edit, RenamesWhatNamesIt) {
    EXPECT_EQ(edit("desk id=d\nlaser id=l on=d\n", {{Kind::Set, "d.id=east"}}),
              "desk id=east\nlaser id=l on=east\n");
    EXPECT_EQ(errorOf("desk id=d\nlaser id=l on=d\n", Kind::Set, "d.id=l"),
              "error: --set d.id=l: the id `l` is taken by the laser in a.env:3");
    EXPECT_EQ(
        errorOf("desk at=1,1\n", Kind::Add, "desk id=desk1"),
        "error: --add desk id=desk1: the id `desk1` is taken by the desk in a.env:2, which has no "
        "id written");
}

TEST(Edit, DeletesAndKeepsTheNamesOfTheOthers) {
    EXPECT_EQ(edit("desk\ndesk at=1,0\ndesk at=2,0\n",
                   {{Kind::Delete, "desk1"}, {Kind::Move, "desk3:0,1"}}),
              "desk id=desk2 at=1,0\ndesk id=desk3 at=2,1\n");
    EXPECT_EQ(edit("desk\ndesk at=1,0\n", {{Kind::Delete, "desk2"}}), "desk\n");
}

TEST(Edit, TakesGlobsInTheOrderOfTheEdits) {
    EXPECT_EQ(edit("desk id=a/1\ndesk id=a/2\nlaser id=l at=1,1\n",
                   {{Kind::Move, "a*:1,0"}, {Kind::Delete, "*/2"}, {Kind::Add, "desk at=9,9"}}),
              "desk id=a/1 at=1,0\nlaser id=l at=1,1\ndesk at=9,9\n");
    EXPECT_EQ(errorOf("desk id=d1\n", Kind::Delete, "d2"),
              "error: --delete d2: no record has the id `d2`, did you mean `d1`?");
}

TEST(Edit, AGlobWithoutMatchListsTheIds) {
    EXPECT_EQ(errorOf("desk id=d\nlaser id=urm1\n", Kind::Rotate, "utm*:30"),
              "error: --rotate utm*:30: no record has the id `utm*`; there are d, urm1");
    std::string many;
    for (int i = 0; i < 30; ++i) many += "desk\n";
    const std::string error = errorOf(many, Kind::Rotate, "utm*:30");
    EXPECT_NE(error.find("there are 30 ids, among them desk11, desk12,"), std::string::npos)
        << error;
    EXPECT_TRUE(error.ends_with("desk29, desk30")) << error;
}

TEST(Edit, MovesAllByAGlobOnce) {
    EXPECT_EQ(edit("desk id=d at=1,1\nlaser id=l at=0.1,0 on=d\nwall id=w from=0,0 to=4,0\n"
                   "door id=o wall=w offset=1\nlaser id=m at=2,2\n",
                   {{Kind::Move, "*:1,0"}}),
              "desk id=d at=2,1\nlaser id=l at=0.1,0 on=d\nwall id=w from=1,0 to=5,0\n"
              "door id=o wall=w offset=1\nlaser id=m at=3,2\n");
    EXPECT_EQ(edit("desk id=d at=1,1\nlaser id=l at=0.1,0 on=d\nlaser id=m at=2,2\n",
                   {{Kind::Rotate, "*:90"}}),
              "desk id=d at=1,1 heading=90\nlaser id=l at=0.1,0 on=d\n"
              "laser id=m at=2,2 heading=90\n");
    // Others have no place, or cannot be tilted.
    EXPECT_EQ(edit("desk id=d at=1,1\nlaser id=l\nresult id=r\n", {{Kind::Move, "*:1,0"}}),
              "desk id=d at=2,1\nlaser id=l\n");
    EXPECT_EQ(edit("desk id=d at=1,1\nlaser id=l at=1,1\n", {{Kind::Tilt, "*:5"}}),
              "desk id=d at=1,1\nlaser id=l at=1,1 tilt=5\n");
    EXPECT_EQ(errorOf("desk id=d1\ndesk id=d2\n", Kind::Tilt, "d*:5"),
              "error: --tilt d*:5: nothing of what matches can be changed so");
    // What it is on stays: then it moves there.
    EXPECT_EQ(edit("desk id=d at=1,1\nlaser id=l1 at=0.1,0 on=d\nlaser id=l2 at=2,2\n",
                   {{Kind::Move, "l*:1,0"}}),
              "desk id=d at=1,1\nlaser id=l1 at=1.1,0 on=d\nlaser id=l2 at=3,2\n");
}

TEST(Edit, LeavesNoNameBehind) {
    EXPECT_EQ(errorOf("desk id=d\nlaser id=l on=d\n", Kind::Delete, "d"),
              "error: --delete d: `l` has `on=d`; delete it, too, or set that anew");
    EXPECT_EQ(edit("desk id=d\nlaser id=l on=d\n", {{Kind::Delete, "d"}, {Kind::Delete, "l"}}), "");
    EXPECT_EQ(edit("desk id=d\nlaser id=l on=d\n",
                   {{Kind::Delete, "d"}, {Kind::Set, "l.on="}, {Kind::Set, "l.at=1,1"}}),
              "laser id=l at=1,1\n");
    // Another file may have what is named.
    EXPECT_EQ(edit("laser id=l on=r1\ndesk id=d\n", {{Kind::Delete, "d"}}), "laser id=l on=r1\n");
}

TEST(Edit, AddsFences) {
    Edit fence = parseEdit(Kind::Fence, "0,0;4,0;4,3");
    fence.closed = true;
    const std::vector<Record> records = edited({}, std::vector<Edit>{fence}, schemas());
    ASSERT_EQ(records.size(), 1U);
    EXPECT_EQ(formatRecord(records[0]), "fence path=0,0;4,0;4,3 closed=yes");
}

TEST(Edit, NamesTheFenceThatIsNone) {
    EXPECT_EQ(errorOf("desk id=d\n", Kind::Fence, "1,0;x,0"),
              "error: --fence 1,0;x,0: `path`: `x` is not a number");
}

TEST(Edit, KeepsIdsThatOthersMayName) {
    EXPECT_EQ(errorOf("desk id=d\n", Kind::Set, "d.id="),
              "error: --set d.id=: an id cannot be left out, others may name it");
    // An id that was given up may be used anew.
    EXPECT_EQ(edit("desk id=d\n", {{Kind::Set, "d.id=e"}, {Kind::Add, "desk id=d at=1,0"}}),
              "desk id=e\ndesk id=d at=1,0\n");
    EXPECT_EQ(edit("desk id=d\n", {{Kind::Delete, "d"}, {Kind::Add, "desk id=d at=1,0"}}),
              "desk id=d at=1,0\n");
}

TEST(Edit, TakesNoTimeForManyRecords) {
    std::string lines;
    for (int i = 0; i < 20000; ++i) lines += "desk\n";
    std::vector<std::pair<Kind, std::string>> edits{{Kind::Delete, "desk*[05]"}};
    for (int i = 0; i < 50; ++i) edits.emplace_back(Kind::Add, "desk at=1,1");
    // 16 000 are left, the added ones have numbers of their own.
    const std::string out = edit(lines, edits);
    EXPECT_EQ(std::count(out.begin(), out.end(), '\n'), 16050);
    EXPECT_NE(out.find("desk id=desk5 at=1,1\n"), std::string::npos);
}

TEST(Edit, DropsAResultThatIsNoLongerTrue) {
    EXPECT_EQ(edit("laser id=l at=1,1\nresult id=r\n", {{Kind::Move, "l:1,0"}}),
              "laser id=l at=2,1\n");
    EXPECT_EQ(edit("result id=r\n", {}), "result id=r\n");
}

TEST(Edit, RefusesWhatHasNoPlace) {
    EXPECT_EQ(errorOf("laser id=l\n", Kind::Move, "l:1,0"),
              "error: --move l:1,0: `l`: has no place of its own, give it one with --set "
              "ID.at=X,Y");
    EXPECT_EQ(errorOf("door id=d wall=w offset=1\n", Kind::Move, "d:1,0"),
              "error: --move d:1,0: `d`: has no place of its own: it is in its wall, move it with "
              "--set ID.offset=M");
    EXPECT_EQ(errorOf("fence id=f path=0,0;1,0\n", Kind::Move, "f:1,0,1"),
              "error: --move f:1,0,1: `f`: has no height to move by");
}

TEST(Edit, RefusesTextThatIsNoEdit) {
    for (const auto& [kind, text] :
         std::vector<std::pair<Kind, std::string>>{{Kind::Move, "l1"},
                                                   {Kind::Move, "l1:"},
                                                   {Kind::Move, ":1,0"},
                                                   {Kind::Set, "l1=3"},
                                                   {Kind::Set, ".at=1,1"},
                                                   {Kind::Set, "l1.=3"},
                                                   {Kind::Delete, ""},
                                                   {Kind::Forward, "l1"}})
        EXPECT_THROW((void)parseEdit(kind, text), UsageError) << text;
    for (const auto& [kind, text] :
         std::vector<std::pair<Kind, std::string>>{{Kind::Move, "l1:1"},
                                                   {Kind::Move, "l1:1,2,3,4"},
                                                   {Kind::Rotate, "l1:fast"},
                                                   {Kind::Forward, "l1:nan"},
                                                   {Kind::Tilt, "l1:5m"}})
        EXPECT_THROW((void)parseEdit(kind, text), FormatError) << text;
}

}  // namespace edit_test
}  // namespace ispace
