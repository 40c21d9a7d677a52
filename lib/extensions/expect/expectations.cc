// SPDX-License-Identifier: GPL-3.0-or-later
// Sentences are parsed with the command line, files of them before the first step: an error in
// either comes before the run. The report holds times of the run only, so that two runs of one seed
// give equal bytes; paths of films are those of the record's folder.
#include "extensions/expect/expectations.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"
#include "base/run_files.h"
#include "cli/common_options.h"
#include "cli/outputs.h"
#include "cli/run_tool.h"
#include "extensions/expect/rule_file.h"

namespace ispace::expect {

namespace {

constexpr double kFilmBefore = 2, kFilmAfter = 1;  // seconds about a failure

/// True for the name of a file: a sentence has blanks.
bool isRuleFile(const std::string& text) {
    return text.find(' ') == std::string::npos &&
           (text.ends_with(".yaml") || text.ends_with(".yml"));
}

/// Returns the command that films a failure; "" of a run without a record.
std::string filmCommand(const RunFailure& failure, const std::string& record, std::size_t number) {
    if (record.empty()) return "";
    // A building's record has a folder for each room.
    const std::string& room = failure.room;
    const double from = std::max(0.0, seconds(failure.from) - kFilmBefore);
    return "simrun --replay " + shellQuote(room.empty() ? record : record + '/' + room) +
           " --from " + formatDouble(std::floor(from * 1000) / 1000) + " --until " +
           formatDouble(std::ceil((seconds(failure.to) + kFilmAfter) * 1000) / 1000) +
           " -o failure" + std::to_string(number) + ".gif";
}

class RunExpectations : public RunJudge {
  public:
    RunExpectations(ExpectationJudge judge, std::string file)
        : judge_(std::move(judge)), file_(std::move(file)) {}
    void observe() override { judge_.observe(); }
    [[nodiscard]] std::vector<RunVerdict> verdicts() const override { return judge_.verdicts(); }
    void report(const std::string& record) const override {
        // A slip in a name must not pass for a rule that holds.
        for (const std::string& name : judge_.untold())
            writeMessage("simrun", {.message = "--expect: `" + name +
                                               "` was never told in this run, and counted as 0",
                                    .severity = Severity::Warning});
        if (file_.empty()) return;
        const bool is_json = outputFormat({}, file_, {"json", "txt"}) == "json";
        const std::vector<JudgedExpectation> results = judge_.results();
        writeAll(file_,
                 is_json ? expectationsJson(results, record) : expectationsText(results, record));
    }

  private:
    ExpectationJudge judge_;
    std::string file_;
};

class ExpectationOptions : public JudgeGroup {
  public:
    void declare(CommandLine& line) override {
        line.texts("--expect", "SENTENCE", texts_,
                   "exit with 3 unless the run does this, e.g. 'r1 within 0.4 of 2,1 before 60', "
                   "'no collision', 'lamp of kitchen on within 2s of ann enters kitchen' (see the "
                   "manual), or all that a file of such sentences says (.yaml)",
                   Enters::Nothing);
        line.file("--expect-report", "FILE", report_,
                  "write which of them failed when, and what was observed then (.txt, .json)",
                  Enters::Nothing);
        line.essential({"--expect"});
    }

    void take(const CommandLine& line) override {
        for (const std::string& text : texts_) {
            Source& source = sources_.emplace_back();
            if (isRuleFile(text))
                source.file = text;
            else
                source.sentences.push_back(
                    ofOption("--expect", [&text] { return parseExpectation(text); }));
        }
        if (!line.given("--expect-report")) return;
        if (texts_.empty())
            throw UsageError("--expect-report tells what became of expectations: give --expect");
        if (isStdout(report_)) throw UsageError("give --expect-report a file, such as rules.txt");
        (void)outputFormat({}, report_, {"json", "txt"});
    }

    [[nodiscard]] bool isAsked() const override { return !texts_.empty(); }
    void claim() const override { claimOutput(report_, "--expect-report"); }

