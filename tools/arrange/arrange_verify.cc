// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/arrange_verify.h"

#include <algorithm>
#include <string>

#include "arrange/arrange_run.h"
#include "arrange/gallery/gallery.h"
#include "arrange/gallery/guard_certificate.h"
#include "arrange/over_poses.h"
#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "report/coverage_report.h"

namespace ispace {

namespace {

std::string lasersText(std::size_t count) {
    return std::to_string(count) + (count == 1 ? " laser" : " lasers");
}

/// Checks a proof of the fewest lasers.
void verifyGuards(const ArrangeToolOptions& options, const Scene& scene, const std::string& text) {
    constexpr int kDigits = 3;
    const std::string& file = options.verify_file;
    if (!options.zones.targets.empty() || !options.zones.weights.empty() ||
        options.how.redundancy > 1)
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
    tell(options.common, "arrange",
         "the layout sees the floor of " + formatFixed(check.area, 2) + " m2 but for " + missed +
             " by " + lasersText(count) + "; at least " + std::to_string(check.bound) +
             (check.bound == 1 ? " is" : " are") + " needed in any poses (" + gap +
             "): verified (witnesses: " + std::to_string(certificate.witnesses.size()) +
             ", trees: " + std::to_string(check.trees) +
             ", leaves: " + std::to_string(check.leaves) +
             ", parts of the floor: " + std::to_string(check.cells) + ")");
}

}  // namespace

void verifyCertificate(const ArrangeToolOptions& options) {
    constexpr int kDecimals = 3;
    constexpr double kRounding = 1e-9;
    const std::string& file = options.verify_file;
    std::vector<std::string> streams = options.operands;
    streams.push_back(file);
    mustReadStdinOnce(streams);
    limitThreads(options.common.threads);
    const std::string written = isStream(file) ? readStdin() : readAll(file);
    const SceneInput input = readScene({options.operands, options.rules, false});
    warnOfImport(options.common, "arrange", input);
    if (isOfGuards(written)) return verifyGuards(options, input.scene, written);
    const PoseCertificate certificate = readCertificate(written, file);
    ArrangeOptions how = options.how;
    const Environment& room = input.scene.environment;
    for (const std::string& text : options.zones.targets)
        for (NamedZone& zone : readZones(text, room))
            how.weights.targets.push_back(std::move(zone));
    for (const std::string& text : options.zones.weights) {
        const auto [name, weight] = splitWeight(text);
        for (NamedZone& zone : readZones(name, room))
            how.weights.weights.emplace_back(std::move(zone), weight);
    }
    const CheckedPoses checked =
        checkPoses(input.scene, how.weights, how.redundancy, certificate, file);
    const std::string unit = how.weights.isUniform() ? " m2" : " m2 by weight";
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
        how.redundancy > 1 ? ", each by " + std::to_string(how.redundancy) + " lasers" : "";
    tell(options.common, "arrange",
         "the layout sees " + text(checked.found) + times + "; in any poses " +
             std::to_string(checked.sensors) +
             (checked.sensors == 1 ? " laser sees" : " lasers see") + " at most " + text(bound) +
             " of " + text(checked.floor) + " (gap " + percentText(gap) +
             "): verified (boxes: " + std::to_string(checked.check.boxes) +
             ", tuples: " + std::to_string(checked.check.tuples) + ")");
}

}  // namespace ispace
