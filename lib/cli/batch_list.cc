// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/batch_list.h"

#include <tbb/global_control.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include "base/error.h"
#include "record/text.h"

namespace ispace {

namespace {

constexpr std::size_t kMaxOperands = 2;

/// The operands on a line, none for a blank one or a comment. \throws LexError
std::vector<std::string> operandsOn(std::string_view line) {
    std::vector<std::string> operands;
    LineLexer lexer(line);
    while (lexer.more()) {
        const Piece word = lexer.word();
        if (word.text.empty()) throw LexError{"an empty name", word.column};
        if (word.text == "-")
            throw LexError{"stdin is not read by a job of a list: give a file", word.column};
        if (operands.size() == kMaxOperands)
            throw LexError{"more than ENV and LAYOUT: put names with blanks in quotes",
                           word.column};
        operands.emplace_back(word.text);
    }
    return operands;
}

}  // namespace

std::string BatchJob::text() const {
    std::string text;
    for (const std::string& operand : operands)
        text.append(text.empty() ? "" : " ").append(operand);
    return text;
}

std::vector<BatchJob> readBatchList(std::string_view bytes, const std::string& name) {
    checkTextBytes(bytes, name);
    std::vector<BatchJob> jobs;
    LineReader lines(withoutMark(bytes));
    while (const auto line = lines.next()) {
        try {
            std::vector<std::string> operands = operandsOn(*line);
            if (!operands.empty()) jobs.push_back({lines.number(), std::move(operands)});
        } catch (const LexError& error) {
            jobs.push_back({lines.number(), {}, error.message});
        }
    }
    if (jobs.empty()) throw FormatError({name, 0, 0, "no job found, wanted lines `ENV [LAYOUT]`"});
    return jobs;
}

void runInOrder(std::size_t count, const std::function<std::function<void()>(std::size_t)>& work) {
    std::size_t next = 0;
    const auto number = [&](tbb::flow_control& control) -> std::size_t {
        if (next < count) return next++;
        control.stop();
        return 0;
    };
    // Whoever waits for others in a job does not begin with another one.
    const auto run = [&](std::size_t i) {
        return tbb::this_task_arena::isolate([&] { return work(i); });
    };
    const auto deliver = [](const std::function<void()>& result) { result(); };
    const std::size_t threads =
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    tbb::parallel_pipeline(
        2 * threads,
        tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, number) &
            tbb::make_filter<std::size_t, std::function<void()>>(tbb::filter_mode::parallel, run) &
            tbb::make_filter<std::function<void()>, void>(tbb::filter_mode::serial_in_order,
                                                          deliver));
}

}  // namespace ispace
