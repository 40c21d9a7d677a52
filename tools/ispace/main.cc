// SPDX-License-Identifier: GPL-3.0-or-later
// ispace: one name for all tools. `ispace scan …` runs the program scan of the same installation,
// even if PATH has another scan; `ispace help scan` runs man.
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

namespace {

namespace fs = std::filesystem;
using namespace ispace;

struct Tool {
    std::string_view name, summary;
};

/// In the order of a pipeline; the summaries are those of the manual pages.
constexpr auto kTools = std::to_array<Tool>({
    {"envc", "compile, check, convert, edit and draw rooms"},
    {"arrange", "compute poses for sensors in a room"},
    {"scan", "simulate the readings of sensors in a room"},
    {"coverage", "measure and draw the floor that sensors cover"},
    {"simrun", "simulate the robots and sensors of a room and serve them over TCP"},
});

constexpr std::string_view kUsage =
    "Usage: ispace TOOL [ARGUMENT]...\n"
    "       ispace help [PAGE]\n"
    "Run a tool of ispace, or open its manual page.\n\nTools:\n";

constexpr std::string_view kRest =
    "\nPages: those of the tools, and env, 3dm, yaml (formats), protocol, wire,\n"
    "stability, golden-diff, sweep.\n"
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

bool isTool(std::string_view word) {
    return std::any_of(kTools.begin(), kTools.end(),
                       [word](const Tool& tool) { return tool.name == word; });
}

/// Finds a program in a separate folder if another package has a program of that name, else beside
/// this one.
fs::path programOf(const std::string& tool) {
    const fs::path prefix(programPrefix());
    if (prefix.empty()) return tool;  // without /proc: from PATH
    const fs::path own = prefix / "lib" / "ispace" / "bin" / tool;
    std::error_code error;
    return fs::exists(own, error) ? own : prefix / "bin" / tool;
}

/// Executes `file`, which execvp looks up in PATH if it has no slash. \throws std::system_error
[[noreturn]] void become(const std::string& file, std::vector<std::string> words) {
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    ::execvp(file.c_str(), argv.data());
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
    if (!words.empty() && isTool(words.front()))
        words.insert(words.begin() + 1, std::string(kErrors) + '=' + form);
}

std::string versionObject() {
    JsonWriter json;
    beginReport(json, "ispace-version/1", "ispace").key("licence").value("GPL-3.0-or-later");
    json.endObject();
    return json.take() + '\n';
}

/// Returns only on errors: another program replaces this one.
void run(std::vector<std::string> words) {
    takeErrors(words);
    std::vector<std::string> known = {"help"};
    for (const Tool& tool : kTools) known.emplace_back(tool.name);
    if (words.empty()) throw UsageError("which tool? (see ispace --help)");
    const std::string& first = words.front();
    if (isTool(first)) become(programOf(first).string(), words);
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
    throw UsageError(what + excerpt(first) + didYouMean(first, known) + " (see ispace --help)");
}

}  // namespace

int main(int argc, char** argv) {
    return runTool("ispace", [&] { run(std::vector<std::string>(argv + 1, argv + argc)); });
}
