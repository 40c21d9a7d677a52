// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/derived_walls.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "env/body.h"
#include "env/environment.h"
#include "env/test_plans.h"
#include "env/test_scene.h"
#include "record/at_once.h"
#include "record/text.h"

namespace ispace {
namespace {

using testing::buildingPlan;
using testing::document;
using testing::environment;
using testing::fencePlan;

/// Rooms of all kinds: with crossings, doors, parts, holes, thick and dangling walls, far away.
const std::vector<std::string>& plans() {
    static const std::vector<std::string> kPlans{
        "ispace size=8,6\n",
        "ispace size=8,6 at=700000.1,-3.7 ceiling=yes heading=30\ndesk at=700000,-3\n",
        "fence path=-5,-4;5,-4;5,4.3;-5,4 closed=yes\nwall from=-7,1.1 to=7,0.7\n"
        "wall from=-4,-5 to=4,5.1\nwall from=-4,5 to=3,-5.3\n",
        "fence path=0,0;9,0;9,7;0,7 closed=yes thickness=0.2\nfence path=3,3;4,3;4,4;3,4 "
        "closed=yes\nfence path=0,0;2,2\nwall id=w from=5,0 to=5,7 thickness=0.1\n"
        "door wall=w offset=2 open=yes\nwindow wall=w offset=5\ninside at=1,5\n",
        "ispace size=4,4\nispace size=4,4 at=4,0\ninside at=0,0\ninside at=4,0\n"
        "pillar at=1,1\n",
        "wall from=0,0 to=4,0.0000004\nwall from=4.0000003,0 to=4,3\nwall from=4,3 to=0,3\n"
        "wall from=0,3.0000002 to=0,-0.0000001\nwall from=2,0 to=2.0000001,2.9999999\n"
        "wall from=1,1 to=1.000002,1\n",
        buildingPlan(60, {.thickness = 0.1, .open_doors = true, .heading = Angle::degrees(33)}),
        buildingPlan(2 * kManyRecords, {.open_doors = true}),
        fencePlan(500),
    };
    return kPlans;
}

Environment withStored(const std::string& plan, const std::string& stored) {
    const Document read = document(plan);
    return {read.records, assignIds(read.records), stored};
}

void expectSame(const Environment& a, const Environment& b, const std::string& what) {
    EXPECT_EQ(a.wallLines(), b.wallLines()) << what;
    EXPECT_EQ(a.indoor(), b.indoor()) << what;
    EXPECT_EQ(a.inside(), b.inside()) << what;
    EXPECT_EQ(a.limits(), b.limits()) << what;
    EXPECT_EQ(a.height(), b.height()) << what;
    EXPECT_EQ(a.floor().vertices, b.floor().vertices) << what;
    EXPECT_EQ(a.floor().triangles, b.floor().triangles) << what;
    ASSERT_EQ(a.elements().size(), b.elements().size()) << what;
    for (std::size_t i = 0; i < a.elements().size(); ++i) {
        const std::vector<Mesh> mine = meshesOf(a.elements()[i].body, Surfaces::Drawn);
        const std::vector<Mesh> other = meshesOf(b.elements()[i].body, Surfaces::Drawn);
        ASSERT_EQ(mine.size(), other.size()) << what;
        for (std::size_t k = 0; k < mine.size(); ++k) {
            ASSERT_EQ(mine[k].vertices, other[k].vertices) << what;
            ASSERT_EQ(mine[k].triangles, other[k].triangles) << what;
        }
    }
    EXPECT_EQ(a.stored(), b.stored()) << what;
}

/// Where the list of changed lines begins: behind checksum and key.
constexpr std::size_t kPayload = 2 * sizeof(WallsKey);

/// Stored bytes that name another inside point, which tells whether they were used.
std::string marked(const Environment& room, Point2 mark) {
    std::string stored = room.stored();
    const auto count_at = [&stored](std::size_t at) {
        std::uint32_t count = 0;
        std::memcpy(&count, stored.data() + at, sizeof count);
        return count;
    };
    const std::uint32_t changed = count_at(kPayload);
    std::size_t at = kPayload + (1 + changed) * sizeof changed;
    for (std::uint32_t i = 0; i < changed; ++i)
        at += sizeof changed + count_at(at) * sizeof(Point2);
    const Point2 inside = room.inside();
    EXPECT_EQ(std::memcmp(stored.data() + at, &inside, sizeof inside), 0);
    std::memcpy(stored.data() + at, &mark, sizeof mark);
    seal(stored);
    return stored;
}

bool isUsed(const std::string& plan, const std::string& stored, Point2 mark) {
    return withStored(plan, stored).inside() == mark;
}

/// Whether rays at this height find their tree in what is stored, which then is one of their lines.
bool knowsOrder(const Environment& room, double height) {
    const Slice slice = room.slice(height);
    const std::vector<Segment2> lines = slice.straightLines();
    const BoxOrder* const order = slice.order == nullptr ? nullptr : slice.order->find(lines);
    if (order == nullptr) return false;
    EXPECT_TRUE(order->isOf(lines.size()));
    return true;
}

TEST(DerivedWalls, OrdersAreOfTheLinesOfAHeight) {
    const std::string walls = "ispace size=8,6\nwall from=1,1 to=2,2 height=1\n";
    const std::string stored = environment(walls).stored();
    const Environment same = withStored(walls, stored);
    EXPECT_TRUE(knowsOrder(same, 0.15));
    EXPECT_TRUE(knowsOrder(same, 0.9));  // the same lines
    EXPECT_FALSE(knowsOrder(same, 1.5));
    // What stands there counts, though the walls are the same.
    const Environment more = withStored(walls + "cube at=3,3\n", stored);
    EXPECT_FALSE(knowsOrder(more, 0.15));
    EXPECT_EQ(more.stored(), environment(walls + "cube at=3,3\n").stored());
    // As many lines, but others.
    const std::string cube = "cube at=3,3\n", moved = "cube at=3.5,3\n";
    EXPECT_TRUE(knowsOrder(withStored(walls + cube, more.stored()), 0.15));
    EXPECT_FALSE(knowsOrder(withStored(walls + moved, more.stored()), 0.15));
}

TEST(DerivedWalls, GiveTheSameRoom) {
    for (const std::string& plan : plans()) {
        const Environment derived = environment(plan);
        const std::string stored = derived.stored();
        expectSame(withStored(plan, stored), derived, plan.substr(0, 80));
        const Region& part = derived.indoor().parts.front();
        const Mesh floor = derived.floor();
        const auto corner = [&floor](std::size_t i) {
            return floor.vertices[floor.triangles.front()[i]];
        };
        const auto third = [&corner](double Point3::*axis) {
            return (corner(0).*axis + corner(1).*axis + corner(2).*axis) / 3;
        };
        const Point2 mark{third(&Point3::x), third(&Point3::y)};
        ASSERT_EQ(part.locate(mark), Side::Inside);
        EXPECT_TRUE(isUsed(plan, marked(derived, mark), mark)) << plan.substr(0, 80);
        EXPECT_TRUE(knowsOrder(withStored(plan, stored), kScanHeight)) << plan.substr(0, 80);
        EXPECT_FALSE(knowsOrder(derived, kScanHeight)) << plan.substr(0, 80);
    }
}

TEST(DerivedWalls, AreOfTheseWallsAlone) {
    const std::string room =
        "fence id=f path=0,0;9,0;9,7;0,7 closed=yes\nwall id=w from=5,0 to=5,7 thickness=0.1\n"
        "door wall=w offset=2\ninside at=1,1\n";
    const Point2 mark{2, 2};
    const std::string stored = marked(environment(room), mark);
    const auto changed = [&room](const std::string& from, const std::string& to) {
        std::string out = room;
        return out.replace(out.find(from), from.size(), to);
    };
    EXPECT_TRUE(isUsed(room, stored, mark));
    EXPECT_TRUE(isUsed("desk at=3,3\n" + room + "pillar at=2,5\n", stored, mark));
    EXPECT_TRUE(isUsed(changed("id=f ", "id=g texture=a.png "), stored, mark));
    for (const std::string& other : {
             changed("5,0 to=5,7", "5,0 to=5,7.0000000001"),
             changed("thickness=0.1", "thickness=0.11"),
             changed("offset=2", "offset=2.5"),
             changed("offset=2", "offset=2 open=yes"),
             changed("at=1,1", "at=1,1.5"),
             changed("inside at=1,1\n", ""),
             changed("9,7;0,7 closed=yes", "9,7;0,7;0,0"),  // the same lines, which may cross
             room + "wall from=1,1 to=2,3\n",
         }) {
        EXPECT_FALSE(isUsed(other, stored, mark)) << other;
        expectSame(withStored(other, stored), environment(other), other);
    }
}

TEST(DerivedWalls, FindingsAreThoseOfTheRecords) {
    const std::string stored = environment("ispace size=8,6\n").stored();
    for (const std::string bad :
         {"ispace size=8,6\ndoor at=50,50\n", "ispace size=8,6\nzone path=0,0;1,1\n",
          "fence path=0,0;4,4;4,0;0,4 closed=yes\n", "desk at=1,1\n"}) {
        std::string found;
        try {
            static_cast<void>(withStored(bad, stored));
        } catch (const FormatError& error) {
            for (const Diagnostic& diagnostic : error.diagnostics())
                found += diagnostic.text() + '\n';
        }
        EXPECT_EQ(found, testing::findings(bad));
        EXPECT_NE(found, "");
    }
}

TEST(DerivedWalls, DamageIsNoticed) {
    for (const std::string& plan : {plans()[3], plans()[5]}) {
        const Environment derived = environment(plan);
        const std::string stored = derived.stored();
        for (std::size_t i = 0; i < stored.size(); ++i) {
            std::string flipped = stored;
            flipped[i] ^= static_cast<char>(1U << i % 8);
            EXPECT_EQ(withStored(plan, flipped).indoor(), derived.indoor());
            EXPECT_EQ(withStored(plan, stored.substr(0, i)).indoor(), derived.indoor());
        }
        expectSame(withStored(plan, stored + '\0'), derived, plan);
    }
}

TEST(DerivedWalls, LiesWithTheRightChecksumDoNoHarm) {
    std::mt19937_64 random(7);
    constexpr std::uint32_t kOdd[] = {0,          1,          2,          3,         5,
                                      0x7fffffff, 0x80000000, 0xffffffff, 0x10000000};
    for (const std::string& plan : {plans()[2], plans()[3], plans()[5]}) {
        const Environment derived = environment(plan);
        const std::string stored = derived.stored();
        std::size_t refused = 0, tried = 0;
        const auto attempt = [&](std::string lie) {
            seal(lie);
            const Environment room = withStored(plan, lie);
            ++tried;
            if (room.stored() == stored) ++refused;
            // What is taken lies within the walls, and can be worked with.
            ASSERT_EQ(room.indoor().locate(room.inside()), Side::Inside);
            ASSERT_GT(room.indoor().area(), 0);
            ASSERT_LE(bounds(room.indoor()).high.x, room.limits().high.x + 0.01);
            ASSERT_NEAR(room.limits().high.x, derived.limits().high.x, 1e-5);
            static_cast<void>(knowsOrder(room, kScanHeight));
            try {
                static_cast<void>(room.floor());
                static_cast<void>(difference(room.indoor(), {}));
            } catch (const FormatError&) {  // lines that cross by the million
            }
        };
        for (std::size_t at = kPayload; at + 4 <= stored.size(); at += 4)
            for (const std::uint32_t odd : kOdd) {
                std::string lie = stored;
                std::memcpy(lie.data() + at, &odd, sizeof odd);
                attempt(lie);
            }
        for (int i = 0; i < 3000; ++i) {
            std::string lie = stored;
            for (std::size_t flips = 1 + random() % 4; flips > 0; --flips)
                lie[kPayload + random() % (lie.size() - kPayload)] ^=
                    static_cast<char>(1U << random() % 8);
            attempt(lie);
        }
        EXPECT_GT(refused, tried / 4);
    }
}

/// A change of these means that files of this version would be read with other results than rooms
/// derived anew: raise kVersion in derived_walls.cc, and then change them.
TEST(DerivedWalls, AreWhatTheyWereInThisVersion) {
    std::string all;
    for (const std::size_t i : {0U, 2U, 3U, 4U, 5U, 7U})  // those whose numbers no machine rounds
        all += environment(plans()[i]).stored();
    EXPECT_EQ(sha256(all),
              "sha256:00ccc05d91f61244f75878eff2464edd2e447d50ec950a95bccc83ce970f0b47");
}

}  // namespace
}  // namespace ispace
