// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/part_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <system_error>

#include "base/checkpoint.h"
#include "base/file.h"
#include "base/test_damage.h"
#include "base/test_folder.h"

namespace ispace {
namespace {

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
    std::string part(int index, int count, const PartHead& like = head()) const {
        PartHead own = like;
        own.shard = {index, count};
        const std::string file = path("s" + std::to_string(index) + "of" + std::to_string(count));
        PartWriter writer(file, own);
        writer.add("from", std::to_string(index));
        writer.finish();
        return file;
    }
    /// What opening parts of scan says, without the folder.
    std::string merging(std::vector<std::string> files) const {
        std::string errors = errorsOf([&] { (void)openParts(files, "scan"); });
        const std::string folder = folder_.path().string() + "/";
        for (std::size_t at = 0; (at = errors.find(folder)) != std::string::npos;)
            errors.erase(at, folder.size());
        return errors;
    }

    testing::TestFolder folder_;
};

TEST_F(PartFileTest, HoldsWhatWasWritten) {
    std::string every(256, '\0');
    for (std::size_t i = 0; i < every.size(); ++i) every[i] = static_cast<char>(i);
    PartWriter writer(path("a"), head(3, 8));
    writer.add("some", every);
    writer.add("none", "");
    writer.add("some", "=end 0 0\n\n");
    writer.finish();
    const PartFile part(path("a"));
    EXPECT_TRUE(part.isFinished());
    EXPECT_EQ(part.head().job.differenceFrom(head().job), "");
    EXPECT_EQ(part.head().shard, (Shard{3, 8}));
    ASSERT_EQ(part.records(), 3U);
    EXPECT_EQ(part.name(1), "none");
    EXPECT_EQ(part.bytes(0), every);
    EXPECT_EQ(part.bytes(1), "");
    EXPECT_EQ(part.find("some"), "=end 0 0\n\n");
    EXPECT_EQ(part.find("other"), std::nullopt);
    EXPECT_TRUE(
        readAll(path("a")).starts_with("#part 1\n# envc plan.yaml\n# scan room.glb --frames 10\n"
                                       "tool scan "));
}

TEST_F(PartFileTest, NothingIsThereBeforeItIsFinished) {
    {
        PartWriter writer(path("a"), head());
        writer.add("some", "bytes");
    }
    EXPECT_FALSE(fs::exists(path("a")));
}

TEST_F(PartFileTest, SurvivesDamage) {
    const std::string good = readAll(part(2, 3));
    const auto read = [&](const std::string& bytes) {
        writeAll(path("bad"), bytes);
        const PartFile part(path("bad"));
        for (std::size_t i = 0; i < part.records(); ++i) (void)part.bytes(i);
    };
    surviveDamage(good, read, 300);
    writeAll(path("room"), "#env 1\n");
    EXPECT_NE(merging({path("room")}).find("room: error: not a part of a job, as --shard writes"),
              std::string::npos);
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
        const std::vector<PartFile> parts = openParts(files, "scan");
        ASSERT_EQ(parts.size(), static_cast<std::size_t>(count));
        for (int i = 0; i < count; ++i)
            EXPECT_EQ(parts[static_cast<std::size_t>(i)].head().shard.index, i + 1);
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
    EXPECT_TRUE(
        with([](JobId& job) { job.version = "9.9"; }).starts_with("the version of ispace (`9.9"));
    PartHead other = head();
    other.job.tool = "arrange";
    EXPECT_EQ(merging({part(1, 1, other)}),
              "s1of1: error: a part of a job of arrange: merge it with arrange --merge\n");
}

TEST_F(PartFileTest, AMergeRefusesAnUnfinishedPart) {
    PartWriter writer(path("a"), head());
    writer.add("some", "bytes");
    writer.leaveOpen();
    EXPECT_EQ(
        merging({path("a")}),
        "a: error: shard 1/1 was cut short: run it again, with --resume if it ran so before\n");
}

TEST_F(PartFileTest, ACheckpointGoesOnWhereItWasCut) {
    const std::string file = path("c");
    {
        Checkpoint checkpoint(file, head());
        EXPECT_EQ(checkpoint.part().records(), 0U);
        checkpoint.add("a", "first");
        checkpoint.add("b", "second");
        EXPECT_EQ(checkpoint.part().find("a"), "first");
    }
    const std::string whole = readAll(file);
    const std::size_t first = whole.find("=a"), second = whole.find("=b");
    for (std::size_t size = first; size <= whole.size(); ++size) {
        writeAll(file, whole.substr(0, size));
        Checkpoint checkpoint(file, head());
        const std::size_t kept = size == whole.size() ? 2 : size >= second ? 1 : 0;
        EXPECT_EQ(checkpoint.part().records(), kept) << size;
        checkpoint.add("c", "third");
        EXPECT_EQ(PartFile(file).find("c"), "third") << size;
        EXPECT_EQ(PartFile(file).records(), kept + 1) << size;
    }
    // Damage in the middle: what is behind it goes, too.
    std::string bad = whole;
    bad[bad.find("first")] = 'F';
    writeAll(file, bad);
    EXPECT_EQ(Checkpoint(file, head()).part().records(), 0U);
}

TEST_F(PartFileTest, ACheckpointOfAnotherJobIsLeftAlone) {
    const std::string file = path("c");
    Checkpoint(file, head()).add("a", "first");
    PartHead other = head();
    other.job.history.back() += " --noise";
    EXPECT_NE(errorsOf([&] { Checkpoint(file, other); }).find("the command"), std::string::npos);
    EXPECT_NE(errorsOf([&] { Checkpoint(file, head(2, 3)); }).find("the shard (1/1, 2/3)"),
              std::string::npos);
    writeAll(path("mine"), "my notes");
    EXPECT_NE(errorsOf([&] { Checkpoint(path("mine"), head()); }).find("not a part"),
              std::string::npos);
    EXPECT_EQ(readAll(path("mine")), "my notes");
    EXPECT_EQ(PartFile(file).find("a"), "first");
    const Checkpoint held(file, head());
    EXPECT_NE(errorsOf([&] { Checkpoint(file, head()); }).find("another process"),
              std::string::npos);
}

TEST_F(PartFileTest, ACheckpointDoesNotGrowByWhatIsReplaced) {
    const std::string file = path("c");
    Checkpoint checkpoint(file, head());
    checkpoint.add("kept", "small");
    std::string state(1 << 20, 'x');
    for (int i = 0; i < 24; ++i) {
        state[0] = static_cast<char>('a' + i % 26);
        checkpoint.add("state", state);
        EXPECT_LT(fs::file_size(file), 20U << 20U);
    }
    EXPECT_EQ(checkpoint.part().find("kept"), "small");
    EXPECT_EQ(checkpoint.part().find("state"), state);
    checkpoint.remove();
    EXPECT_FALSE(fs::exists(file));
}

}  // namespace
}  // namespace ispace
