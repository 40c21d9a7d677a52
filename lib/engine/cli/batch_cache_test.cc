// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/batch_cache.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/missed_files.h"
#include "io/importers.h"
#include "support/test_folder.h"

namespace ispace {
namespace batch_cache_test {

class BatchCacheTest : public ::testing::Test {
  protected:
    BatchCacheTest() { write("one"); }

    /// Files of the tick of the clock in which a job begins count as changed while it runs.
    void write(const std::string& bytes) const {
        writeAll(folder_ / "room.env", bytes);
        std::this_thread::sleep_for(std::chrono::milliseconds(30));
    }
    [[nodiscard]] BatchJob job(int line = 3) const {
        BatchJob job{line, {folder_ / "room.env"}};
        job.name = "list:" + std::to_string(line) + " room.env";
        return job;
    }
    /// Runs the job with the cache of `run`, and returns how often it was computed.
    int computed(const BatchRun& run, const BatchJob& job, const JobOutcome& result,
                 JobOutcome* outcome = nullptr) const {
        BatchCache cache(folder_ / "cache", run);
        int count = 0;
        const JobOutcome found = cache.outcomeOf(job, [&] {
            ++count;
            return result;
        });
        EXPECT_EQ(cache.reused(), count == 0 ? 1U : 0U);
        if (outcome != nullptr) *outcome = found;
        cache.commit();
        return count;
    }
    [[nodiscard]] JobOutcome result() const {
        JobOutcome outcome;
        outcome.line = "{}\n";
        outcome.files = {folder_ / "room.env"};
        return outcome;
    }

