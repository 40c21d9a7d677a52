// SPDX-License-Identifier: GPL-3.0-or-later
// Walls leave no cracks: beams against the slices of random buildings, by brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "base/number.h"
#include "env/walls.h"
#include "geom/pose.h"
#include "geom/predicates.h"
#include "support/test_floor_plans.h"
#include "support/test_scene.h"

namespace ispace {
namespace wall_bodies_test {

using testing::environment;
using testing::pointText;

constexpr double kFar = 1000;

/// Distance at which the beam from `from` to `to` meets the line; infinite if it does not. Whether
/// it does is decided exactly.
double meetingWith(const Segment2& beam, const Segment2& line) {
    if (!intersects(beam, line)) return std::numeric_limits<double>::infinity();
    const Vec2 along = beam.b - beam.a, other = line.b - line.a;
    const double whole = length(along), denominator = cross(along, other);
    const auto at = [&](Point2 p) { return dot(p - beam.a, along) / whole; };
    const auto [low, high] = std::minmax({at(line.a), at(line.b)});
    if (std::abs(denominator) < 1e-9 * whole * length(other)) return low;
    return std::clamp(cross(line.a - beam.a, other) / denominator * whole, low, high);
}

double nearestOf(const Segment2& beam, std::span<const Segment2> lines) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Segment2& line : lines) nearest = std::min(nearest, meetingWith(beam, line));
    return nearest;
}

std::vector<Segment2> linesOf(const Slice& slice) {
    std::vector<Segment2> lines;
    slice.forEachLine([&](const Segment2& line) { lines.push_back(line); });
    return lines;
}

/// An opening of the plan in the world: one may look through it between two heights.
struct Hole {
    Segment2 line;
    double bottom, top;
};

struct Building {
    std::string text;
    std::vector<Point2> inside;
    std::vector<Hole> holes;
};

/// A house with partitions that end on one another and cross, of walls of several thicknesses and
/// heights, with doors and windows; turned and moved.
class Architect {
  public:
    Architect(std::uint64_t seed, bool open) : random_(seed), open_(open) {
        std::uniform_real_distribution<double> turn(-180, 180), shift(-20, 20);
        frame_ = {{shift(random_), shift(random_)},
                  random_() % 4 == 0 ? Angle::degrees(0) : Angle::degrees(turn(random_))};
    }

    Building build() {
        std::uniform_real_distribution<double> step(2.5, 5);
        std::vector<double> xs{0}, ys{0};
        for (int i = 0; i < 3; ++i) {
            xs.push_back(xs.back() + step(random_));
            ys.push_back(ys.back() + step(random_));
        }
        for (const double x : {xs.front(), xs.back()}) add({x, ys.front()}, {x, ys.back()});
        for (const double y : {ys.front(), ys.back()}) add({xs.front(), y}, {xs.back(), y});
        for (std::size_t i = 1; i < 3; ++i) {
            // Whole ones cross, short ones end on others.
            const std::size_t from = random_() % 2, to = 3 - random_() % 2;
            add({xs[i], ys[from]}, {xs[i], ys[to]});
            add({xs[0], ys[i]}, {xs[to], ys[i]});
        }
        std::uniform_real_distribution<double> share(0.2, 0.8);
        for (std::size_t i = 0; i + 1 < xs.size(); ++i)
            for (std::size_t k = 0; k + 1 < ys.size(); ++k)
                building_.inside.push_back(frame_ *
                                           Point2{xs[i] + share(random_) * (xs[i + 1] - xs[i]),
                                                  ys[k] + share(random_) * (ys[k + 1] - ys[k])});
        building_.text += "inside at=" + pointText(building_.inside.front()) + '\n';
        return building_;
    }

  private:
    void add(Point2 from, Point2 to) {
        if (random_() % 2 == 0) std::swap(from, to);
        static constexpr double kThicknesses[] = {0, 0, 0.1, 0.24, 0.3};
        const std::string id = "w" + std::to_string(walls_++);
        building_.text += "wall id=" + id + " from=" + pointText(frame_ * from) +
                          " to=" + pointText(frame_ * to) +
                          " thickness=" + formatDouble(kThicknesses[random_() % 5]) + '\n';
        const double whole = distance(from, to);
        double begin = 0.05;
        std::uniform_real_distribution<double> gap(0, 2), width(0.6, 1.4);
        for (begin += gap(random_); building_.holes.size() < 12;) {
            const double w = width(random_);
            if (begin + w > whole) break;
            addOpening(id, from, (1 / whole) * (to - from), begin, w);
            begin += w + (random_() % 3 == 0 ? 0 : gap(random_));
        }
    }

