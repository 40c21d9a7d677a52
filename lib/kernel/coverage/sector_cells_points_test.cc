// SPDX-License-Identifier: GPL-3.0-or-later
// Cells by sector against each cell's centre by itself: a line of sight, a distance and a
// direction, in code of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "base/number.h"
#include "coverage/sector_cells.h"
#include "support/test_scenes.h"

namespace ispace {
namespace sector_cells_points_test {

using Random = std::mt19937_64;

struct Disc {
    Point2 center;
    double radius;
};

/// A room as text for the code under test, and as bare lines for the test.
struct Room {
    std::string text;
    std::vector<Segment2> lines;
    std::vector<Polygon> solids;
    std::vector<Disc> discs;

    explicit Room(const Polygon& outline) : text("fence closed=yes path=") {
        for (const Point2 p : outline) text += at(p) + ';';
        text.back() = '\n';
        addOutline(outline);
    }
    void addWall(Point2 a, Point2 b) {
        text += "wall from=" + at(a) + " to=" + at(b) + '\n';
        lines.push_back({a, b});
    }
    void addCube(Point2 p, double length, double width, double heading) {
        text += "cube at=" + at(p) + " size=" + at({length, width}) +
                ",1 heading=" + formatDouble(heading) + '\n';
        const double turn = heading * std::numbers::pi / 180;
        const double c = heading == 0 ? 1 : std::cos(turn), s = heading == 0 ? 0 : std::sin(turn);
        Polygon corners;
        for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
            const double u = x * length / 2, v = y * width / 2;
            corners.push_back({p.x + c * u - s * v, p.y + s * u + c * v});
        }
        addOutline(corners);
        solids.push_back(corners);
    }
    void addCylinder(Point2 p, double radius) {
        text += "cylinder at=" + at(p) + " size=" + at({2 * radius, 2 * radius}) + ",1\n";
        discs.push_back({p, radius});
    }

