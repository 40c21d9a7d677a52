// SPDX-License-Identifier: GPL-3.0-or-later
// Options about records: served once more, or drawn.
#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "cli/outputs.h"
#include "simrun/options.h"
#include "view/gif_film.h"

namespace ispace {

namespace {

/// Of pictures, then of films.
std::vector<std::string> formats() { return {"png", "svg", "pdf", "y4m", "gif"}; }

}  // namespace

void SimrunCommand::declareReplay() {
    SimrunOptions& o = options_;
    line_.file(
        "--replay", "DIR", o.replay,
        "serve the run that --record wrote there once more: all go as recorded, sensors read; "
        "ENV and LAYOUT are those of the record unless given",
        Enters::BaseName);
    line_.parsed(
        "--from", "TIME",
        [&o](const std::string& text) { o.from = timeOption(text, SimTime(0), kLongestTime); },
        "begin the replay at this time of the record", Enters::History);
    line_.flag("--hold", o.holds,
               "serve the last moment of the record on and on, instead of ending with it",
               Enters::Nothing);
}

void SimrunCommand::checkReplay() const {
    const SimrunOptions& o = options_;
    if (o.replay.empty()) {
        for (const char* option : {"--from", "--hold"})
            if (line_.given(option))
                throw UsageError(std::string(option) + " is about a record: give --replay DIR");
        return;
    }
    for (const char* option : {"--script", "--dt"})
        if (line_.given(option))
            throw UsageError(std::string(option) +
                             " does not go with --replay: steps and motions are the record's");
    if (o.until && *o.until <= o.from) throw UsageError("--from is not before --until");
    if (!o.record.empty() && o.record == o.replay)
        throw UsageError("--record would replace what --replay reads: give another folder");
}

void SimrunCommand::declareDrawing() {
    DrawingOptions& o = options_.drawing;
    line_.choice("--to", to_, formats(), "format of FILE (default: its suffix, else png)",
                 Enters::Nothing);
    constexpr int kNarrowest = 200, kWidest = 10000;
    line_.count("--width", "PIXELS", o.width, kNarrowest, kWidest,
                "width of the picture or the film", Enters::Nothing);
    const auto positive = [this](const std::string& name, double& variable, double most,
                                 const std::string& help) {
        line_.parsed(
            name, "N",
            [&variable, most](const std::string& text) {
                const auto value = parseDouble(text);
                constexpr double kLeast = 0.001;
                if (!value || *value < kLeast || *value > most)
                    throw UsageError(excerpt(text) + " is no number from 0.001 to " +
                                     formatDouble(most));
                variable = *value;
            },
            help, Enters::Nothing);
    };
    positive("--fps", o.fps, 1000, "pictures a second of the film (default 25)");
    positive("--speed", o.speed, 1e6, "simulated seconds in a second of the film (default 1)");
}

void SimrunCommand::takeDrawing() {
    SimrunOptions& o = options_;
    if (!line_.given("--output")) {
        for (const char* option : {"--to", "--width", "--fps", "--speed"})
            if (line_.given(option))
                throw UsageError(std::string(option) +
                                 " is about a picture of a record: give -o FILE");
        return;
    }
    if (o.replay.empty())
        throw UsageError(
            "-o is a picture or a film of a record: give --replay DIR (a run writes to --record "
            "DIR)");
    std::vector<std::string> of_runs{"--record", "--expect", "--clock",    "--hold",
                                     "--listen", "--web",    "--port-file"};
    for (const WireProtocol* const protocol : wireProtocols())
        of_runs.push_back("--" + std::string(protocol->name));
    for (const std::string& option : of_runs)
        if (line_.given(option))
            throw UsageError(option + " does not go with -o, which serves nobody");
    const bool is_set = OutputSet::of(o.common.output).has_value();
    o.drawing.format =
        is_set && to_.empty() ? "png" : outputFormat(to_, o.common.output, formats());
    if (is_set && o.drawing.format != "png")
        throw UsageError("the pictures of a film are PNG; a film in one file is .y4m or .gif");
    const bool is_gif = o.drawing.format == "gif";
    const bool is_file = is_gif || o.drawing.format == "y4m";
    const bool is_film = is_set || is_file;
    for (const char* option : {"--fps", "--speed", "--from"})
        if (!is_film && line_.given(option))
            throw UsageError(std::string(option) +
                             " is about films: give -o FILE.y4m, FILE.gif or a folder");
    if (!is_set && o.drawing.format != "svg")
        refuseTerminal(o.common.output, is_file ? "a film" : "a picture");
    if (is_gif && (o.drawing.fps < GifFilm::kSlowest || o.drawing.fps > GifFilm::kFastest))
        throw UsageError("--fps of a GIF is from " + formatDouble(GifFilm::kSlowest) + " to " +
                         formatDouble(GifFilm::kFastest) + ": give another one, or -o FILE.y4m");
}

}  // namespace ispace
