// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/judge/track_metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "base/error.h"

namespace ispace::judge {
namespace track_metrics_test {

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// Another implementation of the definitions: all matchings are tried, on full matrices.
class Oracle {
  public:
    explicit Oracle(const ScoredRun& run) : run_(run) {}

    struct Clear {
        std::size_t matches = 0, misses = 0, false_positives = 0, switches = 0;
        double similarity = 0;
    };
    [[nodiscard]] Clear clear() const {
        Clear sum;
        std::vector<std::optional<std::size_t>> last(run_.truths), before(run_.truths);
        for (const ScoredFrame& frame : run_.frames) {
            if (frame.truths.empty() || frame.tracks.empty()) {
                sum.misses += frame.truths.size();
                sum.false_positives += frame.tracks.size();
                continue;
            }
            const Pairs pairs = best(frame, [&](std::size_t i, std::size_t j) {
                const double s = frame.similarity.at(i, j);
                return s < kMatch ? 0 : s + (before[frame.truths[i]] == frame.tracks[j] ? 1000 : 0);
            });
            std::vector<std::optional<std::size_t>> now(run_.truths);
            std::size_t matches = 0;
            for (const auto& [i, j] : pairs) {
                if (frame.similarity.at(i, j) < kMatch) continue;
                const std::size_t truth = frame.truths[i], track = frame.tracks[j];
                ++matches;
                sum.similarity += frame.similarity.at(i, j);
                if (last[truth] && *last[truth] != track) ++sum.switches;
                last[truth] = now[truth] = track;
            }
            before = now;
            sum.matches += matches;
            sum.misses += frame.truths.size() - matches;
            sum.false_positives += frame.tracks.size() - matches;
        }
        return sum;
    }
    [[nodiscard]] double idf1() const {
        const std::vector<double> truths = framesOf(&ScoredFrame::truths, run_.truths),
                                  tracks = framesOf(&ScoredFrame::tracks, run_.tracks);
        ScoredFrame whole;
        whole.truths.resize(run_.truths);
        whole.tracks.resize(run_.tracks);
        whole.similarity = Matrix{run_.truths, run_.tracks};
        for (const ScoredFrame& frame : run_.frames)
            for (std::size_t i = 0; i < frame.truths.size(); ++i)
                for (std::size_t j = 0; j < frame.tracks.size(); ++j)
                    if (frame.similarity.at(i, j) >= kMatch)
                        whole.similarity.at(frame.truths[i], frame.tracks[j]) += 1;
        double common = 0;
        for (const auto& [i, j] :
             best(whole, [&](std::size_t a, std::size_t b) { return whole.similarity.at(a, b); }))
            common += whole.similarity.at(i, j);
        return 2 * common /
               std::max(1.0, std::accumulate(truths.begin(), truths.end(), 0.0) +
                                 std::accumulate(tracks.begin(), tracks.end(), 0.0));
    }
    [[nodiscard]] double hota() const {
        const std::vector<double> truths = framesOf(&ScoredFrame::truths, run_.truths),
                                  tracks = framesOf(&ScoredFrame::tracks, run_.tracks);
        Matrix common{run_.truths, run_.tracks};
        for (const ScoredFrame& frame : run_.frames)
            for (std::size_t i = 0; i < frame.truths.size(); ++i)
                for (std::size_t j = 0; j < frame.tracks.size(); ++j) {
                    double all = -frame.similarity.at(i, j);
                    for (std::size_t k = 0; k < frame.tracks.size(); ++k)
                        all += frame.similarity.at(i, k);
                    for (std::size_t k = 0; k < frame.truths.size(); ++k)
                        all += frame.similarity.at(k, j);
                    if (all > 0)
                        common.at(frame.truths[i], frame.tracks[j]) +=
                            frame.similarity.at(i, j) / all;
                }
        double sum = 0;
        for (int a = 1; a <= 19; ++a) {
            double matches = 0, misses = 0, wrong = 0;
            Matrix of_pair{run_.truths, run_.tracks};
            for (const ScoredFrame& frame : run_.frames) {
                double here = 0;
                for (const auto& [i, j] : best(frame, [&](std::size_t m, std::size_t n) {
                         const double shared = common.at(frame.truths[m], frame.tracks[n]);
                         return frame.similarity.at(m, n) * shared /
                                (truths[frame.truths[m]] + tracks[frame.tracks[n]] - shared);
                     }))
                    if (frame.similarity.at(i, j) >= a * 0.05 - 1e-15) {
                        ++here;
                        ++of_pair.at(frame.truths[i], frame.tracks[j]);
                    }
                matches += here;
                misses += static_cast<double>(frame.truths.size()) - here;
                wrong += static_cast<double>(frame.tracks.size()) - here;
            }
            double associated = 0;
            for (std::size_t i = 0; i < run_.truths; ++i)
                for (std::size_t j = 0; j < run_.tracks; ++j)
                    if (of_pair.at(i, j) > 0)
                        associated += of_pair.at(i, j) * of_pair.at(i, j) /
                                      (truths[i] + tracks[j] - of_pair.at(i, j));
            if (matches > 0)
                sum += std::sqrt(matches / (matches + misses + wrong) * associated / matches);
        }
        return sum / 19;
    }

