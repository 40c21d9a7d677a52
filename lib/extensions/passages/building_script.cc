// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of scripts: trips and rides are checked by the run's own parsers, all else by those of a
// room.
#include "extensions/passages/building_script.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "record/text.h"
#include "sim/simulation.h"

namespace ispace::passages {

namespace {

/// Returns the reason why the world rejects a command of a mover in this room, or "".
std::string refusalOf(const BuildingRun& run, std::size_t room, const std::string& mover,
                      const Command& command) {
    const World& world = run.world(room);
    return world.refusal(world.moverNamed(mover).value(), command);
}

}  // namespace

BuildingScript::BuildingScript(std::string_view text, const std::string& file,
                               const BuildingRun& run) {
    Diagnostics findings;
    LineReader reader(text);
    while (const auto whole = reader.next()) {
        const std::string_view bytes = whole->substr(0, whole->find('#'));
        const std::vector<Piece> words = wordsOf(bytes);
        if (words.empty()) continue;
        const auto fault = [&](std::size_t word, const std::string& message) {
            findings.add({file, reader.number(), words[word].column, message});
        };
        Line line;
        const auto time = parseSimTime(words[0].text);
        if (!time) {
            fault(0, excerpt(words[0].text) + " is no time in seconds from 0 on");
            continue;
        }
        if (words.size() < 3) {
            fault(words.size() - 1, "wanted TIME MOVER COMMAND");
            continue;
        }
        line.time = *time;
        line.mover = words[1].text;
        const auto room = run.roomOf(line.mover);
        if (!room) {
            fault(1, "no robot or person " + excerpt(words[1].text));
            continue;
        }
        const std::string verb = upperCase(words[2].text);
        const bool has_storey =
            words.size() > 3 && words[3].text.find('/') != std::string_view::npos;
        if (verb == "RIDE" && words.size() == 5) {
            line.lift = words[3].text;
            line.storey = words[4].text;
            if (const std::string refusal = run.stopRefusal(line.lift, line.storey);
                !refusal.empty())
                fault(3, refusal);
        } else if ((verb == "GOTO" && words.size() > 3) || (verb == "PATH" && has_storey)) {
            std::vector<std::string_view> texts = {verb};
            for (std::size_t i = 3; i < words.size(); ++i) texts.push_back(words[i].text);
            ParsedTrip trip = parseTrip(texts, run.rooms(), *room);
            if (!trip.fault.empty()) fault(trip.word + 2, trip.fault);
            line.plan = std::move(trip.plan);
        } else {
            const auto begin = static_cast<std::size_t>(words[2].text.data() - bytes.data());
            const ParsedCommand parsed = parseCommand(bytes.substr(begin));
            if (!parsed.command)
                fault(2, parsed.error.message);
            else if (const std::string refusal = refusalOf(run, *room, line.mover, *parsed.command);
                     !refusal.empty())
                fault(2, refusal);
            else
                line.command = *parsed.command;
        }
        lines_.push_back(std::move(line));
    }
    findings.throwIfAny();
    std::stable_sort(lines_.begin(), lines_.end(),
                     [](const Line& a, const Line& b) { return a.time < b.time; });
}

void BuildingScript::give(BuildingRun& run) {
    const SimTime now = run.world(0).time();
    for (; next_ < lines_.size() && lines_[next_].time <= now; ++next_) {
        const Line& line = lines_[next_];
        const std::size_t room = run.roomOf(line.mover).value();
        const std::string refusal = give(line, run, room);
        if (!refusal.empty())
            run.rooms()[room].simulation->events().add(EventKind::Mark, "script: " + refusal,
                                                       line.mover);
    }
}

std::string BuildingScript::give(const Line& line, BuildingRun& run, std::size_t room) {
    if (!line.lift.empty() || !line.plan.points.empty()) {
        const TripAnswer answer = line.lift.empty() ? run.travel(line.mover, line.plan)
                                                    : run.ride(line.mover, line.lift, line.storey);
        if (const auto& point = answer.unreached)
            run.rooms()[room].simulation->events().notify({.kind = EventKind::Unreached,
                                                           .id = line.mover,
                                                           .other = run.rooms()[point->room].id,
                                                           .place = point->at,
                                                           .text = answer.refusal});
        return answer.refusal;
    }
    if (std::string refusal = refusalOf(run, room, line.mover, line.command); !refusal.empty())
        return refusal;
    const bool stops = line.command.verb == Verb::Stop;
    std::string busy = run.endTrip(line.mover, stops ? Outcome::Stopped : Outcome::Replaced);
    if (!busy.empty()) return busy;
    World& world = run.rooms()[room].simulation->world();
    world.command(world.moverNamed(line.mover).value(), line.command);
    return "";
}

}  // namespace ispace::passages
