// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/cpu_quota.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string_view>

#include "base/number.h"

namespace ispace {

namespace {

namespace fs = std::filesystem;

/// The first line; "" if there is no such file.
std::string firstLineOf(const fs::path& file) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    return line;
}

/// Microseconds of processor time in each period; nothing for "max", -1 and what is no number.
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

/// The least that `of` says of a group and those above it. Where the path is another namespace's,
/// only the topmost is there.
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
        // NUMBER:CONTROLLERS:PATH, with 0 and none in version 2
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

}  // namespace ispace
