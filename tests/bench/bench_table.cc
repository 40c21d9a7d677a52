// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench_table.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>

#include "base/number.h"

namespace ispace::bench {

void Contest::add(std::function<void()> run) {
    ways_.push_back(std::move(run));
    quickest_.push_back(std::numeric_limits<double>::infinity());
    last_.push_back(0);
}

void Contest::round() {
    for (std::size_t i = 0; i < ways_.size(); ++i) {
        const auto start = std::chrono::steady_clock::now();
        ways_[i]();
        last_[i] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        quickest_[i] = std::min(quickest_[i], last_[i]);
    }
}

namespace {

/// Seconds of all cores together that were not idle.
double busySeconds() {
    std::ifstream file("/proc/stat");
    std::string name;
    double user = 0, nice = 0, system = 0, idle = 0, waiting = 0, interrupts = 0, soft = 0;
    file >> name >> user >> nice >> system >> idle >> waiting >> interrupts >> soft;
    return (user + nice + system + interrupts + soft) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

double ownSeconds() {
    double sum = 0;
    for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage usage{};
        getrusage(who, &usage);
        for (const timeval& time : {usage.ru_utime, usage.ru_stime})
            sum += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    }
    return sum;
}

std::string printed(std::string cells) {
    std::erase(cells, kCellEnd);
    return cells;
}

/// The row of a run, or its error. Since version 1.8 of the library an error is one way to skip a
/// run.
template <typename Run>
const std::string& wordsOf(const Run& run) {
    if constexpr (requires { run.skip_message; })
        return static_cast<bool>(run.skipped) ? run.skip_message : run.report_label;
    else
        return run.error_occurred ? run.error_message : run.report_label;
}

}  // namespace

Others::Others()
    : busy_(busySeconds()), own_(ownSeconds()), start_(std::chrono::steady_clock::now()) {}

double Others::cores() const {
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    return std::max(0.0, (busySeconds() - busy_) - (ownSeconds() - own_)) / seconds;
}

std::string cell(double number, int decimals, std::size_t width) {
    return cell(formatFixed(number, decimals), width);
}

std::string cell(const std::string& words, std::size_t width) {
    return std::string(width - std::min(width, words.size()), ' ') + words + kCellEnd;
}

std::string leftCell(const std::string& words, std::size_t width) {
    return words + std::string(width - std::min(width, words.size()), ' ') + kCellEnd;
}

std::string headOf(std::initializer_list<Column> columns) {
    std::string line;
    for (const Column& column : columns) {
        const auto width = static_cast<std::size_t>(std::abs(column.width));
        line += column.width < 0 ? leftCell(column.name, width) : cell(column.name, width);
    }
    return line;
}

TableReporter::TableReporter(std::map<std::string, std::string> headings)
    : headings_(std::move(headings)) {
    for (const auto& [group, heading] : headings_)
        benchmark::AddCustomContext("table " + group, heading);
}

bool TableReporter::ReportContext(const Context& context) {
    const double load = context.cpu_info.load_avg.empty() ? 0 : context.cpu_info.load_avg.front();
    std::printf("%d cores, load %.1f\n", context.cpu_info.num_cpus, load);
    return true;
}

void TableReporter::ReportRuns(const std::vector<Run>& runs) {
    for (const Run& run : runs) {
        if (run.run_type == Run::RT_Aggregate) continue;
        const std::string name = run.benchmark_name();
        const std::string group = name.substr(0, name.find('/'));
        if (group != group_) std::printf("\n%s\n", printed(headings_[group]).c_str());
        group_ = group;
        std::printf("%s\n", printed(wordsOf(run)).c_str());
    }
    std::fflush(stdout);
}

void mustAgree(const std::string& name, std::span<const float> ours,
               std::span<const float> others) {
    std::size_t wrong = ours.size() == others.size() ? 0 : ours.size();
    for (std::size_t i = 0; i < std::min(ours.size(), others.size()); ++i)
        if (ours[i] != others[i] && !(std::abs(ours[i] - others[i]) <= 1e-3F)) ++wrong;
    // Rays along an edge go either way in float32; one that runs along a row of pixels has many.
    if (wrong * 1000 <= ours.size() && !ours.empty()) return;
    std::fprintf(stderr, "%s: %zu of %zu beams differ\n", name.c_str(), wrong, ours.size());
    std::exit(1);
}

}  // namespace ispace::bench
