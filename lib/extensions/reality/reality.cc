// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/reality/reality.h"

#include <algorithm>

#include "base/error.h"
#include "base/file.h"
#include "base/run_files.h"
#include "cli/outputs.h"
#include "extensions/pages/page_writer.h"
#include "extensions/reality/fit.h"
#include "extensions/reality/reality_report.h"
#include "scene/placement_schemas.h"
#include "scene/sensor_spec.h"

namespace ispace::reality {

namespace {

class RealityOptions final : public OptionGroup {
  public:
    void declare(CommandLine& line) override {
        line.group("A log of real sensors");
        line.file("--against", "LOG", log_,
                  "compare a log with the plan instead of writing readings: CARMEN, MCAP, a folder "
                  "of rosbag2, JSON lines of scan, a record of simrun; - is stdin",
                  Enters::BaseName);
        line.flag("--align", align_, "first align the poses of the log to the plan",
                  Enters::History);
        line.flag("--json", json_, "the report as JSON", Enters::Nothing);
        line.texts("--require", "inliers=SHARE|sigma=LENGTH|bias=LENGTH", required_,
                   "status 3 unless the inliers are at least, sigma or the bias at most this, e.g. "
                   "inliers=90%",
                   Enters::Nothing);
        line.file("--report", "FILE", page_,
                  "write a page with the plan, its residuals and the fit: .html or .pdf",
                  Enters::Nothing);
        line.file("--fit", "FILE", fit_,
                  "fit the noise of the sensors and of odometry, and write it as a layout for "
                  "--noise",
                  Enters::Nothing);
    }

    [[nodiscard]] bool isAsked() const override { return !log_.empty(); }

    [[nodiscard]] std::span<const std::string_view> honours() const override {
        static constexpr std::string_view kOptions[] = {"--model", "--select"};
        return kOptions;
    }

    void take(const CommandLine& line) override {
        select_ = line.valuesOf("--select");
        if (const auto models = line.valuesOf("--model"); !models.empty()) model_ = models.back();
        if (!page_.empty()) static_cast<void>(pageFormat());
        for (const std::string& text : required_)
            requirements_.push_back(
                ofOption("--require", [&] { return parseRealityRequirement(text); }));
    }

    void run(const TaskInput& input) override {
        claimOutputs(input.common);
        if (!page_.empty()) claimOutput(page_, "--report");
        if (!fit_.empty()) claimOutput(fit_, "--fit");
        const std::string map = mapFormat(input.common.output);
        if (std::find(input.operands.begin(), input.operands.end(), "-") != input.operands.end() &&
            log_ == "-")
            throw UsageError(
                "stdin cannot be read twice: only one of operands and --against can "
                "be -");
        const SceneInput scene_input =
            readScene({input.operands, input.rules, false, [](const SensorKind&) { return true; }});
        warnOfImport(input.common, "scan", scene_input);
        const Scene& scene = scene_input.scene;
        const Log log = readLog(log_);
        LoggedRunOptions options{.select = select_, .model = modelOf()};
        RayScenes worlds(scene.environment);
        std::vector<UltrasoundFit> ultrasound;
        if (!fit_.empty()) ultrasound = fitUltrasound(log, scene, worlds);
        LoggedRun logged;
        if (!log.scans.empty() || !log.clouds.empty())
            logged = runOf(log, scene, options);
        else if (ultrasound.empty())
            throw FormatError({displayName(log_), 0, 0,
                               "the log has bursts of ultrasound alone: give --fit, and a LAYOUT "
                               "with its tags and receivers"});
        SurfaceFinder surfaces(scene.environment);
        simulate(logged, worlds, surfaces);
        std::optional<Alignment> alignment;
        if (align_) {
            alignment = align(logged, worlds);
            logged.doubts.clear();
            simulate(logged, worlds, surfaces);
        }
        warn(input.common, "scan", logged.doubts);
        RealityReport report = measureReality(log, logged, scene.environment, std::move(alignment));
        report.room = displayName(scene_input.environment_operand);
        write(input, report, logged, scene, map);
        if (!fit_.empty()) {
            const std::vector<SensorFit> fits = fitSensors(logged);
            if (fits.empty() && ultrasound.empty())
                warn(input.common, "scan",
                     "no sensor has beams on the plan: " + displayName(fit_) + " has no records");
            writeAll(fit_, fittedLayout(fits, ultrasound, fitOdometry(log), logged, scene,
                                        input.history_line));
        }
        std::vector<std::string> files = filesOf(scene_input);
        files.insert(files.end(), log.files.begin(), log.files.end());
        writeDependencies(input.common, files);
        std::string unmet;
        for (const std::string& clause : unmetRequirements(report, requirements_))
            unmet += (unmet.empty() ? "" : "; ") + clause;
        if (!unmet.empty()) throw UnmetError(unmet);
    }

  private:
    [[nodiscard]] std::string pageFormat() const {
        std::string suffix = suffixOf(page_);
        if (suffix == "html" || suffix == "pdf") return suffix;
        throw UsageError("--report: `" + page_ + "` is neither .html nor .pdf");
    }

    /// Returns the format of -o; "" without it.
    static std::string mapFormat(const std::string& output) {
        if (isStdout(output)) return "";
        std::string suffix = suffixOf(output);
        if (suffix == "png" || suffix == "svg" || suffix == "pdf" || suffix == "gif" ||
            suffix == "csv")
            return suffix;
        throw UsageError(
            "-o: with --against it is the map of the residuals, .png, .svg or .pdf, or "
            "a film of the log beside its simulation, .gif, or a table of all beams, .csv");
    }

    [[nodiscard]] std::optional<Sensor> modelOf() const {
        if (model_.empty()) return std::nullopt;
        const std::vector<std::string_view> kinds = keywordsOf(&SensorKind::follows_poses);
        const SensorSpec spec = ofOption("--model", [&] {
            return readSensorSpec(model_, kinds, sceneSchemas(), shippedDevices());
        });
        Sensor sensor{spec.record.keyword(), sensorModelOf(spec.record, shippedDevices()),
                      poseOf(spec.record)};
        return sensor;
    }

    void write(const TaskInput& input, const RealityReport& report, const LoggedRun& logged,
               const Scene& scene, const std::string& map) const {
        writeAll("-", json_ ? realityJson(report, scene.environment)
                            : realityText(report, scene.environment));
        if (map == "gif") {
            writeAll(input.common.output, realityFilm(report, logged, scene.environment));
        } else if (map == "csv") {
            writeAll(input.common.output, realityTable(logged, scene.environment));
        } else if (!map.empty()) {
            const Picture picture = realityMap(report, logged, scene.environment);
            writeAll(input.common.output, picture.write(map == "png"   ? PictureFormat::Png
                                                        : map == "svg" ? PictureFormat::Svg
                                                                       : PictureFormat::Pdf));
        }
        if (page_.empty()) return;
        const ReportPage page =
            pages::typeset(realityPage(report, logged, scene.environment, input.history_line));
        writeAll(page_, pageFormat() == "html" ? pages::htmlOf(page) : pages::pdfOf(page));
    }

    std::string log_, page_, fit_, model_;
    bool align_ = false, json_ = false;
    std::vector<RealityRequirement> requirements_;
    std::vector<std::string> select_, required_;
};

}  // namespace

std::unique_ptr<OptionGroup> makeRealityOptions() { return std::make_unique<RealityOptions>(); }

}  // namespace ispace::reality
