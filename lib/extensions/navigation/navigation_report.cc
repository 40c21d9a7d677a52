// SPDX-License-Identifier: GPL-3.0-or-later
// One table names the figures for JSON, text and --require, and says for each whether more is
// better.
#include "extensions/navigation/navigation_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"
#include "report/coverage_report.h"

namespace ispace::navigation {

namespace {

enum class FigureForm { Flag, Count, Number };

/// A figure that requirements name, and that JSON has as a member.
struct NavigationFigure {
    std::string_view key, words;
    FigureForm form = FigureForm::Number;
    bool is_least = false;  ///< more is better
    std::optional<double> (*of)(const NavigationFigures&);
};

double countOf(std::size_t number) { return static_cast<double>(number); }

using Figures = NavigationFigures;
using Maybe = std::optional<double>;
constexpr std::array kFigures = {
    NavigationFigure{"success", "goal reached", FigureForm::Flag, true,
                     [](const Figures& f) -> Maybe { return f.success ? 1 : 0; }},
    NavigationFigure{"time", "time to goal, s", FigureForm::Number, false,
                     [](const Figures& f) { return f.time; }},
    NavigationFigure{"duration", "judged, s", FigureForm::Number, false,
                     [](const Figures& f) -> Maybe { return f.duration; }},
    NavigationFigure{"path", "path, m", FigureForm::Number, false,
                     [](const Figures& f) -> Maybe { return f.path; }},
    NavigationFigure{"way", "shortest way, m", FigureForm::Number, false,
                     [](const Figures& f) { return f.way; }},
    NavigationFigure{"path_ratio", "path / shortest way", FigureForm::Number, false,
                     [](const Figures& f) { return f.ratio; }},
    NavigationFigure{"spl", "SPL", FigureForm::Number, true,
                     [](const Figures& f) { return f.spl; }},
    NavigationFigure{"speed", "mean speed, m/s", FigureForm::Number, true,
                     [](const Figures& f) -> Maybe { return f.speed; }},
    NavigationFigure{"min_distance", "least distance to people, m", FigureForm::Number, true,
                     [](const Figures& f) { return f.nearest; }},
    NavigationFigure{"intimate", "intrusions nearer than 0.45 m", FigureForm::Count, false,
                     [](const Figures& f) -> Maybe { return countOf(f.intimate.count); }},
    NavigationFigure{"intimate_time", "and their time, s", FigureForm::Number, false,
                     [](const Figures& f) -> Maybe { return f.intimate.seconds; }},
    NavigationFigure{"personal", "intrusions nearer than 1.2 m", FigureForm::Count, false,
                     [](const Figures& f) -> Maybe { return countOf(f.personal.count); }},
    NavigationFigure{"personal_time", "and their time, s", FigureForm::Number, false,
                     [](const Figures& f) -> Maybe { return f.personal.seconds; }},
    NavigationFigure{"stops", "stops", FigureForm::Count, false,
                     [](const Figures& f) -> Maybe { return countOf(f.stops); }},
    NavigationFigure{"still_time", "time not moving, s", FigureForm::Number, false,
                     [](const Figures& f) -> Maybe { return f.still; }},
    NavigationFigure{"jerk", "mean jerk, m/s^3", FigureForm::Number, false,
                     [](const Figures& f) { return f.jerk; }},
    NavigationFigure{"max_jerk", "greatest jerk, m/s^3", FigureForm::Number, false,
                     [](const Figures& f) { return f.greatest_jerk; }},
    NavigationFigure{"person_collisions", "collisions with people", FigureForm::Count, false,
                     [](const Figures& f) -> Maybe { return countOf(f.with_people); }},
    NavigationFigure{"thing_collisions", "with walls and things", FigureForm::Count, false,
                     [](const Figures& f) -> Maybe { return countOf(f.with_things); }},
    NavigationFigure{"robot_collisions", "with robots", FigureForm::Count, false,
                     [](const Figures& f) -> Maybe { return countOf(f.with_robots); }},
    NavigationFigure{"people_collisions", "between people", FigureForm::Count, false,
                     [](const Figures& f) -> Maybe { return countOf(f.between_people); }},
};

std::string valueText(const NavigationFigure& figure, Maybe value) {
    if (!value) return "-";
    switch (figure.form) {
        case FigureForm::Flag:
            return *value > 0 ? "yes" : "no";
        case FigureForm::Count:
            return formatFixed(*value, 0);
        case FigureForm::Number:
            break;
    }
    return formatFixed(*value, 3);
}

const NavigationFigure* figureNamed(std::string_view name) {
    const auto found = std::find_if(kFigures.begin(), kFigures.end(),
                                    [&](const NavigationFigure& one) { return one.key == name; });
    return found == kFigures.end() ? nullptr : &*found;
}

}  // namespace

NavigationRequirement parseNavigationRequirement(const std::string& text) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const std::string name = text.substr(0, equals);
    const NavigationFigure* const figure = figureNamed(name);
    if (figure == nullptr) {
        std::string names;
        for (const NavigationFigure& one : kFigures) {
            if (!names.empty()) names += ", ";
            names += one.key;
        }
        throw UsageError("--require: " + excerpt(text) + " names no figure of navigation: " +
                         names + ", as in success, spl=0.8 or stops=2");
    }
    if (figure->form == FigureForm::Flag && equals == text.size()) return {name, 1, text};
    const std::optional<double> number =
        parseDouble(text.substr(std::min(equals + 1, text.size())));
    if (!number) throw UsageError("--require: " + excerpt(text) + " needs a number after the =");
    return {name, *number, text};
}

