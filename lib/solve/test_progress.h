// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "base/progress.h"

namespace ispace {

/// Counts what it is told and asked, and says stop by a rule on that.
class StopWhen final : public Progress {
  public:
    using Rule = std::function<bool(const StopWhen&)>;
    explicit StopWhen(Rule rule) : rule_(std::move(rule)) {}
    void begin(std::string_view phase, std::int64_t /*total*/) override {
        ++begun;
        phases += phase;
        phases += ' ';
    }
    void advance(std::int64_t count) override { done += count; }
    void end() override { ++ended; }
    [[nodiscard]] bool stopped() const override {
        ++asked;
        return rule_(*this);
    }

    std::string phases;  ///< that have begun
    std::atomic<int> begun = 0, ended = 0;
    std::atomic<std::int64_t> done = 0;
    mutable std::atomic<int> asked = 0;  ///< with this time

  private:
    Rule rule_;
};

/// Says stop at once.
inline bool always(const StopWhen& /*told*/) { return true; }
/// Says stop once more than so many phases have begun.
inline StopWhen::Rule afterPhases(int count) {
    return [count](const StopWhen& told) { return told.begun > count; };
}

/// Says stop once it was asked more than so often.
inline StopWhen::Rule afterAsking(int times) {
    return [times](const StopWhen& told) { return told.asked > times; };
}

}  // namespace ispace
