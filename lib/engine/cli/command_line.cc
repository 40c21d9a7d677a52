// SPDX-License-Identifier: GPL-3.0-or-later
// Parses a command line, explains its errors, and lists its options for --help, for the history of
// the product and for reruns.
//
// CLI11 parses options that it knows and leaves the rest: unknown options and surplus operands are
// sorted out and explained here. Before it, words are rewritten that it cannot parse: -MD and -MF
// FILE, an option whose number may be left out, and a word behind --help.
#include "cli/command_line.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "cli/command_text.h"
#include "cli/guesses.h"
#include "cli/outputs.h"
#include "cli/run_tool.h"
#include "record/schema.h"

namespace ispace {

namespace {

/// -MD and -MF are written as compilers have them; CLI11 knows them as --MD and --MF.
bool isCompilerName(std::string_view name) { return name == "MD" || name == "MF"; }

/// "--output", "-X" where that is the only name, "-MF"
std::string shown(const std::string& name) {
    return isCompilerName(std::string_view(name).substr(2)) ? name.substr(1) : name;
}
std::string nameOf(const CLI::Option& option) { return shown(option.get_name()); }

/// The heading of the options before the first group.
constexpr const char* kMainGroup = "Main options";

/// Returns the words of a heading in small letters, but for articles.
std::vector<std::string> wordsOf(const std::string& title) {
    std::vector<std::string> words;
    std::string word;
    for (const char c : title + ' ') {
        if (c != ' ' && c != ',') {
            word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        } else if (!word.empty()) {
            if (word != "the" && word != "a") words.push_back(word);
            word.clear();
        }
    }
    return words;
}

}  // namespace

struct CommandLine::Data {
    struct Entry {
        CLI::Option* option;
        std::string value, help;
        Enters enters;
        /// Of options that keep their relative order.
        std::function<void(const std::string&)> take = {};
    };

    std::string tool, synopsis, summary;
    struct Group {
        std::size_t first;  ///< index of its first entry
        std::string title, extension;
    };
    std::vector<Group> groups = {{0, kMainGroup, ""}};
    std::string extension;
    std::set<const CLI::Option*> essential;
    std::optional<std::vector<std::string>> built;              ///< extensions, if they are known
    std::string about;                                          ///< what --help was asked for
    std::vector<std::pair<std::string, std::string>> examples;  // commands and their effects
    std::string statuses = "0 done, 1 bad data or failed I/O, 2 usage, 3 requirement not met";
    CLI::App app;
    std::vector<Entry> entries;
    bool help = false, version = false;
    std::vector<std::string> unused_operands;
    std::vector<std::string>* operands = &unused_operands;
    std::size_t max_operands = 0;
    const bool* many = nullptr;                  // if set, there may be more
    std::map<std::string, std::string> renamed;  // removed options and their hints
    std::map<std::string, std::string> values;   // of options that may stand without one
    std::function<void()> check = [] {};  // of options against each other, once all are known

    [[nodiscard]] std::size_t endOf(std::size_t group) const {
        return group + 1 < groups.size() ? groups[group + 1].first : entries.size();
    }
    [[nodiscard]] std::vector<std::size_t> groupsAbout(const std::string& word) const;
    [[nodiscard]] std::string wordOf(std::size_t group) const;
    void takeHelpWord(std::vector<std::string>& words);

