// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/command.h"

#include <algorithm>
#include <array>
#include <vector>

#include "base/number.h"
#include "base/suggest.h"
#include "base/utf8.h"
#include "sim/words.h"

namespace ispace {

namespace {

/// A slip of a digit, not a way to go; it also keeps poses within what doubles resolve.
constexpr double kFarthest = 1e6;

struct VerbFacts {
    Verb verb;
    std::string_view name;
    std::string_view value_name;
    std::string_view unit;      // of the value
    std::string_view opposite;  // what goes the other way, where the value is not negative
    std::string_view example;
};

/// In the order of Verb.
constexpr std::array<VerbFacts, 7> kVerbs = {{
    {Verb::Forward, "FORWARD", "distance", "metres", "BACKWARD", "FORWARD 1.5"},
    {Verb::Backward, "BACKWARD", "distance", "metres", "FORWARD", "BACKWARD 1.5"},
    {Verb::Left, "LEFT", "angle", "degrees", "RIGHT", "LEFT 90"},
    {Verb::Right, "RIGHT", "angle", "degrees", "LEFT", "RIGHT 90"},
    {Verb::Speed, "SPEED", "speed", "metres a second", "", "SPEED 0.3"},
    {Verb::Rotspeed, "ROTSPEED", "rotspeed", "degrees a second", "", "ROTSPEED 30"},
    {Verb::Stop, "STOP", "", "", "", "STOP"},
}};

const VerbFacts& factsOf(Verb verb) { return kVerbs[static_cast<std::size_t>(verb)]; }

/// Text put together from pieces.
std::string join(std::initializer_list<std::string_view> pieces) {
    std::string text;
    for (const std::string_view piece : pieces) text += piece;
    return text;
}

ParsedCommand refuse(CommandError::Kind kind, std::string message) {
    return {std::nullopt, {kind, std::move(message)}};
}

std::string unknownCommand(std::string_view name) {
    std::vector<std::string> known;
    known.reserve(kVerbs.size());
    for (const VerbFacts& facts : kVerbs) known.emplace_back(facts.name);
    std::string hint = didYouMean(upperCase(name), known);
    if (hint.empty()) {
        hint = ", wanted one of";
        for (const std::string& verb : known) {
            hint += ' ';
            hint += verb;
        }
    }
    return join({"unknown command ", excerpt(name), hint});
}

/// The one value of `facts.verb`.
ParsedCommand parseValue(const VerbFacts& facts, std::string_view text) {
    const auto value = parseDouble(text);
    if (!value) {
        return refuse(CommandError::Kind::Syntax,
                      join({excerpt(text), " is no number, ", facts.name, " wants its ",
                            facts.value_name, " in ", facts.unit, ", like ", facts.example}));
    }
    if (comesToAnEnd(facts.verb) && *value < 0) {
        return refuse(
            CommandError::Kind::Range,
            join({facts.name, " takes no negative ", facts.value_name, ", use ", facts.opposite}));
    }
    if (comesToAnEnd(facts.verb) && *value > kFarthest) {
        return refuse(CommandError::Kind::Range,
                      join({facts.name, " takes at most ", formatDouble(kFarthest), " ", facts.unit,
                            ", found ", excerpt(text)}));
    }
    // Adding 0 drops the sign of minus zero.
    return {Command{facts.verb, *value + 0.0}, {}};
}

}  // namespace

bool comesToAnEnd(Verb verb) { return !factsOf(verb).opposite.empty(); }

std::string_view nameOf(Verb verb) { return factsOf(verb).name; }

std::string_view valueNameOf(Verb verb) { return factsOf(verb).value_name; }

std::optional<Verb> verbNamed(std::string_view name) {
    const auto found = std::find_if(kVerbs.begin(), kVerbs.end(),
                                    [&](const VerbFacts& facts) { return facts.name == name; });
    if (found == kVerbs.end()) return std::nullopt;
    return found->verb;
}

ParsedCommand parseCommand(std::string_view text) {
    const std::vector<Piece> words = wordsOf(text);
    if (words.empty())
        return refuse(CommandError::Kind::Syntax, "no command, wanted one like FORWARD 1.5");
    const auto verb = verbNamed(words.front().text);
    if (!verb) return refuse(CommandError::Kind::Unknown, unknownCommand(words.front().text));
    const VerbFacts& facts = factsOf(*verb);
    const std::size_t wanted = facts.value_name.empty() ? 1 : 2;
    if (words.size() < wanted) {
        return refuse(CommandError::Kind::Syntax,
                      join({facts.name, " wants its ", facts.value_name, " in ", facts.unit,
                            ", like ", facts.example}));
    }
    if (words.size() > wanted) {
        return refuse(CommandError::Kind::Syntax,
                      join({facts.name, wanted == 1 ? " takes no value" : " takes one number",
                            ", found ", excerpt(words[wanted].text), " behind it"}));
    }
    if (wanted == 1) return {Command{*verb, 0}, {}};
    return parseValue(facts, words.back().text);
}

}  // namespace ispace
