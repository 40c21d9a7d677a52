// SPDX-License-Identifier: GPL-3.0-or-later
// Options and their refusals, and the inputs of the cases: rooms are read as the first one was, and
// mountings and crowds are drawn by storey as coverage draws them.
#include "extensions/robustness/robust_options.h"

#include <algorithm>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "extensions/robustness/robust_cases.h"
#include "site/storey_people.h"

namespace ispace::robustness {

namespace {

class RobustLayouts final : public ArrangeGroup {
  public:
    [[nodiscard]] Place place() const override { return Place::Cases; }

    void declare(CommandLine& line) override {
        line.group("Robustness");
        line.parsed(
            "--robust", "WHAT", [this](const std::string& text) { choose(text); },
            "find a layout that holds in several cases: rooms:FILE[,FILE...], this room and the "
            "same with other furniture or doors; failures:K, any K sensors fail; mounting:M,DEG, "
            "as in mounting:5cm,3deg, random errors of mounting",
            Enters::BaseNames);
        constexpr int kMaxPeople = 1000;
        line.parsed(
            "--crowd", "N",
            [this](const std::string& text) {
                const auto people = parseInteger(text);
                if (!people || *people < 0 || *people > kMaxPeople)
                    throw UsageError("--crowd: " + excerpt(text) +
                                     " is no number of people up to 1000");
                of_ = Of::Crowd;
                people_ = static_cast<std::size_t>(*people);
            },
            "maximise the expected coverage with N people in the way of sight, at random positions",
            Enters::History);
        line.choice("--case", case_, {"worst", "mean"},
                    "maximise the value in the worst case (default of --robust) or the mean over "
                    "the cases (default of --crowd)",
                    Enters::History);
    }

    void take(const CommandLine& line, const ArrangeOptions& /*how*/) override {
        if (!isAsked()) {
            if (line.given("--case"))
                throw UsageError("--case is about --robust and --crowd: give one of them, too");
            return;
        }
        if (line.given("--robust") && line.given("--crowd"))
            throw UsageError("--robust and --crowd are about different cases: leave out one");
        is_worst_ = case_.empty() ? of_ != Of::Crowd : case_ == "worst";
        const std::string name = line.given("--crowd") ? "--crowd" : "--robust";
        constexpr const char* kOfOneCase[] = {"--refine", "--connected", "--reso",   "--judge",
                                              "--proof",  "--shard",     "--resume", "--batch"};
        for (const char* option : kOfOneCase)
            if (line.given(option))
                throw UsageError(name + " searches in several cases: leave out " + option);
        constexpr const char* kOfMean[] = {"--target", "--budget",     "--curve", "--alternatives",
                                           "--heat",   "--export-mps", "--trace"};
        for (const char* option : kOfMean)
            if (line.given(option) && is_worst_)
                throw UsageError(std::string(option) +
                                 " is not about the worst case: give --case mean, or leave it out");
        if (of_ == Of::Rooms && line.given("--privacy"))
            throw UsageError("--privacy is about one room: leave out --robust rooms");
        if (of_ != Of::Failures) return;
        for (const char* option : {"--target", "--budget", "--curve", "--redundancy"})
            if (line.given(option))
                throw UsageError(
                    "--robust failures is about a given number of sensors, of which one "
                    "covers floor: leave out " +
                    std::string(option));
    }

    [[nodiscard]] bool isAsked() const override { return of_ != Of::Nothing; }
    [[nodiscard]] std::vector<std::string_view> ofFloor() const override {
        return {"--robust", "--crowd"};
    }

    void aim(const ArrangeInput& input, ArrangeOptions& how,
             std::span<RoomGoals> /*goals*/) const override {
        how.cases = casesIn(input, how);
    }

  private:
    enum class Of { Nothing, Rooms, Failures, Mounting, Crowd };

    /// Parses `rooms:FILE,FILE`, `failures:K` and `mounting:5cm,3deg`.
    void choose(const std::string& text) {
        const auto colon = text.find(':');
        const std::string word = text.substr(0, colon);
        const std::string rest = colon == std::string::npos ? "" : text.substr(colon + 1);
        files_.clear();
        if (word == "rooms" && !rest.empty()) {
            of_ = Of::Rooms;
            std::istringstream list(rest + ',');
            for (std::string file; std::getline(list, file, ',');) {
                if (file.empty()) throw UsageError('`' + text + "` has an empty file name");
                files_.push_back(file);
            }
        } else if (word == "failures") {
            const auto count = parseInteger(rest);
            if (!count || *count < 0 || *count > kMaxSearchedFailures)
                throw UsageError('`' + rest + "` is not a number of failures up to " +
                                 std::to_string(kMaxSearchedFailures));
            of_ = Of::Failures;
            failures_ = static_cast<int>(*count);
        } else if (word == "mounting") {
            of_ = Of::Mounting;
            tolerance_ = parseTolerance(rest);
        } else {
            throw UsageError('`' + text +
                             "` is not rooms:FILE[,FILE...], failures:K or mounting:M,DEG");
        }
    }