    [[nodiscard]] std::unique_ptr<RunJudge> judge(std::span<const RunRoom> rooms) const override {
        std::vector<Expectation> all;
        for (const Source& source : sources_) {
            const auto sentences = source.file.empty()
                                       ? source.sentences
                                       : readRules(readAll(source.file), displayName(source.file));
            all.insert(all.end(), sentences.begin(), sentences.end());
        }
        std::vector<JudgedWorld> worlds;
        worlds.reserve(rooms.size());
        for (const RunRoom& room : rooms)
            worlds.push_back({room.id, &room.simulation->world(), &room.simulation->events()});
        return std::make_unique<RunExpectations>(
            ofOption("--expect", [&] { return ExpectationJudge(worlds, std::move(all)); }),
            report_);
    }

  private:
    /// A file of rules, or sentences of the command line.
    struct Source {
        std::string file;
        std::vector<Expectation> sentences;
    };

    std::vector<std::string> texts_;
    std::string report_;
    std::vector<Source> sources_;
};

}  // namespace

std::unique_ptr<JudgeGroup> makeExpectations() { return std::make_unique<ExpectationOptions>(); }

std::string expectationsJson(std::span<const JudgedExpectation> results,
                             const std::string& record) {
    JsonWriter json;
    beginReport(json, "ispace-expectations/1", "simrun");
    json.key("met").value(std::all_of(results.begin(), results.end(),
                                      [](const auto& result) { return result.verdict.is_met; }));
    json.key("rules").beginArray();
    std::size_t number = 0;
    for (const JudgedExpectation& result : results) {
        const Expectation& rule = *result.expectation;
        json.beginObject();
        if (!rule.name.empty()) json.key("name").value(rule.name);
        json.key("expect").value(rule.text);
        if (!rule.source.file.empty()) {
            json.key("file").value(rule.source.file);
            json.key("line").value(rule.source.line);
        }
        json.key("met").value(result.verdict.is_met);
        json.key("t").value(seconds(result.verdict.time));
        if (!result.verdict.is_met) json.key("reason").value(result.verdict.reason);
        json.key("checks").value(result.checks).key("failed").value(result.failures);
        json.key("failures").beginArray();
        for (const RunFailure& failure : result.shown) {
            json.beginObject().key("of").value(failure.subject);
            json.key("from").value(seconds(failure.from)).key("to").value(seconds(failure.to));
            json.key("reason").value(failure.reason);
            json.key("observed").beginArray();
            for (const ObservedState& sighting : failure.observed)
                json.beginObject()
                    .key("t")
                    .value(seconds(sighting.time))
                    .key("state")
                    .value(sighting.text)
                    .endObject();
            json.endArray();
            if (const std::string film = filmCommand(failure, record, ++number); !film.empty())
                json.key("film").value(film);
            json.endObject();
        }
        json.endArray().endObject();
    }
    json.endArray().endObject();
    return json.take() + '\n';
}

std::string expectationsText(std::span<const JudgedExpectation> results,
                             const std::string& record) {
    std::string text;
    std::size_t number = 0;
    for (const JudgedExpectation& result : results) {
        const Expectation& rule = *result.expectation;
        text.append(result.verdict.is_met ? "met     " : "FAILED  ");
        if (!rule.name.empty()) text.append(rule.name).append(": ");
        text.append(printable(rule.text)).append("\n");
        if (!result.verdict.is_met && result.shown.empty())
            text.append("        ").append(result.verdict.reason).append("\n");
        for (const RunFailure& failure : result.shown) {
            text.append("        ").append(failure.reason).append("\n");
            for (const ObservedState& sighting : failure.observed)
                text.append("            t=")
                    .append(formatMilliseconds(sighting.time))
                    .append("  ")
                    .append(sighting.text)
                    .append("\n");
            if (const std::string film = filmCommand(failure, record, ++number); !film.empty())
                text.append("            ").append(film).append("\n");
        }
        if (result.failures > static_cast<std::int64_t>(result.shown.size()))
            text.append("        and ")
                .append(std::to_string(result.failures -
                                       static_cast<std::int64_t>(result.shown.size())))
                .append(" more\n");
    }
    return text;
}

}  // namespace ispace::expect
