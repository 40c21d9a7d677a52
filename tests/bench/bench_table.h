// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of rates and ratios from benchmarks that do one work in several ways.
#pragma once

#include <benchmark/benchmark.h>
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <chrono>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace ispace::bench {

/// Several ways to do the same work, in turn, so that whatever else the machine does meets all of
/// them; the quickest run of each counts.
class Contest {
  public:
    void add(std::function<void()> run);
    void round();
    /// Seconds.
    [[nodiscard]] double quickest(std::size_t way) const { return quickest_[way]; }
    [[nodiscard]] double last(std::size_t way) const { return last_[way]; }

  private:
    std::vector<std::function<void()>> ways_;
    std::vector<double> quickest_, last_;
};

/// Number of cores that other processes kept busy since construction: unless it is near 0, the gain
/// of two threads is that of the machine.
class Others {
  public:
    Others();
    /// 0 where /proc/stat cannot be read.
    [[nodiscard]] double cores() const;

  private:
    double busy_, own_;
    std::chrono::steady_clock::time_point start_;
};

/// Distributes `count` tasks over this many threads: run(i), in order on one thread. Nested loops
/// use no more threads either.
template <typename Run>
void shareOut(int threads, std::size_t count, Run run) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    if (threads == 1) {
        for (std::size_t i = 0; i < count; ++i) run(i);
        return;
    }
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count),
                      [&run](const tbb::blocked_range<std::size_t>& part) {
                          for (std::size_t i = part.begin(); i < part.end(); ++i) run(i);
                      });
}

/// Ends a cell in the JSON of the results; it is not printed.
constexpr char kCellEnd = '\t';

/// A cell, right-aligned: a number with so many decimals, or words.
std::string cell(double number, int decimals, std::size_t width);
std::string cell(const std::string& words, std::size_t width);
std::string leftCell(const std::string& words, std::size_t width);

/// The head of a column and its width, negative if it is left-aligned.
struct Column {
    const char* name;
    int width;
};
std::string headOf(std::initializer_list<Column> columns);

/// Prints the label of each benchmark as a line, and above those of a group (all names with the
/// same beginning up to the first slash) its heading, whose last line is made of cells as the label
/// is. Results as JSON have the headings, too, as `table GROUP` of the context: tables.py makes CSV
/// of both.
class TableReporter : public benchmark::BenchmarkReporter {
  public:
    explicit TableReporter(std::map<std::string, std::string> headings);
    bool ReportContext(const Context& context) override;
    void ReportRuns(const std::vector<Run>& runs) override;

  private:
    std::map<std::string, std::string> headings_;
    std::string group_;
};

/// Ends the program if more than one beam in ten thousand differs by over a millimetre (grazing
/// hits, where float32 alone goes astray).
void mustAgree(const std::string& name, std::span<const float> ours, std::span<const float> others);

}  // namespace ispace::bench
