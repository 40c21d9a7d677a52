// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/command_line.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "cli/command_line_data.h"
#include "cli/outputs.h"
#include "record/schema.h"

namespace ispace {

CommandLine::CommandLine(std::string tool, std::string synopsis, std::string summary)
    : data_(std::make_unique<Data>()) {
    data_->tool = std::move(tool);
    data_->synopsis = std::move(synopsis);
    data_->summary = std::move(summary);
    data_->app.set_help_flag();
    data_->app.allow_extras();
    flag("-h,--help", data_->help, "show this help and exit", Enters::Nothing);
    flag("-V,--version", data_->version, "show version and licence and exit", Enters::Nothing);
}

CommandLine::~CommandLine() = default;

void CommandLine::text(const std::string& names, const std::string& value, std::string& variable,
                       const std::string& help, Enters enters) {
    data_->keep(data_->app.add_option(names, variable), value, help, enters);
}

void CommandLine::file(const std::string& names, const std::string& value, std::string& variable,
                       const std::string& help, Enters enters) {
    const auto take = [&variable](const std::string& text) {
        if (text.empty()) throw UsageError("an empty name is given");
        variable = text;
    };
    parsed(names, value, take, help, enters);
}

void CommandLine::texts(const std::string& names, const std::string& value,
                        std::vector<std::string>& variable, const std::string& help,
                        Enters enters) {
    CLI::Option* option = data_->app.add_option(names, variable);
    option->expected(1)->allow_extra_args(false)->multi_option_policy(
        CLI::MultiOptionPolicy::TakeAll);
    data_->keep(option, value, help + " (repeatable)", enters);
}

void CommandLine::flag(const std::string& names, bool& variable, const std::string& help,
                       Enters enters) {
    data_->keep(data_->app.add_flag(names, variable)->disable_flag_override(), "", help, enters);
}

void CommandLine::flag(const std::string& names, int& variable, const std::string& help,
                       Enters enters) {
    data_->keep(data_->app.add_flag(names, variable)->disable_flag_override(), "", help, enters);
}

void CommandLine::switchFlag(const std::string& on, const std::string& off,
                             std::optional<bool>& variable, const std::string& help,
                             const std::string& off_help, Enters enters) {
    const auto add = [&](const std::string& name, bool value, const std::string& text) {
        const auto set = [&variable, value](std::int64_t) { variable = value; };
        data_->keep(data_->app.add_flag_function(name, set)->disable_flag_override(), "", text,
                    enters);
    };
    add(on, true, help);
    add(off, false, off_help);
}

void CommandLine::parsed(const std::string& names, const std::string& value,
                         std::function<void(const std::string&)> take, const std::string& help,
                         Enters enters) {
    data_->keep(data_->app.add_option_function<std::string>(names, guarded(names, std::move(take))),
                value, help, enters);
}

std::function<void(const std::string&)> CommandLine::guarded(
    const std::string& names, std::function<void(const std::string&)> take) const {
    std::string last = names.substr(names.rfind(',') + 1);
    if (isCompilerName(last.substr(2))) last.erase(0, 1);
    return [last, take = std::move(take), data = data_.get()](const std::string& s) {
        try {
            take(s);
        } catch (const UsageError& error) {
            data->usage(last + ": " + error.what());
        } catch (const FormatError& error) {
            data->usage(last + ": " + error.diagnostics().front().message);
        }
    };
}

void CommandLine::ordered(const std::string& names, const std::string& value,
                          std::function<void(const std::string&)> take, const std::string& help) {
    CLI::Option* option = data_->app.add_option(names);
    option->expected(1)->allow_extra_args(false)->multi_option_policy(
        CLI::MultiOptionPolicy::TakeAll);
    data_->keep(option, value, help + " (repeatable)", Enters::History);
    data_->entries.back().take = guarded(names, std::move(take));
}

void CommandLine::dependencies(DependencyOptions& options, const std::string& output) {
    data_->check = [&options, &output] { checkDependencies(options, output); };
    flag("--MD", options.wanted, "also write a rule for make that names all files read",
         Enters::Nothing);
    file("--MF", "FILE", options.file,
         "write that rule there (default: the product's name, then .d)", Enters::Nothing);
}

namespace {

/// Puts a whole number in [lowest, highest] into `variable`.
template <typename Number>
auto takeCount(Number& variable, int lowest, int highest) {
    return [&variable, lowest, highest](const std::string& text) {
        const auto number = parseInteger(text);
        if (!number || *number < lowest || *number > highest)
            throw UsageError('`' + text + "` is not a whole number from " + std::to_string(lowest) +
                             " to " + std::to_string(highest));
        variable = static_cast<int>(*number);
    };
}

/// Puts a length or a time in [lowest, highest] into `variable`.
template <typename Number>
auto takeQuantity(Number& variable, Unit unit, double lowest, double highest) {
    return [&variable, unit, lowest, highest](const std::string& text) {
        const bool is_time = unit == Unit::Time;
        KeySpec key;
        key.unit = unit;
        const double value = std::get<double>(parseValue(key, text));
        if (value < lowest || value > highest)
            throw UsageError('`' + text + "` is not from " + formatDouble(lowest) + " to " +
                             formatDouble(highest) + (is_time ? " seconds" : " metres"));
        variable = value;
    };
}

}  // namespace

void CommandLine::count(const std::string& names, const std::string& value,
                        std::optional<int>& variable, int lowest, int highest,
                        const std::string& help, Enters enters) {
    parsed(names, value, takeCount(variable, lowest, highest), help, enters);
}

void CommandLine::count(const std::string& names, const std::string& value, int& variable,
                        int lowest, int highest, const std::string& help, Enters enters) {
    parsed(names, value, takeCount(variable, lowest, highest),
           help + " (default " + std::to_string(variable) + ")", enters);
}

void CommandLine::meters(const std::string& names, std::optional<double>& variable, double lowest,
                         double highest, const std::string& help, Enters enters) {
    parsed(names, "M", takeQuantity(variable, Unit::Length, lowest, highest), help, enters);
}

void CommandLine::meters(const std::string& names, double& variable, double lowest, double highest,
                         const std::string& help, Enters enters) {
    parsed(names, "M", takeQuantity(variable, Unit::Length, lowest, highest),
           help + " (default " + formatDouble(variable) + " m)", enters);
}

void CommandLine::duration(const std::string& names, std::optional<double>& variable, double lowest,
                           double highest, const std::string& help, Enters enters) {
    parsed(names, "TIME", takeQuantity(variable, Unit::Time, lowest, highest), help, enters);
}

void CommandLine::duration(const std::string& names, double& variable, double lowest,
                           double highest, const std::string& help, Enters enters) {
    parsed(names, "TIME", takeQuantity(variable, Unit::Time, lowest, highest),
           help + " (default " + formatDouble(variable) + " s)", enters);
}

void CommandLine::choice(const std::string& names, std::string& variable,
                         std::vector<std::string> words, const std::string& help, Enters enters) {
    std::string list;
    for (const std::string& word : words) list += (list.empty() ? "" : "|") + word;
    const auto take = [&variable, words = std::move(words), list](const std::string& s) {
        if (std::find(words.begin(), words.end(), s) == words.end())
            throw UsageError('`' + s + "` is none of " + list + didYouMean(s, words));
        variable = s;
    };
    parsed(names, list, take, help, enters);
}

void CommandLine::renamed(const std::string& name, const std::string& hint) {
    data_->renamed[name] = hint;
}

void CommandLine::exitStatus(const std::string& text) { data_->statuses = text; }

void CommandLine::operands(std::vector<std::string>& variable, std::size_t most) {
    data_->operands = &variable;
    data_->max_operands = most;
}

void CommandLine::manyOperandsWith(const bool& flag) { data_->many = &flag; }

bool CommandLine::given(const std::string& name) const { return data_->app.count(name) > 0; }

}  // namespace ispace
