// SPDX-License-Identifier: GPL-3.0-or-later
// `--tracks` with `--run`: errors of options and outputs come first, then those of the room, the
// file of tracks and the record. All products are written before --require is checked, so that a
// failed requirement (UnmetError) leaves the report that tells why. The cut-off of OSPA(2) and the
// reach of a match are 1 m and 0.5 m.
#include "extensions/judge/judge.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "base/run_files.h"
#include "base/zstd_text.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "env/body.h"
#include "env/environment.h"
#include "extensions/judge/judge_report.h"
#include "extensions/judge/judged_run.h"
#include "extensions/judge/track_file.h"
#include "extensions/pages/page_writer.h"
#include "geom/polygon.h"
#include "sense/detection.h"

namespace ispace::judge {

namespace {

namespace fs = std::filesystem;

std::string bytesOf(const std::string& file) {
    if (file == "-") return readStdin();
    TextFile text(file);
    std::string bytes;
    while (text.read(bytes)) {
    }
    return bytes;
}

class TrackJudge : public OptionGroup {
  public:
    void declare(CommandLine& line) override {
        line.group("Trackers judged by a recorded run");
        line.file("--tracks", "FILE", tracks_,
                  "judge the tracks in FILE (CSV or lines of JSON with t, track, x, y[, kind]; "
                  "MOT; markers in MCAP) by the "
                  "robots and people of --run: MOTA, MOTP, IDF1, HOTA, OSPA(2), where and why "
                  "tracks were "
                  "lost; -o is the map of it",
                  Enters::BaseName);
        line.parsed(
            "--frame-rate", "HZ", [this](const std::string& text) { rate_ = rateOf(text); },
            "frames a second at which tracks are judged (default: those of FILE)", Enters::History);
        line.choice("--truths", truths_, {"all", "people", "robots"},
                    "movers that are to be tracked (default all)", Enters::History);
        line.file("--films", "DIR", films_, "write a film in GIF of each loss into DIR",
                  Enters::Nothing);
    }
    [[nodiscard]] bool isAsked() const override { return !tracks_.empty(); }
    [[nodiscard]] std::span<const std::string_view> honours() const override {
        static constexpr std::string_view kOptions[] = {
            "--run", "--require", "--json", "--report", "--width", "--plane", "--zone"};
        return kOptions;
    }
    void take(const CommandLine& line) override {
        const auto last = [&line](const std::string& name) {
            const std::vector<std::string> values = line.valuesOf(name);
            return values.empty() ? std::string() : values.back();
        };
        run_ = last("--run");
        if (run_.empty())
            throw UsageError(
                "--tracks: the movers are those of a record: give it, too (--run DIR)");
        report_ = last("--report");
        json_ = line.given("--json");
        zones_ = line.valuesOf("--zone");
        if (const std::string width = last("--width"); !width.empty())
            width_ = static_cast<int>(*parseInteger(width));
        for (const std::string& text : line.valuesOf("--require"))
            requirements_.push_back(parseTrackRequirement(text));
        if (!report_.empty()) report_format_ = outputFormat({}, report_, {"html", "pdf", "json"});
    }

    void run(const TaskInput& input) override {
        const bool has_map = input.common.output != "-";
        std::optional<PictureFormat> format;
        if (has_map)
            format = formatOf(outputFormat({}, input.common.output, {"png", "svg", "pdf"}));
        claimOutputs(input.common);
        claimOutput(report_, "--report");
        SceneInput room = roomOf(input);
        warnOfImport(input.common, "coverage", room);
        addZones(zones_, room);
        const Judgement judgement = judge(input, room.scene);
        if (judgement.judged.rows_outside > 0)
            warn(input.common, "coverage",
                 std::to_string(judgement.judged.rows_outside) + " positions of " +
                     displayName(tracks_) + " lie before or after the run, from " +
                     formatDouble(judgement.judged.times.front()) + " to " +
                     formatDouble(judgement.judged.times.back()) + " s, and are left out");
        if (format)
            writeAll(input.common.output,
                     judgementMap(judgement, room.scene, "tracks " + judgement.file, width_)
                         .write(*format));
        if (!report_.empty()) writeReport(judgement, room.scene, input.history_line);
        if (!films_.empty()) writeFilms(judgement, room.scene, input.common);
        std::vector<std::string> files = filesOf(room);
        files.push_back(tracks_);
        writeDependencies(input.common, files);
        writeAll("-", json_ ? judgementJson(judgement) : judgementText(judgement));
        std::string unmet;
        for (const TrackRequirement& one : requirements_)
            if (const std::string text = unmetText(one, judgement); !text.empty())
                unmet += (unmet.empty() ? "" : "; ") + text;
        if (!unmet.empty()) throw UnmetError(unmet);
    }

