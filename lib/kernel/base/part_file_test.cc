// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/part_file.h"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <latch>
#include <optional>
#include <system_error>
#include <thread>

#include "base/error.h"
#include "base/file.h"
#include "support/test_damage.h"
#include "support/test_folder.h"

namespace ispace {
namespace part_file_test {

namespace fs = std::filesystem;

class PartFileTest : public ::testing::Test {
  protected:
    [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }
    static PartHead head(int index = 1, int count = 1) {
        PartHead head;
        head.job.tool = "scan";
        head.job.history = {"envc plan.yaml", "scan room.glb --frames 10"};
        head.job.room = "sha256:1";
        head.job.inputs = "sha256:2";
        head.job.seed = 7;
        head.job.form = "jsonl";
        head.job.units = 10;
        head.shard = {index, count};
        return head;
    }
    [[nodiscard]] std::string part(int index, int count, const PartHead& like = head()) const {
        PartHead own = like;
        own.shard = {index, count};
        std::string file = path("s" + std::to_string(index) + "of" + std::to_string(count));
        JobResults results(file, own.job, own.shard, false);
        results.store("header", "of all");
        results.store("from" + std::to_string(index), std::to_string(index));
        results.writePart(file);
        return file;
    }
    /// What merging parts of scan says, without the folder.
    [[nodiscard]] std::string merging(std::vector<std::string> files) const {
        std::string errors = errorsOf([&] { (void)mergeParts(files, "scan", "header"); });
        const std::string folder = folder_.path().string() + "/";
        for (std::size_t at = 0; (at = errors.find(folder)) != std::string::npos;)
            errors.erase(at, folder.size());
        return errors;
    }

