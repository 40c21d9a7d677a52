// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/batch.h"

#include <tbb/global_control.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <exception>
#include <pugixml.hpp>
#include <sstream>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "cli/outputs.h"
#include "cli/run_tool.h"
#include "record/text.h"
#include "sim/sim_time.h"

namespace ispace {

void addBatchOptions(CommandLine& line, BatchOptions& options, const std::string& shares) {
    line.parsed(
        "--shard", "I/N", [&options](const std::string& text) { options.shard = parseShard(text); },
        "do the I-th of N shares of the job (" + shares + ") and write a part for --merge",
        Enters::Nothing);
    line.flag("--merge", options.merge,
              "merge the parts of all shards, which are the operands, to the output of one run",
              Enters::Nothing);
    line.flag("--resume", options.resume,
              "store completed work in FILE.resume beside the output, and continue a killed run of "
              "the same command from there",
              Enters::Nothing);
    line.manyOperandsWith(options.merge);
}

void checkBatchOptions(const CommandLine& line, const BatchOptions& options,
                       const CommonOptions& common, const std::vector<std::string>& operands) {
    if (options.merge) {
        if (options.shard) throw UsageError("--merge joins what shards made: leave out --shard");
        if (options.resume) throw UsageError("--merge takes moments: leave out --resume");
        if (operands.empty()) throw UsageError("--merge: name the parts of all shards");
        // The parts store the options that change the result.
        const std::string words = line.historyLine({});
        if (const std::size_t blank = words.find(' '); blank != std::string::npos) {
            const std::string rest = words.substr(blank + 1);
            throw UsageError("--merge: the parts know their options; leave out " +
                             rest.substr(0, rest.find(' ')));
        }
    }
    const std::string suffix = suffixOf(common.output);
    if (options.shard && !suffix.empty() && suffix != "part" && !OutputSet::of(common.output))
        throw UsageError("--shard writes a part, which --merge makes a whole: name it " +
                         withoutSuffix(common.output) +
                         ".part, and the format by --to if it is "
                         "not the default");
    if (options.resume && !OutputSet::of(common.output) && isStream(common.output))
        throw UsageError("--resume needs a file (-o): what went into a stream is gone");
}

namespace {

constexpr std::size_t kMaxOperands = 2;

/// Returns the operands on a line, empty for a blank one or a comment. \throws LexError
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
    LineReader lines(withoutBom(bytes));
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
    // A thread that waits within a job does not begin another one.
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

namespace {

using Outcome = JunitCase::Outcome;

void addCase(pugi::xml_node list, const std::string& tool, const JunitCase& one) {
    pugi::xml_node test = list.append_child("testcase");
    test.append_attribute("classname") = tool.c_str();
    test.append_attribute("name") = printable(one.name).c_str();
    test.append_attribute("time") = formatMilliseconds(one.time).c_str();
    if (one.outcome == Outcome::Met) return;
    const bool is_error = one.outcome == Outcome::Error;
    pugi::xml_node failure = test.append_child(is_error ? "error" : "failure");
    failure.append_attribute("message") = printable(one.message).c_str();
    failure.append_attribute("type") = is_error ? "error" : "unmet";
}

}  // namespace

// The format has no standard; these are the elements and attributes that Jenkins, GitLab and
// GitHub's readers share: https://github.com/testmoapp/junitxml
std::string junitXml(const std::string& tool, const std::string& suite,
                     std::span<const JunitCase> cases) {
    const auto count = [cases](Outcome outcome) {
        return static_cast<unsigned long>(std::count_if(
            cases.begin(), cases.end(), [=](const JunitCase& c) { return c.outcome == outcome; }));
    };
    std::chrono::nanoseconds end{};
    for (const JunitCase& one : cases) end = std::max(end, one.time);

    pugi::xml_document document;
    pugi::xml_node declaration = document.append_child(pugi::node_declaration);
    declaration.append_attribute("version") = "1.0";
    declaration.append_attribute("encoding") = "UTF-8";
    pugi::xml_node root = document.append_child("testsuites");
    pugi::xml_node list = root.append_child("testsuite");
    list.append_attribute("name") = printable(suite).c_str();
    list.append_attribute("tests") = static_cast<unsigned long>(cases.size());
    list.append_attribute("failures") = count(Outcome::Unmet);
    list.append_attribute("errors") = count(Outcome::Error);
    list.append_attribute("skipped") = 0;
    list.append_attribute("time") = formatMilliseconds(end).c_str();
    for (const JunitCase& one : cases) addCase(list, tool, one);
    std::ostringstream out;
    document.save(out, "  ");
    return out.str();
}

JunitFile::JunitFile(std::string tool, const std::string& file) : tool_(std::move(tool)) {
    if (!file.empty()) file_.emplace(file);
}

void JunitFile::write(const std::string& suite, std::span<const JunitCase> cases) {
    if (!file_) return;
    file_->write(junitXml(tool_, suite, cases));
    file_->commit();
    file_.reset();
}

void JunitFile::during(std::span<const std::string> inputs, const std::function<void()>& work) {
    try {
        work();
    } catch (...) {
        JunitCase error{.name = tool_, .outcome = Outcome::Error};
        for (const std::string& input : inputs) error.name += ' ' + displayName(baseName(input));
        for (const std::string& line : currentFailure().lines)
            error.message.append(error.message.empty() ? "" : "; ").append(line);
        try {
            write(error.name, {&error, 1});
        } catch (const std::exception&) {  // the exception of the work is the one to report
        }
        throw;
    }
}

}  // namespace ispace