    void addOpening(const std::string& wall, Point2 from, Vec2 unit, double begin, double width) {
        const bool door = random_() % 2 == 0;
        building_.text += door ? "door" : "window";
        building_.text += " wall=" + wall + " offset=" + formatDouble(begin + width / 2) +
                          " size=" + formatDouble(width);
        if (door) building_.text += open_ ? " open=yes" : "";
        if (!door) building_.text += open_ ? " glass=clear" : " glass=opaque";
        building_.text += '\n';
        building_.holes.push_back(
            {{frame_ * (from + begin * unit), frame_ * (from + (begin + width) * unit)},
             door ? 0 : 0.9,
             door ? 2 : 2.1});
    }

    std::mt19937_64 random_;
    bool open_;
    Pose2 frame_;
    Building building_;
    int walls_ = 0;
};

/// Beams from each room at the given height towards all corners, jambs and joints, and closely past
/// them: calls leaves(beam, exit) for each that is not stopped where its room ends.
template <typename Leaves>
int sendBeams(const Building& building, const Environment& env, double height, Leaves leaves) {
    const std::vector<Segment2> lines = linesOf(env.slice(height));
    const std::vector<Region> faces = boundedFaces({env.wallLines(), {}});
    int count = 0;
    for (const Point2 from : building.inside) {
        if (env.slice(height).blocked(from)) continue;
        const auto face = std::find_if(faces.begin(), faces.end(), [&](const Region& region) {
            return region.locate(from) == Side::Inside;
        });
        if (face == faces.end()) continue;
        std::vector<Segment2> edges;
        face->forEachEdge([&](const Segment2& edge) { edges.push_back(edge); });
        for (const Segment2& line : lines) {
            for (const double off : {0.0, 1e-15, -1e-15, 1e-9, -1e-9}) {
                const Vec2 to = line.a - from;
                const Vec2 direction = to + off * perpendicular(to);
                const Segment2 beam{from, from + kFar / length(direction) * direction};
                const double exit = nearestOf(beam, edges);
                ++count;
                if (nearestOf(beam, lines) > exit + 1e-6) leaves(beam, exit);
            }
        }
    }
    return count;
}

TEST(Cracks, NoBeamLeavesARoomOfClosedWalls) {
    int beams = 0;
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        const Building building = Architect(seed, false).build();
        const Environment env = environment(building.text);
        for (const double height : {0.0, 0.5, 0.9, 1.5, 2.0, 2.05, 2.1, 2.3, 2.5})
            beams += sendBeams(building, env, height, [&](const Segment2& beam, double exit) {
                ADD_FAILURE() << "seed " << seed << " height " << height << " from "
                              << pointText(beam.a) << " towards " << pointText(beam.b)
                              << " leaves at " << exit << "\n"
                              << building.text;
            });
        if (HasFailure()) break;
    }
    EXPECT_GT(beams, 100000);
}

TEST(Cracks, BeamsLeaveThroughOpeningsOnly) {
    int through = 0;
    for (std::uint64_t seed = 100; seed < 110; ++seed) {
        const Building building = Architect(seed, true).build();
        const Environment env = environment(building.text);
        for (const double height : {0.0, 0.5, 1.5, 2.05, 2.3}) {
            sendBeams(building, env, height, [&](const Segment2& beam, double exit) {
                const Point2 place = beam.a + exit / kFar * (beam.b - beam.a);
                const bool in_hole = std::any_of(
                    building.holes.begin(), building.holes.end(), [&](const Hole& hole) {
                        return hole.bottom <= height && height <= hole.top &&
                               distance(place, hole.line) < 1e-5;
                    });
                EXPECT_TRUE(in_hole)
                    << "seed " << seed << " height " << height << " at " << pointText(place) << '\n'
                    << building.text;
                ++through;
            });
            if (HasFailure()) return;
        }
    }
    EXPECT_GT(through, 2000);
}