    testing::TestFolder folder_;
};

TEST_F(PartFileTest, EarlierResultsAreThoseOfTheSameJob) {
    const std::string file = part(1, 1);
    const auto found = JobResults::earlier(file, head().job);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->find("from1"), "1");
    EXPECT_FALSE(JobResults::earlier(path("missing"), head().job));
    JobId other = head().job;
    other.version = "0.0.1";
    EXPECT_FALSE(JobResults::earlier(file, other));
    EXPECT_EQ(readAll(file), readAll(part(1, 1)));
}

TEST_F(PartFileTest, DamagedEarlierResultsAreMissing) {
    const std::string file = part(1, 1);
    const std::string whole = readAll(file);
    const std::size_t begin = whole.find("\n\n") + 2;
    for (std::size_t i = begin; i < whole.size(); ++i) {
        std::string damaged = whole;
        damaged[i] ^= 1;
        writeAll(file, damaged);
        const auto found = JobResults::earlier(file, head().job);
        ASSERT_TRUE(found);
        const auto result = found->find("from1");
        EXPECT_TRUE(!result || *result == "1") << "byte " << i;
        writeAll(file, whole.substr(0, i));
        const auto cut = JobResults::earlier(file, head().job)->find("from1");
        EXPECT_TRUE(!cut || *cut == "1") << "cut at " << i;
    }
}

TEST_F(PartFileTest, OtherFilesAreNoEarlierResults) {
    const std::string file = part(1, 1);
    JobId other = head().job;
    other.form = "cache";
    EXPECT_THROW((void)JobResults::earlier(file, other), FormatError);
    other = head().job;
    other.tool = "coverage";
    EXPECT_THROW((void)JobResults::earlier(file, other), FormatError);
    for (const char* const bytes :
         {"", "#env 1\n", "#part 1\n", "#part 2\n", "#part 2\ntool scan"}) {
        writeAll(file, bytes);
        EXPECT_THROW((void)JobResults::earlier(file, head().job), FormatError) << bytes;
    }
    EXPECT_THROW((void)JobResults::earlier(path(""), head().job), FormatError);
}

TEST_F(PartFileTest, HoldsWhatWasStored) {
    std::string every(256, '\0');
    for (std::size_t i = 0; i < every.size(); ++i) every[i] = static_cast<char>(i);
    JobResults results(path("a"), head().job, {}, false);
    results.store("some", every);
    results.store("none", "");
    results.store("step/2", "=end 0 0\n\n");
    results.store("some", "replaced" + every);
    EXPECT_EQ(results.find("some"), "replaced" + every);
    results.writePart(path("a"));
    const std::string_view prefixes[] = {"none", "step/"};
    results.writePart(path("b"), prefixes);
    const JobResults part = mergeParts(std::vector{path("a")}, "scan", "header");
    EXPECT_EQ(part.head().job.differenceFrom(head().job), "");
    EXPECT_EQ(part.keys(), (std::vector<std::string>{"none", "some", "step/2"}));
    EXPECT_EQ(part.find("some"), "replaced" + every);
    EXPECT_EQ(part.find("none"), "");
    EXPECT_EQ(part.find("step/2"), "=end 0 0\n\n");
    EXPECT_EQ(part.find("other"), std::nullopt);
    EXPECT_EQ(mergeParts(std::vector{path("b")}, "scan", "header").keys(),
              (std::vector<std::string>{"none", "step/2"}));
    EXPECT_TRUE(
        readAll(path("a")).starts_with("#part 2\n# envc plan.yaml\n# scan room.glb --frames 10\n"
                                       "tool scan "));
}

TEST_F(PartFileTest, APartHasTheSameBytesInWhateverOrderItIsStored) {
    const auto bytes_of = [&](const std::vector<std::string>& keys, bool is_kept) {
        JobResults results(path("a"), head().job, {}, is_kept);
        std::vector<std::thread> threads;
        threads.reserve(keys.size());
        for (const std::string& key : keys)
            threads.emplace_back([&results, &key] { results.store(key, "of " + key); });
        for (std::thread& thread : threads) thread.join();
        results.writePart(path("a"));
        results.finish();
        return readAll(path("a"));
    };
    const std::string one = bytes_of({"a", "b", "c"}, false);
    EXPECT_EQ(bytes_of({"c", "a", "b"}, false), one);
    EXPECT_EQ(bytes_of({"b", "c", "a"}, true), one);
}

TEST_F(PartFileTest, NothingIsThereBeforeItIsWritten) {
    {
        JobResults results(path("a"), head().job, {}, false);
        results.store("some", "bytes");
    }
    EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(PartFileTest, KeptFilesAreNamedAfterTheOutput) {
    fs::create_directory(path("folder"));
    EXPECT_EQ(JobResults::keptFile("a.jsonl", {2, 3}), "a.jsonl.resume");
    EXPECT_EQ(JobResults::keptFile(path("folder"), {}), path("folder/.resume"));
    EXPECT_EQ(JobResults::keptFile(path("folder") + "/", {2, 3}), path("folder/.resume-2of3"));
}

TEST_F(PartFileTest, SurvivesDamage) {
    const std::string good = readAll(part(2, 3));
    const auto read = [&](const std::string& bytes) {
        writeAll(path("bad"), bytes);
        (void)partHeadOf(path("bad"));
        (void)isPartOf(path("bad"), head(2, 3));
        writeAll(path("bad.resume"), bytes);
        const JobResults results(path("bad"), head().job, {2, 3}, true);
        for (const std::string& key : results.keys()) (void)results.find(key);
    };
    EXPECT_TRUE(isPartOf(part(2, 3), head(2, 3)));
    EXPECT_FALSE(isPartOf(part(2, 3), head(1, 3)));
    surviveDamage(good, read, 300);
    writeAll(path("room"), "#env 1\n");
    EXPECT_NE(merging({path("room")}).find("room: error: not a part of a job, as --shard writes"),
              std::string::npos);
}

TEST_F(PartFileTest, RefusesPartsOfOlderVersions) {
    std::string old = readAll(part(1, 1));
    old.replace(0, 7, "#part 1");
    writeAll(path("old"), old);
    const std::string hint =
        "of another version of ispace, whose parts have another form: delete it and run its shard "
        "again\n";
    EXPECT_EQ(merging({path("old")}), "old: error: " + hint);
    writeAll(path("old.resume"), old);
    EXPECT_NE(errorsOf([&] { JobResults(path("old"), head().job, {}, true); }).find(hint),
              std::string::npos);
    EXPECT_EQ(readAll(path("old.resume")), old);
}

TEST_F(PartFileTest, RefusesNegativeFigures) {
    const auto error_of = [this](const std::string& line, const std::string& damaged) {
        std::string text = readAll(part(1, 1));
        text.replace(text.find(line), line.size(), damaged);
        writeAll(path("damaged"), text);
        return merging({path("damaged")});
    };
    EXPECT_EQ(error_of("seed 7", "seed -7"),
              "damaged:7: error: bad line `seed` in the header of a part\n");
    EXPECT_EQ(error_of("units 10", "units -10"),
              "damaged:10: error: bad line `units` in the header of a part\n");
}

TEST_F(PartFileTest, AMergeTakesAllShardsOnceAndInAnyOrder) {
    for (const int count : {1, 2, 7}) {
        std::vector<std::string> files;
        for (int i = count; i > 0; --i) files.push_back(part(i, count));
        EXPECT_EQ(mergeParts(files, "scan", "header").head().shard.count, count);
    }
}

TEST_F(PartFileTest, AMergeNamesWhatIsMissingOrDoubled) {
    EXPECT_EQ(merging({part(1, 3), part(3, 3)}), "error: missing shard 2 of 3\n");
    EXPECT_EQ(merging({part(3, 8), part(7, 8)}),
              "error: missing shards 1, 2, 4, 5, 6 and 8 of 8\n");
    EXPECT_EQ(merging({part(1, 2), part(2, 2), part(1, 2)}),
              "s1of2: error: shard 1/2 is given twice, as s1of2, too\n");
    EXPECT_EQ(merging({part(1, 1000)}).substr(0, 40), "error: missing shards 2, 3, 4, 5, 6, 7, ");
    EXPECT_EQ(merging({part(1, 2), part(2, 3)}),
              "s2of3: error: shard 2/3, and s1of2 is shard 1/2\n");
}

TEST_F(PartFileTest, AMergeRefusesPartsOfOtherJobs) {
    const auto with = [this](auto change) {
        PartHead other = head();
        change(other.job);
        const std::string errors = merging({part(1, 2), part(2, 2, other)});
        const std::string begin = "s2of2: error: not of the same job as s1of2: ";
        EXPECT_TRUE(errors.starts_with(begin)) << errors;
        return errors.substr(std::min(begin.size(), errors.size()));
    };
    EXPECT_EQ(with([](JobId& job) { job.room = "sha256:9"; }), "the room differs\n");
    EXPECT_EQ(with([](JobId& job) { job.seed = 8; }), "the seed (`8`, `7`) differs\n");
    EXPECT_EQ(with([](JobId& job) { job.form = "csv"; }), "the format (`csv`, `jsonl`) differs\n");
    EXPECT_EQ(with([](JobId& job) { job.inputs = "sha256:9"; }),
              "what is in the files that were read differs\n");
    EXPECT_EQ(
        with([](JobId& job) { job.history.back() += " --noise"; }),
        "the command (`scan room.glb --frames 10 --noise`, `scan room.glb --frames 10`) differs\n");
    JobId plain = head().job, seeded = plain;
    plain.history = {"arrange crowded.env --sensor laser,range=4:2 --candidates 0.6,0.6,8"};
    seeded.history = {plain.history.back() + " --seed 5"};
    EXPECT_EQ(plain.differenceFrom(seeded),
              "the command (`... --candidates 0.6,0.6,8`, `... --candidates 0.6,0.6,8 --seed 5`)");
    EXPECT_TRUE(
        with([](JobId& job) { job.version = "9.9"; }).starts_with("the version of ispace (`9.9"));
    PartHead other = head();
    other.job.tool = "arrange";
    EXPECT_EQ(merging({part(1, 1, other)}),
              "s1of1: error: a part of a job of arrange: merge it with arrange --merge\n");
}

TEST_F(PartFileTest, AMergeRefusesRecordsOfOtherParts) {
    const auto with = [this](const std::string& key, const std::string& bytes) {
        (void)part(1, 2);
        writeAll(path("b"),
                 partHeadText(head(2, 2)) + partRecordText(key, bytes) + partRecordText("end", ""));
        return merging({path("s1of2"), path("b")});
    };
    EXPECT_EQ(with("from2", "2"), "no error");
    EXPECT_EQ(with("header", "of all"), "no error");
    EXPECT_EQ(with("from1", "1"), "b: error: its record `from1` is in s1of2, too\n");
    EXPECT_EQ(with("header", "of one"), "b: error: its record `header` is in s1of2, too\n");
}

TEST_F(PartFileTest, AMergeRefusesAnUnfinishedPart) {
    writeAll(path("a"), partHeadText(head()) + partRecordText("some", "bytes"));
    EXPECT_EQ(
        merging({path("a")}),
        "a: error: shard 1/1 was cut short: run it again, with --resume if it ran so before\n");
}

TEST_F(PartFileTest, KeptResultsGoOnWhereTheyWereCut) {
    const std::string output = path("c"), file = output + ".resume";
    {
        JobResults results(output, head().job, {}, true);
        EXPECT_EQ(results.keys().size(), 0U);
        results.store("a", "first");
        results.store("b", "second");
        EXPECT_EQ(results.find("a"), "first");
    }
    const std::string whole = readAll(file);
    const std::size_t second = whole.find("=b");
    for (std::size_t size = 0; size <= whole.size(); ++size) {
        writeAll(file, whole.substr(0, size));
        JobResults results(output, head().job, {}, true);
        const std::size_t kept = size == whole.size() ? 2 : size >= second ? 1 : 0;
        EXPECT_EQ(results.keys().size(), kept) << size;
        results.store("c", "third");
        EXPECT_EQ(results.find("c"), "third") << size;
        EXPECT_EQ(results.keys().size(), kept + 1) << size;
    }
    // Damage in the middle: the entries behind it are dropped, too.
    std::string bad = whole;
    bad[bad.find("first")] = 'F';
    writeAll(file, bad);
    EXPECT_TRUE(JobResults(output, head().job, {}, true).keys().empty());
}

TEST_F(PartFileTest, KeptResultsOfAnotherJobAreLeftAlone) {
    const std::string output = path("c"), file = output + ".resume";
    JobResults(output, head().job, {}, true).store("a", "first");
    PartHead other = head();
    other.job.history.back() += " --noise";
    EXPECT_NE(errorsOf([&] { JobResults(output, other.job, {}, true); }).find("the command"),
              std::string::npos);
    EXPECT_NE(errorsOf([&] {
                  JobResults(output, head().job, {2, 3}, true);
              }).find("the shard (1/1, 2/3)"),
              std::string::npos);
    writeAll(path("mine.resume"), "my notes");
    EXPECT_NE(errorsOf([&] { JobResults(path("mine"), head().job, {}, true); }).find("not a part"),
              std::string::npos);
    EXPECT_EQ(readAll(path("mine.resume")), "my notes");
    const JobResults held(output, head().job, {}, true);
    EXPECT_EQ(held.find("a"), "first");
    EXPECT_NE(errorsOf([&] { JobResults(output, head().job, {}, true); }).find("another process"),
              std::string::npos);
}

TEST_F(PartFileTest, KeptResultsHaveOneOwner) {
    constexpr int kThreads = 4, kRounds = 200;
    for (int round = 0; round < kRounds; ++round) {
        const std::string output = path("c" + std::to_string(round));
        std::latch start(kThreads), end(kThreads);
        std::atomic<int> owners = 0;
        std::vector<std::thread> threads;
        for (int i = 0; i < kThreads; ++i)
            threads.emplace_back([&] {
                std::optional<JobResults> results;
                start.arrive_and_wait();
                try {
                    results.emplace(output, head().job, Shard(), true);
                    ++owners;
                } catch (const FormatError&) {
                    // Another thread has it open.
                }
                end.arrive_and_wait();
            });
        for (std::thread& thread : threads) thread.join();
        ASSERT_EQ(owners, 1) << round;
    }
}

TEST_F(PartFileTest, KeptResultsSurviveAFailedRewrite) {
    const std::string output = path("c"), file = output + ".resume", taken = file + ".new";
    std::string state(1 << 20, 'x');
    {
        JobResults results(output, head().job, {}, true);
        results.store("kept", "small");
        fs::create_directory(taken);  // the new file finds no name
        for (int i = 0; i < 24; ++i) {
            state[0] = static_cast<char>('a' + i);
            results.store("state", state);
            ASSERT_EQ(results.find("state"), state) << i;
        }
        EXPECT_GT(fs::file_size(file), 24U << 20U);
    }
    fs::remove(taken);
    JobResults again(output, head().job, {}, true);
    EXPECT_EQ(again.find("kept"), "small");
    EXPECT_EQ(again.find("state"), state);
    again.store("next", "bytes");
    EXPECT_LT(fs::file_size(file), 2U << 20U) << "rewritten at last";
}

TEST_F(PartFileTest, RewrittenResultsStayLocked) {
    const std::string output = path("c"), file = output + ".resume";
    JobResults results(output, head().job, {}, true);
    const std::string state(6U << 20U, 'x');
    for (int i = 0; i < 5; ++i) results.store("state", state);
    EXPECT_LT(fs::file_size(file), 7U << 20U);
    EXPECT_NE(errorsOf([&] { JobResults(output, head().job, {}, true); }).find("another process"),
              std::string::npos);
    results.store("next", "bytes");
    EXPECT_EQ(results.find("next"), "bytes");
    EXPECT_EQ(results.find("state"), state);
}

TEST_F(PartFileTest, KeptResultsDoNotGrowByThoseReplaced) {
    const std::string output = path("c"), file = output + ".resume";
    JobResults results(output, head().job, {}, true);
    results.store("kept", "small");
    std::string state(1 << 20, 'x');
    for (int i = 0; i < 24; ++i) {
        state[0] = static_cast<char>('a' + i % 26);
        results.store("state", state);
        EXPECT_LT(fs::file_size(file), 20U << 20U);
    }
    EXPECT_EQ(results.find("kept"), "small");
    EXPECT_EQ(results.find("state"), state);
    results.finish();
    EXPECT_FALSE(fs::exists(file));
}

}  // namespace part_file_test
}  // namespace ispace
