// SPDX-License-Identifier: GPL-3.0-or-later
// arrange --verify: certificates of proofs over all poses, checked for a room and its layout by
// other code than that of the search.
#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "arrange/search/set_cover.h"
#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "extensions/proofs/gallery/guard_certificate.h"
#include "extensions/proofs/over_poses.h"
#include "extensions/proofs/proof_options.h"
#include "report/coverage_report.h"

namespace ispace::proofs {

namespace {

std::string lasersText(std::size_t count) {
    return std::to_string(count) + (count == 1 ? " laser" : " lasers");
}

/// The options of the check: what counted in the proof.
struct Goal {
    std::string file;  ///< the certificate
    std::vector<std::string> zones = {}, weights = {};
    int redundancy = 1;
};

/// Checks a proof of the fewest lasers.
void verifyGuards(const CommonOptions& common, const Goal& goal, const Scene& scene,
                  const std::string& text) {
    constexpr int kDigits = 3;
    const std::string& file = goal.file;
    if (!goal.zones.empty() || !goal.weights.empty() || goal.redundancy > 1)
        throw UsageError(
            "--verify: all of the floor counts, once, in a proof of the fewest: leave out "
            "--redundancy, --zone and --weight");
    const GuardCertificate certificate = readGuardCertificate(text, file);
    const GuardCheck check = checkGuarded(scene, certificate, file);
    if (check.bound < certificate.bound)
        throw UnmetError(printable(file) + ": its weights do not prove the " +
                         std::to_string(certificate.bound) + " lasers that it states");
    const auto lasers =
        std::count_if(scene.sensors.begin(), scene.sensors.end(),
                      [](const Sensor& sensor) { return kindOf(sensor.model).perceives; });
    const std::string missed = formatDouble(roundSignificant(check.missed, kDigits)) + " m2";
    if (check.missed > kMissedShare * check.area)
        throw UnmetError(printable(file) + ": the layout leaves " + missed + " of " +
                         formatFixed(check.area, 2) + " m2 unseen");
    const auto count = static_cast<std::size_t>(lasers);
    if (count < check.bound)
        throw UnmetError(printable(file) + ": the layout is short by its unseen floor of " +
                         missed + ": " + lasersText(count) + " cannot see all, at least " +
                         std::to_string(check.bound) + " are needed in any poses");
    const std::string gap =
        count == check.bound ? "proven fewest" : "gap " + lasersText(count - check.bound);
    report(common, "arrange",
           "the layout sees the floor of " + formatFixed(check.area, 2) + " m2 but for " + missed +
               " by " + lasersText(count) + "; at least " + std::to_string(check.bound) +
               (check.bound == 1 ? " is" : " are") + " needed in any poses (" + gap +
               "): verified (witnesses: " + std::to_string(certificate.witnesses.size()) +
               ", trees: " + std::to_string(check.trees) +
               ", leaves: " + std::to_string(check.leaves) +
               ", parts of the floor: " + std::to_string(check.cells) + ")");
}

FloorWeights weightsIn(const Environment& room, const Goal& goal) {
    FloorWeights weights;
    for (const std::string& text : goal.zones)
        for (NamedZone& zone : readZones(text, room)) weights.targets.push_back(std::move(zone));
    for (const std::string& text : goal.weights) {
        const auto [name, weight] = splitWeight(text);
        for (NamedZone& zone : readZones(name, room))
            weights.weights.emplace_back(std::move(zone), weight);
    }
    return weights;
}

/// Checks a certificate, and reports both sides.
/// \throws UnmetError if its trees prove a larger bound than it states
void verify(const TaskInput& task, const Goal& goal) {
    constexpr int kDecimals = 3;
    constexpr double kRounding = 1e-9;
    const std::string& file = goal.file;
    std::vector<std::string> streams = task.operands;
    streams.push_back(file);
    mustReadStdinOnce(streams);
    limitThreads(task.common.threads);
    const std::string written = isStream(file) ? readStdin() : readAll(file);
    const SceneInput input = readScene({task.operands, task.rules, false});
    warnOfImport(task.common, "arrange", input);
    if (isOfGuards(written)) return verifyGuards(task.common, goal, input.scene, written);
    const PoseCertificate certificate = readCertificate(written, file);
    const FloorWeights weights = weightsIn(input.scene.environment, goal);
    const CheckedPoses checked =
        checkPoses(input.scene, weights, goal.redundancy, certificate, file);
    const std::string unit = weights.isUniform() ? " m2" : " m2 by weight";
    const auto text = [&unit](double area) { return formatFixed(area, kDecimals) + unit; };
    if (checked.check.refused != 0)
        throw UnmetError(
            printable(file) + ": the trees prove at most " + text(checked.check.bound) +
            " for tuple " + std::to_string(checked.check.refused) + ", not the " +
            text(certificate.bound) +
            " that it states; give --redundancy, --zone and --weight as for its proof");
    const double bound = std::min(checked.check.bound, checked.floor);
    if (checked.found > bound * (1 + kRounding))
        throw UnmetError(printable(file) + ": the layout sees " + text(checked.found) +
                         ", more than the " + text(bound) + " that the certificate allows");
    const double gap = bound > 0 ? std::max(0.0, (bound - checked.found) / bound) : 0;
    const std::string times =
        goal.redundancy > 1 ? ", each by " + std::to_string(goal.redundancy) + " lasers" : "";
    report(task.common, "arrange",
           "the layout sees " + text(checked.found) + times + "; in any poses " +
               std::to_string(checked.sensors) +
               (checked.sensors == 1 ? " laser sees" : " lasers see") + " at most " + text(bound) +
               " of " + text(checked.floor) + " (gap " + percentText(gap) +
               "): verified (boxes: " + std::to_string(checked.check.boxes) +
               ", tuples: " + std::to_string(checked.check.tuples) + ")");
}

class VerifyOptions : public OptionGroup {
  public:
    void declare(CommandLine& line) override {
        line.group("Proofs");
        line.file("--verify", "FILE", goal_.file,
                  "check this certificate for the sensors of LAYOUT by other code than that of the "
                  "search; arrange nothing, and exit with 3 if it does not prove its bound; "
                  "--redundancy, --zone and --weight as for its proof",
                  Enters::Nothing);
    }
    [[nodiscard]] bool isAsked() const override { return !goal_.file.empty(); }
    [[nodiscard]] std::span<const std::string_view> honours() const override {
        static constexpr std::string_view kOptions[] = {"--redundancy", "--zone", "--weight"};
        return kOptions;
    }
    void take(const CommandLine& line) override {
        if (line.given("--output")) throw UsageError("--verify writes nothing: leave out --output");
        goal_.zones = line.valuesOf("--zone");
        goal_.weights = line.valuesOf("--weight");
        for (const std::string& weight : goal_.weights) (void)splitWeight(weight);
        if (const std::vector<std::string> times = line.valuesOf("--redundancy"); !times.empty())
            goal_.redundancy = static_cast<int>(parseInteger(times.back()).value_or(1));
    }
    void run(const TaskInput& input) override { verify(input, goal_); }

  private:
    Goal goal_;
};

}  // namespace

std::unique_ptr<OptionGroup> makeCertificateCheck() { return std::make_unique<VerifyOptions>(); }

}  // namespace ispace::proofs