  private:
    template <typename Member>
    [[nodiscard]] std::vector<double> framesOf(Member member, std::size_t count) const {
        std::vector<double> frames(count);
        for (const ScoredFrame& frame : run_.frames)
            for (const std::size_t one : frame.*member) ++frames[one];
        return frames;
    }
    template <typename Gain>
    static Pairs best(const ScoredFrame& frame, Gain gain) {
        const std::size_t rows = frame.similarity.rows, columns = frame.similarity.columns;
        std::vector<std::size_t> order(std::max(rows, columns));
        std::iota(order.begin(), order.end(), std::size_t{0});
        Pairs found;
        double most = -1;
        do {
            Pairs pairs;
            double sum = 0;
            for (std::size_t k = 0; k < std::min(rows, columns); ++k) {
                pairs.emplace_back(rows <= columns ? k : order[k], rows <= columns ? order[k] : k);
                sum += gain(pairs.back().first, pairs.back().second);
            }
            if (sum > most) {
                most = sum;
                found = pairs;
            }
        } while (std::next_permutation(order.begin(), order.end()));
        return found;
    }

    const ScoredRun& run_;
};

/// A run of up to four truths and four tracks, some missing in some frames.
ScoredRun randomRun(std::mt19937& random) {
    ScoredRun run{1 + random() % 4, 1 + random() % 4, {}};
    std::uniform_real_distribution<double> share(0, 1);
    for (std::size_t f = 0, frames = 1 + random() % 12; f < frames; ++f) {
        ScoredFrame& frame = run.frames.emplace_back();
        for (std::size_t i = 0; i < run.truths; ++i)
            if (share(random) < 0.8) frame.truths.push_back(i);
        for (std::size_t j = 0; j < run.tracks; ++j)
            if (share(random) < 0.8) frame.tracks.push_back(j);
        frame.similarity = Matrix{frame.truths.size(), frame.tracks.size()};
        for (double& one : frame.similarity.values) one = share(random);
    }
    return run;
}

TEST(TrackMetrics, AgreeWithAnotherImplementation) {
    std::mt19937 random(11);
    for (int round = 0; round < 400; ++round) {
        const ScoredRun run = randomRun(random);
        const Oracle oracle(run);
        const ClearMot clear = clearMot(run);
        const Oracle::Clear wanted = oracle.clear();
        ASSERT_EQ(clear.matches, wanted.matches) << round;
        ASSERT_EQ(clear.misses, wanted.misses) << round;
        ASSERT_EQ(clear.false_positives, wanted.false_positives) << round;
        ASSERT_EQ(clear.switches, wanted.switches) << round;
        ASSERT_NEAR(clear.similarity, wanted.similarity, 1e-9) << round;
        ASSERT_NEAR(identityOf(run).idf1, oracle.idf1(), 1e-9) << round;
        ASSERT_NEAR(hotaOf(run).hota, oracle.hota(), 1e-9) << round;
    }
}

/// One truth and tracks of it by frame: -1 for no track.
ScoredRun followedBy(const std::vector<int>& tracks) {
    ScoredRun run{1, 0, {}};
    for (const int track : tracks) {
        ScoredFrame& frame = run.frames.emplace_back();
        frame.truths = {0};
        if (track >= 0) frame.tracks = {static_cast<std::size_t>(track)};
        run.tracks = std::max(run.tracks, static_cast<std::size_t>(track + 1));
        frame.similarity = Matrix{1, frame.tracks.size()};
        for (double& one : frame.similarity.values) one = 1;
    }
    return run;
}

TEST(TrackMetrics, OfOneTruthByHand) {
    const ScoredRun run = followedBy({0, 0, -1, 0, 1, 1, 1, 1});
    const ClearMot clear = clearMot(run);
    EXPECT_EQ(clear.matches, 7U);
    EXPECT_EQ(clear.misses, 1U);
    EXPECT_EQ(clear.switches, 1U);
    // A frame without any track interrupts no pair.
    EXPECT_EQ(clear.fragments, 0U);
    EXPECT_DOUBLE_EQ(clear.mota, 1 - 2.0 / 8);
    EXPECT_EQ(clear.mostly_tracked, 1U);
    EXPECT_DOUBLE_EQ(identityOf(run).idf1, 2.0 * 4 / (8 + 7));
}

TEST(TrackMetrics, MoreErrorsThanTruthsAreBelowZero) {
    ScoredRun run{1, 4, {}};
    ScoredFrame& frame = run.frames.emplace_back();
    frame.truths = {0};
    frame.tracks = {0, 1, 2, 3};
    frame.similarity = Matrix{1, 4};
    EXPECT_DOUBLE_EQ(clearMot(run).mota, -4);
    EXPECT_EQ(hotaOf(run).hota, 0);
    EXPECT_EQ(identityOf(run).idf1, 0);
}

TEST(TrackMetrics, ARunWithoutTracksIsMissed) {
    const ScoredRun run = followedBy({-1, -1});
    EXPECT_EQ(clearMot(run).mota, 0);
    EXPECT_EQ(clearMot(run).misses, 2U);
    EXPECT_EQ(clearMot(run).mostly_lost, 1U);
    EXPECT_EQ(hotaOf(run).hota, 0);
}

/// OSPA(2) by its definition: all matchings are tried.
double ospaByHand(const std::vector<PointTrack>& a, const std::vector<PointTrack>& b, double cutoff,
                  std::size_t frames) {
    const std::size_t most = std::max(a.size(), b.size());
    std::vector<std::size_t> order(most);
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto place = [](const PointTrack& track, std::size_t frame) -> std::optional<Point2> {
        for (std::size_t i = 0; i < track.frames.size(); ++i)
            if (track.frames[i] == frame) return track.places[i];
        return {};
    };
    double best = HUGE_VAL;
    do {
        double sum = 0;
        for (std::size_t k = 0; k < most; ++k) {
            if (k >= a.size() || order[k] >= b.size()) {
                sum += cutoff;
                continue;
            }
            double mean = 0;
            std::size_t common = 0;
            for (std::size_t f = 0; f < frames; ++f) {
                const auto p = place(a[k], f), q = place(b[order[k]], f);
                if (!p && !q) continue;
                ++common;
                mean += p && q ? std::min(cutoff, distance(*p, *q)) : cutoff;
            }
            sum += mean / static_cast<double>(common);
        }
        best = std::min(best, sum);
    } while (std::next_permutation(order.begin(), order.end()));
    return best / static_cast<double>(most);
}

TEST(TrackMetrics, Ospa2AgreesWithItsDefinition) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> at(0, 1.5);
    constexpr std::size_t kFrames = 8;
    const auto tracks = [&](std::size_t count) {
        std::vector<PointTrack> all(count);
        for (PointTrack& one : all) {
            for (std::size_t f = 0; f < kFrames; ++f)
                if (random() % 3 != 0) {
                    one.frames.push_back(f);
                    one.places.push_back({at(random), at(random)});
                }
            if (one.frames.empty()) one = {{0}, {{0, 0}}};
        }
        return all;
    };
    for (int round = 0; round < 200; ++round) {
        const auto truths = tracks(1 + random() % 4), found = tracks(random() % 5);
        ASSERT_NEAR(ospa2(truths, found, 1), ospaByHand(truths, found, 1, kFrames), 1e-12) << round;
    }
    EXPECT_EQ(ospa2({}, {}, 1), 0);
}

TEST(TrackMetrics, TooManyPairsAreRefused) {
    ScoredRun run{100'000, 100'000, {}};
    EXPECT_THROW(static_cast<void>(identityOf(run)), UsageError);
}

}  // namespace track_metrics_test
}  // namespace ispace::judge
