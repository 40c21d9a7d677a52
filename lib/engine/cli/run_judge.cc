// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/run_judge.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace ispace {

namespace {

/// Several judges as one.
class JointJudge : public RunJudge {
  public:
    explicit JointJudge(std::vector<std::unique_ptr<RunJudge>> judges)
        : judges_(std::move(judges)) {}
    void observe() override {
        for (const auto& judge : judges_) judge->observe();
    }
    [[nodiscard]] std::vector<RunVerdict> verdicts() const override {
        std::vector<RunVerdict> all;
        for (const auto& judge : judges_)
            for (RunVerdict& verdict : judge->verdicts()) all.push_back(std::move(verdict));
        return all;
    }
    void report(const std::string& record) const override {
        for (const auto& judge : judges_) judge->report(record);
    }

  private:
    std::vector<std::unique_ptr<RunJudge>> judges_;
};

}  // namespace

std::string unmetText(const std::vector<RunVerdict>& verdicts) {
    std::string text;
    for (const RunVerdict& verdict : verdicts)
        if (!verdict.is_met)
            text.append(text.empty() ? "" : "; ")
                .append("expected `")
                .append(verdict.expectation)
                .append("`: ")
                .append(verdict.reason);
    return text;
}

JudgeExtensions::JudgeExtensions(std::span<const MakeJudge> rows) {
    groups_.reserve(rows.size());
    for (const MakeJudge make : rows) groups_.push_back(make());
}

void JudgeExtensions::declare(CommandLine& line) {
    const auto before = static_cast<std::ptrdiff_t>(line.names().size());
    for (const auto& group : groups_) group->declare(line);
    const std::vector<std::string> names = line.names();
    options_.assign(names.begin() + before, names.end());
}

void JudgeExtensions::take(const CommandLine& line) const {
    for (const auto& group : groups_) group->take(line);
}

bool JudgeExtensions::isAsked() const {
    return std::any_of(groups_.begin(), groups_.end(),
                       [](const auto& group) { return group->isAsked(); });
}

void JudgeExtensions::claim() const {
    for (const auto& group : groups_) group->claim();
}

std::unique_ptr<RunJudge> JudgeExtensions::judge(std::span<const RunRoom> rooms) const {
    std::vector<std::unique_ptr<RunJudge>> judges;
    for (const auto& group : groups_)
        if (group->isAsked()) judges.push_back(group->judge(rooms));
    return std::make_unique<JointJudge>(std::move(judges));
}

}  // namespace ispace