    testing::TestFolder folder_;
    BatchRun run_{.tool = "coverage", .common = {}, .batch = {}, .command = "coverage --grid 20"};
};

TEST_F(BatchCacheTest, ReusesOutcomesOfTheSameBytes) {
    EXPECT_EQ(computed(run_, job(), result()), 1);
    EXPECT_EQ(computed(run_, job(), result()), 0);
    write("one");
    EXPECT_EQ(computed(run_, job(), result()), 0);
    write("two");
    EXPECT_EQ(computed(run_, job(), result()), 1);
    EXPECT_EQ(computed(run_, job(), result()), 0);
}

TEST_F(BatchCacheTest, ComputesAgainIfAMissingFileAppears) {
    const std::string model = folder_ / "models";
    int count = 0;
    const auto reused = [&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(30));
        const int before = count;
        BatchCache cache(folder_ / "cache", run_);
        cache.outcomeOf(job(), [&] {
            ++count;
            noteMissed(model);
            return result();
        });
        cache.commit();
        return count == before;
    };
    EXPECT_FALSE(reused());
    EXPECT_TRUE(reused());
    std::filesystem::create_directory(model);
    EXPECT_FALSE(reused());
    EXPECT_TRUE(reused());
    std::filesystem::remove(model);
    writeAll(model, "a");
    EXPECT_FALSE(reused());
    EXPECT_TRUE(reused());
    writeAll(model, "b");
    EXPECT_FALSE(reused());
}

/// As an importer of an extension has them.
std::vector<std::string> surroundings;

TEST_F(BatchCacheTest, ComputesAgainInOtherSurroundings) {
    addImportSurroundings([] { return surroundings; });
    EXPECT_EQ(computed(run_, job(), result()), 1);
    surroundings = {"models in /models"};
    EXPECT_EQ(computed(run_, job(), result()), 1);
    EXPECT_EQ(computed(run_, job(), result()), 0);
    surroundings.clear();
    EXPECT_EQ(computed(run_, job(), result()), 1);
}

TEST_F(BatchCacheTest, ComputesAgainForAnotherRun) {
    EXPECT_EQ(computed(run_, job(), result()), 1);
    BatchRun other = run_;
    other.command += " --height 1";
    EXPECT_EQ(computed(other, job(), result()), 1);
    EXPECT_EQ(computed(run_, job(), result()), 1);
    other = run_;
    other.common.seed = 5;
    EXPECT_EQ(computed(other, job(), result()), 1);
    other = run_;
    other.common.quiet = true;
    EXPECT_EQ(computed(other, job(), result()), 1);
    other.tool = "arrange";
    EXPECT_THROW(BatchCache(folder_ / "cache", other), FormatError);
}

TEST_F(BatchCacheTest, ResultsOfAnotherFormAreMissing) {
    EXPECT_EQ(computed(run_, job(), result()), 1);
    const std::string file = folder_ / "cache";
    const JobId id = partHeadOf(file).job;
    const auto cache = JobResults::earlier(file, id);
    ASSERT_TRUE(cache);
    ASSERT_EQ(cache->keys().size(), 1U);
    const std::string key = cache->keys().front(), whole = *cache->find(key);
    for (std::size_t size = 0; size < whole.size(); ++size)
        for (const std::string& bytes :
             {whole.substr(0, size), whole.substr(0, size) + std::string(64, '\xff')}) {
            JobResults other(file, id, Shard(), false);
            other.store(key, bytes);
            other.writePart(file);
            JobOutcome found;
            (void)computed(run_, job(), result(), &found);
            EXPECT_EQ(found.line, result().line) << "cut at " << size;
        }
}

TEST_F(BatchCacheTest, VerdictsNameTheLineOfThisRun) {
    JobOutcome unmet = result();
    unmet.status = JobOutcome::kUnmet;
    unmet.verdicts = {{.name = job(3).name + ": 95%", .outcome = JunitCase::Outcome::Unmet}};
    EXPECT_EQ(computed(run_, job(3), unmet), 1);
    JobOutcome found;
    EXPECT_EQ(computed(run_, job(8), unmet, &found), 0);
    ASSERT_EQ(found.verdicts.size(), 1U);
    EXPECT_EQ(found.verdicts.front().name, "list:8 room.env: 95%");
    EXPECT_EQ(found.status, JobOutcome::kUnmet);
    EXPECT_EQ(found.line, unmet.line);
}

TEST_F(BatchCacheTest, ForgetsFailuresAndIncompleteOutcomes) {
    JobOutcome failed = result();
    failed.status = 1;
    JobOutcome cut = result();
    cut.files.clear();
    JobOutcome lost = result();
    lost.files.push_back(folder_ / "missing");
    for (const JobOutcome& outcome : {failed, cut, lost}) {
        EXPECT_EQ(computed(run_, job(), outcome), 1);
        EXPECT_EQ(computed(run_, job(), outcome), 1);
    }
}

TEST_F(BatchCacheTest, ForgetsFilesThatChangedWhileTheirJobRan) {
    {
        BatchCache cache(folder_ / "cache", run_);
        (void)cache.outcomeOf(job(), [&] {
            write("two");
            return result();
        });
        cache.commit();
    }
    EXPECT_EQ(computed(run_, job(), result()), 1);
    EXPECT_EQ(computed(run_, job(), result()), 0);
}

TEST_F(BatchCacheTest, ReusesOutcomesWhoseProductIsUnchanged) {
    BatchJob with_product = job();
    with_product.product = folder_ / "best.3dm";
    EXPECT_EQ(computed(run_, with_product, result()), 1);  // writes none
    EXPECT_EQ(computed(run_, with_product, result()), 1);
    writeAll(with_product.product, "#3dm 1\n");
    EXPECT_EQ(computed(run_, with_product, result()), 1);
    EXPECT_EQ(computed(run_, with_product, result()), 0);
    writeAll(with_product.product, "#3dm 1\nlaser\n");
    EXPECT_EQ(computed(run_, with_product, result()), 1);
    BatchJob moved = with_product;
    moved.line = 9;
    EXPECT_EQ(computed(run_, moved, result()), 1);
}

}  // namespace batch_cache_test
}  // namespace ispace
