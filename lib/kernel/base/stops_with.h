// SPDX-License-Identifier: GPL-3.0-or-later
// The progress of a search within a search: silent, and stopped with the whole.
//
//     StopsWith inner(progress);
//     const auto best = improve(start, inner);  // returns early after a signal
#pragma once

#include <cstdint>
#include <string_view>

#include "base/error.h"

namespace ispace {

/// Shows no progress, and says stop when another one does: of searches within a search, which count
/// other units than the whole. Thread-safe as stopped() of the other is.
class StopsWith final : public Progress {
  public:
    /// Stores the reference. \pre `whole` outlives this
    explicit StopsWith(const Progress& whole) : whole_(whole) {}
    void begin(std::string_view /*phase*/, std::int64_t /*total*/) override {}
    void advance(std::int64_t /*count*/) override {}
    void end() override {}
    [[nodiscard]] bool stopped() const override { return whole_.stopped(); }

  private:
    const Progress& whole_;
};

}  // namespace ispace
