// SPDX-License-Identifier: GPL-3.0-or-later
// golden-diff: compares the output of a tool with the expected one, numbers within a tolerance.
#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/golden.h"
#include "base/json_writer.h"
#include "base/number.h"
#include "cli/command_line.h"
#include "cli/run_tool.h"
#include "drawing/picture_difference.h"
#include "tools.h"

namespace {

using namespace ispace;

struct Options {
    std::vector<std::string> operands;
    Tolerance tolerance;
    std::vector<std::string> ignored;
    bool history = false, quiet = false;
    std::string errors = "text";  ///< parse() has selected the form already
};

auto takeTolerance(double& variable) {
    return [&variable](const std::string& text) {
        const auto number = parseDouble(text);
        if (!number || *number < 0) throw UsageError('`' + text + "` is not a number from 0 on");
        variable = *number;
    };
}

Options parseOptions(int argc, const char* const* argv) {
    Options o;
    CommandLine line("golden-diff", "EXPECTED ACTUAL",
                     "Compare two files that the tools wrote: numbers within a tolerance, history "
                     "left out, everything else byte by byte; PNGs by their pixels. - is stdin.");
    line.example("golden-diff expected.json actual.json --abs 1e-6 --ignore digest,version",
                 "report the keys of JSON that differ, but for these two");
    line.example("coverage room.env layout.3dm -o map.png && golden-diff expected.png map.png",
                 "compare two pictures by their pixels");
    line.exitStatus("0 no difference, 1 a difference, 2 trouble, as with diff");
    line.operands(o.operands, 2);
    line.group("Comparison");
    line.parsed("--abs", "X", takeTolerance(o.tolerance.absolute),
                "how far two numbers may lie apart (default 1e-9)", Enters::Nothing);
    line.parsed("--rel", "Y", takeTolerance(o.tolerance.relative),
                "this much more, times the larger of the two (default 1e-9)", Enters::Nothing);
    line.texts("--ignore", "KEY,...", o.ignored,
               "leave out these keys of JSON: a name at any depth (digest) or a path from the top "
               "(sensors.*.model)",
               Enters::Nothing);
    line.flag("--history", o.history, "compare history, too", Enters::Nothing);
    line.group("Report");
    line.flag("-q,--quiet", o.quiet, "report by the exit status alone", Enters::Nothing);
    line.choice("--errors", o.errors, {"text", "json"},
                "errors on stderr as lines for people, or as a JSON object each (default text)",
                Enters::Nothing);
    line.parse(argc, argv);
    if (o.operands.size() != 2) throw UsageError("two files are wanted, EXPECTED and ACTUAL");
    if (o.operands[0] == "-" && o.operands[1] == "-")
        throw UsageError("stdin cannot be read twice: only one operand can be -");
    return o;
}

bool isPng(const std::string& bytes) { return bytes.starts_with("\x89PNG\r\n\x1a\n"); }

/// Splits comma-separated lists.
std::vector<std::string> split(const std::vector<std::string>& lists) {
    std::vector<std::string> parts;
    for (const std::string& list : lists) {
        std::istringstream rest(list);
        for (std::string part; std::getline(rest, part, ',');) parts.push_back(part);
    }
    return parts;
}

/// Lists the differences of JSON, one a line.
std::string listOf(const std::vector<std::string>& differences) {
    constexpr std::size_t kMaxShown = 100;
    std::string list;
    for (std::size_t i = 0; i < std::min(kMaxShown, differences.size()); ++i)
        list += '\n' + differences[i];
    if (differences.size() > kMaxShown)
        list += "\nand " + std::to_string(differences.size() - kMaxShown) + " more";
    return list.empty() ? "" : ':' + list;
}

/// Returns "" if the files agree, else a text that follows "B differs from A".
std::string differenceOf(const Options& options, std::string expected, std::string actual) {
    if (isPng(expected) != isPng(actual)) return ", one is a PNG and the other is not";
    if (isPng(expected)) {
        const std::string found = pictureDifference(expected, actual);
        return found.empty() ? "" : ", " + found;
    }
    if (!options.history) {
        expected = withoutHistory(expected);
        actual = withoutHistory(actual);
    }
    if (const auto found =
            jsonDifferences(expected, actual, options.tolerance, split(options.ignored)))
        return listOf(*found);
    if (!options.ignored.empty())
        throw UsageError("--ignore leaves out keys of JSON, and these files are not JSON");
    const std::string found = textDifference(expected, actual, options.tolerance);
    return found.empty() ? "" : ", " + found;
}

/// Returns true, and reports the first difference, if the files do not agree.
bool differ(const Options& options) {
    const std::string &expected = options.operands[0], &actual = options.operands[1];
    const std::string found = differenceOf(options, readAll(expected), readAll(actual));
    if (!found.empty() && !options.quiet)
        writeAll("-",
                 displayName(actual) + " differs from " + displayName(expected) + found + '\n');
    return !found.empty();
}

}  // namespace

int ispace::runGoldenDiff(int argc, char** argv) {
    constexpr int kSame = 0, kDiffer = 1, kTrouble = 2;
    bool is_other = false;
    const int status = runTool("golden-diff", [&] { is_other = differ(parseOptions(argc, argv)); });
    if (status != 0) return kTrouble;
    return is_other ? kDiffer : kSame;
}
