// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace ispace {

/// Results of the steps of a long computation by name, from an earlier run or from other processes,
/// and where new ones are kept. Whoever computes asks before each step and tells after it; steps
/// are pure functions of their input, so it does not matter who took them.
class Ledger {
  public:
    Ledger() = default;
    virtual ~Ledger() = default;
    Ledger(const Ledger&) = delete;
    Ledger& operator=(const Ledger&) = delete;

    /// From any thread.
    [[nodiscard]] virtual std::optional<std::string> find(const std::string& name) const = 0;
    /// Keeps a result; one of the same name is replaced. From any thread.
    virtual void keep(const std::string& name, std::string_view bytes) = 0;
    /// True now and then: who has state worth keeping in the middle of a step keeps it.
    [[nodiscard]] virtual bool isDue() { return false; }

    /// 1, 2, … each time that this kind of step is taken. From one thread, in the same order in
    /// each run.
    int numberOf(const std::string& step) { return ++counts_[step]; }
    /// A name with that number: "tree1", "tree2", …
    std::string nameFor(const std::string& step) { return step + std::to_string(numberOf(step)); }

  private:
    std::map<std::string, int> counts_;
};

}  // namespace ispace
