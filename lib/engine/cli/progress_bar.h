// SPDX-License-Identifier: GPL-3.0-or-later
// Progress of long work on stderr, and searches that end early.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "base/error.h"
#include "cli/run_tool.h"

namespace ispace {

/// A line on stderr that shows phase, share, rate, time left and the last note, drawn at most ten
/// times a second and left at its last state at the end of a phase. advance() and note() may be
/// called by any thread, the others by one; between drawings advance() costs a clock and an atomic
/// addition. The time left assumes a constant rate since the start of the phase.
class ProgressBar final : public Progress {
  public:
    /// \param quick seconds; shorter phases are not drawn
    explicit ProgressBar(std::string tool, double quick = 0)
        : tool_(std::move(tool)), quick_(quick) {}
    ~ProgressBar() override;
    void begin(std::string_view phase, std::int64_t total) override;
    void advance(std::int64_t count) override;
    void note(std::string_view text) override;
    void end() override;

  private:
    void draw(std::int64_t done, bool last);

    using Clock = std::chrono::steady_clock;
    std::string tool_, phase_, note_;
    double quick_;
    std::int64_t total_ = 0;
    std::atomic<std::int64_t> done_{0};
    std::atomic<std::int64_t> next_draw_{0};  // microseconds after start_
    std::mutex drawing_;
    Clock::time_point start_;
    bool shown_ = false;
};

/// Creates a ProgressBar if `wanted`, or by default if stderr is a terminal; else a silent one.
/// \param quick seconds; shorter phases are drawn only if `wanted`: those of work that is mostly
///        done at once
std::unique_ptr<Progress> makeProgress(const std::string& tool, std::optional<bool> wanted,
                                       bool quiet, double quick = 0);

/// Progress of a search that ends early at TERM, INT or a time limit, with the best result so far.
///
///     SearchWatch watch(makeProgress("arrange", common.progress, common.quiet), limit);
///     const Layout best = search(room, watch);
///     write(best);
///     if (watch.signal() != 0) endBySignal(watch.signal());  // as if it had not been caught
class SearchWatch final : public Progress {
  public:
    /// \param shown receives the progress; \param limit seconds from now on
    /// \param takes_signals false: signals end the process; several may live at a time
    SearchWatch(std::unique_ptr<Progress> shown, std::optional<double> limit,
                bool takes_signals = true);

    void begin(std::string_view phase, std::int64_t total) override { shown_->begin(phase, total); }
    void advance(std::int64_t count) override { shown_->advance(count); }
    /// With a limit, also shows the time left.
    void note(std::string_view text) override;
    void end() override { shown_->end(); }
    [[nodiscard]] bool stopped() const override;

    /// Returns the signal received, or 0.
    [[nodiscard]] int signal() const { return signals_ ? signals_->signal() : 0; }

  private:
    using Clock = std::chrono::steady_clock;
    std::unique_ptr<Progress> shown_;
    std::optional<Clock::time_point> end_;
    std::optional<StopSignals> signals_;
};

/// Ends this process by the signal, as if it had not been caught.
[[noreturn]] void endBySignal(int signal);

}  // namespace ispace
