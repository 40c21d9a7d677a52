// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "extensions/proofs/poses/box_views.h"
#include "extensions/proofs/poses/certificate.h"
#include "extensions/proofs/poses/pose_search.h"
#include "extensions/proofs/test_pose_floors.h"
#include "geom/visibility/visibility.h"
#include "support/test_problems.h"

namespace ispace::proofs {
namespace check_certificate_test {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kCells = 1200;

using poses::BoxViews;
using poses::PoseBox;
using poses::PoseFloor;
using poses::Sector;

/// A gallery of many reflex corners, in which portals lie at all angles.
Region comb() {
    Polygon outline = {{0, 0}, {12, 0}, {12, 1.5}};
    for (int tooth = 5; tooth >= 0; --tooth) {
        const double x = 2.0 * tooth;
        outline.insert(
            outline.end(),
            {{x + 1.7, 1.5}, {x + 0.9 + 0.3 * tooth / 5, 5}, {x + 0.4, 5}, {x + 0.9, 1.5}});
    }
    outline.push_back({0, 1.5});
    return {outline, {}};
}

PoseCertificate certificateOf(const Region& region, const Sector& sector, int sensors, int rounds,
                              const PoseGoal& goal = {}) {
    PoseCertificate certificate;
    const PoseFloor floor({&region, 1}, kCells, goal.weights);
    StopWhen progress(afterAsking(rounds));
    const PoseBound bound = boundOverPoses(
        floor, sector,
        {.sensors = sensors, .times = goal.times, .gap = 0.001, .certificate = &certificate},
        progress);
    EXPECT_EQ(bound.bound, certificate.bound);
    return certificate;
}

CertificateCheck checked(const Region& region, const Sector& sector, int sensors,
                         const PoseCertificate& certificate, const PoseGoal& goal = {}) {
    return checkCertificate({&region, 1}, kCells, sector, sensors, goal, certificate, "c");
}

std::string refusalOf(const PoseCertificate& certificate) {
    try {
        checked(roomsWithPillar(), {3, 2, 0}, 2, certificate);
    } catch (const FormatError& error) {
        return error.what();
    }
    return "";
}

TEST(CheckCertificate, ConfirmsSearches) {
    for (const Region& region : {roomsWithPillar(), comb()})
        for (const Sector& sector : {Sector{3, 2, -1}, Sector{2.5, 4, 0}, Sector{30, 2 * kPi, 0}})
            for (const int sensors : {1, 2, 3})
                for (const int rounds : {0, 40}) {
                    const PoseCertificate made = certificateOf(region, sector, sensors, rounds);
                    const CertificateCheck check = checked(region, sector, sensors, made);
                    EXPECT_LE(check.bound, made.bound * (1 + 1e-9))
                        << sector.field << ' ' << sensors << ' ' << rounds;
                    EXPECT_GT(check.bound, 0);
                }
}

poses::FloorWeighting zones() {
    return {.elsewhere = 0.5,
            .pieces = {{{{1, 1}, {4.3, 1}, {4.3, 3.7}, {1, 3.7}}, 3},
                       {{{6.05, 0}, {10, 0.3}, {8.5, 4}}, 0},
                       {{{4.5, 1}, {5.1, 1}, {5.1, 2}, {4.5, 2}}, 2}}};
}

TEST(CheckCertificate, ConfirmsSearchesOfWeightsAndSeveralTimes) {
    const Region region = roomsWithPillar();
    for (const Sector& sector : {Sector{3, 2, -1}, Sector{30, 2 * kPi, 0}})
        for (const PoseGoal& goal : {PoseGoal{1, zones()}, PoseGoal{2, {}}, PoseGoal{2, zones()}})
            for (const int sensors : {2, 3})
                for (const int rounds : {0, 20}) {
                    const PoseCertificate made =
                        certificateOf(region, sector, sensors, rounds, goal);
                    const CertificateCheck check = checked(region, sector, sensors, made, goal);
                    EXPECT_LE(check.bound, made.bound * (1 + 1e-9))
                        << sector.field << ' ' << sensors << ' ' << goal.times << ' ' << rounds;
                    EXPECT_GT(check.bound, 0);
                    if (rounds > 0 || sensors > 2) continue;
                    // It confirms no claim far below.
                    PoseCertificate bold = made;
                    bold.bound *= 0.7;
                    EXPECT_GT(checked(region, sector, sensors, bold, goal).bound, bold.bound);
                }
}

TEST(CheckCertificate, BoundsWhatSeveralSensorsSee) {
    const Region region = roomsWithPillar();
    const Sector sector{3, 4, 0};
    std::mt19937 random(7);
    std::uniform_real_distribution<double> x(0, 11), y(0, 5), turn(0, 2 * kPi);
    const SeenAreas areas(region, sector);
    for (const int times : {2, 3}) {
        const double bound = checked(region, sector, 3,
                                     certificateOf(region, sector, 3, 60, {times, {}}), {times, {}})
                                 .bound;
        for (int i = 0; i < 100; ++i) {
            std::vector<Pose2> poses;
            while (poses.size() < 3) {
                const Point2 at{x(random), y(random)};
                if (region.locate(at) == Side::Inside)
                    poses.push_back({at, Angle::radians(turn(random))});
            }
            EXPECT_LE(areas.of(poses, times), bound);
        }
    }
}

/// The weight of each zone's floor in a box's view, against one view cut by the zones.
TEST(BoxViews, WeighFloorByZones) {
    const Region region = roomsWithPillar();
    const PoseFloor searched({&region, 1}, kCells, zones());
    const double weight = searched.weightOf([&searched](std::size_t first, std::size_t count) {
        const auto begin = searched.parts().begin() + static_cast<std::ptrdiff_t>(first);
        return std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(count), 0U);
    });
    // 3.3 x 2.7 m of weight 3, 0.6 x 1 m of 2, none in the triangle beside the pillar.
    const BoxViews views({&region, 1}, kCells, {3, 4, 0}, zones());
    EXPECT_LE(views.floorArea(), weight + 1e-9);
    EXPECT_NEAR(BoxViews({&region, 1}, kCells, {3, 4, 0}).floorArea(), region.area(), 0.01);
    const double zoned = 0.5 * region.area() + 2.5 * 3.3 * 2.7 + 1.5 * 0.6;
    EXPECT_LT(views.floorArea(), zoned);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> x(0, 11), y(0, 5), turn(0, 2 * kPi), size(0, 2);
    for (int i = 0; i < 60; ++i) {
        const Point2 low{x(random), y(random)};
        const PoseBox box{
            {low, {low.x + size(random), low.y + size(random)}}, turn(random), size(random)};
        const Sector sector{1 + 2 * size(random), i % 3 == 0 ? 2 * kPi : 0.5 + turn(random) / 2, 0};
        const double own = BoxViews({&region, 1}, kCells, sector, zones()).viewOf(box).area;
        EXPECT_LE(own, outerBoundOf(searched, sector, box).area * (1 + 1e-9) + 1e-9) << i;
        const double one = BoxViews({&region, 1}, kCells, sector).viewOf(box).area;
        EXPECT_LE(own, 3 * one + 1e-9);
    }
}

TEST(CheckCertificate, TextSurvivesWritingAndReading) {
    const PoseCertificate made = certificateOf(roomsWithPillar(), {3, 2, 0}, 3, 30);
    const std::string text = certificateText(made, {"arrange a.env", "more"});
    const PoseCertificate again = readCertificate(text, "c");
    EXPECT_EQ(again.bound, made.bound);
    EXPECT_EQ(again.boxes, made.boxes);
    EXPECT_EQ(again.tuples, made.tuples);
    EXPECT_EQ(certificateText(again, {"arrange a.env", "more"}), text);
}

TEST(CheckCertificate, RefusesTextThatIsNone) {
    const auto refusal = [](const std::string& text) -> std::string {
        try {
            readCertificate(text, "c");
        } catch (const FormatError& error) {
            return error.what();
        }
        return "";
    };
    const std::string head = "#certificate 1\nbound 3\n";
    EXPECT_EQ(refusal(head + "boxes\n.\ntuples\n.\n"), "");
    EXPECT_NE(refusal("").find("wanted #certificate 1"), std::string::npos);
    EXPECT_NE(refusal("#certificate 2\n").find("c:1: "), std::string::npos);
    EXPECT_NE(refusal("#certificate 1\nbound -1\n").find("wanted `bound AREA`"), std::string::npos);
    EXPECT_NE(refusal("#certificate 1\nbound nan\n").find("c:2: "), std::string::npos);
    EXPECT_NE(refusal(head).find("wanted `boxes`"), std::string::npos);
    EXPECT_NE(refusal(head + "boxes\nx..\n").find("wanted `tuples`"), std::string::npos);
    EXPECT_NE(refusal(head + "boxes\n3\n").find("`3` is no node of boxes"), std::string::npos);
    EXPECT_NE(refusal(head + "boxes\n.\ntuples\n.\nboxes\n").find("more than two"),
              std::string::npos);
}

TEST(CheckCertificate, RefusesTreesThatLeaveOutPoses) {
    const PoseCertificate made = certificateOf(roomsWithPillar(), {3, 2, 0}, 2, 20);
    EXPECT_EQ(refusalOf(made), "");
    PoseCertificate cut = made;
    cut.tuples.pop_back();
    EXPECT_NE(refusalOf(cut).find("tuples ends early"), std::string::npos);
    cut = made;
    cut.boxes.pop_back();
    EXPECT_NE(refusalOf(cut).find("boxes ends early"), std::string::npos);
    cut = made;
    cut.tuples += '.';
    EXPECT_NE(refusalOf(cut).find("more than one tree"), std::string::npos);
    EXPECT_NE(refusalOf({3, "x..", "-"}).find("leaves out all"), std::string::npos);
    EXPECT_NE(refusalOf({3, "x..", "0-."}).find("see floor"), std::string::npos);
    EXPECT_NE(refusalOf({3, "x..", "2.."}).find("no sensor 2"), std::string::npos);
    EXPECT_NE(refusalOf({3, "x..", "00..."}).find("halves a whole box"), std::string::npos);
    EXPECT_NE(refusalOf({3, std::string(70, 'x') + std::string(71, '.'), "."}).find("64 times"),
              std::string::npos);
}

TEST(CheckCertificate, EachDroppedLeafIsNoticed) {
    // The second laser is never in an earlier half than the first, so one tuple may be left out.
    const PoseCertificate whole{9, "xy..y..", "01..1-."};
    EXPECT_EQ(refusalOf(whole), "");
    for (std::size_t i = 0; i < whole.tuples.size(); ++i) {
        if (whole.tuples[i] != '.') continue;
        PoseCertificate cut = whole;
        cut.tuples[i] = '-';
        EXPECT_NE(refusalOf(cut).find("see floor"), std::string::npos) << i;
    }
}

TEST(CheckCertificate, ALowerClaimIsNotConfirmed) {
    const Sector sector{3, 2, 0};
    PoseCertificate made = certificateOf(roomsWithPillar(), sector, 2, 60);
    made.bound *= 0.97;
    EXPECT_GT(checked(roomsWithPillar(), sector, 2, made).bound, made.bound);
    // Nor does the proof for two sensors hold for three, or for a longer range.
    EXPECT_GT(checked(roomsWithPillar(), sector, 3, made).bound, made.bound);
    EXPECT_GT(checked(roomsWithPillar(), {4, 2, 0}, 2, made).bound, made.bound);
}

TEST(CheckCertificate, EndsAtTheFirstTupleThatMaySeeMore) {
    const Region region = roomsWithPillar();
    const Sector sector{4, 4, 0};
    PoseCertificate claim;
    StopWhen soon(afterAsking(32));
    (void)boundOverPoses(PoseFloor({&region, 1}, kCells), sector,
                         {.sensors = 2, .singles = 500, .certificate = &claim}, soon);
    const CertificateCheck whole = checked(region, sector, 2, claim);
    EXPECT_EQ(whole.refused, 0U);
    EXPECT_GT(whole.bounded, 100U);
    claim.bound *= 0.93;
    std::size_t refused = 0;
    for (int step = 0; step < 3; ++step) {
        CertificateCheck checks[2];
        for (const std::size_t threads : {1U, 2U}) {
            using Control = tbb::global_control;
            const Control limit(Control::max_allowed_parallelism, threads);
            checks[threads - 1] = checked(region, sector, 2, claim);
            EXPECT_LT(checks[threads - 1].bounded, whole.bounded / 2);
        }
        EXPECT_GT(checks[0].refused, refused);  // all up to the last one are within its bound
        EXPECT_EQ(checks[0].refused, checks[1].refused);
        EXPECT_GT(checks[0].bound, claim.bound);
        EXPECT_EQ(checks[0].bound, checks[1].bound);
        refused = checks[0].refused;
        claim.bound = checks[0].bound;
    }
}

/// Poses of the box see no more than its view, by exact area, and by cell.
void expectHolds(const Region& region, const Sector& sector, const PoseBox& box,
                 std::mt19937& random) {
    std::vector<Segment2> walls;
    region.forEachEdge([&](const Segment2& edge) { walls.push_back(edge); });
    const VisibilityMap map(walls);
    const BoxViews views({&region, 1}, kCells, sector);
    const poses::BoxView view = views.viewOf(box);
    std::uniform_real_distribution<double> share(0, 1);
    for (int i = 0; i < 30; ++i) {
        const Point2 p{box.at.low.x + share(random) * box.at.width(),
                       box.at.low.y + share(random) * box.at.depth()};
        if (region.locate(p) != Side::Inside) continue;
        const double heading = box.from + share(random) * box.span;
        const VisibleRegion seen = sectorOf(map.query(p, sector.range), Angle::radians(heading),
                                            Angle::radians(sector.field));
        Polygon outline;
        if (!seen.is_whole) outline.push_back(p);
        for (const VisibilityEdge& edge : seen.edges) {
            outline.push_back(edge.from);
            outline.push_back(edge.to);
        }
        EXPECT_LE(std::abs(signedArea(outline)), view.area + 1e-9);
        const poses::BoxView single = views.viewOf({{p, p}, heading, 0});
        for (std::size_t k = 0; k < single.parts.size(); ++k) {
            const std::size_t cell = single.first + k;
            const bool is_in = cell >= view.first && cell < view.first + view.parts.size();
            EXPECT_LE(single.parts[k], is_in ? view.parts[cell - view.first] : 0);
        }
    }
}

TEST(BoxViews, HoldTheViewsOfTheirPoses) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> x(0, 11), y(0, 5), turn(0, 2 * kPi), size(0, 2);
    for (const Region& region : {roomsWithPillar(), comb()})
        for (int i = 0; i < 40; ++i) {
            const Point2 low{x(random), y(random)};
            const PoseBox box{
                {low, {low.x + size(random), low.y + size(random)}}, turn(random), size(random)};
            const Sector sector{1 + 2 * size(random), i % 3 == 0 ? 2 * kPi : 0.5 + turn(random) / 2,
                                0};
            expectHolds(region, sector, box, random);
        }
}

TEST(BoxViews, AreNoLargerThanThoseOfTheSearch) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> x(0, 11), y(0, 5), turn(0, 2 * kPi), size(0, 2);
    for (const Region& region : {roomsWithPillar(), comb()}) {
        const PoseFloor floor({&region, 1}, kCells);
        for (int i = 0; i < 100; ++i) {
            const Point2 low{x(random), y(random)};
            const PoseBox box{
                {low, {low.x + size(random), low.y + size(random)}}, turn(random), size(random)};
            const Sector sector{1 + 2 * size(random), i % 3 == 0 ? 2 * kPi : 0.5 + turn(random) / 2,
                                0};
            const double searched = outerBoundOf(floor, sector, box).area;
            const double own = BoxViews({&region, 1}, kCells, sector).viewOf(box).area;
            EXPECT_LE(own, searched * (1 + 1e-9) + 1e-9) << i;
        }
    }
}

}  // namespace check_certificate_test
}  // namespace ispace::proofs
