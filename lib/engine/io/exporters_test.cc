// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/exporters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/file.h"
#include "env/level.h"
#include "io/importers.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "support/test_folder.h"
#include "support/test_layout.h"

namespace ispace {

namespace exporters_test {

TEST(ExportFormats, RowsAreWhole) {
    std::set<std::string_view> names;
    for (const ExportFormat& format : exportFormats()) {
        EXPECT_TRUE(names.insert(format.name).second) << format.name;
        EXPECT_EQ(&exportFormat(format.name), &format);
        EXPECT_TRUE(format.help.ends_with('.')) << format.name;
        EXPECT_NE(format.write == nullptr, format.write_records == nullptr) << format.name;
        // Slices are of scenes.
        EXPECT_FALSE(format.takes_slice && format.write == nullptr) << format.name;
        const bool is_alone = format.beside_suffix.empty();
        EXPECT_EQ(is_alone, format.beside_role.empty()) << format.name;
        EXPECT_EQ(is_alone, format.naming_hint.empty()) << format.name;
        EXPECT_FALSE(is_alone && (format.needs_beside || format.beside_as_needed)) << format.name;
    }
    EXPECT_EQ(exportFormats().front().name, "glb");
}

TEST(RobotUrdf, HasTheRobotAndItsSensorsByTheirFrames) {
    const Scene scene =
        testing::scene("ispace size=8,6\n",
                       "robot id=r1 at=1,1\nrobot id=r2 at=2,0 heading=90\nlaser id=a on=r1\n"
                       "camera id=b on=r2 at=0.1,0,0.4\nlaser id=c at=0,0,1\n");
    const std::vector<std::string> frames{"a", "b_2", "c"};
    const std::vector<std::string> wheels{"left", "right"};
    const std::string text = writeRobotUrdf(scene, 1, "r_2", wheels, frames);
    for (const char* part :
         {"<robot name=\"r_2\">", "<link name=\"left\">",
          "<joint name=\"right_joint\" type=\"continuous\">", "xyz=\"0 -0.24 0.11\"",
          "<link name=\"r_2\">", "<link name=\"b_2\">", "<link name=\"b_2_optical\"",
          "<parent link=\"r_2\"", "xyz=\"0.1 0 0.4\""})
        EXPECT_NE(text.find(part), std::string::npos) << part << '\n' << text;
    for (const char* part : {"world", "\"a\"", "\"c\"", "floating"})
        EXPECT_EQ(text.find(part), std::string::npos) << part;
}

TEST(ExportFormats, BytesAreWhatTheRowSays) {
    const Document document = readRecordText("#env 1\nispace size=4,3\n", "room", sceneSchemas());
    const Scene scene = makeScene(document, nullptr, DeviceCatalogue());
    ExportOptions options;
    options.beside = "beside";
    for (const ExportFormat& format : exportFormats()) {
        if (format.write_records != nullptr) {
            EXPECT_NE(format.write_records(Document(document)).find("4"), std::string::npos)
                << format.name;
            continue;
        }
        const ExportedFiles files = format.write(scene, document, options);
        EXPECT_FALSE(files.product.empty()) << format.name;
        // A room without meshes.
        EXPECT_EQ(files.beside.empty(), format.beside_suffix.empty() || format.beside_as_needed)
            << format.name;
        const bool has_zeros = files.product.find('\0') != std::string::npos;
        EXPECT_TRUE(!has_zeros || !format.binary.empty()) << format.name;
    }
    EXPECT_TRUE(exportFormat("pdf").write(scene, document, options).product.starts_with("%PDF-"));
}

}  // namespace exporters_test

}  // namespace ispace
