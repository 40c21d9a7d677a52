// SPDX-License-Identifier: GPL-3.0-or-later
// golden [OPTION VALUE]… COMMAND: runs a shell command in a scratch folder and compares exit
// status, standard output, standard error and its files with the expected ones.
//
//   --expect TOOL/CASE  TOOL/CASE.out and .err are the expected texts, TOOL/CASE.FILE those of
//                     its files; without .out or .err that stream must be empty
//   --err LINE        standard error is `TOOL: LINE`; with an empty LINE it is that of .err
//   --scratch FOLDER  created for every run, removed after success
//   --inputs FOLDER   its files are copied into the scratch folder (repeatable)
//   --status N        expected exit status, 0 by default
//   --creates A;B     the created files, no more and no less
//   --pictures A;B    PNGs among them that are compared with PREFIX.FILE by their pixels
//   --abs X --rel Y   tolerance of numbers
//   --exact yes       history is compared, too
//   --needs FILE      skipped, with status 77, without this file in $ISPACE_TEST_DATA
//
// With UPDATE_GOLDEN=1 in the environment it writes the expectations instead; one line of standard
// error that begins with `TOOL: ` goes to the row of the case in TOOL/CMakeLists.txt.
#include <fcntl.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/golden.h"
#include "drawing/picture_difference.h"
#include "rows.h"

namespace fs = std::filesystem;

namespace {

/// Share of the pixels of a picture that may differ: another Cairo than the one that drew the
/// expectations draws letters otherwise.
constexpr double kOtherPixels = ISPACE_GOLDEN_PIXELS;

struct Case {
    std::string command;
    fs::path expect, scratch;
    std::vector<fs::path> inputs;
    int status = 0;
    std::string error_line;
    std::set<std::string> creates, pictures;
    std::string needs;
    ispace::Tolerance tolerance;
    bool exact = false;
};

std::set<std::string> splitList(const std::string& list) {
    std::set<std::string> items;
    std::istringstream stream(list);
    for (std::string item; std::getline(stream, item, ';');) items.insert(item);
    return items;
}

Case parseCase(const std::vector<std::string>& words) {
    Case test;
    if (words.size() % 2 == 0) throw std::runtime_error("options need values, then the command");
    for (std::size_t i = 0; i + 2 < words.size(); i += 2) {
        const std::string& name = words[i];
        const std::string& value = words[i + 1];
        if (name == "--expect") {
            test.expect = value;
        } else if (name == "--scratch") {
            test.scratch = value;
        } else if (name == "--inputs") {
            test.inputs.emplace_back(value);
        } else if (name == "--status") {
            test.status = std::stoi(value);
        } else if (name == "--err") {
            test.error_line = value;
        } else if (name == "--creates") {
            test.creates = splitList(value);
        } else if (name == "--pictures") {
            test.pictures = splitList(value);
        } else if (name == "--abs") {
            test.tolerance.absolute = std::stod(value);
        } else if (name == "--rel") {
            test.tolerance.relative = std::stod(value);
        } else if (name == "--needs") {
            test.needs = value;
        } else if (name == "--exact") {
            test.exact = value == "yes";
        } else {
            throw std::runtime_error("unknown option " + name);
        }
    }
    test.command = words.back();
    return test;
}

/// The file's bytes; "" for one that is not there.
std::string read(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// An empty expectation has no file.
void update(const fs::path& file, const std::string& text) {
    if (text.empty()) {
        fs::remove(file);
    } else {
        fs::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary) << text;
    }
}

/// Rewrites ERR in the row of the case, one process at a time; false if there is no such row.
bool updateRow(const fs::path& expect, const std::string& line) {
    const fs::path file = expect.parent_path() / "CMakeLists.txt";
    const int lock = open(expect.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock < 0 || flock(lock, LOCK_EX) != 0)
        throw std::runtime_error("cannot lock " + file.string());
    const std::string before = read(file);
    const auto after = golden::withErrorLine(before, expect.filename().string(), line);
    if (after && *after != before) update(file, *after);
    close(lock);
    return after.has_value();
}

fs::path withSuffix(const fs::path& prefix, const std::string& suffix) {
    return prefix.string() + "." + suffix;
}

std::set<std::string> namesIn(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) {
        names.insert(entry.path().filename().string());
    }
    return names;
}

/// A new room with the inputs in it.
void furnish(const Case& test, const fs::path& room) {
    fs::remove_all(test.scratch);
    fs::create_directories(room);
    for (const fs::path& folder : test.inputs) {
        fs::copy(folder, room, fs::copy_options::recursive);
    }
}

