// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/flat_world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "base/file.h"
#include "geom/point.h"
#include "support/test_layout.h"
#include "support/test_paths.h"
#include "support/test_scans.h"

namespace ispace {

using namespace testing;

namespace flat_world_test {

/// Tests each line against each ray in long doubles, with exact signs for the sides.
class BruteForce {
  public:
    BruteForce(const Lines& lines, Point2 origin) {
        const auto height = [](Vec2 a, Vec2 b) {
            const long double x = static_cast<long double>(b.x) - a.x;
            const long double y = static_cast<long double>(b.y) - a.y;
            return (a.x * y - a.y * x) / std::sqrt(x * x + y * y);
        };
        std::vector<Vec2> touching;
        for (const Segment2& line : lines) {
            const Vec2 a = line.a - origin, e = line.b - line.a;
            if (e == Vec2{}) continue;
            const double s = std::clamp(-dot(a, e) / dot(e, e), 0.0, 1.0);
            if (length(a + s * e) < kTouching) touching.push_back((1 / length(e)) * e);
        }
        for (const Segment2& line : lines) {
            const Vec2 a = line.a - origin, b = line.b - origin, e = line.b - line.a;
            if (e == Vec2{}) continue;
            const long double h = height(a, b);
            if (std::fabs(h) <= 1e-9) continue;
            if (std::fabs(h) <= kTouching &&
                std::any_of(touching.begin(), touching.end(),
                            [&](Vec2 u) { return std::fabs(dot(u, e)) > (1 - 1e-6) * length(e); }))
                continue;
            const double size = std::min(std::max(std::fabs(a.x), std::fabs(a.y)),
                                         std::max(std::fabs(b.x), std::fabs(b.y)));
            lines_.push_back(
                {h > 0 ? a : b, h > 0 ? b : a, std::fabs(h), std::min(1e-9, 1e-6 * size)});
        }
    }
    /// \param cosine if given, of the nearest surface
    [[nodiscard]] double range(Vec2 way, double* cosine = nullptr) const {
        auto best = static_cast<long double>(kInfinity);
        for (const Line& line : lines_) {
            if (cross(line.a, way) < -line.edge || cross(way, line.b) < -line.edge) continue;
            const long double x = static_cast<long double>(line.b.x) - line.a.x;
            const long double y = static_cast<long double>(line.b.y) - line.a.y;
            const long double steep = (way.x * y - way.y * x) / std::sqrt(x * x + y * y);
            if (steep <= 0 || line.height / steep >= best) continue;
            best = line.height / steep;
            if (cosine != nullptr) *cosine = static_cast<double>(steep);
        }
        return static_cast<double>(best);
    }

