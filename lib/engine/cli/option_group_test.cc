// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/option_group.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"

namespace ispace {
namespace option_group_test {

/// Weighs the sensors that --select chooses.
class Scales : public OptionGroup {
  public:
    inline static std::string said;

    void declare(CommandLine& line) override {
        line.group("Weights");
        line.file("--weigh", "FILE", file_, "weigh sensors", Enters::History);
        line.flag("--net", net_, "without cables", Enters::History);
    }
    [[nodiscard]] bool isAsked() const override { return !file_.empty(); }
    [[nodiscard]] std::span<const std::string_view> honours() const override {
        static constexpr std::string_view kOptions[] = {"--select"};
        return kOptions;
    }
    void take(const CommandLine& line) override { select_ = line.valuesOf("--select"); }
    void run(const TaskInput& input) override {
        said = file_ + (net_ ? " net" : "");
        for (const std::string& one : select_) said += ' ' + one;
        said += " of " + input.operands.front() + ", " + input.history_line;
    }

  private:
    std::string file_;
    bool net_ = false;
    std::vector<std::string> select_;
};

/// Counts them.
class Abacus : public OptionGroup {
  public:
    void declare(CommandLine& line) override {
        line.group("Counts");
        line.flag("--count", asked_, "count sensors", Enters::Nothing);
    }
    [[nodiscard]] bool isAsked() const override { return asked_; }
    [[nodiscard]] std::span<const std::string_view> honours() const override { return {}; }
    void take(const CommandLine&) override {}
    void run(const TaskInput&) override {}

  private:
    bool asked_ = false;
};

template <typename Group>
std::unique_ptr<OptionGroup> make() {
    return std::make_unique<Group>();
}

constexpr ToolExtension kRows[] = {{"scales", "scan", make<Scales>},
                                   {"abacus", "scan", make<Abacus>},
                                   {"scales", "envc", make<Scales>},
                                   {"rulers", "envc", nullptr, "--measure"}};

/// Parses a command of a tool with an option of its own, --select, and one that no task honours,
/// --frames.
ExtensionTask taskOf(std::vector<const char*> words, std::string_view tool = "scan") {
    CommandLine line("scan", "ENV", "Read.");
    CommonOptions common;
    std::vector<std::string> operands, select;
    std::optional<int> frames;
    line.operands(operands, 2);
    line.texts("--select", "GLOB", select, "choose", Enters::History);
    line.count("--frames", "N", frames, 1, 9, "number", Enters::History);
    ToolExtensions extensions(kRows, tool);
    extensions.declare(line);
    addCommonOptions(line, common, "product");
    words.insert(words.begin(), "scan");
    line.parse(static_cast<int>(words.size()), words.data());
    return extensions.task(line, {common, {}, operands});
}

std::string errorOf(const std::vector<const char*>& words, std::string_view tool = "scan") {
    try {
        static_cast<void>(taskOf(words, tool));
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

TEST(ToolExtensions, ACommandWithoutTheirOptionsHasNoTask) {
    EXPECT_FALSE(taskOf({"room.env", "--frames", "2"}));
}

TEST(ToolExtensions, ATaskOutlivesTheCommandLineAndReadsTheToolsOptions) {
    const ExtensionTask task =
        taskOf({"room.env", "--weigh", "log", "--net", "--select", "l*", "--select", "c1", "-q"});
    ASSERT_TRUE(task);
    task();
    EXPECT_EQ(
        Scales::said,
        "log net l* c1 of room.env, scan room.env --select 'l*' --select c1 --weigh log --net");
}

TEST(ToolExtensions, OptionsWithoutAMeaningAreRefused) {
    EXPECT_EQ(errorOf({"room.env", "--weigh", "log", "--frames", "2"}),
              "--frames does not go with --weigh: leave it out");
    EXPECT_EQ(errorOf({"room.env", "--net"}), "--net goes with --weigh: give that, too");
    EXPECT_EQ(errorOf({"room.env", "--weigh", "log", "--count"}),
              "--weigh and --count are two tasks: give one of them");
}

TEST(ToolExtensions, AToolHasItsOwnRowsAlone) {
    EXPECT_TRUE(errorOf({"room.env", "--count"}, "envc").starts_with("unknown option --count"));
    EXPECT_FALSE(taskOf({"room.env"}, "arrange"));
}

TEST(ToolExtensions, AnOptionOfAMissingExtensionNamesIt) {
    EXPECT_EQ(
        errorOf({"room.env", "--measure"}, "envc"),
        "unknown option --measure: it belongs to the extension rulers, which this build lacks "
        "(see scan --help)");
    EXPECT_TRUE(errorOf({"room.env", "--measure"}).starts_with("unknown option --measure"));
}

}  // namespace option_group_test
}  // namespace ispace
