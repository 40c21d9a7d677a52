// SPDX-License-Identifier: GPL-3.0-or-later
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/part_file.h"
#include "base/run_files.h"

namespace ispace {

PartHead partHeadOf(const std::string& file) {
    JobResults results;
    results.addFile(file);
    return results.head();
}

bool isPartOf(const std::string& file, const PartHead& head) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) return false;
    JobResults results;
    try {
        results.addFile(file);
        for (const std::string& key : results.keys()) static_cast<void>(results.find(key));
    } catch (const FormatError&) {
        return false;
    }
    return results.files_.front().is_finished && results.head().shard == head.shard &&
           results.head().job.differenceFrom(head.job).empty();
}

namespace {

/// "3", "2 and 5", "2, 4, 7 and 12 more"
std::string numberList(const std::vector<int>& numbers) {
    constexpr std::size_t kMaxNamed = 20;
    std::string text;
    for (std::size_t i = 0; i < std::min(numbers.size(), kMaxNamed); ++i) {
        if (i > 0) text += i + 1 == numbers.size() ? " and " : ", ";
        text += std::to_string(numbers[i]);
    }
    if (numbers.size() > kMaxNamed)
        text += " and " + std::to_string(numbers.size() - kMaxNamed) + " more";
    return text;
}

/// Opens all parts and keeps them open; raises the limit of open files if necessary.
void allowFiles(std::size_t count) {
    constexpr rlim_t kOthers = 64;
    const rlim_t wanted = count + kOthers;
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= wanted) return;
    limit.rlim_cur = std::min(wanted, limit.rlim_max);
    ::setrlimit(RLIMIT_NOFILE, &limit);
}

/// Reason why a part cannot be merged with `first`; "" if it can.
std::string mergeProblem(const PartHead& head, bool is_finished, std::string_view tool,
                         const std::optional<PartHead>& first, const std::string& first_name) {
    if (head.job.tool != tool)
        return "a part of a job of " + head.job.tool + ": merge it with " + head.job.tool +
               " --merge";
    if (!is_finished)
        return "shard " + head.shard.text() +
               " was cut short: run it again, with --resume if it ran so before";
    if (!first) return "";
    if (head.shard.count != first->shard.count)
        return "shard " + head.shard.text() + ", and " + first_name + " is shard " +
               first->shard.text();
    const std::string difference = head.job.differenceFrom(first->job);
    if (difference.empty()) return "";
    return "not of the same job as " + first_name + ": " + difference + " differs";
}

}  // namespace

JobResults mergeParts(std::span<const std::string> files, std::string_view tool,
                      std::string_view common, bool is_equal) {
    JobResults merged;
    merged.is_merge_ = true;
    merged.common_ = common;
    merged.is_common_equal_ = is_equal;
    Diagnostics findings;
    allowFiles(files.size());
    std::optional<PartHead> first;
    std::map<int, std::string> names;  // by shard
    for (const std::string& name : files) {
        noteInput(name);
        merged.addFile(name);
        const JobResults::File& file = merged.files_.back();
        const Shard& shard = file.head.shard;
        std::string problem = mergeProblem(file.head, file.is_finished, tool, first,
                                           names.empty() ? "" : names.begin()->second);
        if (problem.empty()) {
            first = file.head;
            const auto [at, is_new] = names.emplace(shard.index, name);
            problem = file.doubled;
            if (!is_new)
                problem = "shard " + shard.text() + " is given twice, as " + at->second + ", too";
        }
        if (!problem.empty()) findings.add({name, 0, 0, problem});
    }
    findings.throwIfAny();
    const int count = first ? first->shard.count : 0;
    std::vector<int> missing;
    for (int i = 1; i <= count; ++i)
        if (!names.contains(i)) missing.push_back(i);
    if (!missing.empty())
        throw FormatError({"", 0, 0,
                           (missing.size() == 1 ? "missing shard " : "missing shards ") +
                               numberList(missing) + " of " + std::to_string(count)});
    return merged;
}

}  // namespace ispace