    [[nodiscard]] std::shared_ptr<const LayoutCases> casesIn(const ArrangeInput& input,
                                                             const ArrangeOptions& how) const {
        if (of_ == Of::Rooms) return otherSites(input, how);
        if (of_ == Of::Failures)
            return std::make_shared<const SensorFailures>(is_worst_, failures_);
        const SiteInput& site = input.site;
        std::vector<std::uint64_t> seeds;
        seeds.reserve(site.rooms().size());
        for (std::size_t i = 0; i < site.rooms().size(); ++i)
            seeds.push_back(seedOfStorey(input.common.seed, i));
        if (of_ == Of::Mounting)
            return std::make_shared<const MountingCases>(is_worst_, tolerance_, std::move(seeds));
        std::vector<std::size_t> people = {people_};
        if (!site.isOneRoom()) people = spreadOverStoreys(site.building, how.plane, people_);
        std::vector<std::vector<Crowd>> crowds;
        crowds.reserve(seeds.size());
        for (std::size_t i = 0; i < seeds.size(); ++i)
            crowds.push_back(crowdsIn(*site.rooms()[i], people[i], seeds[i]));
        return std::make_shared<const CrowdCases>(is_worst_, people_, std::move(crowds));
    }

    /// Reads the rooms or buildings, each with the layout.
    [[nodiscard]] std::shared_ptr<const LayoutCases> otherSites(const ArrangeInput& input,
                                                                const ArrangeOptions& how) const {
        const std::string& own = input.site.environment_operand;
        std::vector<std::string> files = files_;
        files.push_back(own);
        // Files of several folders may have one name.
        const auto name_of = [&files](const std::string& file) {
            const auto count = std::count_if(
                files.begin(), files.end(),
                [&](const std::string& one) { return baseName(one) == baseName(file); });
            return count > 1 ? file : baseName(file);
        };
        std::vector<NamedSite> others;
        for (const std::string& file : files_) {
            if (isStream(file)) throw UsageError("--robust rooms: stdin is not read: give files");
            const SiteInput other = readOther(input, file, name_of(own));
            others.push_back({name_of(file), searchedSite(other, how)});
        }
        return std::make_shared<const OtherSites>(is_worst_, name_of(own), std::move(others));
    }

    /// \param own name of the room or building for which layouts are written
    static SiteInput readOther(const ArrangeInput& input, const std::string& file,
                               const std::string& own) {
        SceneRequest request{{file}, input.rules, false};
        request.is_further = true;
        request.rules.same_environment = false;
        if (!input.site.layout_operand.empty())
            request.operands.push_back(input.site.layout_operand);
        SiteInput other = readSite(request);
        if (other.ids() != input.site.ids()) {
            const auto text = [](const SiteInput& site) {
                std::string all;
                for (const std::string& id : site.ids())
                    all.append(all.empty() ? "" : ", ").append(printable(id));
                return site.isOneRoom() ? "one room" : "the storeys " + all;
            };
            throw UsageError("--robust rooms: " + file + " has " + text(other) + ", " + own +
                             " has " + text(input.site) + ": choose the same with --storey");
        }
        std::vector<std::string> fixed;
        for (const std::string& id : input.fixed) fixed.push_back(inOwnStorey(other, id));
        if (!fixed.empty() && other.layout) other.setLayout(withoutPlaces(*other.layout, fixed));
        warnOfImport(input.common, "arrange", other);
        input.files.insert(input.files.end(), other.files.begin(), other.files.end());
        return other;
    }

    Of of_ = Of::Nothing;
    bool is_worst_ = true;
    std::vector<std::string> files_;
    int failures_ = 0;
    MountingTolerance tolerance_;
    std::size_t people_ = 0;
    std::string case_;
};

}  // namespace

std::unique_ptr<ArrangeGroup> makeRobustLayouts() { return std::make_unique<RobustLayouts>(); }

}  // namespace ispace::robustness
