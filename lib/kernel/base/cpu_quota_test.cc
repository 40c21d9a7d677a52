// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "support/test_folder.h"

namespace ispace {
namespace cpu_quota_test {

namespace fs = std::filesystem;

/// A machine's /proc and /sys as files.
class CpuQuotaTest : public ::testing::Test {
  protected:
    void write(const std::string& name, const std::string& text) const {
        fs::create_directories((root_ / name).parent_path());
        std::ofstream(root_ / name) << text;
    }
    [[nodiscard]] std::optional<int> quota() const { return cpuQuota(root_.path()); }

    testing::TestFolder root_;
};

TEST_F(CpuQuotaTest, IsRoundedUp) {
    EXPECT_EQ(quota(), std::nullopt);  // no control groups at all
    write("proc/self/cgroup", "0::/job\n");
    EXPECT_EQ(quota(), std::nullopt);
    write("sys/fs/cgroup/job/cpu.max", "max 100000\n");
    EXPECT_EQ(quota(), std::nullopt);
    for (const auto& [text, count] : {std::pair("150000 100000\n", 2),
                                      {"100000 100000\n", 1},
                                      {"100001 100000\n", 2},
                                      {"5000 100000\n", 1},
                                      {"6400000 100000\n", 64}}) {
        write("sys/fs/cgroup/job/cpu.max", text);
        EXPECT_EQ(quota(), count) << text;
    }
    for (const char* text :
         {"", "0 100000\n", "100000 0\n", "100000\n", "-1 100000\n", "many few\n"}) {
        write("sys/fs/cgroup/job/cpu.max", text);
        EXPECT_EQ(quota(), std::nullopt) << text;
    }
}

TEST_F(CpuQuotaTest, TheTightestGroupAboveCounts) {
    write("proc/self/cgroup", "0::/slurm/job_7/step_0\n");
    write("sys/fs/cgroup/slurm/job_7/step_0/cpu.max", "max 100000\n");
    write("sys/fs/cgroup/slurm/job_7/cpu.max", "300000 100000\n");
    write("sys/fs/cgroup/slurm/cpu.max", "800000 100000\n");
    EXPECT_EQ(quota(), 3);
    // A path outside of this namespace: what is seen is the top.
    write("proc/self/cgroup", "0::/../elsewhere/deep\n");
    write("sys/fs/cgroup/cpu.max", "200000 100000\n");
    EXPECT_EQ(quota(), 2);
}

TEST_F(CpuQuotaTest, VersionOneNamesTheController) {
    write("proc/self/cgroup",
          "12:cpuset:/job\n4:cpu,cpuacct:/docker/abc\n1:name=systemd:/job\n0::/job\n");
    write("sys/fs/cgroup/cpu,cpuacct/docker/abc/cpu.cfs_quota_us", "250000\n");
    write("sys/fs/cgroup/cpu,cpuacct/docker/abc/cpu.cfs_period_us", "100000\n");
    write("sys/fs/cgroup/cpuset/job/cpu.cfs_quota_us", "100000\n");
    write("sys/fs/cgroup/cpuset/job/cpu.cfs_period_us", "100000\n");
    EXPECT_EQ(quota(), 3);
    write("sys/fs/cgroup/cpu,cpuacct/docker/abc/cpu.cfs_quota_us", "-1\n");
    EXPECT_EQ(quota(), std::nullopt);
    // A container that sees its own group as the top.
    write("sys/fs/cgroup/cpu/cpu.cfs_quota_us", "50000\n");
    write("sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000\n");
    EXPECT_EQ(quota(), 1);
}

}  // namespace cpu_quota_test
}  // namespace ispace
