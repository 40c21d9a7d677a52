// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/search_share.h"

#include <gtest/gtest.h>

#include "arrange/search/packed_search.h"
#include "arrange/search/search.h"
#include "base/packed.h"
#include "support/test_folder.h"
#include "support/test_problems.h"
#include "support/test_results.h"

namespace ispace {
namespace search_share_test {

/// Large enough for a tree of some hundred nodes.
RandomProblem hardProblem(std::uint64_t seed) {
    RandomProblemOptions options;
    options.columns = 40;
    options.rows = 30;
    options.sites = 100;
    options.headings = 6;
    options.most = 6;
    options.max_range = 8;
    options.max_weight = 9;
    return randomProblem(seed, options);
}

SearchOptions searchOptions(Optimizer optimizer) {
    SearchOptions options;
    options.optimizer = optimizer;
    options.swap.starts = 7;
    options.swap.seed = 5;
    return options;
}

/// The merge of so many shards.
SearchResult inShards(const Problem& problem, const SearchOptions& options, Shared what,
                      int count) {
    TestResults all;
    for (int i = 1; i <= count; ++i) {
        SilentProgress silent;
        TestResults own;
        SearchOptions sharing = options;
        sharing.share = {.what = what, .own = Shard{i, count}, .joined = 0, .results = own.get()};
        (void)search(problem, sharing, silent);
        all.takeFrom(own, what == Shared::Tree ? "proof/" : "start");
    }
    SilentProgress silent;
    SearchOptions merging = options;
    merging.share = {.what = what, .own = {}, .joined = count, .results = all.get()};
    return search(problem, merging, silent);
}

TEST(SearchShare, StartsJoinToTheSameSolution) {
    for (std::uint64_t round = 0; round < 12; ++round) {
        const RandomProblem random = round < 10 ? variedProblem(round) : hardProblem(round);
        const SearchOptions options = searchOptions(Optimizer::Swap);
        SilentProgress silent;
        const SearchResult single = search(random.problem, options, silent);
        for (const int count : {1, 2, 3, 8, 11}) {
            const SearchResult merged = inShards(random.problem, options, Shared::Starts, count);
            EXPECT_EQ(merged.best.chosen, single.best.chosen) << round << ' ' << count;
            EXPECT_EQ(merged.best.value, single.best.value);
            EXPECT_EQ(merged.bound, single.bound);
        }
    }
}

TEST(SearchShare, ProofsOfShardsCloseTheSameGap) {
    for (std::uint64_t round = 0; round < 40; ++round) {
        const RandomProblem random = round < 36 ? variedProblem(round) : hardProblem(round);
        const SearchOptions options = searchOptions(Optimizer::Exact);
        SilentProgress silent;
        const SearchResult single = search(random.problem, options, silent);
        for (const int count : {1, 2, 8}) {
            const SearchResult merged = inShards(random.problem, options, Shared::Tree, count);
            EXPECT_EQ(merged.best.value, single.best.value) << round << ' ' << count;
            EXPECT_EQ(merged.bound, single.bound) << round << ' ' << count;
            EXPECT_EQ(merged.best.value, valueOf(random.problem, merged.best.chosen));
            EXPECT_TRUE(merged.is_complete);
        }
    }
}

TEST(SearchShare, BoundsOfShardsThatAreCutShortHold) {
    int open = 0;
    for (std::uint64_t round = 36; round < 40; ++round) {
        const RandomProblem random = hardProblem(round);
        const SearchOptions options = searchOptions(Optimizer::Exact);
        SilentProgress silent;
        const SearchResult best = search(random.problem, options, silent);
        for (const int asking : {300, 1000, 3000, 10000}) {
            TestResults all;
            for (int i = 1; i <= 3; ++i) {
                SearchOptions sharing = options;
                TestResults own;
                sharing.share = {
                    .what = Shared::Tree, .own = Shard{i, 3}, .joined = 0, .results = own.get()};
                StopWhen stopping(afterAsking(asking * i));
                (void)search(random.problem, sharing, stopping);
                all.takeFrom(own, "proof/");
            }
            SearchOptions merging = options;
            merging.share = {.what = Shared::Tree, .own = {}, .joined = 3, .results = all.get()};
            const SearchResult merged = search(random.problem, merging, silent);
            EXPECT_LE(merged.best.value, best.best.value);
            EXPECT_GE(merged.bound, best.best.value) << round << ' ' << asking;
            EXPECT_EQ(merged.is_complete, merged.best.value == merged.bound);
            open += merged.is_complete ? 0 : 1;
        }
    }
    EXPECT_GT(open, 0) << "nothing was cut short";
}

TEST(SearchShare, OneOfSeveralSearchesMayBeMissing) {
    const RandomProblem random = hardProblem(36);
    SilentProgress silent;
    SearchOptions options = searchOptions(Optimizer::Exact);
    const SearchResult best = search(random.problem, options, silent);
    TestResults all, own;
    options.share = {.what = Shared::Tree,
                     .own = Shard{1, 2},
                     .joined = 0,
                     .results = own.get(),
                     .search = "/0/3"};
    (void)search(random.problem, options, silent);
    all.takeFrom(own, "proof/");
    options.share = {
        .what = Shared::Tree, .own = {}, .joined = 2, .results = all.get(), .search = "/0/3"};
    const SearchResult merged = search(random.problem, options, silent);
    EXPECT_EQ(merged.best.value, valueOf(random.problem, merged.best.chosen));
    EXPECT_GT(merged.best.value, 0U);
    EXPECT_LE(merged.best.value, best.best.value);
    EXPECT_EQ(merged.bound, random.problem.totalWeight());
    EXPECT_FALSE(merged.is_complete);
    options.share.search = "/0/4";
    EXPECT_TRUE(search(random.problem, options, silent).best.chosen.empty());
}

/// Runs that are stopped, each a little later, until one is complete.
TEST(SearchShare, ASearchGoesOnWhereItWasStopped) {
    for (const Optimizer optimizer : {Optimizer::Swap, Optimizer::Exact})
        for (std::uint64_t round = 36; round < 39; ++round) {
            const RandomProblem random = hardProblem(round);
            const SearchOptions options = searchOptions(optimizer);
            SilentProgress silent;
            const SearchResult single = search(random.problem, options, silent);
            TestResults kept;
            SearchResult result;
            int runs = 0;
            for (int asking = 2;; asking += 1 + asking / 4) {
                SearchOptions resuming = options;
                // A new process counts anew, and finds what is kept.
                TestResults own(true);
                own.takeFrom(kept);
                own.get()->setInterval(runs++ % 2 == 0 ? 0 : 1e6);
                resuming.share.results = own.get();
                StopWhen stopping(afterAsking(asking));
                result = search(random.problem, resuming, stopping);
                kept.takeFrom(own);
                if (!stopping.stopped()) break;
                ASSERT_LT(runs, 100);
            }
            EXPECT_GT(runs, 3);
            EXPECT_EQ(result.best.chosen, single.best.chosen) << round;
            EXPECT_EQ(result.bound, single.bound) << round;
            EXPECT_TRUE(result.is_complete);
        }
}

/// Results kept for another problem are not used.
TEST(SearchShare, StepsOfAnotherProblemAreNotTaken) {
    const RandomProblem one = hardProblem(36), other = hardProblem(37);
    const SearchOptions options = searchOptions(Optimizer::Exact);
    SilentProgress silent;
    const SearchResult single = search(other.problem, options, silent);
    TestResults kept, again;
    SearchOptions keeping = options;
    keeping.share.results = kept.get();
    (void)search(one.problem, keeping, silent);
    EXPECT_GT(kept.size(), 5U);
    again.takeFrom(kept);
    keeping.share.results = again.get();
    const SearchResult result = search(other.problem, keeping, silent);
    EXPECT_EQ(result.best.chosen, single.best.chosen);
    EXPECT_EQ(result.bound, single.bound);
}

/// A stored step with another result.
std::string forged(const std::string& bytes, const Problem& problem,
                   void (*change)(SearchResult&)) {
    Unpacker from(bytes);
    Packer before, after;
    for (Packer* to : {&before, &after}) to->add(Unpacker(bytes).number());
    static_cast<void>(from.number());
    SearchResult result = unpackResult(from, problem);
    pack(before, result);
    change(result);
    pack(after, result);
    return after.bytes() + bytes.substr(before.bytes().size());
}

TEST(SearchShare, ForgedStartsAreSearchedAgain) {
    const RandomProblem random = hardProblem(36);
    const SearchOptions options = searchOptions(Optimizer::Swap);
    SilentProgress silent;
    const SearchResult single = search(random.problem, options, silent);
    TestResults kept, forged;
    SearchOptions keeping = options;
    keeping.share.results = kept.get();
    (void)search(random.problem, keeping, silent);
    std::vector<Choice> many;
    for (std::size_t i = 0; i < 60; ++i) many.push_back({0, i});
    int starts = 0;
    for (const std::string& key : kept.get()->keys()) {
        if (!key.starts_with("start1/")) continue;
        const std::string bytes = kept.get()->find(key).value();
        Packer to;
        to.add(Unpacker(bytes).number());
        pack(to, many);
        forged.get()->store(key, to.bytes());
        ++starts;
    }
    EXPECT_EQ(starts, options.swap.starts + 1);
    keeping.share.results = forged.get();
    const SearchResult result = search(random.problem, keeping, silent);
    EXPECT_EQ(result.best.chosen, single.best.chosen);
    EXPECT_EQ(result.best.value, single.best.value);
}

TEST(SearchShare, ForgedStepsAreRefused) {
    const RandomProblem random = hardProblem(36);
    const Problem& problem = random.problem;
    SilentProgress silent;
    TestResults kept;
    SearchOptions keeping = searchOptions(Optimizer::Exact);
    keeping.share.results = kept.get();
    (void)search(problem, keeping, silent);
    const std::vector<void (*)(SearchResult&)> changes = {
        [](SearchResult& result) { ++result.best.value; },
        [](SearchResult& result) { result.bound = result.best.value - 1; },
        [](SearchResult& result) { result.best.chosen.pop_back(); },
        [](SearchResult& result) { result.best.chosen.resize(60); },
    };
    int steps = 0;
    for (const std::string& key : kept.get()->keys())
        for (const auto change : changes) {
            if (key.starts_with("start") || key.starts_with("bound")) continue;
            TestResults again;
            again.takeFrom(kept);
            again.get()->store(key, forged(kept.get()->find(key).value(), problem, change));
            keeping.share.results = again.get();
            EXPECT_THROW((void)search(problem, keeping, silent), FormatError) << key;
            ++steps;
        }
    EXPECT_GE(steps, 8);
}

TEST(SearchShare, ForgedBoundsAreRefused) {
    const RandomProblem random = hardProblem(36);
    const Problem& problem = random.problem;
    SilentProgress silent;
    TestResults kept;
    SearchOptions keeping = searchOptions(Optimizer::Exact);
    keeping.share.results = kept.get();
    (void)search(problem, keeping, silent);
    const std::vector<void (*)(Bound&)> changes = {
        [](Bound& bound) { bound.value = 1; },
        [](Bound& bound) { ++bound.scale; },
        [](Bound& bound) { bound.multipliers.back() = 0xffffffffU; },
        [](Bound& bound) {
            bound.survivors.at(0) = {2, 1};
        },
    };
    for (const auto change : changes) {
        const std::string bytes = kept.get()->find("bound1").value();
        Unpacker from(bytes);
        Packer to;
        to.add(from.number());
        Bound bound = unpackBound(from, problem);
        change(bound);
        pack(to, bound);
        TestResults again;
        again.takeFrom(kept);
        again.get()->store("bound1", to.bytes());
        keeping.share.results = again.get();
        EXPECT_THROW((void)search(problem, keeping, silent), FormatError);
    }
}

TEST(PackedSearch, DamageIsRefused) {
    const RandomProblem random = hardProblem(36);
    SearchResult result{{{{0, 3}, {0, 7}}, 0}, random.problem.totalWeight(), true};
    result.best.value = valueOf(random.problem, result.best.chosen);
    Packer to;
    pack(to, result);
    Unpacker from(to.bytes());
    EXPECT_EQ(unpackResult(from, random.problem).best.chosen, result.best.chosen);
    EXPECT_TRUE(from.atEnd());
    for (std::size_t size = 0; size < to.bytes().size(); ++size) {
        Unpacker cut(std::string_view(to.bytes()).substr(0, size));
        EXPECT_THROW((void)unpackResult(cut, random.problem), FormatError) << size;
    }
    result.best.chosen = {{0, 1'000'000}};
    Packer bad;
    pack(bad, result);
    Unpacker unknown(bad.bytes());
    EXPECT_THROW((void)unpackResult(unknown, random.problem), FormatError);
}

TEST(PackedSearch, SurvivorsAreOneListForEachKindOrNone) {
    const RandomProblem random = hardProblem(36);
    Problem problem = random.problem;
    problem.kinds.push_back(problem.kinds.front());
    for (std::size_t lists = 0; lists <= 3; ++lists) {
        Bound bound;
        bound.scale = RelaxedCells(problem).scale;
        bound.multipliers.resize(problem.cells());
        bound.survivors.resize(lists);
        Packer to;
        pack(to, bound);
        Unpacker from(to.bytes());
        if (lists == 0 || lists == 2) {
            EXPECT_EQ(unpackBound(from, problem).survivors.size(), lists);
        } else {
            EXPECT_THROW((void)unpackBound(from, problem), FormatError) << lists;
        }
    }
}

}  // namespace search_share_test
}  // namespace ispace
