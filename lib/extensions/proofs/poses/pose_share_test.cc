// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/proofs/poses/pose_share.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "extensions/proofs/test_pose_floors.h"
#include "support/test_problems.h"
#include "support/test_results.h"

namespace ispace::proofs::poses {
namespace pose_share_test {

constexpr std::size_t kCells = 800;
const Sector kSector{3, 4, 0};

/// A search, each time by a new process that finds the results of those before.
struct Case {
    int sensors = 2, times = 1;
    double gap = 0.03;
    FloorWeighting weights = {};
    std::size_t max_bytes = std::size_t{8} << 30U;
    Sector sector = kSector;
    double found = 1;
    Region region = roomsWithPillar();

    [[nodiscard]] PoseBound run(PoseShare share, PoseCertificate* certificate,
                                Progress& progress) const {
        const PoseFloor floor({&region, 1}, kCells, weights);
        PoseSearchOptions options{.sensors = sensors,
                                  .times = times,
                                  .found = found,
                                  .gap = gap,
                                  .max_bytes = max_bytes,
                                  .singles = 800,
                                  .certificate = certificate};
        options.share = share;
        const SeenAreas areas(region, sector);
        options.improve = [&](std::span<const PoseBox> boxes) {
            PosedLayout layout;
            for (const PoseBox& box : boxes) {
                if (region.locate(box.at.center()) != Side::Inside) return PosedLayout();
                layout.poses.push_back({box.at.center(), Angle::radians(box.from + box.span / 2)});
            }
            layout.area = areas.of(layout.poses, times);
            return layout;
        };
        return boundOverPoses(floor, sector, options, progress);
    }
};

void expectSame(const PoseBound& a, const PoseBound& b) {
    EXPECT_EQ(a.bound, b.bound);
    EXPECT_EQ(a.found.area, b.found.area);
    EXPECT_EQ(a.found.poses, b.found.poses);
    EXPECT_EQ(a.boxes, b.boxes);
    EXPECT_EQ(a.tuples, b.tuples);
    EXPECT_EQ(a.is_complete, b.is_complete);
}

TEST(PoseShare, AStoppedSearchContinuesToTheSameResult) {
    const FloorWeighting zone{.elsewhere = 1, .pieces = {{{{1, 1}, {3, 1}, {3, 3}}, 2}}};
    // All end by memory, so that they take the same steps.
    constexpr std::size_t kBytes = 2'000'000;
    for (const Case& own : {Case{1, 1, 0.0001, {}, kBytes}, Case{2, 1, 0.001, {}, kBytes},
                            Case{3, 1, 0.001, {}, 2 * kBytes}, Case{3, 2, 0.001, {}, kBytes},
                            Case{2, 1, 0.001, zone, kBytes}}) {
        SilentProgress silent;
        PoseCertificate whole;
        const bool is_certified = own.times == 1 && own.weights.pieces.empty();
        const PoseBound single = own.run({}, is_certified ? &whole : nullptr, silent);
        TestResults kept;
        PoseCertificate certificate;
        PoseBound last;
        int runs = 0;
        for (int asking = 8;; asking += 2 + asking / 3) {
            TestResults results(true);
            results.takeFrom(kept);
            results.get()->setInterval(runs++ % 2 == 0 ? 0 : 1e6);
            StopWhen stop(afterAsking(asking));
            last = own.run({.results = results.get()}, is_certified ? &certificate : nullptr, stop);
            kept.takeFrom(results);
            if (!stop.stopped()) break;
            ASSERT_LT(runs, 60);
        }
        EXPECT_GT(runs, 2) << own.sensors << ' ' << own.times;
        expectSame(last, single);
        EXPECT_EQ(certificate.boxes, whole.boxes);
        EXPECT_EQ(certificate.tuples, whole.tuples);
    }
}

/// An open tuple computes the missing views of its box, and so of one half of the box around it;
/// sums over sensors take those of both halves.
TEST(PoseShare, HalvesContinueOfWhichOneLacksItsViews) {
    Case own{3, 1, 0.1, {}, 6'000'000, {4, 4, 0}, 83};
    own.region = {{{0, 0}, {12, 0}, {12, 8}, {0, 8}}, {}};
    SilentProgress silent;
    PoseCertificate whole, certificate;
    const PoseBound single = own.run({}, &whole, silent);
    TestResults kept;
    PoseBound last;
    int runs = 0;
    for (bool is_stopped = true; is_stopped; ++runs) {
        ASSERT_LT(runs, 40);
        TestResults results;
        results.takeFrom(kept);
        StopWhen stop(afterAsking(runs == 0 ? 14 : 4));
        last = own.run({.results = results.get()}, &certificate, stop);
        kept.takeFrom(results);
        is_stopped = stop.stopped();
    }
    EXPECT_GT(runs, 5);
    expectSame(last, single);
    EXPECT_EQ(certificate.boxes, whole.boxes);
    EXPECT_EQ(certificate.tuples, whole.tuples);
}

/// The state of a search that was stopped.
void stopSoon(const Case& own, TestResults& results, int asking = 30) {
    StopWhen stop(afterAsking(asking));
    (void)own.run({.results = results.get()}, nullptr, stop);
    ASSERT_TRUE(stop.stopped());
    ASSERT_TRUE(results.get()->find("posestate1"));
}

TEST(PoseShare, StatesOfOtherSearchesAreNotTaken) {
    const Case own{2, 1, 0.2, {}}, other{2, 1, 0.21, {}};
    SilentProgress silent;
    const PoseBound single = other.run({}, nullptr, silent);
    TestResults kept, again;
    stopSoon(own, kept);
    again.takeFrom(kept);
    expectSame(other.run({.results = again.get()}, nullptr, silent), single);
}

TEST(PoseShare, DamagedStatesAreRefused) {
    SilentProgress silent;
    for (const Case& own : {Case{2, 1, 0.001, {}}, Case{3, 1, 0.001, {}}}) {
        TestResults kept;
        stopSoon(own, kept, own.sensors == 2 ? 30 : 14);
        const std::string bytes = kept.get()->find("posestate1").value();
        const auto refused = [&](const std::string& damaged) {
            TestResults again;
            again.takeFrom(kept);
            again.get()->store("posestate1", damaged);
            try {
                StopWhen soon(afterAsking(3));
                (void)own.run({.results = again.get()}, nullptr, soon);
            } catch (const FormatError&) {
                return true;
            }
            return false;
        };
        EXPECT_FALSE(refused(bytes));
        for (std::size_t size = 8; size < bytes.size(); size += 1 + bytes.size() / 40)
            EXPECT_TRUE(refused(bytes.substr(0, size))) << size;
        EXPECT_TRUE(refused(bytes + "12345678"));
        // A parent of boxes, and a bound, that cannot be.
        std::string other = bytes;
        other.replace(24, 4, "\xff\xff\xff\x7f");
        EXPECT_TRUE(refused(other));
        other = bytes;
        const std::size_t parents = static_cast<unsigned char>(bytes[16]) +
                                    256U * static_cast<unsigned char>(bytes[17]) +
                                    65536U * static_cast<unsigned char>(bytes[18]);
        const std::size_t most = 24 + 4 * parents + 8;
        other.replace(most, 8, 8, '\xff');  // not a number
        EXPECT_TRUE(refused(other));
        // Views of a box are none, those in large cells, or all.
        for (const std::size_t id : {std::size_t{0}, std::size_t{1}, 2 * parents}) {
            other = bytes;
            char& viewed = other.at(most + 8 * (2 * parents + 1) + 8 + id);
            ASSERT_LE(viewed, 2);
            for (const char number : {'\3', '\xff'}) {
                viewed = number;
                EXPECT_TRUE(refused(other)) << id;
            }
        }
    }
}

TEST(PoseShare, NegativeBoundsOfTuplesAreRefused) {
    const Case own{2, 1, 0.001, {}};
    TestResults kept;
    stopSoon(own, kept);
    std::string bytes = kept.get()->find("posestate1").value();
    const auto number_at = [&bytes](std::size_t at) {
        std::uint64_t number = 0;
        std::memcpy(&number, &bytes.at(at), sizeof number);
        return number;
    };
    // At the end: the bounds, the boxes and nodes, and a tree of one node, each after its count.
    constexpr std::size_t kTree = 8 + 5 * 4, kBound = 8, kTuple = (kMaxPosed + 1) * 4;
    std::size_t count = 1, end = 0;
    for (;; ++count) {
        ASSERT_LT(kTree + 16 + count * (kBound + kTuple), bytes.size());
        end = bytes.size() - kTree - 8 - count * kTuple;
        if (number_at(end) == count * (kMaxPosed + 1) &&
            number_at(end - count * kBound - 8) == count)
            break;
    }
    for (const double bound : {-1.0, -1e-300, std::nan("")}) {
        std::memcpy(&bytes.at(end - kBound), &bound, sizeof bound);
        TestResults again;
        again.get()->store("posestate1", bytes);
        StopWhen soon(afterAsking(3));
        EXPECT_THROW((void)own.run({.results = again.get()}, nullptr, soon), FormatError) << bound;
    }
}

TEST(PoseShare, ChangedStatesEndInABoundOrARefusal) {
    std::mt19937 random(4);
    const Case own{3, 1, 0.001, {}};
    for (const int asking : {14, 24}) {
        TestResults kept;
        StopWhen stop(afterAsking(asking));
        PoseCertificate certificate;
        (void)own.run({.results = kept.get()}, &certificate, stop);
        const std::string bytes = kept.get()->find("posestate1").value();
        int refused = 0;
        for (int i = 0; i < 120; ++i) {
            std::string changed = bytes;
            for (int k = 0; k <= i % 3; ++k)
                changed[8 + random() % (bytes.size() - 8)] = static_cast<char>(random());
            TestResults again;
            again.takeFrom(kept);
            again.get()->store("posestate1", changed);
            try {
                StopWhen soon(afterAsking(3));
                const PoseBound ended = own.run({.results = again.get()}, &certificate, soon);
                EXPECT_GE(ended.bound, std::max(1.0, ended.found.area));
                EXPECT_TRUE(std::isfinite(ended.bound));
            } catch (const FormatError&) {
                ++refused;
            }
        }
        EXPECT_GT(refused, 10);
    }
}

PoseBound inShards(const Case& own, int count, int asking = 1'000'000) {
    TestResults all;
    double most = 0;
    for (int i = 1; i <= count; ++i) {
        TestResults results;
        StopWhen stop(afterAsking(asking));
        const PoseBound part =
            own.run({.results = results.get(), .own = Shard{i, count}}, nullptr, stop);
        most = std::max(most, part.bound);
        all.takeFrom(results, "poses/");
    }
    SilentProgress silent;
    PoseBound merged = own.run({.results = all.get(), .joined = count}, nullptr, silent);
    EXPECT_EQ(merged.bound, most);
    return merged;
}

TEST(PoseShare, ShardsProveTheBoundOfTheWhole) {
    for (const Case& own : {Case{2, 1, 0.2, {}}, Case{3, 2, 0.3, {}}}) {
        SilentProgress silent;
        const PoseBound single = own.run({}, nullptr, silent);
        ASSERT_TRUE(single.is_complete);
        for (const int count : {1, 3}) {
            const PoseBound merged = inShards(own, count);
            EXPECT_TRUE(merged.is_complete);
            // Both are closed up to the gap: what either found, the other does not exclude.
            EXPECT_GE(merged.bound, single.found.area);
            EXPECT_GE(single.bound, merged.found.area);
            EXPECT_LE(merged.bound, merged.found.area / (1 - own.gap) + 1e-9);
            EXPECT_EQ(merged.found.poses.size(), single.found.poses.size());
            if (count == 1) expectSame(merged, single);
        }
    }
}

TEST(PoseShare, ShardsThatWereCutShortHaveABound) {
    const Case own{2, 1, 0.001, {}};
    StopWhen long_enough(afterAsking(60));
    const double close = own.run({}, nullptr, long_enough).found.area;
    for (const int asking : {0, 3, 30}) {
        const PoseBound merged = inShards(own, 2, asking);
        EXPECT_FALSE(merged.is_complete);
        EXPECT_GE(merged.bound, close);
    }
}

TEST(PoseShare, SharesOfOtherTuplesAreRefused) {
    const Case own{2, 1, 0.02, {}};
    TestResults all;
    for (int i = 1; i <= 2; ++i) {
        TestResults results;
        StopWhen stop(afterAsking(40));
        (void)own.run({.results = results.get(), .own = Shard{i, 2}}, nullptr, stop);
        all.takeFrom(results, "poses/");
    }
    const auto merge = [&] {
        SilentProgress silent;
        (void)own.run({.results = all.get(), .joined = 2}, nullptr, silent);
    };
    EXPECT_NO_THROW(merge());
    const std::string bytes = all.get()->find("poses/2").value();
    std::uint64_t dealt = 0;
    std::memcpy(&dealt, &bytes.at(8), sizeof dealt);
    ASSERT_NE(dealt, 0U);
    const auto change = [&](std::uint64_t other) {
        std::string changed = bytes;
        std::memcpy(&changed.at(8), &other, sizeof other);
        all.get()->store("poses/2", changed);
    };
    change(0);  // it searched all tuples
    EXPECT_NO_THROW(merge());
    change(dealt + 1);
    EXPECT_THROW(merge(), FormatError);
}

TEST(PoseShare, MissingAndForeignPartsAreRefused) {
    const Case own{2, 1, 0.05, {}}, other{2, 1, 0.06, {}};
    SilentProgress silent;
    TestResults results;
    const auto search_shard = [&results](const Case& search, int index) {
        StopWhen soon(afterAsking(16));
        (void)search.run({.results = results.get(), .own = Shard{index, 2}}, nullptr, soon);
    };
    search_shard(own, 1);
    EXPECT_THROW((void)own.run({.results = results.get(), .joined = 2}, nullptr, silent),
                 FormatError);
    search_shard(other, 2);
    EXPECT_THROW((void)own.run({.results = results.get(), .joined = 2}, nullptr, silent),
                 FormatError);
    search_shard(own, 2);
    EXPECT_NO_THROW((void)own.run({.results = results.get(), .joined = 2}, nullptr, silent));
    const std::string bytes = results.get()->find("poses/2").value();
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        results.get()->store("poses/2", bytes.substr(0, size));
        EXPECT_THROW((void)own.run({.results = results.get(), .joined = 2}, nullptr, silent),
                     FormatError);
    }
}

}  // namespace pose_share_test
}  // namespace ispace::proofs::poses