  private:
    static std::string at(Point2 p) { return formatDouble(p.x) + ',' + formatDouble(p.y); }
    void addOutline(const Polygon& polygon) {
        for (std::size_t i = 0; i < polygon.size(); ++i)
            lines.push_back({polygon[i], polygon[(i + 1) % polygon.size()]});
    }
};

double side(Point2 a, Point2 b, Point2 p) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

double farFrom(Point2 a, Point2 b, Point2 p) {
    const double dx = b.x - a.x, dy = b.y - a.y, squared = dx * dx + dy * dy;
    const double along = (p.x - a.x) * dx + (p.y - a.y) * dy;
    const double t = squared > 0 ? std::clamp(along / squared, 0.0, 1.0) : 0;
    return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

enum class Meeting { None, Touching, Crossing };

/// Exact for coordinates of few bits.
Meeting meetingOf(Point2 a, Point2 b, Point2 c, Point2 d) {
    const auto within = [](Point2 p, Point2 q, Point2 r) {
        return side(p, q, r) == 0 && std::min(p.x, q.x) <= r.x && r.x <= std::max(p.x, q.x) &&
               std::min(p.y, q.y) <= r.y && r.y <= std::max(p.y, q.y);
    };
    const auto apart = [](double x, double y) { return (x < 0 && y > 0) || (x > 0 && y < 0); };
    if (apart(side(a, b, c), side(a, b, d)) && apart(side(c, d, a), side(c, d, b)))
        return Meeting::Crossing;
    const bool touch = within(a, b, c) || within(a, b, d) || within(c, d, a) || within(c, d, b);
    return touch ? Meeting::Touching : Meeting::None;
}

enum class Answer { No, Yes, Unsure };

/// \param unsure lengths nearer than this may round to either side; 0: those of few bits do not,
/// but the far end of a line of sight that touches a corner does, and what is on a wall cut by one
Answer isSeen(const Room& room, Point2 from, Point2 to, double range, double unsure) {
    const double far = std::hypot(to.x - from.x, to.y - from.y);
    if (std::abs(far - range) < unsure) return Answer::Unsure;
    if (far > range) return Answer::No;
    Answer answer = Answer::Yes;
    for (const auto& [a, b] : room.lines) {
        const double nearest = std::min(
            {farFrom(a, b, from), farFrom(a, b, to), farFrom(from, to, a), farFrom(from, to, b)});
        if (nearest < unsure) return Answer::Unsure;
        const Meeting meeting = meetingOf(a, b, from, to);
        if (meeting == Meeting::Crossing) return Answer::No;
        if (meeting == Meeting::Touching) answer = Answer::Unsure;
    }
    for (const Disc& disc : room.discs) {
        const double gap = farFrom(from, to, disc.center) - disc.radius;
        if (std::abs(gap) < unsure) return Answer::Unsure;
        if (gap <= 0) return Answer::No;
    }
    return answer;
}

bool isIn(const Polygon& polygon, Point2 p) {
    bool inside = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        if ((a.y > p.y) != (b.y > p.y) && (side(a, b, p) > 0) == (b.y > a.y)) inside = !inside;
    }
    return inside;
}

bool isInSolid(const Room& room, Point2 p) {
    return std::any_of(room.solids.begin(), room.solids.end(),
                       [&](const Polygon& solid) { return isIn(solid, p); }) ||
           std::any_of(room.discs.begin(), room.discs.end(), [&](const Disc& disc) {
               return std::hypot(p.x - disc.center.x, p.y - disc.center.y) < disc.radius;
           });
}

/// Ascends with a direction from -180 to 180: exact at multiples of 90 degrees, no angle between.
double quadrants(double dx, double dy) {
    const double share = 1 - dx / (std::abs(dx) + std::abs(dy));
    return 90 * (dy < 0 ? -share : share);
}

struct Counts {
    int seen = 0, unsure = 0, all = 0;
};

/// Compares each cell; `limits` in degrees, ascending.
void expectPoints(const Room& room, const Level& level, const Grid& grid, Point2 place,
                  double range, const std::vector<double>& limits, double unsure, Counts& counts) {
    std::vector<Angle> angles;
    angles.reserve(limits.size());
    for (const double limit : limits) angles.push_back(Angle::degrees(limit));
    CellParts parts;
    cellsBySector(grid, level, place, range, angles, parts);
    ASSERT_EQ(parts.size(), limits.size() + 1);
    constexpr std::size_t kNone = 1000;
    std::vector<std::size_t> part_of(grid.size(), kNone);
    for (std::size_t part = 0; part < parts.size(); ++part)
        for (std::size_t i = parts.first[part]; i < parts.first[part + 1]; ++i)
            for (std::uint32_t cell = parts.runs[i].first; cell < parts.runs[i].end; ++cell) {
                ASSERT_EQ(part_of[cell], kNone) << cell;
                part_of[cell] = part;
            }
    const bool is_buried = isInSolid(room, place);
    const double width = grid.limits.width() / grid.columns;
    const double depth = grid.limits.depth() / grid.rows;
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column) {
            const Point2 center{grid.limits.low.x + (column + 0.5) * width,
                                grid.limits.low.y + (row + 0.5) * depth};
            const double dx = center.x - place.x, dy = center.y - place.y;
            const Answer answer =
                is_buried ? Answer::No : isSeen(room, place, center, range, unsure);
            const double direction =
                unsure > 0 ? std::atan2(dy, dx) * 180 / std::numbers::pi : quadrants(dx, dy);
            const bool on_limit = std::any_of(limits.begin(), limits.end(), [&](double limit) {
                return std::abs(direction - limit) * range < 60 * unsure;
            });
            ++counts.all;
            if (answer == Answer::Unsure || (answer == Answer::Yes && on_limit)) {
                ++counts.unsure;
                continue;
            }
            std::size_t expected = kNone;
            if (answer == Answer::Yes) {
                ++counts.seen;
                const auto after = std::upper_bound(limits.begin(), limits.end(), direction);
                expected = after == limits.begin()
                               ? limits.size() - 1
                               : static_cast<std::size_t>(after - limits.begin()) - 1;
                if (limits.empty() || (dx == 0 && dy == 0)) expected = limits.size();
            }
            ASSERT_EQ(part_of[grid.cell(column, row)], expected)
                << room.text << "place " << formatDouble(place.x) << ',' << formatDouble(place.y)
                << " centre " << center.x << ',' << center.y << " range " << range;
        }
}