  private:
    static double rateOf(const std::string& text) {
        constexpr double kSlowest = 0.001, kFastest = 10000;
        const std::optional<double> rate = parseDouble(text);
        if (!rate || !(*rate >= kSlowest && *rate <= kFastest))
            throw UsageError("`" + text + "` is no number from 0.001 to 10000");
        return *rate;
    }
    static PictureFormat formatOf(const std::string& name) {
        return name == "svg"   ? PictureFormat::Svg
               : name == "pdf" ? PictureFormat::Pdf
                               : PictureFormat::Png;
    }

    /// Reads the room of the operands, else that of the record.
    [[nodiscard]] SceneInput roomOf(const TaskInput& input) const {
        checkRecordFolder(run_);
        std::vector<std::string> operands = input.operands;
        if (operands.empty()) {
            const std::string scene = sceneOfRecord(run_);
            if (scene.empty() && fs::exists(fs::path(run_) / "building.yaml"))
                throw UsageError("the record " + displayName(run_) +
                                 " is of a building: give the folder of one storey in it");
            if (scene.empty())
                throw UsageError("the record " + displayName(run_) +
                                 " holds no scene: give ENV and LAYOUT");
            operands.push_back(scene);
        }
        return readScene({operands, input.rules, false, [](const SensorKind&) { return true; }});
    }

    [[nodiscard]] Judgement judge(const TaskInput& input, const Scene& scene) const {
        TrackFile file = readTracks(bytesOf(tracks_), displayName(tracks_));
        leaveOutKinds(file, input.common);
        const std::optional<RunInfo> info = recordedInfo(run_);
        RunReader reader(run_);
        Judgement judgement;
        judgement.run = baseName(run_);
        judgement.file = tracks_ == "-" ? displayName(tracks_) : baseName(tracks_);
        FrameChoice choice{rate_, truths_ == "people"   ? TruthKind::People
                                  : truths_ == "robots" ? TruthKind::Robots
                                                        : TruthKind::All};
        constexpr double kUsual = 0.1;
        const double every = info && info->every > 0 ? info->every : kUsual;
        if (file.counts_frames && !rate_) {
            // A MOT file counts moments of the record, or frames of its own that fill the run.
            if (const std::optional<double> fitted = frameInterval(file, info, every))
                choice.rate = 1 / *fitted;
            warn(input.common, "coverage",
                 "frames of " + displayName(tracks_) + " are taken as " +
                     formatDouble(choice.rate ? 1 / *choice.rate : every) +
                     " s long, from the run's beginning on: --frame-rate sets their rate");
        }
        judgement.judged = judgedRun(reader, file, choice, every);
        const auto& found = judgement.judged.track_places;
        const auto empty =
            std::count_if(found.begin(), found.end(), [](const auto& one) { return one.empty(); });
        if (2 * static_cast<std::size_t>(empty) > found.size())
            warn(input.common, "coverage",
                 std::to_string(empty) + " of " + std::to_string(found.size()) +
                     " frames have no track; frames are " +
                     formatDouble(judgement.judged.interval) +
                     " s apart, --frame-rate sets their rate");
        if (reader.isCut())
            warn(input.common, "coverage",
                 "the record ends in the midst of a step, which is left out");
        countSensors(judgement, scene);
        const ScoredRun run = scored(judgement.judged, file.kinds);
        judgement.clear = clearMot(run);
        judgement.identity = identityOf(run);
        judgement.hota = hotaOf(run);
        constexpr double kCutoff = 1;
        judgement.ospa = ospa2(
            pointTracks(judgement.judged.truth_places, judgement.judged.truths.size()),
            pointTracks(judgement.judged.track_places, judgement.judged.tracks.size()), kCutoff);
        judgement.latency = latencyOf(judgement.judged, judgement.clear);
        judgement.losses = lossesOf(judgement.judged, judgement.clear);
        addTables(judgement, scene);
        return judgement;
    }

    /// Removes tracks of the kind that is not judged.
    void leaveOutKinds(TrackFile& file, const CommonOptions& common) const {
        if (truths_ == "all") return;
        const std::string other = truths_ == "people" ? "robot" : "person";
        const std::size_t before = file.rows.size();
        std::erase_if(file.rows,
                      [&](const TrackRow& row) { return file.kinds[row.track] == other; });
        if (const std::size_t left_out = before - file.rows.size(); left_out > 0)
            warn(common, "coverage",
                 std::to_string(left_out) + " positions of tracks of the kind " + other +
                     " are left out by --truths");
        if (file.rows.empty())
            throw UsageError("--truths " + truths_ + ": no track of " + displayName(tracks_) +
                             " is of that kind");
    }

