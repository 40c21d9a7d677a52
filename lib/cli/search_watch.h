// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "base/progress.h"
#include "cli/stop_signals.h"

namespace ispace {

/// Progress of a search that ends early at TERM, INT or a time limit, with the best it has.
class SearchWatch final : public Progress {
  public:
    /// \param shown where progress is shown; \param limit seconds from now on
    SearchWatch(std::unique_ptr<Progress> shown, std::optional<double> limit);

    void begin(std::string_view phase, std::int64_t total) override { shown_->begin(phase, total); }
    void advance(std::int64_t count) override { shown_->advance(count); }
    /// With a limit also says how much time is left.
    void note(std::string_view text) override;
    void end() override { shown_->end(); }
    [[nodiscard]] bool stopped() const override;

    /// The signal that came, 0 if none did.
    [[nodiscard]] int signal() const { return signals_.signal(); }

  private:
    using Clock = std::chrono::steady_clock;
    std::unique_ptr<Progress> shown_;
    std::optional<Clock::time_point> end_;
    StopSignals signals_;
};

/// Ends this process by the signal, as if nobody had caught it.
[[noreturn]] void endBySignal(int signal);

}  // namespace ispace
