// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/outcome.h"

#include "base/message.h"
#include "record/text.h"

namespace ispace {

namespace {

// Each line behind the report begins with what it is; a verdict has its parts between tabs, which
// printable() leaves nowhere else.
constexpr char kFailed = 'f', kMessage = 'm', kMet = '0', kUnmet = '1', kError = '2';

char letterOf(JunitCase::Outcome outcome) {
    return outcome == JunitCase::Outcome::Met     ? kMet
           : outcome == JunitCase::Outcome::Unmet ? kUnmet
                                                  : kError;
}

JunitCase verdictOf(char letter, std::string_view parts) {
    const auto tab = parts.find('\t');
    return {.name = std::string(parts.substr(0, tab)),
            .outcome = letter == kMet     ? JunitCase::Outcome::Met
                       : letter == kUnmet ? JunitCase::Outcome::Unmet
                                          : JunitCase::Outcome::Error,
            .message = std::string(parts.substr(tab + 1))};
}

}  // namespace

std::string SceneOutcome::text() const {
    std::string text = report;
    if (failed) text.append(1, kFailed) += '\n';
    for (const std::string& message : messages)
        text.append(1, kMessage).append(printable(message)) += '\n';
    for (const JunitCase& verdict : verdicts) {
        text.append(1, letterOf(verdict.outcome)).append(printable(verdict.name)) += '\t';
        text.append(printable(verdict.message)) += '\n';
    }
    return text;
}

SceneOutcome SceneOutcome::fromText(std::string_view text) {
    LineReader lines(text);
    SceneOutcome outcome{.report = std::string(lines.next().value_or("null")) + '\n'};
    while (const auto line = lines.next()) {
        if (line->empty()) continue;
        const char letter = line->front();
        const std::string_view rest = line->substr(1);
        if (letter == kFailed)
            outcome.failed = true;
        else if (letter == kMessage)
            outcome.messages.emplace_back(rest);
        else
            outcome.verdicts.push_back(verdictOf(letter, rest));
    }
    return outcome;
}

}  // namespace ispace