    /// Returns the length of a MOT file's frames if they fill the run at a whole rate; empty if
    /// they are its moments. \throws UsageError for others
    [[nodiscard]] std::optional<double> frameInterval(const TrackFile& file,
                                                      const std::optional<RunInfo>& info,
                                                      double every) const {
        const double frames = file.rows.back().time;
        if (!info || info->steps <= 0 || frames < 2) return {};
        const double duration = static_cast<double>(info->steps) * info->step;
        constexpr double kSlack = 1.01, kHalf = 0.5, kOff = 0.01;
        const double by_moments = (frames - 1) * every;
        if (by_moments <= kSlack * duration && by_moments >= kHalf * duration) return {};
        const double rate = (frames - 1) / duration;
        if (std::abs(rate - std::round(rate)) > kOff * rate)
            throw UsageError("--frame-rate: say how many frames a second " + displayName(tracks_) +
                             " has, its " + formatDouble(frames) +
                             " frames tell no whole rate for the run's " + formatDouble(duration) +
                             " s");
        return 1 / std::round(rate);
    }

    static void countSensors(Judgement& judgement, const Scene& scene) {
        const DetectionMonitor monitor(scene);
        // The record has no poses of carriers at frames; a mounted sensor would stay at its start.
        judgement.knows_sensors = monitor.sensors() > 0 && !monitor.rides();
        if (!judgement.knows_sensors) return;
        for (std::vector<TruthPlace>& places : judgement.judged.truth_places) {
            std::vector<DetectionMonitor::Target> targets;
            targets.reserve(places.size());
            for (const TruthPlace& one : places) targets.push_back({one.place});
            const std::vector<std::size_t> counts = monitor.seenBy(targets);
            for (std::size_t i = 0; i < places.size(); ++i) places[i].sensors = counts[i];
        }
    }

    static void addTables(Judgement& judgement, const Scene& scene) {
        const JudgedRun& run = judgement.judged;
        const std::vector<std::string> numbers = {"0", "1", "2", "3 or more"};
        const auto most = numbers.size() - 1;
        std::vector<std::string> names;
        std::vector<Polygon> outlines;
        for (const Element& element : scene.environment.elements())
            if (element.record.keyword() == "zone") {
                names.push_back(element.id);
                outlines.push_back(zoneOutline(element.record));
            }
        if (!names.empty()) {
            ClassTable table{"zone", "zone", {}};
            for (std::size_t i = 0; i < names.size(); ++i) {
                auto of_zone =
                    figuresBy(run, judgement.clear, {names[i]},
                              [&](std::size_t, const TruthPlace& truth) -> std::size_t {
                                  return locate(outlines[i], truth.place) == Side::Outside ? 1 : 0;
                              });
                table.classes.push_back(std::move(of_zone.front()));
            }
            judgement.tables.push_back(std::move(table));
        }
        if (judgement.knows_sensors)
            judgement.tables.push_back({"sensors", "sensors that see",
                                        figuresBy(run, judgement.clear, numbers,
                                                  [&](std::size_t, const TruthPlace& truth) {
                                                      return std::min(truth.sensors.value_or(0),
                                                                      most);
                                                  })});
        judgement.tables.push_back({"near", "others within 1 m",
                                    figuresBy(run, judgement.clear, numbers,
                                              [&](std::size_t frame, const TruthPlace& truth) {
                                                  return std::min(neighboursOf(run, frame, truth),
                                                                  most);
                                              })});
    }

    void writeReport(const Judgement& judgement, const Scene& scene,
                     const std::string& command) const {
        if (report_format_ == "json") return writeAll(report_, judgementJson(judgement));
        const ReportPage page = pages::typeset(judgementPage(judgement, scene, command));
        writeAll(report_, report_format_ == "pdf" ? pages::pdfOf(page) : pages::htmlOf(page));
    }

    void writeFilms(const Judgement& judgement, const Scene& scene,
                    const CommonOptions& common) const {
        fs::create_directories(films_);
        constexpr std::size_t kMostFilms = 100;
        const std::size_t count = std::min(judgement.losses.size(), kMostFilms);
        for (std::size_t i = 0; i < count; ++i)
            writeAll((fs::path(films_) / lossFilmName(judgement, i)).string(),
                     lossFilm(judgement, scene, i));
        if (count < judgement.losses.size())
            warn(common, "coverage",
                 "films of the first " + std::to_string(count) + " of " +
                     std::to_string(judgement.losses.size()) + " losses are written");
    }

    std::string tracks_, truths_ = "all", films_, run_, report_, report_format_;
    std::optional<double> rate_;
    bool json_ = false;
    int width_ = 1200;
    std::vector<std::string> zones_;
    std::vector<TrackRequirement> requirements_;
};

}  // namespace

std::unique_ptr<OptionGroup> makeTrackJudge() { return std::make_unique<TrackJudge>(); }

}  // namespace ispace::judge
