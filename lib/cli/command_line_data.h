// SPDX-License-Identifier: GPL-3.0-or-later
// What CommandLine keeps, for the files that declare, parse and print options.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "cli/command_line.h"

namespace ispace {

/// -MD and -MF are written as compilers have them; CLI11 knows them as --MD and --MF.
inline bool isCompilerName(std::string_view name) { return name == "MD" || name == "MF"; }

/// "--output", "-X" where that is the only name, "-MF"
inline std::string nameOf(const CLI::Option& option) {
    const std::string name = option.get_name();
    return isCompilerName(std::string_view(name).substr(2)) ? name.substr(1) : name;
}

struct CommandLine::Data {
    struct Entry {
        CLI::Option* option;
        std::string value, help;
        Enters enters;
        /// Of options whose order among each other counts.
        std::function<void(const std::string&)> take = {};
    };

    std::string tool, synopsis, summary;
    std::string statuses = "0 done, 1 bad data or failed I/O, 2 usage, 3 requirement not met";
    CLI::App app;
    std::vector<Entry> entries;
    bool help = false, version = false;
    std::vector<std::string> unused_operands;
    std::vector<std::string>* operands = &unused_operands;
    std::size_t max_operands = 0;
    const bool* many = nullptr;                  // where it is set there may be more
    std::map<std::string, std::string> renamed;  // options that there are not: hints
    std::function<void()> check = [] {};  // of options against each other, once all are known

    CLI::Option* keep(CLI::Option* option, const std::string& value, const std::string& text,
                      Enters enters) {
        entries.push_back({option, value, text, enters, {}});
        return option;
    }
    [[noreturn]] void usage(const std::string& message) const {
        throw UsageError(message + " (see " + tool + " --help)");
    }
    /// In our words: an option without its value, or given too often.
    void explain(const std::string& mismatch) const;
    void sortOut(const std::vector<std::string>& words);
    [[nodiscard]] std::string hintFor(const std::string& unknown) const;
    /// Calls visit(entry, text) for the ordered options as they came.
    template <typename Visit>
    void forEachOrdered(Visit visit) const {
        std::map<const CLI::Option*, std::size_t> used;
        for (const CLI::Option* option : app.parse_order())
            for (const Entry& entry : entries)
                if (entry.option == option && entry.take)
                    visit(entry, option->results().at(used[option]++));
    }
    /// Calls visit(name, value or null, entry) for what enters the history, in the man page's
    /// order.
    template <typename Visit>
    void forEachResult(Visit visit) const;
};

}  // namespace ispace
