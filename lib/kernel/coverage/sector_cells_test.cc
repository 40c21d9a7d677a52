// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/sector_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "base/number.h"
#include "coverage/visible_area.h"
#include "support/test_covering_sensors.h"
#include "support/test_scenes.h"

namespace ispace {
namespace sector_cells_test {

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

/// The cells of parts [begin, end).
CellSet cellsOf(const CellParts& parts, std::size_t begin, std::size_t end, std::size_t cells) {
    CellSet set(cells);
    for (std::size_t i = parts.first[begin]; i < parts.first[end]; ++i)
        for (std::uint32_t cell = parts.runs[i].first; cell < parts.runs[i].end; ++cell)
            set.set(cell);
    return set;
}

/// Where sectors with these headings begin, and where they no longer see.
std::vector<Angle> limitsOf(const Laser& laser, const std::vector<double>& headings) {
    std::vector<Angle> limits;
    for (const double heading : headings)
        if (const auto sector = sectorOf(laser, Angle::degrees(heading)))
            limits.insert(limits.end(), {sector->first, sector->beyond});
    std::sort(limits.begin(), limits.end());
    limits.erase(std::unique(limits.begin(), limits.end()), limits.end());
    return limits;
}

std::size_t indexOf(const std::vector<Angle>& limits, Angle direction) {
    const auto found = std::find(limits.begin(), limits.end(), direction);
    EXPECT_NE(found, limits.end());
    return static_cast<std::size_t>(found - limits.begin());
}

/// The visible area of a laser, joined from parts.
CellSet cellsOfSector(const CellParts& parts, const std::vector<Angle>& limits, const Laser& laser,
                      double heading, std::size_t cells) {
    const auto sector = sectorOf(laser, Angle::degrees(heading));
    if (!sector) return cellsOf(parts, 0, parts.size(), cells);
    const std::size_t begin = indexOf(limits, sector->first);
    const std::size_t end = indexOf(limits, sector->beyond);
    CellSet seen = cellsOf(parts, parts.size() - 1, parts.size(), cells);
    if (begin < end) return seen |= cellsOf(parts, begin, end, cells);
    seen |= cellsOf(parts, begin, limits.size(), cells);
    return seen |= cellsOf(parts, 0, end, cells);
}

/// Parts are disjoint lists of ascending runs that do not touch.
void expectSound(const CellParts& parts, std::size_t limits, std::size_t cells) {
    ASSERT_EQ(parts.size(), limits + 1);
    ASSERT_EQ(parts.first.front(), 0U);
    ASSERT_EQ(parts.first.back(), parts.runs.size());
    std::vector<int> times(cells);
    for (std::size_t part = 0; part < parts.size(); ++part)
        for (std::size_t i = parts.first[part]; i < parts.first[part + 1]; ++i) {
            ASSERT_LT(parts.runs[i].first, parts.runs[i].end);
            ASSERT_LE(parts.runs[i].end, cells);
            if (i > parts.first[part]) {
                ASSERT_LT(parts.runs[i - 1].end, parts.runs[i].first);
            }
            for (std::uint32_t cell = parts.runs[i].first; cell < parts.runs[i].end; ++cell)
                ASSERT_EQ(++times[cell], 1) << cell;
        }
}

struct Case {
    const Grid& grid;
    const VisibleArea& sight;
    Point2 place;
    Laser laser;
    std::vector<double> headings;
};

void expectSame(const Case& c, CellParts& parts) {
    const std::vector<Angle> limits = limitsOf(c.laser, c.headings);
    cellsBySector(c.grid, *c.sight.levelAt(kScanHeight), c.place, c.laser.max_range, limits, parts);
    expectSound(parts, limits.size(), c.grid.size());
    for (const double heading : c.headings) {
        const Sensor sensor{"l", c.laser, poseAt({c.place.x, c.place.y, kScanHeight}, heading, 0)};
        const CellSet expected = c.sight.cellsOf(c.grid, sensor);
        const CellSet seen = cellsOfSector(parts, limits, c.laser, heading, c.grid.size());
        ASSERT_EQ(seen, expected) << "place " << c.place.x << ',' << c.place.y << " heading "
                                  << heading << " fov "
                                  << (c.laser.last() - c.laser.first).degrees() << " range "
                                  << c.laser.max_range << ": " << seen.count() << " instead of "
                                  << expected.count();
    }
}

std::string randomRoom(Random& random) {
    std::string text = "ispace size=12,8\n";
    const auto number = [&random](double low, double high) {
        return formatDouble(std::round(uniform(random, low, high) * 8) / 8);
    };
    for (int i = 0; i < 3; ++i)
        text.append("wall from=" + number(-6, 6) + ',' + number(-4, 4) + " to=" + number(-6, 6) +
                    ',' + number(-4, 4) + '\n');
    for (int i = 0; i < 4; ++i)
        text.append("cube at=" + number(-5, 5) + ',' + number(-3, 3) + " size=" + number(0.25, 2) +
                    ',' + number(0.25, 2) + ",1 heading=" + number(-180, 180) + '\n');
    text.append("cylinder at=" + number(-5, 5) + ',' + number(-3, 3) + " size=1,1,1\n");
    text.append("chair at=" + number(-5, 5) + ',' + number(-3, 3) + '\n');
    return text;
}

/// Anywhere, on a lattice, on a cell's centre, or on a line of the slice.
Point2 randomPlace(Random& random, const Grid& grid, const Slice& slice) {
    const Point2 any{uniform(random, -6.2, 6.2), uniform(random, -4.2, 4.2)};
    switch (random() % 5) {
        case 0:
            return {std::round(any.x * 4) / 4, std::round(any.y * 4) / 4};
        case 1:
            return grid.center(random() % grid.size());
        case 2:
            return {any.x, grid.rowCenter(static_cast<int>(random() % 20))};
        case 3: {
            std::vector<Segment2> lines;
            slice.forEachLine([&lines](const Segment2& line) { lines.push_back(line); });
            const Segment2 line = lines[random() % lines.size()];
            return line.a + uniform(random, 0, 1) * (line.b - line.a);
        }
        default:
            return any;
    }
}

Laser randomLaser(Random& random, double fov) {
    Laser laser = laserWith(std::vector<double>{1, 2.5, 4, 30}[random() % 4], -fov / 2, fov);
    if (random() % 4 == 0) laser.first = Angle::degrees(-fov / 3);
    if (random() % 5 == 0) {
        laser.sweep = SweepAxis::Heading;
        laser.sweep_span = Angle::degrees(random() % 3 == 0 ? 360 : 45);
    }
    return laser;
}

TEST(CellsBySector, SectorsAreWhatLasersSee) {
    Random random(20);
    CellParts parts;
    for (int room = 0; room < 24; ++room) {
        const Scene scene = sceneOf(randomRoom(random));
        const Slice slice = scene.environment.slice(kScanHeight);
        const VisibleArea sight(scene.environment, 0);
        const int fine = room % 4 == 3 ? 3 : 1;  // more than a word a row
        const Grid grid{scene.environment.limits(), 48 * fine, room % 3 == 0 ? 31 : 32 * fine};
        for (int trial = 0; trial < 40; ++trial) {
            Case c{grid, sight, randomPlace(random, grid, slice), {}, {}};
            const double fov = std::vector<double>{0, 60, 90, 180, 240, 270, 360}[random() % 7];
            c.laser = randomLaser(random, fov);
            const int headings = std::vector<int>{1, 4, 6, 8, 16}[random() % 5];
            const double offset = random() % 3 == 0 ? uniform(random, -400, 400) : 0;
            for (int k = 0; k < headings; ++k)
                c.headings.push_back(offset + k * (360.0 / headings));
            ASSERT_NO_FATAL_FAILURE(expectSame(c, parts)) << room << ' ' << trial;
        }
    }
}

TEST(CellsBySector, ManyLimitsCloseTogether) {
    Random random(21);
    const auto heading_to = [](Point2 from, Point2 to) {
        return directionOf(to.x - from.x, to.y - from.y).degrees();
    };
    const Scene scene = sceneOf("ispace size=12,8\ncube at=1,1 size=1,2,1\n");
    const VisibleArea sight(scene.environment, 0);
    const Grid grid{scene.environment.limits(), 60, 40};
    CellParts parts;
    for (int trial = 0; trial < 200; ++trial) {
        Case c{grid, sight, grid.center(random() % grid.size()), laserWith(6, -90, 180), {}};
        const double apart = std::pow(10, uniform(random, -12, 0));
        double about = 45 * (trial % 8);
        if (trial % 3 == 0) about = heading_to(c.place, grid.center(random() % grid.size())) - 90;
        for (int k = 0; k < 12; ++k) c.headings.push_back((k - 6) * apart + about);
        ASSERT_NO_FATAL_FAILURE(expectSame(c, parts)) << trial;
    }
}

TEST(CellsBySector, RowsAlmostLevelWithThePlace) {
    const Scene scene = sceneOf("ispace size=12,8\n");
    const VisibleArea sight(scene.environment, 0);
    const Grid grid{scene.environment.limits(), 24, 16};
    CellParts parts;
    for (const double by : {1e-15, 1e-12, 2e-11, 4e-11, 1e-10, 1e-9, 1e-8, 1e-7})
        for (const double side : {-1, 1})
            for (const double turn : {0.0, 1e-10, -1e-10, 5e-10, 2e-9, 1e-8}) {
                Case c{grid, sight, grid.center(grid.cell(11, 8)), laserWith(9, 0, 180), {}};
                c.place.y += side * by;
                for (int k = 0; k < 4; ++k) c.headings.push_back(k * 90 + turn);
                ASSERT_NO_FATAL_FAILURE(expectSame(c, parts)) << by << ' ' << side << ' ' << turn;
            }
}

TEST(CellsBySector, FarFromTheOriginAndInLargeRooms) {
    Random random(22);
    CellParts parts;
    for (const double far : {1e4, 999000.0}) {
        const std::string at = formatDouble(far);
        const std::string up = formatDouble(far + 16), half = formatDouble(far + 8);
        const Scene scene = sceneOf("fence path=" + at + ",0;" + up + ",0;" + up + ",8;" + at +
                                    ",8 closed=yes\ncube at=" + half + ",4 size=1,2,1\n");
        const VisibleArea sight(scene.environment, 0);
        const Grid grid{scene.environment.limits(), 160, 80};
        for (int trial = 0; trial < 10; ++trial) {
            Case c{grid, sight, grid.center(random() % grid.size()), laserWith(5, -90, 180), {}};
            for (int k = 0; k < 8; ++k) c.headings.push_back(k * 45);
            ASSERT_NO_FATAL_FAILURE(expectSame(c, parts)) << far << ' ' << trial;
        }
    }
}

TEST(CellsBySector, CellsAtTheGreatestRange) {
    const Scene scene = sceneOf("ispace size=12,8\n");
    const VisibleArea sight(scene.environment, 0);
    const Grid grid{scene.environment.limits(), 24, 16};
    CellParts parts;
    // Centres are half a metre apart; 3, 4, 5 and multiples are whole.
    for (const double range : {1.0, 2.5, 3.0, 5.0, 5.2})
        for (const double by : {-1e-6, -1e-7, -4e-8, -1e-9, 0.0, 1e-9, 4e-8, 1e-7, 1e-6}) {
            const Laser laser = laserWith(range * (1 + by), -90, 180);
            const Case c{grid, sight, grid.center(grid.cell(11, 8)), laser, {0, 30, 90, 200}};
            ASSERT_NO_FATAL_FAILURE(expectSame(c, parts)) << range << ' ' << by;
        }
}

TEST(CellsBySector, OneLimitAndNone) {
    const Scene scene = sceneOf("ispace size=12,8\n");
    const VisibleArea sight(scene.environment, 0);
    const Grid grid{scene.environment.limits(), 12, 8};
    const Point2 place = grid.center(grid.cell(3, 3));
    CellParts parts;
    cellsBySector(grid, *sight.levelAt(kScanHeight), place, 30, {}, parts);
    ASSERT_NO_FATAL_FAILURE(expectSound(parts, 0, grid.size()));
    EXPECT_EQ(parts.runs, (std::vector<CellRun>{{0, 96}}));  // rows go on
    for (const double degrees : {0.0, 45.0, 90.0, -160.0, 180.0, -1.0, 1e-9}) {
        const Angle limit = Angle::degrees(degrees);
        cellsBySector(grid, *sight.levelAt(kScanHeight), place, 30, {&limit, 1}, parts);
        ASSERT_NO_FATAL_FAILURE(expectSound(parts, 1, grid.size()));
        EXPECT_EQ(cellsOf(parts, 0, 2, grid.size()).count(), grid.size());
        EXPECT_EQ(cellsOf(parts, 1, 2, grid.size()).count(), 1U);  // the centre
    }
}

TEST(CellsBySector, LimitsBelongToWhatComesAfterThem) {
    const Scene scene = sceneOf("ispace size=12,8\n");
    const VisibleArea sight(scene.environment, 0);
    const Grid grid{scene.environment.limits(), 12, 8};
    CellParts parts;
    const auto cells_on = [&](double degrees) {
        const Angle limits[] = {Angle::degrees(degrees),
                                Angle::degrees(std::nextafter(degrees, 1000))};
        cellsBySector(grid, *sight.levelAt(kScanHeight), grid.center(grid.cell(3, 3)), 30, limits,
                      parts);
        EXPECT_EQ(cellsOf(parts, 0, 3, grid.size()).count(), grid.size());
        return cellsOf(parts, 0, 1, grid.size()).count();
    };
    EXPECT_EQ(cells_on(0), 8U);
    EXPECT_EQ(cells_on(45), 4U);
    EXPECT_EQ(cells_on(90), 4U);
    EXPECT_EQ(cells_on(-90), 3U);
    EXPECT_EQ(cells_on(-135), 3U);
    EXPECT_EQ(cells_on(-160), 0U);
    const Angle limits[] = {Angle::degrees(10), Angle::degrees(180)};
    cellsBySector(grid, *sight.levelAt(kScanHeight), grid.center(grid.cell(3, 3)), 30, limits,
                  parts);
    EXPECT_TRUE(cellsOf(parts, 1, 2, grid.size()).test(grid.cell(1, 3)));  // on 180 degrees
}

TEST(CellsBySector, NothingFromWithinASolidOrOutOfTheGrid) {
    const Scene scene = sceneOf("ispace size=12,8\ncube at=0,0 size=2,2,1\n");
    const VisibleArea sight(scene.environment, 0);
    const Grid grid{scene.environment.limits(), 12, 8};
    const std::vector<Angle> limits = {Angle::degrees(10), Angle::degrees(100)};
    CellParts parts;
    cellsBySector(grid, *sight.levelAt(kScanHeight), {0.1, 0.2}, 5, limits, parts);
    EXPECT_TRUE(parts.runs.empty());
    EXPECT_EQ(parts.size(), 3U);
    cellsBySector(grid, *sight.levelAt(kScanHeight), {100, 100}, 5, limits, parts);
    EXPECT_TRUE(parts.runs.empty());
    EXPECT_EQ(parts.size(), 3U);
}

}  // namespace sector_cells_test
}  // namespace ispace
