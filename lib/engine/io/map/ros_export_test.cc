// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/exporters.h"
#include "support/test_paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>

#include "base/error.h"
#include "base/file.h"
#include "base/number.h"
#include "env/level.h"
#include "geom/arrangement.h"
#include "geom/predicates.h"
#include "io/importers.h"
#include "raster/picture.h"
#include "support/test_layout.h"

namespace ispace {
namespace ros_export_test {

using ispace::testing::scene;

constexpr double kHeight = 0.15;

/// The cells of a picture, row 0 on top: '.' free, '#' occupied, ' ' unknown.
std::vector<std::string> cellsOf(const std::string& bytes) {
    const auto image = parsePgm(bytes, "map.pgm");
    std::vector<std::string> rows;
    for (int y = 0; y < image.height; ++y) {
        std::string& row = rows.emplace_back();
        for (int x = 0; x < image.width; ++x) {
            const int sample = image.samples[static_cast<std::size_t>(y * image.width + x)];
            row += sample == 254 ? '.' : sample == 0 ? '#' : sample == 205 ? ' ' : '?';
        }
    }
    return rows;
}

/// Without the rim, which is unknown all round.
std::vector<std::string> trimmed(const std::vector<std::string>& rows) {
    constexpr std::size_t kRim = 3;
    std::vector<std::string> inner;
    for (std::size_t i = kRim; i + kRim < rows.size(); ++i)
        inner.push_back(rows[i].substr(kRim, rows[i].size() - 2 * kRim));
    return inner;
}

std::vector<std::string> mapOf(const std::string& room, double resolution) {
    return trimmed(cellsOf(writeRosMap(scene(room), kHeight, resolution, "map.pgm").beside));
}

using Rows = std::vector<std::string>;

TEST(RosExport, RoomOnTheGrid) {
    const ExportedFiles files = writeRosMap(scene("ispace size=2,1"), kHeight, 0.25, "map.pgm");
    EXPECT_EQ(files.product,
              "image: map.pgm\nmode: trinary\nresolution: 0.25\norigin: [-2, -1.5, 0]\nnegate: "
              "0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
    EXPECT_EQ(trimmed(cellsOf(files.beside)), (Rows{"##########",  //
                                                    "#........#",  //
                                                    "#........#",  //
                                                    "#........#",  //
                                                    "#........#",  //
                                                    "##########"}));
    for (const std::string& row : {cellsOf(files.beside).front(), cellsOf(files.beside).back()})
        EXPECT_EQ(row, std::string(row.size(), ' '));
}

TEST(RosExport, SolidsAtTheHeightAreOccupied) {
    const std::string room = "ispace size=2,2\ncube at=0.5,0.5 size=0.5,0.5,0.5\n";
    const Rows low = mapOf(room, 0.25);
    ASSERT_EQ(low.size(), 10U);
    EXPECT_EQ(low[1], "#........#");
    EXPECT_EQ(low[2], "#.....##.#");
    EXPECT_EQ(low[3], "#.....##.#");
    const ExportedFiles above = writeRosMap(scene(room), 0.6, 0.25, "m.pgm");
    EXPECT_EQ(trimmed(cellsOf(above.beside))[3], "#........#");
}

TEST(RosExport, ThinWallsStay) {
    // In the middle of cells, on their edges, slanted, as a sheet and as a thin board.
    EXPECT_EQ(mapOf("ispace size=2,1.5\nwall from=-0.9,0.125 to=0.5,0.125\n", 0.25),
              (Rows{"##########",  //
                    "#........#",  //
                    "#........#",  //
                    "#######..#",  //
                    "#........#",  //
                    "#........#",  //
                    "#........#",  //
                    "##########"}));
    const Rows on_edge = mapOf("ispace size=2,1.5\nwall from=-0.9,0 to=0.5,0\n", 0.25);
    EXPECT_EQ(std::count(on_edge.begin(), on_edge.end(), "#######..#"), 1);
    const Rows board =
        mapOf("ispace size=2,1.5\nbarrier at=-0.2,0.01 size=1.4,0.02 height=1\n", 0.25);
    EXPECT_EQ(std::count(board.begin(), board.end(), "#######..#"), 1);
}

TEST(RosExport, SmallThingsLeaveACell) {
    const Rows rows = mapOf("ispace size=2,1\ncube at=0.24,0.24 size=0.02,0.02,0.5\n", 0.25);
    EXPECT_EQ(rows, (Rows{"##########",  //
                          "#........#",  //
                          "#....#...#",  //
                          "#........#",  //
                          "#........#",  //
                          "##########"}));
    const Rows hole = mapOf(
        "ispace size=2,1\nfence path=0.2,0.2;0.22,0.2;0.22,0.22 closed=yes\ninside at=-0.5,0\n",
        0.25);
    EXPECT_EQ(hole, rows);
}

TEST(RosExport, RefusesMapsNobodyCanHold) {
    const Scene room = scene("ispace size=100,100");
    EXPECT_THROW(writeRosMap(room, kHeight, 0, "m.pgm"), UsageError);
    EXPECT_THROW(writeRosMap(room, kHeight, -0.05, "m.pgm"), UsageError);
    EXPECT_THROW(writeRosMap(room, kHeight, std::nan(""), "m.pgm"), UsageError);
    try {
        writeRosMap(room, kHeight, 0.001, "m.pgm");
        FAIL();
    } catch (const UsageError& error) {
        EXPECT_STREQ(error.what(),
                     "a map of 100008 x 100008 cells cannot be written, at most 30000 each way and "
                     "400000000 in all: take a resolution of 0.0051 m");
    }
    EXPECT_NO_THROW(writeRosMap(scene("ispace size=9,9"), kHeight, 0.0051, "m.pgm"));
}

TEST(RosExport, QuotesNamesThatYamlWouldTakeForElse) {
    const Scene room = scene("ispace size=2,1");
    const auto line = [&](const std::string& name) {
        const std::string yaml = writeRosMap(room, kHeight, 0.5, name).product;
        return yaml.substr(0, yaml.find('\n'));
    };
    EXPECT_EQ(line("a/room-1.pgm"), "image: a/room-1.pgm");
    EXPECT_EQ(line("my \"room\": #1.pgm"), "image: \"my \\\"room\\\": #1.pgm\"");
    EXPECT_EQ(line("- a.pgm"), "image: \"- a.pgm\"");
    EXPECT_EQ(line("1.5"), "image: \"1.5\"");
}

/// Writes maps to a folder of the running test's own and reads them back.
class RosRoundTrip : public ::testing::Test {
  protected:
    RosRoundTrip()
        : folder_(std::filesystem::path(testing::buildPath("ros_export_test")) /
                  ::testing::UnitTest::GetInstance()->current_test_info()->name()) {
        std::filesystem::create_directories(folder_);
    }
    ~RosRoundTrip() override { std::filesystem::remove_all(folder_); }

    [[nodiscard]] Environment reread(const Scene& from, double resolution,
                                     const ImportOptions& options = {}) const {
        const ExportedFiles files = writeRosMap(from, kHeight, resolution, "map.pgm");
        writeAll((folder_ / "map.pgm").string(), files.beside);
        const Document map =
            readRosMap(files.product, (folder_ / "map.yaml").string(), options, sceneSchemas());
        return makeScene(map, nullptr, DeviceCatalogue()).environment;
    }

    std::filesystem::path folder_;
};

using Lines = std::vector<Segment2>;

/// What bounds the floor: edges of the free pieces, and walls without thickness that stand in them.
Lines boundaryOf(const Environment& room) {
    Lines lines;
    const std::vector<Region> pieces = room.level(kHeight)->freeFloor();
    for (const Region& piece : pieces)
        piece.forEachEdge([&](const Segment2& edge) { lines.push_back(edge); });
    for (const Segment2& sheet : room.slice(kHeight).sheets) {
        const Point2 middle = sheet.a + 0.5 * (sheet.b - sheet.a);
        if (room.indoor().locate(middle) == Side::Inside) lines.push_back(sheet);
    }
    return lines;
}

/// Distance in cells as cells count: the greater of those along x and along y.
double cellDistance(Point2 p, const Segment2& line, double cell) {
    const Vec2 a = line.a - p, along = line.b - line.a;
    double least = std::numeric_limits<double>::infinity();
    const auto at = [&](double top, double bottom) {
        const double t = bottom == 0 ? 0 : std::clamp(top / bottom, 0.0, 1.0);
        const Vec2 v = a + t * along;
        least = std::min(least, std::max(std::abs(v.x), std::abs(v.y)));
    };
    // The ends, and wherever one of the two is 0 or both are the same.
    at(0, 1);
    at(1, 1);
    at(-a.x, along.x);
    at(-a.y, along.y);
    at(a.y - a.x, along.x - along.y);
    at(-a.y - a.x, along.x + along.y);
    return least / cell;
}

/// The greatest distance in cells of a point of `from` to the nearest of `to`, on samples.
double farthest(const Lines& from, const Lines& to, double cell) {
    double most = 0;
    for (const Segment2& line : from) {
        const double steps = std::ceil(distance(line.a, line.b) / (cell / 4));
        for (int i = 0; i <= steps; ++i) {
            const Point2 p = line.a + i / steps * (line.b - line.a);
            double least = std::numeric_limits<double>::infinity();
            for (const Segment2& other : to) least = std::min(least, cellDistance(p, other, cell));
            most = std::max(most, least);
        }
    }
    return most;
}

/// How far lines of the map are from the room's, and lines of the room from the map's, in cells.
struct Offsets {
    double map_to_room, room_to_map;
};
Offsets offsets(const Environment& room, const Environment& map, double cell) {
    const Lines of_room = boundaryOf(room), of_map = boundaryOf(map);
    return {farthest(of_map, of_room, cell), farthest(of_room, of_map, cell)};
}

std::string numbers(std::initializer_list<double> values) {
    std::string text;
    for (const double value : values) text += (text.empty() ? "" : ",") + formatDouble(value);
    return text;
}

TEST_F(RosRoundTrip, RoomsOnTheGridComeBackExactly) {
    const Scene room = scene(
        "fence path=0,0;6,0;6,4;4,4;4,5;0,5 closed=yes\ninside at=1,1\n"
        "pillar at=2,2 size=0.5,0.5\n");
    const Environment again = reread(room, 0.05);
    EXPECT_LT(offsets(room.environment, again, 0.05).map_to_room, 1e-4);
    EXPECT_LT(offsets(room.environment, again, 0.05).room_to_map, 1e-4);
    EXPECT_NEAR(again.indoor().area(), totalArea(room.environment.level(kHeight)->freeFloor()),
                1e-6);
}

/// A room with a notch, at any angle; half of them have a slanted side, some have thick walls.
std::string randomRoom(std::mt19937_64& random, int round, bool with_wall) {
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const Angle turn = Angle::degrees(round % 3 == 0 ? 0 : between(-180, 180));
    const Pose2 world_from_room{{between(-20, 20), between(-20, 20)}, turn};
    const auto place = [&](double x, double y) {
        const Point2 p = world_from_room * Point2{x, y};
        return numbers({p.x, p.y});
    };
    const double length = between(3, 6), width = between(3, 5), notch = between(0.8, 1.4);
    const double bend = round % 2 == 0 ? 0 : between(-0.6, 0.6);
    std::string lines =
        "fence closed=yes thickness=" + numbers({!with_wall && round % 5 == 4 ? 0.1 : 0});
    lines.append(" path=").append(place(0, 0));
    for (const Point2 p : {Point2{length, bend}, Point2{length, width}, Point2{notch, width},
                           Point2{notch, width - notch}, Point2{0, width - notch}})
        lines.append(";").append(place(p.x, p.y));
    lines.append("\ninside at=").append(place(0.5, 1));
    lines.append(round % 2 == 0 ? "\npillar kind=round at=" : "\npillar at=").append(place(1, 1));
    lines.append(" size=").append(numbers({between(0.3, 0.5)}));
    lines.append(" heading=").append(numbers({between(0, 90)}));
    if (with_wall) {
        lines.append("\nwall from=").append(place(length, 1.6));
        lines.append(" to=").append(place(length - 1, between(1.4, 1.8)));
    }
    return lines + '\n';
}

TEST_F(RosRoundTrip, RandomRoomsComeBackWithinACell) {
    std::mt19937_64 random(20241);
    for (int round = 0; round < 120; ++round) {
        const double cell = std::uniform_real_distribution<double>(0.02, 0.12)(random);
        const bool with_wall = round % 4 < 2;
        const std::string lines = randomRoom(random, round, with_wall);
        const Scene room = scene(lines);
        SCOPED_TRACE(std::to_string(round) + ", " + formatDouble(cell) + " m a cell: " + lines);
        ImportOptions exact;
        exact.simplify = 0;
        const Offsets cells = offsets(room.environment, reread(room, cell, exact), cell);
        EXPECT_LE(cells.map_to_room, 1);
        // Beside a thin wall a corner may be cut off that is no wider than a cell.
        EXPECT_LE(cells.room_to_map, with_wall ? 2 : 1);
        // The importer's straight lines take the tips of slanted corners, never more.
        const Offsets plain = offsets(room.environment, reread(room, cell), cell);
        EXPECT_LE(plain.map_to_room, with_wall ? 1.5 : 1);
        EXPECT_LE(plain.room_to_map, with_wall ? 2 : 1.5);
    }
}

TEST_F(RosRoundTrip, AThinWallBetweenTwoRoomsHolds) {
    std::mt19937_64 random(7);
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    // A closed fence within the room cuts a hole, whatever its slant; only the outer part is kept.
    for (int round = 0; round < 40; ++round) {
        const double resolution = between(0.03, 0.1);
        const double a = between(0, 360);
        const Pose2 world{{between(-1, 1), between(-1, 1)}, Angle::degrees(a)};
        std::string path;
        for (const Point2 p :
             {Point2{-0.5, -0.01}, Point2{1, -0.01}, Point2{1, 0.01}, Point2{-0.5, 0.01}}) {
            const Point2 q = world * p;
            path += (path.empty() ? "" : ";") + numbers({q.x, q.y});
        }
        const Scene room =
            scene("ispace size=5,5\ninside at=-2,-2\nfence path=" + path + " closed=yes\n");
        const Environment again = reread(room, resolution);
        ASSERT_EQ(again.indoor().parts.at(0).holes.size(), 1U) << round;
        EXPECT_LE(offsets(room.environment, again, resolution).map_to_room, 1) << round;
    }
}

TEST(RosExport, NoFloorLeaksThroughAThinWall) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> place(-1.9, 1.9), size(0.03, 0.3);
    for (int round = 0; round < 200; ++round) {
        // From one wall to the other: two rooms, of which one is indoor.
        const double a = place(random), b = place(random);
        const std::string wall = round % 2 == 0 ? numbers({-2, a}) + " to=" + numbers({2, b})
                                                : numbers({a, -2}) + " to=" + numbers({b, 2});
        const Point2 inside = round % 2 == 0 ? Point2{-1.9999, -1.9999} : Point2{1.9999, -1.9999};
        const Scene room = scene("ispace size=4,4\nwall from=" + wall + " thickness=0.001\n" +
                                 "inside at=" + numbers({inside.x, inside.y}) + "\n");
        const ExportedFiles files = writeRosMap(room, kHeight, size(random), "m.pgm");
        const MapCells free = freeCells(parsePgm(files.beside, "m.pgm"), {});
        const double cell =
            parseDouble(files.product.substr(files.product.find("resolution: ") + 12,
                                             files.product.find("\norigin") -
                                                 files.product.find("resolution: ") - 12))
                .value();
        const double area = static_cast<double>(free.count()) * cell * cell;
        EXPECT_NEAR(area, room.environment.indoor().area(), 14 * cell) << round;
    }
}

}  // namespace ros_export_test
}  // namespace ispace