std::string unmetText(const NavigationRequirement& requirement,
                      const NavigationJudgement& judgement) {
    const NavigationFigure& figure = *figureNamed(requirement.figure);
    Maybe value = figure.of(judgement.figures);
    if (!value && figure.key == "min_distance") value = std::numeric_limits<double>::infinity();
    const bool is_met =
        value && (figure.is_least ? *value >= requirement.bound : *value <= requirement.bound);
    if (is_met) return "";
    if (figure.form == FigureForm::Flag) return "the goal is not reached";
    return requirement.figure + " is " + valueText(figure, value) + ", required is " +
           (figure.is_least ? "at least " : "at most ") + formatDouble(requirement.bound) + " (" +
           requirement.text + ")";
}

std::string navigationJson(const NavigationJudgement& judgement) {
    JsonWriter json;
    json.beginObject().key("schema").value("ispace-navigation/1");
    json.key("tool").value("coverage").key("version").value(version());
    json.key("run").value(judgement.run).key("robot").value(judgement.robot);
    json.key("goal").beginArray().value(judgement.goal.place.x).value(judgement.goal.place.y);
    json.endArray().key("room");
    if (judgement.room.empty())
        json.null();
    else
        json.value(judgement.room);
    json.key("reach").value(judgement.goal.reach);
    for (const NavigationFigure& figure : kFigures) {
        json.key(figure.key);
        const Maybe value = figure.of(judgement.figures);
        if (value && figure.form == FigureForm::Flag)
            json.value(*value > 0);
        else if (value && figure.form == FigureForm::Count)
            json.value(static_cast<std::int64_t>(*value));
        else
            json.value(value);
    }
    return json.endObject().take() + '\n';
}

std::string navigationText(const NavigationJudgement& judgement) {
    std::vector<TextRow> rows;
    rows.reserve(kFigures.size());
    for (const NavigationFigure& figure : kFigures)
        rows.push_back(
            {std::string(figure.words), valueText(figure, figure.of(judgement.figures))});
    const std::string room = judgement.room.empty() ? "" : printable(judgement.room) + "/";
    return "robot " + printable(judgement.robot) + " of run " + printable(judgement.run) + " to " +
           room + formatDouble(judgement.goal.place.x) + "," +
           formatDouble(judgement.goal.place.y) + ", at most " +
           formatDouble(judgement.goal.reach) + " m from it\n" + aligned(rows, "lr");
}

}  // namespace ispace::navigation
