// SPDX-License-Identifier: GPL-3.0-or-later
// What compiled files keep of the derivation: rooms of it are those that are derived anew, whatever
// happens to the file.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/test_paths.h"
#include "io/input.h"
#include "io/test_glb.h"
#include "record/text.h"

namespace ispace {
namespace {

namespace fs = std::filesystem;
using testing::readCompiled;

Scene sceneOf(const Document& document) { return makeScene(document, nullptr, DeviceCatalogue()); }

/// The same records without what is known of them.
Document plain(Document document) {
    document.derived.clear();
    return document;
}

/// Whether all that is drawn, and all that is derived, is the same.
bool areSame(const Scene& a, const Scene& b, const Document& document) {
    return writeGlb(a, document) == writeGlb(b, document) && a.digest() == b.digest() &&
           a.environment.wallLines() == b.environment.wallLines();
}

/// The compiled form; nothing for what is no room.
std::optional<std::string> tryCompile(const std::string& file) {
    try {
        const Document document = readDocument(file, ImportOptions(), sceneSchemas());
        return writeGlb(sceneOf(document), document);
    } catch (const FormatError&) {
        return std::nullopt;
    }
}

/// Files of our formats, and plans of others.
std::vector<std::string> filesIn(const std::string& folder) {
    constexpr std::string_view kSuffixes[] = {".env",  ".yaml", ".dxf", ".svg",
                                              ".json", ".map",  ".sdf"};
    std::vector<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const bool is_wanted = std::count(std::begin(kSuffixes), std::end(kSuffixes),
                                          entry.path().extension().string()) > 0;
        if (entry.is_regular_file() && is_wanted && entry.file_size() < 1'000'000)
            files.push_back(entry.path().string());
    }
    std::sort(files.begin(), files.end());
    return files;
}

/// \return how many of the files are rooms
std::size_t expectSameRooms(const std::string& folder) {
    std::size_t rooms = 0;
    for (const std::string& file : filesIn(folder)) {
        const auto glb = tryCompile(file);
        if (!glb) continue;
        ++rooms;
        const Document document = readCompiled(*glb);
        EXPECT_NE(document.derived, "") << file;
        const Scene scene = sceneOf(document);
        EXPECT_TRUE(areSame(scene, sceneOf(plain(document)), document)) << file;
        EXPECT_EQ(scene.environment.stored(), document.derived) << file;
    }
    return rooms;
}

TEST(GlbDerived, GivesTheSameRoomOfAllScenes) {
    EXPECT_GE(expectSameRooms(testing::sourcePath("share/scenes")), 10U);
    EXPECT_GE(expectSameRooms(testing::sourcePath("tests/data")), 10U);
}

TEST(GlbDerived, GivesTheSameRoomOfAllPlans) {
    const char* const folder = std::getenv("ISPACE_TEST_DATA");
    if (folder == nullptr) GTEST_SKIP() << "ISPACE_TEST_DATA names no folder of plans";
    EXPECT_GE(expectSameRooms(folder), 1U);
}

const std::string& smallRoom() {
    static const std::string kRoom = testing::compiled(
        readRecordText("#env 1\nfence path=0,0;4,0;4,3;0,3 closed=yes\nwall id=w from=2,0 to=2,3\n"
                       "door wall=w offset=1.5 open=yes\nwall from=1,1 to=3,2\ninside at=0.5,0.5\n",
                       "room.env", sceneSchemas()));
    return kRoom;
}

TEST(GlbDerived, AFlippedBitChangesNothingUnnoticed) {
    const std::string& glb = smallRoom();
    std::size_t refused = 0;
    for (std::size_t i = 0; i < glb.size(); ++i) {
        std::string bytes = glb;
        bytes[i] ^= static_cast<char>(1U << i % 8);
        try {
            const Document document = readCompiled(bytes);
            const Scene scene = sceneOf(document);
            ASSERT_TRUE(areSame(scene, sceneOf(plain(document)), document)) << i;
        } catch (const FormatError& error) {
            ++refused;
            ASSERT_NE(std::string(error.what()), "") << i;
        }
    }
    EXPECT_GT(refused, 0U);
    EXPECT_LT(refused, glb.size());
}

/// With another text of the same length in the JSON.
std::string replaced(std::string glb, const std::string& from, const std::string& to) {
    EXPECT_EQ(from.size(), to.size());
    const std::size_t at = glb.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return glb.replace(at, from.size(), to);
}

TEST(GlbDerived, FilesWithoutItOrWithoutItsViewAreRead) {
    const std::string& glb = smallRoom();
    const Document document = readCompiled(glb);
    const std::string key = R"("ispace_derived":4)";
    for (const char* const other :
         {R"("ispace_other":  4)", R"("ispace_derived":9)", R"("ispace_derived":0)"}) {
        const Document changed = readCompiled(replaced(glb, key, other));
        EXPECT_EQ(changed.records, document.records);
        EXPECT_TRUE(areSame(sceneOf(changed), sceneOf(document), document)) << other;
    }
}

TEST(GlbDerived, RecordsChangedByAnotherToolCount) {
    const std::string& glb = smallRoom();
    const Document changed = readCompiled(replaced(glb, "4,0;4,3", "5,0;5,3"));
    EXPECT_NE(changed.derived, "");
    EXPECT_DOUBLE_EQ(sceneOf(changed).environment.indoor().area(), 15);
}

}  // namespace
}  // namespace ispace
