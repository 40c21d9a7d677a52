// SPDX-License-Identifier: GPL-3.0-or-later
// Rooms after random edits, against rooms built from the same records.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <random>
#include <string>
#include <utility>

#include "base/number.h"
#include "env/level.h"
#include "sim/collision.h"
#include "support/test_source.h"
#include "trace/ray_world.h"

namespace ispace {
namespace edit_random_test {

using std::chrono::milliseconds;

constexpr int kColumns = 5, kRows = 3;
constexpr double kWidth = 4 * kColumns, kDepth = 7 * kRows;

/// Rooms on corridors, furnished, with doors and windows, two robots and a laser.
std::string plan() {
    const auto at = [](double x, double y) { return formatDouble(x) + ',' + formatDouble(y); };
    std::string text = "fence path=0,0;" + at(kWidth, 0) + ';' + at(kWidth, kDepth) + ';' +
                       at(0, kDepth) + " closed=yes\n";
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column) {
            const double x = 4 * column, y = 7 * row;
            const std::string id = std::to_string(row) + std::to_string(column);
            text += "wall id=w" + id + " from=" + at(x, y + 5) + " to=" + at(x + 4, y + 5) +
                    "\nwall from=" + at(x + 4, y) + " to=" + at(x + 4, y + 5) + "\ndoor wall=w" +
                    id + " offset=1.2 open=yes\nwindow wall=w" + id + " offset=3\n";
            text += "desk at=" + at(x + 2.8, y + 1) + "\nchair at=" + at(x + 2.8, y + 2) +
                    " heading=-90\ntable at=" + at(x + 1.2, y + 3.4) + " size=1,0.8,0.72\n";
            text +=
                "pillar id=p" + id + " kind=round at=" + at(x + 0.5, y + 6.4) + " size=0.4,0.4,3\n";
        }
    return text +
           "floor at=3,6 size=3,1 friction=0.2\nzone id=z path=1,5.5;9,5.5;9,6.5;1,6.5\n"
           "robot id=r1 at=2,5.9\nrobot id=r2 at=10,12.9 heading=40 height=0.9\n"
           "laser id=l1 at=6,6.2\nlaser id=l2 on=r2 at=0,0,0.7\nlaser id=l3 on=desk1\n";
}

/// A world that random requests change.
class Edited {
  public:
    Edited()
        : world_(std::make_shared<const Scene>(testing::scene(plan())), milliseconds(100)),
          simulation_(world_, {}, {Clock::Kind::Step, 1}, std::nullopt),
          editor_(simulation_, std::make_shared<testing::TextSource>()) {}

    World& world() { return world_; }
    /// \returns false if the request is rejected
    bool edit(const std::string& request) {
        try {
            editor_.edit(parseEdits(request)).carryOut();
            return true;
        } catch (const FormatError&) {
            return false;
        }
    }

  private:
    World world_;
    Simulation simulation_;
    WorldEditor editor_;
};

/// Writes requests for the records of a scene.
class Requests {
  public:
    explicit Requests(unsigned seed) : random_(seed) {}

    std::string next(const Scene& scene) {
        const std::string& id = scene.ids[draw(scene.ids.size())];
        switch (draw(12)) {
            case 0:
                return "DELETE " + id;
            case 1:
                return "DELETE " + id + ' ' + scene.ids[draw(scene.ids.size())];
            case 2:
                return "SET " + id + ".id=new" + std::to_string(++made_);
            case 3:
                return "SET " + id + ".height=" + formatFixed(0.1 + 2 * share(), 1);
            case 4:
                return "SET chair*.heading=" + std::to_string(draw(360));
            case 5:
                return "ADD cube at=" + place() + " size=" + formatFixed(0.1 + 0.6 * share(), 2);
            case 6:
                return "ADD table id=new" + std::to_string(++made_) + " at=" + place();
            case 7:
                return "ADD wall from=" + place() + " to=" + place();
            case 8:
                return "ADD floor at=" + place() + " size=1,2 friction=0.5";
            case 9:
                return "SET " + id + ".heading=" + std::to_string(draw(360));
            default:
                return "SET " + id + ".at=" + place();
        }
    }
    Point2 point() { return {kWidth * share(), kDepth * share()}; }
    double share() { return std::uniform_real_distribution<double>(0, 1)(random_); }

  private:
    std::size_t draw(std::size_t count) { return random_() % count; }
    std::string place() {
        const Point2 p = point();
        return formatFixed(p.x, 2) + ',' + formatFixed(p.y, 2);
    }