/// Runs the command in the room; its streams go to files beside it.
int run(const Case& test, const fs::path& room) {
    const fs::path script = test.scratch / "command";
    std::ofstream(script) << "cd '" << room.string() << "' || exit 125\n" << test.command << '\n';
    const std::string shell = "sh '" + script.string() + "' </dev/null >'" +
                              (test.scratch / "out").string() + "' 2>'" +
                              (test.scratch / "err").string() + "'";
    const int result = std::system(shell.c_str());
    if (result == -1) throw std::runtime_error("cannot run a shell");
    return WIFEXITED(result) ? WEXITSTATUS(result) : 128 + WTERMSIG(result);
}

class Verdict {
  public:
    explicit Verdict(const Case& test)
        : test_(test), update_(std::getenv("UPDATE_GOLDEN") != nullptr) {}

    void text(const std::string& what, const fs::path& expected_file, std::string actual) {
        if (!test_.exact) actual = ispace::withoutHistory(actual);
        if (update_) return update(expected_file, actual);
        const std::string found =
            ispace::textDifference(read(expected_file), actual, test_.tolerance);
        if (!found.empty()) fail(what + " differs from " + expected_file.string() + ", " + found);
    }

    void standardError(const std::string& actual) {
        const fs::path file = withSuffix(test_.expect, "err");
        const std::string tool = test_.expect.parent_path().filename().string() + ": ";
        if (update_) {
            const bool one_line =
                actual.starts_with(tool) && actual.find('\n') == actual.size() - 1;
            const std::string line =
                one_line ? actual.substr(tool.size(), actual.size() - 1 - tool.size()) : "";
            const bool in_row = updateRow(test_.expect, line) && one_line;
            return update(file, in_row ? "" : actual);
        }
        if (test_.error_line.empty()) return text("standard error", file, actual);
        const std::string expected = tool + test_.error_line + "\n";
        const std::string found = ispace::textDifference(expected, actual, test_.tolerance);
        if (!found.empty()) fail("standard error differs from ERR, " + found);
    }

    void picture(const std::string& name, const fs::path& expected_file, const std::string& png) {
        if (update_) return update(expected_file, png);
        const std::string found = ispace::pictureDifference(read(expected_file), png, kOtherPixels);
        if (!found.empty()) fail(name + " differs from " + expected_file.string() + ": " + found);
    }

    void status(int actual) {
        if (actual != test_.status) {
            fail("exit status is " + std::to_string(actual) + ", expected " +
                 std::to_string(test_.status));
        }
    }

    /// Every file made must be announced, every announced one made; texts that have an expectation
    /// are compared with it.
    void files(const fs::path& room, const std::set<std::string>& before) {
        std::set<std::string> made = namesIn(room);
        for (const std::string& name : before) made.erase(name);
        for (const std::string& name : made) {
            if (!test_.creates.contains(name)) fail("left behind: " + name);
        }
        for (const std::string& name : test_.creates) {
            const fs::path expected = withSuffix(test_.expect, name);
            if (!made.contains(name)) {
                fail("not made: " + name);
            } else if (test_.pictures.contains(name)) {
                picture(name, expected, read(room / name));
            } else if (fs::exists(expected)) {
                text(name, expected, read(room / name));
            }
        }
    }

    void fail(const std::string& message) {
        std::cout << message << '\n';
        failed_ = true;
    }

    [[nodiscard]] bool failed() const { return failed_; }

  private:
    const Case& test_;
    bool update_;
    bool failed_ = false;
};

bool isMissing(const std::string& file) {
    const char* const folder = std::getenv("ISPACE_TEST_DATA");
    return !file.empty() && (folder == nullptr || !fs::exists(fs::path(folder) / file));
}

bool passes(const Case& test) {
    const fs::path room = test.scratch / "room";
    furnish(test, room);
    const std::set<std::string> before = namesIn(room);
    Verdict verdict(test);
    verdict.status(run(test, room));
    verdict.text("standard output", withSuffix(test.expect, "out"), read(test.scratch / "out"));
    verdict.standardError(read(test.scratch / "err"));
    verdict.files(room, before);
    if (verdict.failed()) {
        std::cout << "command: " << test.command << "\nstderr:\n" << read(test.scratch / "err");
    } else {
        fs::remove_all(test.scratch);
    }
    return !verdict.failed();
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const Case test = parseCase({argv + 1, argv + argc});
        if (isMissing(test.needs)) return 77;
        return passes(test) ? 0 : 1;
    } catch (const std::exception& error) {
        std::cout << "golden: " << error.what() << '\n';
        return 2;
    }
}
