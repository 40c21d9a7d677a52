// SPDX-License-Identifier: GPL-3.0-or-later
// ispace: the program that all tools are. It runs the one of the name by which it was called, or of
// its first word, as in `ispace scan …`; `ispace help scan` runs man.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "base/json_writer.h"
#include "base/message.h"
#include "cli/run_tool.h"
#include "tools.h"

namespace {

namespace fs = std::filesystem;
using namespace ispace;

struct Tool {
    std::string_view name, summary;
    int (*run)(int argc, char** argv);
};

/// In the order of a pipeline; the summaries are those of the manual pages.
constexpr auto kTools = std::to_array<Tool>({
    {"envc", "compile, check, convert, edit and draw rooms", runEnvc},
    {"arrange", "compute poses for sensors in a room", runArrange},
    {"scan", "simulate the readings of sensors in a room", runScan},
    {"coverage", "measure and draw the floor that sensors cover", runCoverage},
    {"simrun", "simulate the robots and sensors of a room and serve them over TCP", runSimrun},
});

constexpr std::string_view kUsage =
    "Usage: ispace TOOL [ARGUMENT]...\n"
    "       ispace help [PAGE]\n"
    "Run a tool of ispace, or open its manual page.\n\nTools:\n";

constexpr std::string_view kRest =
    "\nPages: those of the tools, and env, 3dm, yaml (formats), protocol, wire,\n"
    "ros, stability, golden-diff, sweep.\n"
    "\nOptions:\n"
    "  --errors text|json  messages on stderr as lines for people, or as a JSON\n"
    "                      object each, here and of TOOL (default text)\n"
    "  -h, --help          show this help and exit\n"
    "  -V, --version       show version and licence and exit; with --json as JSON\n"
    "\nExamples:\n"
    "  ispace coverage room.env layout.3dm -o map.png\n"
    "  ispace help scan\n"
    "\nDetails: man ispace\n";

std::string helpText() {
    constexpr std::size_t kColumn = 12;
    std::string text(kUsage);
    for (const Tool& tool : kTools) {
        text.append("  ").append(tool.name).append(kColumn - 2 - tool.name.size(), ' ');
        text.append(tool.summary).append("\n");
    }
    return text.append(kRest);
}

const Tool* toolOf(std::string_view name) {
    const auto* const found = std::ranges::find(kTools, name, &Tool::name);
    return found == kTools.end() ? nullptr : found;
}

/// Returns words as main() has them, with a null at the end.
std::vector<char*> pointersTo(std::vector<std::string>& words) {
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return pointers;
}

/// Executes `file`, which execvp looks up in PATH if it has no slash. \throws std::system_error
[[noreturn]] void become(const std::string& file, std::vector<std::string> words) {
    ::execvp(file.c_str(), pointersTo(words).data());
    throw std::system_error(errno, std::generic_category(), file);
}

/// Finds the file of a page, compressed or not: `scan` is man1/scan.1, `env` is
/// man5/ispace-env.5.gz. Packages may add to the section (scan.1ispace). "" if it is missing.
std::string pageFile(const std::string& page) {
    const std::array<std::string, 2> names = {page, "ispace-" + page};
    for (const std::string& name : names)
        for (const char section : {'1', '5', '7'}) {
            const fs::path folder =
                fs::path(programPrefix()) / "share" / "man" / (std::string("man") + section);
            std::error_code error;
            for (const auto& entry : fs::directory_iterator(folder, error))
                if (entry.path().filename().string().starts_with(name + '.' + section))
                    return entry.path().string();
        }
    return "";
}

[[noreturn]] void openPage(const std::string& page) {
    const bool is_name = !page.empty() && page.find('/') == std::string::npos;
    const std::string file = is_name ? pageFile(page) : "";
    if (file.empty())
        throw UsageError("no manual page " + excerpt(page) + " is installed (see ispace --help)");
    try {
        become("man", {"man", file});
    } catch (const std::system_error& error) {
        if (error.code() != std::errc::no_such_file_or_directory) throw;
        throw std::runtime_error("the program man is not installed (Debian: man-db), which shows " +
                                 file);
    }
}

/// Takes `--errors FORM` from the front: it holds for this program, and for the tool that follows.
void takeErrors(std::vector<std::string>& words) {
    constexpr std::string_view kErrors = "--errors";
    if (words.empty() || !words.front().starts_with(kErrors)) return;
    std::string form = words.front().substr(kErrors.size());
    const bool is_pair = form.empty() && words.size() > 1;
    form = is_pair ? words[1] : form.starts_with('=') ? form.substr(1) : "";
    if (form != "text" && form != "json")
        throw UsageError("--errors: " + excerpt(form) + " is not text or json");
    words.erase(words.begin(), words.begin() + (is_pair ? 2 : 1));
    if (form == "json") selectMessageForm(MessageForm::Json);
    if (!words.empty() && toolOf(words.front()) != nullptr)
        words.insert(words.begin() + 1, std::string(kErrors) + '=' + form);
}

std::string versionObject() {
    JsonWriter json;
    beginReport(json, "ispace-version/1", "ispace").key("licence").value("GPL-3.0-or-later");
    json.endObject();
    return json.take() + '\n';
}

/// Returns the tool to run, with its words; does all else itself.
const Tool* begin(std::vector<std::string>& words) {
    takeErrors(words);
    std::vector<std::string> known = {"help"};
    for (const Tool& tool : kTools) known.emplace_back(tool.name);
    if (words.empty()) throw UsageError("which tool? (see ispace --help)");
    const std::string& first = words.front();
    if (const Tool* const tool = toolOf(first)) return tool;
    const bool is_help = first == "help" || first == "-h" || first == "--help";
    const bool is_version = first == "-V" || first == "--version";
    if (is_version && words.size() == 2 && words.back() == "--json")
        throw TextRequested{versionObject()};
    if (words.size() > (first == "help" ? 2 : 1) && (is_help || is_version))
        throw UsageError("too many operands: " + shellQuote(words.back()) + " (see ispace --help)");
    if (first == "help") openPage(words.size() == 1 ? "ispace" : words[1]);
    if (is_help) throw TextRequested{helpText()};
    if (is_version)
        throw TextRequested{"ispace " + std::string(version()) +
                            "\nLicence GPL-3.0-or-later; there is no warranty.\n"};
    const std::string what = first.starts_with('-') ? "unknown option " : "unknown tool ";
    const std::string meant =
        first == "sweep" ? ": ispace-sweep is a program of its own" : didYouMean(first, known);
    throw UsageError(what + excerpt(first) + meant + " (see ispace --help)");
}

}  // namespace

int main(int argc, char** argv) {
    const std::string called = argc > 0 ? fs::path(argv[0]).filename().string() : "";
    if (const Tool* const tool = toolOf(called)) return tool->run(argc, argv);
    if (called == "golden-diff") return runGoldenDiff(argc, argv);
    std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
    const Tool* tool = nullptr;
    const int status = runTool("ispace", [&] { tool = begin(words); });
    if (tool == nullptr) return status;
    std::vector<char*> pointers = pointersTo(words);
    return tool->run(static_cast<int>(words.size()), pointers.data());
}