  private:
    struct Line {
        Vec2 a, b;
        long double height;
        double edge;
    };
    std::vector<Line> lines_;
};

/// \return how far the worst beam is off
double worstError(const FlatWorld& world, const Lines& lines, Point2 origin,
                  const Directions& directions, double max_range) {
    const Seen seen = cast(world, origin, directions, max_range);
    const BruteForce brute(lines, origin);
    double worst = 0;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        double cosine = 1;
        double exact = brute.range({directions.x[i], directions.y[i]}, &cosine);
        if (static_cast<float>(exact) > static_cast<float>(max_range)) exact = kInfinity;
        if (std::isinf(exact)) cosine = 1;
        if (exact == seen.ranges[i] && std::isinf(exact)) {
            EXPECT_EQ(seen.cosines[i], 1);
            continue;
        }
        // One of the two may round to max_range.
        const double off =
            std::fabs(std::min(exact, max_range) -
                      std::min<double>(static_cast<double>(seen.ranges[i]), max_range));
        // Corners have two cosines.
        if (off > 1e-6 * (1 + exact)) worst = std::max(worst, off);
        EXPECT_NEAR(seen.cosines[i], cosine, 1e-5) << i;
    }
    return worst;
}

Lines linesOf(const Slice& slice) {
    Lines lines;
    slice.forEachLine([&](const Segment2& line) { lines.push_back(line); });
    return lines;
}

Lines shippedScene(const std::string& name) {
    const std::string file = testing::sourcePath("share/scenes/") + name;
    const Document document = readRecordText(readAll(file), file, sceneSchemas());
    return linesOf(makeScene(document, nullptr, testing::devices()).environment.slice(0.15));
}

Box2 boxOf(const Lines& lines) {
    Box2 box;
    for (const Segment2& line : lines) {
        box.add(line.a);
        box.add(line.b);
    }
    return box;
}

struct Plan {
    std::string name;
    Lines lines;
};

std::vector<Plan> plans() {
    std::mt19937_64 random(1);
    return {{"ispace", shippedScene("ispace.env")},
            {"crowded", shippedScene("crowded.env")},
            {"l-room", shippedScene("l-room.env")},
            {"office", office(8, 7)},
            {"tangle", tangle(random, 300, 20)}};
}

TEST(FlatWorld, AMillionBeamsAgreeWithBruteForce) {
    for (const auto& [name, lines] : plans()) {
        SCOPED_TRACE(name);
        ASSERT_GT(lines.size(), 4U);
        const FlatWorld world(lines);
        const Box2 box = boxOf(lines);
        std::mt19937_64 random(2);
        std::uniform_real_distribution<double> x(box.low.x, box.high.x), y(box.low.y, box.high.y);
        std::uniform_real_distribution<double> turn(-180, 180);
        double worst = 0;
        for (int i = 0; i < 200; ++i) {
            const Directions beams =
                scan(Angle::degrees(turn(random)), Angle::degrees(i % 2 == 0 ? 0.25 : -0.25), 1081);
            worst = std::max(worst, worstError(world, lines, {x(random), y(random)}, beams, 30));
        }
        EXPECT_LT(worst, 1e-3);
    }
}

TEST(FlatWorld, FansOfAllKindsAgreeWithBruteForce) {
    std::mt19937_64 random(3);
    const Lines lines = office(5, 4);
    const FlatWorld world(lines);
    std::uniform_real_distribution<double> x(0, 20), y(0, 28), turn(-400, 400);
    const std::pair<double, std::size_t> kinds[] = {
        {0, 1},    {0, 9},     {1, 1},      {180, 3},     {90, 4},     {120, 3},     {360, 2},
        {-120, 4}, {1, 360},   {1, 361},    {-1, 361},    {0.5, 721},  {0.1, 3600},  {0.1, 3601},
        {30, 13},  {-30, 12},  {45, 9},     {51, 8},      {7.5, 48},   {0.36, 1000}, {0.001, 4099},
        {1e-6, 9}, {1e-9, 20}, {-1e-3, 17}, {0.08, 4500}, {1e-12, 11}, {89.9, 5},    {0.087, 2049}};
    for (const auto& [step, count] : kinds) {
        SCOPED_TRACE(std::to_string(step) + " x " + std::to_string(count));
        for (int i = 0; i < 30; ++i) {
            // Multiples of 90 degrees lie along walls and the ends of turns.
            const double first = i % 3 == 0 ? 90.0 * (i % 4) : turn(random);
            const Directions beams = scan(Angle::degrees(first), Angle::degrees(step), count);
            const Point2 origin{x(random), y(random)};
            EXPECT_LT(worstError(world, lines, origin, beams, i % 2 == 0 ? kInfinity : 6), 1e-3);
        }
    }
}

TEST(FlatWorld, AMillionBeamsInOneFan) {
    const Lines lines = office(2, 2);
    const FlatWorld world(lines);
    const Directions beams = scan(Angle::degrees(30), Angle::degrees(120e-6), 1000001);
    EXPECT_LT(worstError(world, lines, {3.9, 6.1}, beams, 30), 1e-3);
}

TEST(FlatWorld, ARayIsTheSameInAnyCompany) {
    std::mt19937_64 random(4);
    for (const auto& [name, lines] : plans()) {
        SCOPED_TRACE(name);
        const Box2 box = boxOf(lines);
        std::uniform_real_distribution<double> x(box.low.x, box.high.x), y(box.low.y, box.high.y);
        std::uniform_real_distribution<double> turn(-180, 180);
        const FlatWorld world(lines);
        Lines mixed = lines;
        std::shuffle(mixed.begin(), mixed.end(), random);
        for (std::size_t i = 0; i < mixed.size(); i += 2) std::swap(mixed[i].a, mixed[i].b);
        mixed.insert(mixed.end(), lines.begin(), lines.begin() + 3);
        const FlatWorld other(mixed);
        for (int i = 0; i < 40; ++i) {
            Point2 origin{x(random), y(random)};
            if (i % 4 == 0) origin = lines[random() % lines.size()].a;
            if (i % 4 == 1) origin.y = lines[random() % lines.size()].a.y;
            const Angle first = Angle::degrees(i % 2 == 0 ? 90 : turn(random));
            const Directions beams = scan(first, Angle::degrees(0.5), 721);
            const Seen seen = cast(world, origin, beams, 12);
            EXPECT_EQ(cast(other, origin, beams, 12), seen);
            EXPECT_EQ(castApart(world, origin, beams, 12), seen);
            Directions free = beams;
            free.arc.reset();
            EXPECT_EQ(cast(world, origin, free, 12), seen);
            for (const std::size_t begin : {0U, 5U, 600U}) {
                Directions part = scan({}, Angle::degrees(0.5), 121);
                part.arc->first = first + static_cast<double>(begin) * Angle::degrees(0.5);
                for (std::size_t k = 0; k < part.size(); ++k) part.set(k, beams[begin + k]);
                const Seen few = cast(world, origin, part, 12);
                for (std::size_t k = 0; k < part.size(); ++k) {
                    EXPECT_EQ(few.ranges[k], seen.ranges[begin + k]);
                    EXPECT_EQ(few.cosines[k], seen.cosines[begin + k]);
                }
            }
        }
    }
}

TEST(FlatWorld, NoBeamSlipsThroughACommonEnd) {
    std::mt19937_64 random(5);
    for (const double far : {0.0, 1e5}) {
        Lines lines;
        addPolygon(lines, {far, -far}, 10, 2000, 0.05);
        const FlatWorld world(lines);
        std::uniform_real_distribution<double> place(-6, 6);
        for (int i = 0; i < 100; ++i) {
            const Point2 origin{far + place(random), place(random) - far};
            std::vector<Point2> corners;
            for (const Segment2& line : lines) corners.push_back(line.a);
            const Seen seen = cast(world, origin, towards(origin, corners));
            for (std::size_t k = 0; k < corners.size(); ++k)
                EXPECT_NEAR(seen.ranges[k], distance(origin, corners[k]), 1e-5);
            // The same directions as scans so narrow that all beams point at the corner.
            for (std::size_t k = 0; k < corners.size(); k += 97) {
                const Vec2 way = corners[k] - origin;
                const Directions beams =
                    scan(directionOf(way.x, way.y) - Angle::degrees(4e-7), Angle::degrees(1e-7), 9);
                for (const float found : cast(world, origin, beams).ranges)
                    EXPECT_NEAR(found, length(way), 1e-5);
            }
        }
    }
}

TEST(FlatWorld, Sizes) {
    std::mt19937_64 random(6);
    for (const double scale : {1e-6, 1e-3, 1.0, 1e4}) {
        const Lines lines = tangle(random, 200, scale);
        const FlatWorld world(lines);
        std::uniform_real_distribution<double> place(0, scale), turn(-180, 180);
        for (int i = 0; i < 40; ++i) {
            const Directions beams = scan(Angle::degrees(turn(random)), Angle::degrees(0.5), 541);
            const Point2 origin{place(random), place(random)};
            EXPECT_LT(worstError(world, lines, origin, beams, kInfinity), 1e-3 + 1e-7 * scale);
        }
    }
}

TEST(FlatWorld, LinesTooShortForALengthCountAsPoints) {
    // The square of 1e-170 is 0. Leaves tell by lengths how many lines they have.
    const Lines lines = {
        {{0, 0}, {1e-170, 0}}, {{0, 1}, {2, 1}}, {{3, 0}, {3, 1e-170}}, {{0, 2}, {2, 2}}};
    const FlatTree tree(lines);
    ASSERT_EQ(tree.leaves.size(), 1U);
    EXPECT_EQ(tree.leaves.front().count(), 2);
    EXPECT_EQ(FlatTree(Lines{lines[0], lines[2]}).leaves.size(), 0U);
    for (std::size_t count = 1; count <= 8; ++count) {
        const FlatTree few(Lines(count, lines[1]));
        ASSERT_EQ(few.leaves.size(), 1U);
        EXPECT_EQ(few.leaves.front().count(), static_cast<int>(count));
    }
}

/// Chooses items of `all` that are removed, and counts the others.
template <typename T>
std::vector<T> chosen(const std::vector<T>& all, double share, std::mt19937_64& random,
                      std::vector<T>& rest) {
    std::vector<T> some;
    std::bernoulli_distribution is_chosen(share);
    for (const T& item : all) (is_chosen(random) ? some : rest).push_back(item);
    return some;
}

TEST(FlatWorld, AnUpdatedTreeAnswersLikeANewOne) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> place(0, 20), size(0.1, 1), turn(-180, 180);
    const auto rounds = [&](int count) {
        std::vector<Ellipse> made;
        for (int i = 0; i < count; ++i)
            made.emplace_back(Point2{place(random), place(random)}, size(random), size(random),
                              Angle::degrees(turn(random)));
        return made;
    };
    for (const auto& [lines, bodies, more_lines, more_bodies] :
         {std::array{300, 20, 40, 5}, std::array{300, 0, 0, 3}, std::array{0, 9, 30, 0},
          std::array{0, 0, 12, 2}, std::array{9, 1, 0, 0}, std::array{1, 1, 1, 1}})
        for (const double share : {0.0, 0.1, 1.0}) {
            FlatBodies base{tangle(random, static_cast<std::size_t>(lines), 20), rounds(bodies)};
            if (lines > 0) base.lines.push_back(base.lines.front());  // once more
            base.lines.push_back({{3, 3}, {3, 3}});
            FlatBodies after;
            const FlatBodies removed{chosen(base.lines, share, random, after.lines),
                                     chosen(base.rounds, share, random, after.rounds)};
            const FlatBodies added{tangle(random, static_cast<std::size_t>(more_lines), 20),
                                   rounds(more_bodies)};
            after.lines.insert(after.lines.end(), added.lines.begin(), added.lines.end());
            after.rounds.insert(after.rounds.end(), added.rounds.begin(), added.rounds.end());
            const FlatWorld before(base.lines, base.rounds);
            const FlatWorld updated(before, removed, added), made(after.lines, after.rounds);
            for (int i = 0; i < 30; ++i) {
                const Point2 origin{place(random), place(random)};
                const Directions beams = scan(Angle::degrees(turn(random)), Angle::degrees(1), 361);
                EXPECT_EQ(cast(updated, origin, beams), cast(made, origin, beams));
                EXPECT_EQ(castApart(updated, origin, beams, 5), castApart(made, origin, beams, 5));
            }
        }
}

}  // namespace flat_world_test

}  // namespace ispace