TEST(Cracks, TheBandHasNoneWhereGlassIs) {
    const Environment env = environment(
        "ispace size=6,4\nwindow at=0,-2 size=1.2\nwindow at=0,2 glass=none\ndoor at=3,0\n");
    const auto stopped = [](const auto& standing, Point2 to) {
        bool any = false;
        standing.forEachLine([&](const Segment2& line) {
            any = any || intersects({{0, 0}, to}, line);
        });
        return any;
    };
    EXPECT_FALSE(stopped(env.slice(1.5), {0, -9}));
    EXPECT_TRUE(stopped(env.slice(0.5), {0, -9}));
    EXPECT_TRUE(stopped(env.band(1, 1.5), {0, -9}));
    EXPECT_FALSE(stopped(env.band(1, 1.5), {0, 9}));
    EXPECT_TRUE(stopped(env.band(0, 1.5), {0, 9}));
    EXPECT_TRUE(stopped(env.slice(1.5), {9, 0}));
}

/// Sources and footprints of the prisms of some parts.
std::vector<Body> bodies(const std::vector<WallLine>& walls) {
    std::vector<Segment2> lines;
    for (const WallLine& wall : walls) lines.push_back(wall.line);
    return wallBodies(walls, weld(lines));
}

TEST(WallJoints, PiecesOfALineShareTheirCorners) {
    const Vec2 along = unitVector(Angle::degrees(33.3));
    const Point2 a{0.1, 0.2}, b = a + 7 * along, foot = a + 3.1 * along;
    const Point2 beside = foot + 2 * perpendicular(along);
    const auto body = bodies({{{a, b}, 0, 2, 0.2}, {{foot, beside}, 0, 2, 0.1}});
    ASSERT_EQ(body[0].prisms.size(), 2U);
    const Polygon& first = body[0].prisms[0].footprint;
    const Polygon& second = body[0].prisms[1].footprint;
    EXPECT_EQ(first.size(), 4U);
    EXPECT_EQ(first[1], second[0]);
    EXPECT_EQ(first[2], second[3]);
}

TEST(WallJoints, SheetsMeetBoxesInTheirPoint) {
    const auto body = bodies({{{{0, 0}, {4, 0}}, 0, 2, 0.2}, {{{4, 0}, {7, 0}}, 0, 2, 0}});
    ASSERT_EQ(body[0].prisms.size(), 1U);
    const Polygon& box = body[0].prisms[0].footprint;
    EXPECT_EQ(box.size(), 5U);
    EXPECT_NE(std::find(box.begin(), box.end(), (Point2{4, 0})), box.end());
}

TEST(WallJoints, BoxesOfTwoThicknessesMeetInTheirPoint) {
    const auto body = bodies({{{{0, 0}, {4, 0}}, 0, 2, 0.2}, {{{4, 0}, {7, 0}}, 0, 2, 0.4}});
    EXPECT_EQ(body[0].prisms[0].footprint.size(), 5U);
    EXPECT_EQ(body[1].prisms[0].footprint.size(), 5U);
}

TEST(WallJoints, MitresAreAsHighAsWhatMeets) {
    // Two high walls and a low one between them on the outside of the corner.
    const auto body = bodies({{{{0, 0}, {4, 0}}, 0, 3, 0.2},
                              {{{0, 0}, {0, 4}}, 0, 3, 0.2},
                              {{{0, 0}, {-4, 0}}, 0, 1, 0.2}});
    std::vector<const Prism*> mitres;
    for (const Prism& prism : body[0].prisms)
        if (signedArea(prism.footprint) < 0.1) mitres.push_back(&prism);
    ASSERT_EQ(mitres.size(), 1U);
    EXPECT_EQ(mitres[0]->bottom, 1) << "below, the three walls leave no notch";
    EXPECT_EQ(mitres[0]->top, 3);
    EXPECT_EQ(locate(mitres[0]->footprint, {-0.05, -0.05}), Side::Inside);
}

TEST(WallJoints, ManyWallsAtOnePointAreNotComparedPairByPair) {
    std::vector<WallLine> walls;
    for (int i = 0; i < 3000; ++i) {
        const Vec2 along = unitVector(Angle::degrees(0.12 * i));
        walls.push_back({{{0, 0}, Point2{} + 5 * along}, 0.001 * i, 3 + 0.001 * i, 0.1});
    }
    EXPECT_EQ(bodies(walls).size(), 3000U);
}

TEST(WallJoints, ThinnerThanTheWeldIsASheet) {
    const auto body = bodies({{{{0, 0}, {4, 0}}, 0, 2, 1e-9}});
    EXPECT_EQ(body[0].sheets.size(), 1U);
    EXPECT_TRUE(body[0].prisms.empty());
}

}  // namespace wall_bodies_test
}  // namespace ispace