double uniform(Random& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

Point2 anyPlace(Random& random) { return {uniform(random, -6, 6), uniform(random, -4, 4)}; }

std::vector<double> anyLimits(Random& random) {
    std::vector<double> limits(random() % 9);
    for (double& limit : limits) limit = uniform(random, -180, 180);
    std::sort(limits.begin(), limits.end());
    return limits;
}

TEST(CellsBySectorPoints, RandomRoomsAndSectors) {
    Random random(40);
    Counts counts;
    for (int i = 0; i < 60; ++i) {
        Polygon star;
        const int corners = 3 + static_cast<int>(random() % 12);
        for (int k = 0; k < corners; ++k) {
            const double turn = 2 * std::numbers::pi * (k + uniform(random, 0, 0.8)) / corners;
            const double radius = uniform(random, 2, 7);
            star.push_back({radius * std::cos(turn), radius * std::sin(turn)});
        }
        Room room(i % 2 == 0 ? star : Polygon{{-6, -4}, {6, -4}, {6, 4}, {-6, 4}});
        // In a star there is room for one body alone, about its middle.
        for (int k = 0; k < 4 && i % 2 != 0; ++k) {
            room.addWall(anyPlace(random), anyPlace(random));
            room.addCube(anyPlace(random), uniform(random, 0.1, 2), uniform(random, 0.1, 2),
                         uniform(random, -180, 180));
        }
        room.addCylinder({uniform(random, -0.3, 0.3), 0}, uniform(random, 0.1, 0.5));
        const Scene scene = sceneOf(room.text);
        const std::shared_ptr<const Level> level = scene.environment.level(kScanHeight);
        Box2 box = scene.environment.limits();
        if (i % 3 == 0) box.high.x -= 0.3 * box.width();  // not all of it
        const Grid grid{box, 5 + static_cast<int>(random() % 90),
                        5 + static_cast<int>(random() % 60)};
        for (int k = 0; k < 12; ++k) {
            const Point2 place = anyPlace(random);
            if (i % 2 == 0 && !isIn(star, place)) continue;
            const double range = uniform(random, 0.2, k % 4 == 0 ? 20 : 5);
            ASSERT_NO_FATAL_FAILURE(
                expectPoints(room, *level, grid, place, range, anyLimits(random), 1e-4, counts))
                << i << ' ' << k;
        }
    }
    EXPECT_GT(counts.seen, counts.all / 10);
    EXPECT_LT(counts.unsure, counts.all / 100);
}

/// Cells on limits, level with the place and under it, and, as 3, 4, 5 are whole, at the
/// greatest range.
TEST(CellsBySectorPoints, NothingRoundsOnALattice) {
    Random random(41);
    const auto on_lattice = [&random](double extent, int parts) {
        const auto steps = static_cast<std::uint64_t>(2 * extent * parts);
        return static_cast<double>(random() % steps) / parts - extent;
    };
    Counts counts;
    for (int i = 0; i < 60; ++i) {
        Room room(Polygon{{-6, -4}, {6, -4}, {6, 4}, {-6, 4}});
        for (int k = 0; k < 4; ++k) {
            const Point2 a{on_lattice(6, 4), on_lattice(4, 4)};
            const Point2 b{random() % 3 == 0 ? a.x : on_lattice(6, 4),
                           random() % 3 == 0 ? a.y : on_lattice(4, 4)};
            if (a.x != b.x || a.y != b.y) room.addWall(a, b);
            room.addCube({on_lattice(5, 4), on_lattice(3, 4)},
                         0.5 * (1 + static_cast<int>(random() % 3)), 0.5, 0);
        }
        const Scene scene = sceneOf(room.text);
        const std::shared_ptr<const Level> level = scene.environment.level(kScanHeight);
        // Centres on multiples of 1/8 or of 1/2.
        const Grid grid = i % 2 == 0 ? Grid{scene.environment.limits(), 48, 32}
                                     : Grid{{{-6.25, -4.25}, {6.25, 4.25}}, 25, 17};
        for (int k = 0; k < 20; ++k) {
            const Point2 place{on_lattice(6, 8), on_lattice(4, 8)};
            // On a line sight has two sides: another test's.
            if (std::any_of(room.lines.begin(), room.lines.end(),
                            [&](const Segment2& s) { return farFrom(s.a, s.b, place) < 0.01; }))
                continue;
            std::vector<double> limits;
            for (const int degrees : {-90, 0, 90, 180})
                if (random() % 2 == 0) limits.push_back(degrees);
            const double range = std::vector<double>{0.125, 0.625, 1.25, 2.5, 5, 30}[random() % 6];
            ASSERT_NO_FATAL_FAILURE(
                expectPoints(room, *level, grid, place, range, limits, 0, counts))
                << i << ' ' << k;
        }
    }
    EXPECT_GT(counts.seen, counts.all / 20);
    EXPECT_LT(counts.unsure, counts.all / 10);
}

}  // namespace sector_cells_points_test
}  // namespace ispace
