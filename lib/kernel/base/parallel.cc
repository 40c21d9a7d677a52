// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string_view>
#include <utility>

#include "base/number.h"

namespace ispace {

namespace {

namespace fs = std::filesystem;

/// Reads the first line; "" if the file is missing.
std::string firstLineOf(const fs::path& file) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    return line;
}

/// Microseconds of processor time in each period; nullopt for "max", -1 and text that is not a
/// number.
std::optional<int> processors(const std::string& quota, const std::string& period) {
    const auto granted = parseInteger(quota), each = parseInteger(period);
    if (!granted || !each || *granted <= 0 || *each <= 0) return std::nullopt;
    const std::int64_t count = *granted / *each + (*granted % *each > 0 ? 1 : 0);
    return static_cast<int>(std::min<std::int64_t>(count, std::numeric_limits<int>::max()));
}

std::optional<int> ofGroup2(const fs::path& group) {
    std::istringstream words(firstLineOf(group / "cpu.max"));
    std::string quota, period;
    words >> quota >> period;
    return processors(quota, period);
}

std::optional<int> ofGroup1(const fs::path& group) {
    return processors(firstLineOf(group / "cpu.cfs_quota_us"),
                      firstLineOf(group / "cpu.cfs_period_us"));
}

/// The least value that `of` returns for a group and its ancestors. If the path belongs to another
/// namespace, only the topmost group exists.
template <typename Of>
void limitBy(const fs::path& top, const std::string& path, Of of, std::optional<int>& least) {
    fs::path group = fs::path(path).relative_path();
    while (true) {
        if (const auto count = of(top / group)) least = std::min(least.value_or(*count), *count);
        if (group.empty()) return;
        group = group.parent_path();
    }
}

bool hasWord(std::string_view list, std::string_view word) {
    while (!list.empty()) {
        const std::size_t comma = std::min(list.find(','), list.size());
        if (list.substr(0, comma) == word) return true;
        list.remove_prefix(std::min(comma + 1, list.size()));
    }
    return false;
}

}  // namespace

std::optional<int> cpuQuota(const std::string& root) {
    std::optional<int> least;
    const fs::path groups = fs::path(root + "/sys/fs/cgroup");
    std::ifstream in(root + "/proc/self/cgroup");
    for (std::string line; std::getline(in, line);) {
        // NUMBER:CONTROLLERS:PATH; 0 and no controllers in version 2
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const std::string path = line.substr(second + 1);
        if (controllers.empty()) {
            limitBy(groups, path, ofGroup2, least);
            limitBy(groups / "unified", path, ofGroup2, least);
        } else if (hasWord(controllers, "cpu")) {
            for (const std::string& name : {std::string("cpu"), controllers})
                limitBy(groups / name, path, ofGroup1, least);
        }
    }
    return least;
}

namespace {

/// True on a thread that runs work of a function of this file.
thread_local bool is_inside = false;

struct Inside {
    bool before = std::exchange(is_inside, true);
    ~Inside() { is_inside = before; }
};

/// A thread that waits for part of the work steals only tasks of this work: its caller may hold a
/// lock that other tasks request. Nested calls belong to the work.
template <typename Work>
void isolated(Work work) {
    if (is_inside)
        work();
    else
        tbb::this_task_arena::isolate([&work] {
            const Inside inside;
            work();
        });
}

}  // namespace

void parallelInvoke(bool at_once, const std::function<void()>& first,
                    const std::function<void()>& second) {
    if (!at_once) {
        first();
        second();
        return;
    }
    const auto part = [](const std::function<void()>& work) {
        return [&work] {
            const Inside inside;
            work();
        };
    };
    isolated([&] { tbb::parallel_invoke(part(first), part(second)); });
}

void orderedPipeline(std::size_t blocks, const std::function<void(std::size_t)>& make,
                     const std::function<void(std::size_t)>& take) {
    using tbb::filter_mode;
    std::size_t next = 0;
    const auto begin = [&](tbb::flow_control& control) {
        if (next == blocks) control.stop();
        return next++;
    };
    const auto make_one = [&make](std::size_t block) {
        const Inside inside;
        make(block);
        return block;
    };
    const auto take_one = [&take](std::size_t block) {
        const Inside inside;
        take(block);
    };
    isolated([&] {
        tbb::parallel_pipeline(
            kBlocksAtOnce,
            tbb::make_filter<void, std::size_t>(filter_mode::serial_in_order, begin) &
                tbb::make_filter<std::size_t, std::size_t>(filter_mode::parallel, make_one) &
                tbb::make_filter<std::size_t, void>(filter_mode::serial_in_order, take_one));
    });
}

void parallelChunks(bool at_once, std::size_t count,
                    const std::function<void(std::size_t, std::size_t)>& work) {
    if (!at_once) return work(0, count);
    constexpr std::size_t kPart = 1024;
    isolated([&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kPart),
                          [&work](const auto& part) {
                              const Inside inside;
                              work(part.begin(), part.end());
                          });
    });
}

}  // namespace ispace
