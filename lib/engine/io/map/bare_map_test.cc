// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/importers.h"

#include "base/file.h"
#include "support/test_import.h"

namespace ispace {
namespace bare_map_test {

ImportOptions withResolution(double metres) {
    ImportOptions options;
    options.resolution = metres;
    return options;
}

constexpr const char* kRoom =
    "P2 5 4 255\n0 0 0 0 0\n0 254 254 254 0\n0 254 254 254 0\n0 0 0 0 0\n";

TEST(BarePicture, ResolutionAndOrigin) {
    ImportOptions options = withResolution(0.5);
    options.origin = {{10, 20}, Angle::degrees(90)};
    const Document document = readBarePicture(kRoom, "room.pgm", options, sceneSchemas());
    EXPECT_EQ(writeRecordText(document),
              "#env 1\nfence path=9.5,20.5;9.5,22;8.5,22;8.5,20.5 closed=yes\n"
              "inside at=9.25,20.75\n");
}

TEST(BarePicture, NeedsResolution) {
    EXPECT_EQ(errorsOf([] { readBarePicture(kRoom, "room.pgm", {}, sceneSchemas()); }),
              "room.pgm: error: a picture does not say how large its pixels are: say it with `envc "
              "--resolution M` (metres a pixel), or name the map.yaml that goes with it\n");
}

TEST(BarePicture, Refuses) {
    const auto error_of = [](const std::string& bytes, double resolution) {
        return errorsOf([&] {
            readBarePicture(bytes, "room.pgm", withResolution(resolution), sceneSchemas());
        });
    };
    EXPECT_NE(error_of("P2 2 1 255 0 205\n", 1).find("no free cell among 2 x 1"),
              std::string::npos);
    EXPECT_NE(error_of(kRoom, 9000).find("more than 10000 m"), std::string::npos);
    EXPECT_NE(error_of("P2 2 1 255 0\n", 1).find("truncated"), std::string::npos);
}

TEST(BarePicture, TransparentIsUnknown) {
    // Through TIFF, since no writer of PNG is at hand here: 4 x 1, white, two pixels transparent.
    const std::string pixels("\xff\xff\xff\x00\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\x00",
                             16);
    std::string tiff("II*\0\x08\0\0\0", 8);
    const auto add = [&tiff](unsigned value, int count) {
        for (int i = 0; i < count; ++i) tiff += static_cast<char>(value >> (8 * i) & 0xff);
    };
    constexpr unsigned kEntries = 10, kData = 8 + 2 + 12 * kEntries + 4;
    add(kEntries, 2);
    const auto entry = [&add](unsigned tag, unsigned type, unsigned count, unsigned value) {
        add(tag, 2), add(type, 2), add(count, 4), add(value, 4);
    };
    entry(256, 3, 1, 4), entry(257, 3, 1, 1), entry(258, 3, 4, kData), entry(259, 3, 1, 1);
    entry(262, 3, 1, 2), entry(273, 4, 1, kData + 8), entry(277, 3, 1, 4), entry(278, 3, 1, 1);
    entry(279, 4, 1, 16), entry(338, 3, 1, 2);
    add(0, 4);
    for (int i = 0; i < 4; ++i) add(8, 2);
    tiff += pixels;
    const Document document = readBarePicture(tiff, "room.tif", withResolution(1), sceneSchemas());
    EXPECT_EQ(writeRecordText(document),
              "#env 1\nfence path=1,0;3,0;3,1;1,1 closed=yes\ninside at=1.5,0.5\n");
}

}  // namespace bare_map_test
}  // namespace ispace