    void keep(CLI::Option* option, const std::string& value, const std::string& text,
              Enters enters) {
        entries.push_back({option, value, text, enters, {}});
    }
    [[noreturn]] void usage(const std::string& message) const {
        throw UsageError(message + " (see " + tool + " --help)");
    }
    /// Rejects an option without its value, or given too often, in our words.
    void explain(const std::string& mismatch) const {
        for (const Entry& entry : entries) {
            const CLI::Option& option = *entry.option;
            if (!mismatch.starts_with(option.get_name() + ": ")) continue;
            if (option.count() > 1)
                usage(nameOf(option) + ": may be given once, and is given " +
                      std::to_string(option.count()) + " times");
            usage(nameOf(option) + ' ' + entry.value + ": the value is missing");
        }
    }
    /// Adds the value of an option that may stand without one where no number follows it.
    void addValues(std::vector<std::string>& words) const {
        for (std::size_t i = 0; i < words.size(); ++i) {
            const auto value = values.find(words[i]);
            const bool has_number = i + 1 < words.size() && parseInteger(words[i + 1]).has_value();
            if (value != values.end() && !has_number) words[i] += '=' + value->second;
        }
    }
    void sortOut(const std::vector<std::string>& words) {
        bool options_ended = false;
        for (const std::string& word : words) {
            if (!options_ended && word == "--") {
                options_ended = true;
            } else if (!options_ended && word.size() > 1 && word.starts_with('-')) {
                usage("unknown option " + shellQuote(word) +
                      hintFor(word.substr(0, word.find('='))));
            } else if (word.empty()) {
                usage("an operand is empty");
            } else {
                operands->push_back(word);
            }
        }
        if (operands->size() > max_operands && !(many != nullptr && *many))
            usage(
                "too many operands: " + shellQuote((*operands)[max_operands]) +
                ((*operands)[max_operands].ends_with(".3dm")
                     ? ": one layout is read; `envc ENV LAYOUT --add RECORD -o FILE.3dm` adds to it"
                     : ""));
    }
    [[nodiscard]] std::string hintFor(const std::string& unknown) const {
        if (const auto hint = renamed.find(unknown); hint != renamed.end())
            return ": " + hint->second;
        if (const std::string advice = guessAdvice(tool, unknown); !advice.empty())
            return ": " + advice;
        std::vector<std::string> known;
        for (const Entry& entry : entries)
            for (const std::string& name : entry.option->get_lnames()) known.push_back("--" + name);
        return didYouMean(unknown, known);
    }
    /// Calls visit(entry, text) for the ordered options as they came.
    template <typename Visit>
    void forEachOrdered(Visit visit) const {
        std::map<const CLI::Option*, std::size_t> used;
        for (const CLI::Option* option : app.parse_order())
            for (const Entry& entry : entries)
                if (entry.option == option && entry.take)
                    visit(entry, option->results().at(used[option]++));
    }
    /// Calls visit(name, value or null, entry) for the options that enter the history, in the man
    /// page's order.
    template <typename Visit>
    void forEachResult(Visit visit) const {
        bool ordered_done = false;
        for (const Entry& entry : entries) {
            const CLI::Option& option = *entry.option;
            if (entry.enters == Enters::Nothing || option.count() == 0) continue;
            if (entry.take) {
                // At the man page's position of the first one, all follow in the order of the
                // command line.
                if (!std::exchange(ordered_done, true))
                    forEachOrdered([&](const Entry& one, const std::string& text) {
                        visit(nameOf(*one.option), &text, one);
                    });
            } else if (entry.value.empty()) {
                visit(nameOf(option), nullptr, entry);
            } else {
                for (const std::string& value : option.results())
                    visit(nameOf(option), &value, entry);
            }
        }
    }
};

/// Returns the groups with `word` as their heading; else those of the extension `word`, or with it
/// as the first word of the heading; else with it in the heading; else with a word that begins so.
std::vector<std::size_t> CommandLine::Data::groupsAbout(const std::string& word) const {
    using Test = bool (*)(const Group&, const std::string&);
    constexpr auto kTests = std::to_array<Test>({
        [](const Group& group, const std::string& text) {
            const std::vector<std::string> words = wordsOf(group.title);
            return words.size() == 1 && words.front() == text;
        },
        [](const Group& group, const std::string& text) {
            return group.extension == text || wordsOf(group.title).front() == text;
        },
        [](const Group& group, const std::string& text) {
            const std::vector<std::string> words = wordsOf(group.title);
            return std::find(words.begin(), words.end(), text) != words.end();
        },
        [](const Group& group, const std::string& text) {
            const std::vector<std::string> words = wordsOf(group.title);
            return std::any_of(words.begin(), words.end(),
                               [&](const std::string& one) { return one.starts_with(text); });
        },
    });
    std::vector<std::size_t> found;
    for (const Test test : kTests) {
        for (std::size_t i = 0; i < groups.size() && !word.empty(); ++i)
            if (test(groups[i], word)) found.push_back(i);
        if (!found.empty()) break;
    }
    return found;
}

/// Returns a word that stands for a group alone, if there is one.
std::string CommandLine::Data::wordOf(std::size_t group) const {
    std::vector<std::string> words = wordsOf(groups[group].title);
    words.push_back(groups[group].extension);
    for (const std::string& word : words)
        if (groupsAbout(word) == std::vector<std::size_t>{group}) return word;
    return words.front();
}

/// Takes the word behind --help, or joined to it by =, out of a command line; the last word may be
/// an option with a value, as --seed. A name of a file is an operand.
void CommandLine::Data::takeHelpWord(std::vector<std::string>& words) {
    for (std::size_t i = 0; i < words.size(); ++i) {
        constexpr std::string_view kJoined = "--help=";
        if (words[i].starts_with(kJoined)) {
            about = words[i].substr(kJoined.size());
            words[i] = "--help";
        }
        if (words[i] != "--help" && words[i] != "-h") continue;
        if (!about.empty() || i + 1 == words.size()) return;
        const std::string next = words[i + 1];
        const CLI::Option* const option = app.get_option_no_throw(next);
        // Its value is missing, so that it is a question.
        const bool asks_for_option = option != nullptr && i + 2 == words.size() &&
                                     option->get_items_expected_min() > 0 && next.starts_with("--");
        if (next.empty() || (next.starts_with('-') && !asks_for_option)) return;
        if (next.find_first_of("./") != std::string::npos) return;
        about = next;
        words.erase(words.begin() + static_cast<std::ptrdiff_t>(i) + 1);
        return;
    }
}

CommandLine::CommandLine(std::string tool, std::string synopsis, std::string summary)
    : data_(std::make_unique<Data>()) {
    data_->tool = std::move(tool);
    data_->synopsis = std::move(synopsis);
    data_->summary = std::move(summary);
    data_->app.set_help_flag();
    data_->app.allow_extras();
    flag("-h,--help", data_->help,
         "show this help and exit; --help WORD prints a group of options, or one, --help all all",
         Enters::Nothing);
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
    return [last = shown(names.substr(names.rfind(',') + 1)), take = std::move(take),
            data = data_.get()](const std::string& s) {
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

/// Parses a whole number in [lowest, highest] into `variable`.
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

/// Parses a length or a time in [lowest, highest] into `variable`.
template <typename Number>
auto takeQuantity(Number& variable, Unit unit, double lowest, double highest) {
    return [&variable, unit, lowest, highest](const std::string& text) {
        KeySpec key;
        key.unit = unit;
        const double value = std::get<double>(parseValue(key, text));
        if (value < lowest || value > highest)
            throw UsageError('`' + text + "` is not from " + formatDouble(lowest) + " to " +
                             formatDouble(highest) + (unit == Unit::Time ? " seconds" : " metres"));
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

void CommandLine::countOr(const std::string& name, std::optional<int>& variable, int otherwise,
                          int lowest, int highest, const std::string& help, Enters enters) {
    data_->values[name] = std::to_string(otherwise);
    parsed(name, "[N]", takeCount(variable, lowest, highest),
           help + " (default " + std::to_string(otherwise) + ")", enters);
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
                         std::vector<std::string> words, const std::string& help, Enters enters,
                         std::string_view (*missing)(std::string_view word)) {
    std::string list;
    for (const std::string& word : words) list += (list.empty() ? "" : "|") + word;
    const auto take = [&variable, words = std::move(words), list, missing](const std::string& s) {
        const std::string extension(missing != nullptr ? missing(s) : "");
        if (!extension.empty())
            throw UsageError('`' + s + "`: it belongs to the extension " + extension +
                             ", which this build lacks");
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

void CommandLine::group(const std::string& title) {
    data_->groups.push_back({data_->entries.size(), title, data_->extension});
}

void CommandLine::extension(const std::string& name) { data_->extension = name; }

void CommandLine::built(std::span<const std::string_view> extensions) {
    data_->built.emplace(extensions.begin(), extensions.end());
}

void CommandLine::essential(std::initializer_list<std::string_view> names) {
    data_->essential.insert(data_->app.get_option("--help"));
    for (const std::string_view name : names)
        data_->essential.insert(data_->app.get_option(std::string(name)));
}

void CommandLine::example(const std::string& command, const std::string& effect) {
    data_->examples.emplace_back(command, effect);
}

void CommandLine::operands(std::vector<std::string>& variable, std::size_t most) {
    data_->operands = &variable;
    data_->max_operands = most;
}

void CommandLine::manyOperandsWith(const bool& flag) { data_->many = &flag; }

bool CommandLine::given(const std::string& name) const {
    const CLI::Option* const option = data_->app.get_option_no_throw(name);
    return option != nullptr && option->count() > 0;
}

std::vector<std::string> CommandLine::valuesOf(const std::string& name) const {
    return given(name) ? data_->app.get_option(name)->results() : std::vector<std::string>{};
}

std::vector<std::string> CommandLine::names() const {
    std::vector<std::string> names;
    for (const Data::Entry& entry : data_->entries) {
        const CLI::Option& option = *entry.option;
        names.push_back(option.get_lnames().empty() ? '-' + option.get_snames().front()
                                                    : "--" + option.get_lnames().front());
    }
    return names;
}

namespace {

/// Converts -MD, -MF FILE and -MFFILE to names that CLI11 can parse.
void rewriteCompilerNames(std::vector<std::string>& words) {
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (!words[i].starts_with("-M") || !isCompilerName(words[i].substr(1, 2))) continue;
        const std::string joined = words[i].substr(3);
        words[i] = "-" + words[i].substr(0, 3);
        if (!joined.empty()) words[i] += '=' + joined;
    }
}

}  // namespace

void CommandLine::parse(int argc, const char* const* argv) {
    Data& d = *data_;
    std::vector<std::string> words(argv + 1, argv + argc);
    // CLI11 takes words from the back; those after "--" are withheld from it and appended.
    const auto end = std::find(words.begin(), words.end(), "--");
    const std::vector<std::string> tail(end, words.end());
    words.erase(end, words.end());
    const auto has = [&words](std::string_view word) {
        return std::find(words.begin(), words.end(), word) != words.end();
    };
    // Also of tools without reports in JSON.
    if ((has("-V") || has("--version")) && has("--json"))
        throw TextRequested{versionJson(d.tool, d.built)};
    // Selected at once, so that errors of the command line have that form.
    const std::vector<std::string> json = {"--errors", "json"};
    if (has("--errors=json") ||
        std::search(words.begin(), words.end(), json.begin(), json.end()) != words.end())
        selectMessageForm(MessageForm::Json);
    d.takeHelpWord(words);
    rewriteCompilerNames(words);
    d.addValues(words);
    std::reverse(words.begin(), words.end());
    try {
        d.app.parse(words);
    } catch (const CLI::ArgumentMismatch& error) {
        d.explain(error.what());
        d.usage(error.what());
    } catch (const CLI::ParseError& error) {
        d.usage(error.what());
    }
    if (d.help) throw TextRequested{helpText(d.about)};
    if (d.version) throw TextRequested{versionText(d.tool, d.built)};
    d.forEachOrdered([](const Data::Entry& entry, const std::string& text) { entry.take(text); });
    std::vector<std::string> rest = d.app.remaining();
    rest.insert(rest.end(), tail.begin(), tail.end());
    d.sortOut(rest);
    d.check();
}

namespace {

/// "-o, --output FILE"
std::string signature(const CLI::Option& option, const std::string& value) {
    std::string names;
    for (const std::string& name : option.get_snames()) names += "-" + name + ", ";
    for (const std::string& name : option.get_lnames()) names += shown("--" + name) + ", ";
    names.resize(names.size() - 2);
    return value.empty() ? names : names + ' ' + value;
}

/// True if a text has an option's name, and not a longer one that begins with it.
bool mentions(std::string_view text, std::string_view name) {
    for (std::size_t at = text.find(name); at != std::string_view::npos;
         at = text.find(name, at + 1)) {
        const std::size_t end = at + name.size();
        const bool is_whole =
            end == text.size() || (text[end] != '-' && (text[end] < 'a' || text[end] > 'z'));
        if (is_whole) return true;
    }
    return false;
}

}  // namespace

std::string CommandLine::historyLine(const std::vector<std::string>& operands) const {
    std::string line = data_->tool;
    for (const std::string& operand : operands) line += ' ' + fileInHistory(operand);
    data_->forEachResult(
        [&line](const std::string& name, const std::string* value, const Data::Entry& entry) {
            line += ' ' + name;
            if (value == nullptr) return;
            line += ' ' + (entry.enters == Enters::BaseName    ? fileInHistory(*value)
                           : entry.enters == Enters::BaseNames ? filesInHistory(*value)
                                                               : shellQuote(*value));
        });
    return line;
}

std::vector<std::string> CommandLine::resultWords() const {
    std::vector<std::string> words = {data_->tool};
    data_->forEachResult(
        [&words](const std::string& name, const std::string* value, const Data::Entry&) {
            // A value may begin with a minus.
            const bool is_long = value != nullptr && name.starts_with("--");
            words.push_back(is_long ? name + '=' + *value : name);
            if (value != nullptr && !is_long) words.push_back(*value);
        });
    words.emplace_back("--");
    words.insert(words.end(), data_->operands->begin(), data_->operands->end());
    return words;
}

std::string CommandLine::helpText(const std::string& about) const {
    const Data& d = *data_;
    HelpPage page{d.tool,     d.synopsis, d.summary,           {}, {},
                  d.examples, d.statuses, d.built.has_value(), {}};
    const auto add = [&](std::size_t index, const std::string& heading) {
        const Data::Entry& entry = d.entries[index];
        page.options.push_back({heading, signature(*entry.option, entry.value), entry.help});
    };
    const auto add_group = [&](std::size_t group) {
        for (std::size_t i = d.groups[group].first; i < d.endOf(group); ++i)
            add(i, i == d.groups[group].first ? d.groups[group].title : "");
    };
    const bool is_short = about.empty() && !d.essential.empty();
    if (is_short) {
        for (std::size_t i = 0; i < d.entries.size(); ++i)
            if (d.essential.contains(d.entries[i].option))
                add(i, page.options.empty() ? "Options" : "");
        for (std::size_t group = 0; group < d.groups.size(); ++group) {
            std::size_t i = d.groups[group].first;
            while (i < d.endOf(group) && d.essential.contains(d.entries[i].option)) ++i;
            if (i == d.endOf(group)) continue;
            const std::string& title = d.groups[group].title;
            page.groups.push_back({d.wordOf(group), title, d.groups[group].extension});
        }
        return ispace::helpText(page);
    }
    if (about.empty() || about == "all") {
        page.extensions = d.built;
        for (std::size_t group = 0; group < d.groups.size(); ++group) add_group(group);
        return ispace::helpText(page);
    }
    page.examples.clear();
    const auto is_named = [&](std::size_t i) {
        const CLI::Option& option = *d.entries[i].option;
        return option.check_name(about) || option.check_name("--" + about);
    };
    // The word that the short page lists for a group stands for it, else that of an option.
    const std::vector<std::size_t> found = d.groupsAbout(about);
    const bool is_listed = found.size() == 1 && d.wordOf(found.front()) == about;
    for (std::size_t i = 0; i < d.entries.size() && !is_listed; ++i)
        if (is_named(i)) add(i, "Option");
    if (page.options.empty() && found.size() == 1) {
        add_group(found.front());
        return ispace::helpText(page);
    }
    // And those that speak of it.
    const std::string name = about.starts_with('-') ? about : "--" + about;
    for (std::size_t i = 0; i < d.entries.size() && !page.options.empty(); ++i)
        if (!is_named(i) && mentions(d.entries[i].help, name)) add(i, "");
    if (!page.options.empty()) return ispace::helpText(page);
    if (const auto hint = d.renamed.find(name); found.empty() && hint != d.renamed.end())
        throw UsageError("--help " + about + ": " + hint->second);
    std::string words;
    for (std::size_t group = 0; group < d.groups.size(); ++group)
        if (found.empty() || std::find(found.begin(), found.end(), group) != found.end())
            words.append(words.empty() ? "" : ", ").append(d.wordOf(group));
    throw UsageError("--help " + about +
                     (found.empty() ? ": no group and no option has this name: all, "
                                    : ": several groups have this word: ") +
                     words);
}

}  // namespace ispace
