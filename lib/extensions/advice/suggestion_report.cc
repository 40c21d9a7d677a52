// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/advice/suggestion_report.h"

#include "base/message.h"
#include "base/number.h"
#include "cli/common_options.h"
#include "report/coverage_report.h"

namespace ispace::advice {

std::string gainText(const Suggestion& suggestion) {
    std::string text = formatFixed(suggestion.gained, 2);
    if (text.front() != '-') text.insert(0, 1, '+');
    text += " m2, to " + percentText(suggestion.share);
    if (suggestion.saved > 0) text += "; saves " + formatDouble(suggestion.saved);
    if (suggestion.kind == Suggestion::Kind::Together && suggestion.unmet > 0)
        text += "; meets all rules of cameras, " + formatFixed(suggestion.unmet, 2) +
                " m2 of required floor stay missing";
    else if (suggestion.kind == Suggestion::Kind::Together)
        text += "; meets all requirements";
    else if (suggestion.required > 0)
        text += "; " + formatFixed(suggestion.required, 2) + " m2 less are missing";
    return text;
}

void AdviceSection::writeJson(JsonWriter& json) const {
    json.key("suggestions").beginArray();
    for (const Suggestion& suggestion : advice_.suggestions) {
        json.beginObject();
        json.key("kind").value(nameOf(suggestion.kind));
        json.key("text").value(suggestion.text);
        json.key("gained").value(roundSignificant(suggestion.gained));
        json.key("coverage").value(roundSignificant(suggestion.share));
        if (suggestion.saved > 0) json.key("saved").value(suggestion.saved);
        if (suggestion.required > 0)
            json.key("required").value(roundSignificant(suggestion.required));
        if (suggestion.unmet > 0) json.key("unmet").value(roundSignificant(suggestion.unmet));
        json.key("command").value(commandOf(advice_.command, suggestion.edits));
        json.endObject();
    }
    json.endArray();
    if (advice_.is_cut) json.key("suggestions_complete").value(false);
}

std::string AdviceSection::text() const {
    std::string text = "\nsuggestions:\n";
    if (advice_.suggestions.empty())
        text = advice_.is_cut ? "\n"
               : !advice_.has_fixed
                   ? "\nno sensor that stands by itself was found, to move or to add "
                     "one like it; no change of a piece helps\n"
                   : "\nno change of one sensor or piece helps\n";
    for (const Suggestion& suggestion : advice_.suggestions) {
        text += "  " + printable(suggestion.text) + ": " + gainText(suggestion) + '\n';
        text += "    " + commandOf(advice_.command, suggestion.edits) + '\n';
    }
    if (advice_.is_short) text.append(kShortAdvice).append("\n");
    if (advice_.is_cut) text.append(kCutAdvice).append("\n");
    return text;
}

namespace {

/// Builds the section of suggestions.
PageSection adviceSection(const Advice& advice) {
    PageSection section{"advice", "Suggestions", {}};
    if (advice.suggestions.empty() && !advice.is_cut)
        section.blocks.push_back(PageText{"No change of one sensor or piece of furniture helps."});
    for (const Suggestion& suggestion : advice.suggestions)
        section.blocks.push_back(
            PageText{printable(suggestion.text) + ": " + gainText(suggestion) + "."});
    if (advice.is_short) {
        std::string text = kShortAdvice;
        text.front() = 'N';
        section.blocks.push_back(PageText{text + '.'});
    }
    if (advice.is_cut) {
        std::string text = kCutAdvice;
        text.front() = 'C';
        section.blocks.push_back(PageText{text + '.'});
    }
    return section;
}

/// Builds the appendix with the command of each suggestion.
PageSection adviceCommands(const Advice& advice) {
    PageSection section{"advice-commands", "Appendix: commands of the suggestions", {}};
    for (const Suggestion& suggestion : advice.suggestions) {
        section.blocks.push_back(PageText{printable(suggestion.text) + ":", Tone::Small});
        section.blocks.push_back(PageCode{commandOf(advice.command, suggestion.edits)});
    }
    return section;
}

}  // namespace

PageAdditions AdviceSection::page(const PageSubject& subject) const {
    PageAdditions added;
    if (subject.of == PageSubject::Of::Room) added.figures.push_back(adviceSection(advice_));
    if (subject.of == PageSubject::Of::Site) added.closing.push_back(adviceSection(advice_));
    if (!advice_.suggestions.empty()) added.appendices.push_back(adviceCommands(advice_));
    return added;
}

}  // namespace ispace::advice