    std::mt19937_64 random_;
    int made_ = 0;
};

void expectSameSlice(const Slice& a, const Slice& b) {
    EXPECT_EQ(a.sheets, b.sheets);
    EXPECT_EQ(a.solids, b.solids);
    EXPECT_EQ(a.sheet_owners, b.sheet_owners);
    EXPECT_EQ(a.solid_owners, b.solid_owners);
    EXPECT_EQ(a.curves(), b.curves());
}

void expectSameRoom(const Environment& a, const Environment& b) {
    ASSERT_EQ(a.elements().size(), b.elements().size());
    for (std::size_t i = 0; i < a.elements().size(); ++i) {
        const Element &x = a.elements()[i], &y = b.elements()[i];
        EXPECT_EQ(x.id, y.id);
        EXPECT_EQ(x.record, y.record);
        EXPECT_EQ(topOf(x.body), topOf(y.body)) << x.id;
        EXPECT_EQ(x.body.plates.size(), y.body.plates.size()) << x.id;
    }
    EXPECT_EQ(a.limits(), b.limits());
    EXPECT_EQ(a.indoor(), b.indoor());
    EXPECT_EQ(a.inside(), b.inside());
    EXPECT_EQ(a.wallLines(), b.wallLines());
    EXPECT_EQ(a.height(), b.height());
    EXPECT_EQ(a.digest(), b.digest());
    for (const double height : {0.15, 0.7}) {
        expectSameSlice(a.slice(height), b.slice(height));
        expectSameSlice(a.band(0, height), b.band(0, height));
        EXPECT_EQ(a.level(height)->freeFloor(), b.level(height)->freeFloor());
    }
}

void expectSameObstacles(const Obstacles& a, const Obstacles& b, Requests& random) {
    const auto lines = [](const Obstacles& obstacles, Point2 p) {
        std::vector<Segment2> found;
        obstacles.findAbout(p, 1, found);
        std::vector<std::array<double, 4>> sorted;
        for (const Segment2& line : found)
            if (squaredDistance(p, line) <= 1)
                sorted.push_back({line.a.x, line.a.y, line.b.x, line.b.y});
        std::sort(sorted.begin(), sorted.end());
        return sorted;
    };
    for (int i = 0; i < 60; ++i) {
        const Point2 p = random.point(), q = p + Vec2{random.share() - 0.5, random.share() - 0.5};
        EXPECT_EQ(a.overlap(p, 0.3), b.overlap(p, 0.3));
        EXPECT_EQ(a.overlap(p, 0.001), b.overlap(p, 0.001));
        EXPECT_EQ(a.nearest(p, 2), b.nearest(p, 2));
        EXPECT_EQ(a.near({p, q}, 0.2), b.near({p, q}, 0.2));
        EXPECT_EQ(a.stop({p, q}, 0.2), b.stop({p, q}, 0.2));
        EXPECT_EQ(lines(a, p), lines(b, p));
    }
}

std::vector<float> castFrom(const RayWorld& world, Point2 p, std::vector<float>& cosines) {
    constexpr std::size_t kBeams = 361;
    Directions beams;
    beams.resize(kBeams);
    beams.arc = Directions::Arc{Angle(), Angle::degrees(1)};
    for (std::size_t i = 0; i < kBeams; ++i) {
        const Vec2 way = unitVector(Angle::degrees(static_cast<double>(i)));
        beams.set(i, {way.x, way.y, 0});
    }
    std::vector<float> ranges(kBeams);
    cosines.resize(kBeams);
    world.cast({p.x, p.y, 0.15}, beams, 30, ranges, cosines);
    return ranges;
}

/// The data that a run derives from a scene, updated from one scene to the next.
struct Derived {
    Derived(const Scene& scene, const Derived* before)
        : obstacles(obstaclesOf(scene.environment, moversOf(scene),
                                before == nullptr ? nullptr : &before->obstacles)),
          worlds(scene.environment) {
        worlds.prepare(pose(), before == nullptr ? nullptr : &before->worlds);
    }
    static Pose3 pose() { return {{0, 0, 0.15}, {}, {}, {}}; }

    ObstacleSets obstacles;
    RayScenes worlds;
};

TEST(RandomEdits, ARoomAnswersLikeOneBuiltFromItsRecords) {
    std::size_t accepted = 0, shared = 0;
    for (const unsigned seed : {1U, 2U, 3U}) {
        Edited it;
        Requests random(seed);
        std::shared_ptr<const Scene> scene = it.world().sharedScene();
        auto derived = std::make_unique<Derived>(*scene, nullptr);
        for (int i = 0; i < 60; ++i) {
            const std::string request = random.next(*scene);
            SCOPED_TRACE(std::to_string(seed) + ", " + std::to_string(i) + ": " + request);
            const std::shared_ptr<const Scene> before = scene;
            if (!it.edit(request)) {
                EXPECT_EQ(it.world().sharedScene(), before);
                continue;
            }
            ++accepted;
            scene = it.world().sharedScene();
            shared += scene->environment.changesSince(before->environment) ? 1 : 0;
            Document document;
            document.records = scene->records;
            const Scene made = makeScene(document, nullptr, testing::devices());
            ASSERT_EQ(scene->ids, made.ids);
            expectSameRoom(scene->environment, made.environment);
            auto updated = std::make_unique<Derived>(*scene, derived.get());
            const Derived fresh(made, nullptr);
            ASSERT_EQ(updated->obstacles.size(), fresh.obstacles.size());
            for (const auto& [height, obstacles] : updated->obstacles)
                expectSameObstacles(obstacles, fresh.obstacles.at(height), random);
            for (int k = 0; k < 10; ++k) {
                const Point2 p = random.point();
                std::vector<float> cosines, fresh_cosines;
                EXPECT_EQ(castFrom(updated->worlds.at(Derived::pose()), p, cosines),
                          castFrom(fresh.worlds.at(Derived::pose()), p, fresh_cosines));
                EXPECT_EQ(cosines, fresh_cosines);
            }
            World other(made, milliseconds(100));
            for (std::size_t k = 0; k < made.sensors.size(); ++k)
                EXPECT_EQ(it.world().look(scene->sensors[k]).ranges,
                          other.look(made.sensors[k]).ranges);
            derived = std::move(updated);
        }
    }
    // Most requests succeed, and most of these leave the walls.
    EXPECT_GT(accepted, 60U);
    EXPECT_GT(shared, accepted / 2);
}

}  // namespace edit_random_test
}  // namespace ispace
