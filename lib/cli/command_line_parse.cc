// SPDX-License-Identifier: GPL-3.0-or-later
// Reading a command line, and what is wrong with one.
#include <algorithm>
#include <utility>

#include "base/message.h"
#include "base/program.h"
#include "cli/command_line_data.h"
#include "cli/run_tool.h"

namespace ispace {

namespace {

/// Turns -MD, -MF FILE and -MFFILE into what CLI11 can parse.
void rewriteCompilerNames(std::vector<std::string>& words) {
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (!words[i].starts_with("-M") || !isCompilerName(words[i].substr(1, 2))) continue;
        const std::string joined = words[i].substr(3);
        words[i] = "-" + words[i].substr(0, 3);
        if (!joined.empty()) words[i] += '=' + joined;
    }
}

}  // namespace

std::string CommandLine::Data::hintFor(const std::string& unknown) const {
    if (const auto hint = renamed.find(unknown); hint != renamed.end()) return ": " + hint->second;
    std::vector<std::string> known;
    for (const Entry& entry : entries)
        for (const std::string& name : entry.option->get_lnames()) known.push_back("--" + name);
    return didYouMean(unknown, known);
}

void CommandLine::Data::explain(const std::string& mismatch) const {
    for (const Entry& entry : entries) {
        const CLI::Option& option = *entry.option;
        if (!mismatch.starts_with(option.get_name() + ": ")) continue;
        if (option.count() > 1)
            usage(nameOf(option) + ": may be given once, and is given " +
                  std::to_string(option.count()) + " times");
        usage(nameOf(option) + ' ' + entry.value + ": the value is missing");
    }
}

void CommandLine::Data::sortOut(const std::vector<std::string>& words) {
    bool options_ended = false;
    for (const std::string& word : words) {
        if (!options_ended && word == "--") {
            options_ended = true;
        } else if (!options_ended && word.size() > 1 && word.starts_with('-')) {
            usage("unknown option " + shellQuote(word) + hintFor(word.substr(0, word.find('='))));
        } else if (word.empty()) {
            usage("an operand is empty");
        } else {
            operands->push_back(word);
        }
    }
    const bool takes_many = many != nullptr && *many;
    if (operands->size() > max_operands && !takes_many)
        usage("too many operands: " + shellQuote((*operands)[max_operands]));
}

void CommandLine::parse(int argc, const char* const* argv) {
    Data& d = *data_;
    std::vector<std::string> words(argv + 1, argv + argc);
    // CLI11 takes words from the back; what follows "--" is kept from it and put behind.
    const auto end = std::find(words.begin(), words.end(), "--");
    const std::vector<std::string> tail(end, words.end());
    words.erase(end, words.end());
    rewriteCompilerNames(words);
    std::reverse(words.begin(), words.end());
    try {
        d.app.parse(words);
    } catch (const CLI::ArgumentMismatch& error) {
        d.explain(error.what());
        d.usage(error.what());
    } catch (const CLI::ParseError& error) {
        d.usage(error.what());
    }
    if (d.help) throw TextRequested{helpText()};
    if (d.version)
        throw TextRequested{d.tool + " (ispace) " + std::string(version()) +
                            "\nLicence GPL-3.0-or-later; there is no warranty.\n"};
    d.forEachOrdered([](const Data::Entry& entry, const std::string& text) { entry.take(text); });
    std::vector<std::string> rest = d.app.remaining();
    rest.insert(rest.end(), tail.begin(), tail.end());
    d.sortOut(rest);
    d.check();
}

}  // namespace ispace
