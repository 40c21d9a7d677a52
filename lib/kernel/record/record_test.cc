// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/record.h"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "record/text.h"
#include "support/test_schemas.h"

namespace ispace {

namespace record_test {

Record make(const char* keyword) { return Record(*testSchemas().find(keyword)); }

Record make(const char* keyword, const std::string& id) {
    Record record = make(keyword);
    record.set("id", id);
    return record;
}

TEST(Record, HoldsWhatWasSet) {
    Record desk = make("desk", "d1");
    desk.set("at", Tuple{2, 3});
    desk.set("heading", 30.0);
    EXPECT_EQ(desk.keyword(), "desk");
    EXPECT_EQ(desk.writtenId(), "d1");
    EXPECT_EQ(desk.tuple("at"), (Tuple{2, 3}));
    EXPECT_EQ(desk.angle("heading"), Angle::degrees(30));
    desk.set("heading", 40.0);
    EXPECT_EQ(desk.number("heading"), 40);
    desk.erase("at");
    EXPECT_FALSE(desk.has("at"));
    EXPECT_EQ(desk.find("at"), nullptr);
    desk.erase("at");
    EXPECT_EQ(formatRecord(desk), "desk id=d1 heading=40");
}

TEST(Record, FallsBackToDefaults) {
    const Record desk = make("desk");
    EXPECT_EQ(desk.writtenId(), "");
    EXPECT_EQ(desk.number("height"), 0.7);
    EXPECT_FALSE(desk.flag("closed"));
    EXPECT_EQ(desk.text("kind"), "open");
    EXPECT_FALSE(desk.has("height"));
}

TEST(Record, ADefaultIsNotWritten) {
    Record desk = make("desk");
    desk.set("height", 1.0);
    EXPECT_TRUE(desk.has("height"));
    desk.set("height", 0.7);
    EXPECT_FALSE(desk.has("height"));
    EXPECT_EQ(desk.number("height"), 0.7);
    EXPECT_EQ(desk, make("desk"));
    EXPECT_EQ(formatRecord(desk), "desk");
}

TEST(Record, ChecksWhatIsSet) {
    const auto file = std::make_shared<const std::string>("a.env");
    Record laser(*testSchemas().find("laser"), {file, 3, 1});
    EXPECT_EQ(findingsOf([&] { laser.set("fov", -3.0); })[0],
              "a.env:3:1: error: `fov`: -3 is below 0");
    EXPECT_EQ(findingsOf([&] {
                  laser.set("fov", -3.0, {file, 3, 9});
              })[0],
              "a.env:3:9: error: `fov`: -3 is below 0");
    EXPECT_FALSE(laser.has("fov"));
    EXPECT_THROW(laser.set("at", Tuple{1}), FormatError);
}

TEST(Record, WrongKeysAndTypesAreABug) {
    Record desk = make("desk");
    EXPECT_THROW(desk.set("colour", 1.0), std::logic_error);
    EXPECT_THROW(desk.set("height", true), std::logic_error);
    EXPECT_THROW((void)desk.number("colour"), std::logic_error);
    EXPECT_THROW((void)desk.number("closed"), std::logic_error);
    EXPECT_THROW((void)desk.tuple("at"), std::logic_error) << "neither written nor a default";
}

TEST(Record, EqualityIsOfKeywordAndValues) {
    const auto file = std::make_shared<const std::string>("a.env");
    Record a(*testSchemas().find("desk"), {file, 3, 1});
    Record b = make("desk");
    a.set("heading", 30.0, {file, 3, 6});
    a.set("at", Tuple{1, 2});
    EXPECT_FALSE(a == b);
    b.set("at", Tuple{1, 2});
    EXPECT_FALSE(a == b);
    b.set("heading", 30.0);
    EXPECT_EQ(a, b) << "neither order nor places matter";
    b.set("heading", 31.0);
    EXPECT_FALSE(a == b);
    EXPECT_FALSE(make("desk") == make("laser"));
}

TEST(Record, FindingsHaveThePlaceOfTheValue) {
    const Document document = readRecordText("#env 1\n  desk at=1,2\n", "a.env", testSchemas());
    const Record& desk = document.records.at(0);
    EXPECT_EQ(desk.finding("x").text(), "a.env:2:3: error: x");
    EXPECT_EQ(desk.finding("at", "x").text(), "a.env:2:11: error: x");
    EXPECT_EQ(desk.finding("height", "x").text(), "a.env:2:3: error: x");
    EXPECT_EQ(make("desk").finding("at", "x").text(), "error: x");
}

TEST(Record, CopiesShareUntilOneIsChanged) {
    const Record desk = make("desk", "a");
    Record set = desk, erased = desk, made = desk, included = desk, with_mesh = desk;
    EXPECT_EQ(&set.text("id"), &desk.text("id"));
    set.set("heading", 30.0);
    erased.erase("id");
    made.setMade();
    included.setIncludedFrom(std::make_shared<const SourcePosition>());
    with_mesh.setMesh(std::make_shared<const TriangleMesh>());
    EXPECT_EQ(formatRecord(desk), "desk id=a");
    EXPECT_FALSE(desk.isMade());
    EXPECT_EQ(desk.place().included_from, nullptr);
    EXPECT_EQ(desk.mesh(), nullptr);
    EXPECT_EQ(formatRecord(set), "desk id=a heading=30");
    EXPECT_EQ(formatRecord(erased), "desk");
    EXPECT_TRUE(made.isMade());
    EXPECT_NE(included.place().included_from, nullptr);
    EXPECT_NE(with_mesh.mesh(), nullptr);
    EXPECT_NE(&made.text("id"), &desk.text("id"));
}

TEST(Record, AssignedAfterItWasMovedFrom) {
    Record desk = make("desk", "a");
    const Record moved = std::move(desk);
    desk = moved;
    desk.set("id", "b");
    EXPECT_EQ(formatRecord(moved), "desk id=a");
    EXPECT_EQ(formatRecord(desk), "desk id=b");
}

TEST(Record, ValuesKeepThePlacesOfOtherFiles) {
    const SourcePosition own{std::make_shared<const std::string>("a.env"), 3, 1};
    const SourcePosition other{std::make_shared<const std::string>("b.3dm"), 7, 2};
    Record desk(*testSchemas().find("desk"), own);
    desk.set("at", Tuple{1, 2}, other);
    desk.set("heading", 30.0, own.at({3, 9}));
    EXPECT_EQ(desk.finding("at", "x").text(), "b.3dm:7:2: error: x");
    EXPECT_EQ(desk.finding("heading", "x").text(), "a.env:3:9: error: x");
    Record copy = desk;
    // The position belongs to the record that this call releases.
    copy.set("at", Tuple{3, 4}, copy.place());
    desk = copy;
    EXPECT_EQ(desk.finding("at", "x").text(), "a.env:3:1: error: x");
    desk.set("at", Tuple{5, 6}, other);
    desk.set("at", Tuple{5, 6});
    EXPECT_EQ(desk.finding("at", "x").text(), "a.env:3:1: error: x") << "no place of its own";
    EXPECT_EQ(copy.tuple("at"), (Tuple{3, 4}));
}

TEST(Record, AMeshAndPlacesInOtherFilesAreKeptTogether) {
    const SourcePosition other{std::make_shared<const std::string>("b.3dm"), 7, 2};
    const auto mesh = std::make_shared<const TriangleMesh>();
    Record desk(*testSchemas().find("desk"), {std::make_shared<const std::string>("a.env"), 3, 1});
    desk.set("at", Tuple{1, 2}, other);
    desk.setMesh(mesh);
    desk.set("heading", 30.0, other);
    Record copy = desk;
    copy.setMesh(nullptr);
    copy.set("heading", 40.0);
    EXPECT_EQ(desk.mesh(), mesh);
    EXPECT_EQ(desk.finding("at", "x").text(), "b.3dm:7:2: error: x");
    EXPECT_EQ(desk.finding("heading", "x").text(), "b.3dm:7:2: error: x");
    EXPECT_EQ(copy.mesh(), nullptr);
    EXPECT_EQ(copy.finding("at", "x").text(), "b.3dm:7:2: error: x");
    EXPECT_EQ(copy.finding("heading", "x").text(), "a.env:3:1: error: x");
}

TEST(Record, CopiesAreChangedInThreadsOfTheirOwn) {
    for (int round = 0; round < 200; ++round) {
        Record desk = make("desk", "a");
        std::thread other([copy = desk]() mutable {
            const std::string id = copy.text("id");
            copy.set("id", id + "b");
            EXPECT_EQ(copy.text("id"), "ab");
        });
        desk.set("id", "c");
        EXPECT_EQ(desk.text("id"), "c");
        other.join();
    }
}

TEST(AssignIds, NumbersEachKeywordInFileOrder) {
    const std::vector<Record> records = {make("desk"), make("laser"), make("desk", "d"),
                                         make("desk"), make("laser")};
    EXPECT_EQ(assignIds(records),
              (std::vector<std::string>{"desk1", "laser1", "d", "desk2", "laser2"}));
    EXPECT_TRUE(assignIds({}).empty());
}

TEST(AssignIds, SkipsEveryWrittenId) {
    const std::vector<Record> records = {make("desk"), make("laser", "desk1"), make("desk"),
                                         make("desk", "desk3"), make("desk")};
    EXPECT_EQ(assignIds(records),
              (std::vector<std::string>{"desk2", "desk1", "desk4", "desk3", "desk5"}));
}

TEST(AssignIds, KeywordsThatEndInDigitsDoNotMeet) {
    const KeySpec id = testKey("id", KeyType::Word);
    const Schemas schemas(
        {{"a", RecordType::Other, "", {id}}, {"a1", RecordType::Other, "", {id}}});
    std::vector<Record> records(11, Record(*schemas.find("a")));
    records.emplace_back(*schemas.find("a1"));
    EXPECT_EQ(assignIds(records).back(), "a12") << "the eleventh of the others is a11";
}

TEST(CheckIds, NamesBothLines) {
    std::vector<Record> records = {make("desk", "a"), make("laser", "b"), make("laser")};
    EXPECT_NO_THROW(checkIds(records));
    records.push_back(make("laser", "a"));
    EXPECT_EQ(findingsOf([&] { checkIds(records); }),
              std::vector<std::string>{"error: doubled id `a`"});
    const Record one = readRecord("desk id=a", "a.env", testSchemas());
    const Record two = readRecord("laser id=a", "b.3dm", testSchemas());
    EXPECT_EQ(
        findingsOf([&] {
            checkIds({one, two});
        }),
        std::vector<std::string>{"b.3dm:1:10: error: doubled id `a`, first used in a.env line 1"});
}

TEST(Digest, IsSha256) {
    EXPECT_EQ(sha256(""),
              "sha256:e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(sha256("abc"),
              "sha256:ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Digest, IsOverTheCanonicalEnvironment) {
    const auto digest = [](const std::string& text) {
        return environmentDigest(readRecordText("#env 1\n" + text, "a", testSchemas()).records);
    };
    const std::string desk = digest("desk id=d at=1,2\n");
    EXPECT_EQ(desk, sha256("desk id=d at=1,2\n"));
    EXPECT_EQ(desk, digest("# envc a\n\ndesk   at=100cm,2 height=70cm id=d # x\nlaser\nresult"));
    EXPECT_NE(desk, digest("desk id=e at=1,2\n"));
    EXPECT_NE(desk, digest("desk at=1,2\n"));
    EXPECT_NE(digest("desk id=a\ndesk id=b\n"), digest("desk id=b\ndesk id=a\n"));
    EXPECT_EQ(digest("laser\n"), sha256(""));
}

}  // namespace record_test

}  // namespace ispace
