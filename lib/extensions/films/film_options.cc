// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/films/film_options.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/number.h"
#include "cli/outputs.h"
#include "cli/progress_bar.h"
#include "drawing/film.h"
#include "extensions/films/run_picture.h"
#include "scene/run/run_reader.h"

namespace ispace::films {

namespace {

constexpr double kRounding = 1e-9;  // s

/// Of pictures, then of films.
std::vector<std::string> formats() { return {"png", "svg", "pdf", "y4m", "gif"}; }

class FilmOptions : public DrawingGroup {
  public:
    void declare(CommandLine& line) override;
    void take(const CommandLine& line, const std::string& output) override;
    [[nodiscard]] std::int64_t draw(const DrawnRun& run) const override;

  private:
    std::string format_;           // "" for the default until take()
    int width_ = 1200;             // pixels
    double fps_ = 25, speed_ = 1;  // of a film: pictures per second, simulated seconds per second

    std::int64_t takeFilm(const DrawnRun& run, RunPicture& picture,
                          const std::function<void(const Image&, int)>& write) const;
    std::int64_t writeY4m(const DrawnRun& run, RunPicture& picture) const;
    std::int64_t writeGif(const DrawnRun& run, RunPicture& picture) const;
    std::int64_t writePictures(const DrawnRun& run, const OutputSet& files,
                               RunPicture& picture) const;
};

void FilmOptions::declare(CommandLine& line) {
    line.group("Pictures and films of a record");
    line.choice("--to", format_, formats(), "format of FILE (default: its suffix, else png)",
                Enters::Nothing);
    constexpr int kMinWidth = 200, kMaxWidth = 10000;
    line.count("--width", "PIXELS", width_, kMinWidth, kMaxWidth,
               "width of the picture or the film", Enters::Nothing);
    const auto positive = [&line](const std::string& name, double& variable, double most,
                                  const std::string& help) {
        line.parsed(
            name, "N",
            [&variable, most](const std::string& text) {
                const auto value = parseDouble(text);
                constexpr double kMinValue = 0.001;
                if (!value || *value < kMinValue || *value > most)
                    throw UsageError(excerpt(text) + " is no number from 0.001 to " +
                                     formatDouble(most));
                variable = *value;
            },
            help, Enters::Nothing);
    };
    positive("--fps", fps_, 1000, "pictures a second of the film (default 25)");
    positive("--speed", speed_, 1e6, "simulated seconds in a second of the film (default 1)");
}

void FilmOptions::take(const CommandLine& line, const std::string& output) {
    const bool is_set = OutputSet::of(output).has_value();
    format_ = is_set && format_.empty() ? "png" : outputFormat(format_, output, formats());
    if (is_set && format_ != "png")
        throw UsageError("the pictures of a film are PNG; a film in one file is .y4m or .gif");
    const bool is_gif = format_ == "gif";
    const bool is_file = is_gif || format_ == "y4m";
    const bool is_film = is_set || is_file;
    for (const char* option : {"--fps", "--speed", "--from"})
        if (!is_film && line.given(option))
            throw UsageError(std::string(option) +
                             " is about films: give -o FILE.y4m, FILE.gif or a folder");
    if (!is_set && format_ != "svg") refuseTerminal(output, is_file ? "a film" : "a picture");
    if (is_gif && (fps_ < GifFilm::kSlowest || fps_ > GifFilm::kFastest))
        throw UsageError("--fps of a GIF is from " + formatDouble(GifFilm::kSlowest) + " to " +
                         formatDouble(GifFilm::kFastest) + ": give another one, or -o FILE.y4m");
}

double endOf(const DrawnRun& run) { return seconds(run.until.value_or(kMaxTime)) + kRounding; }

/// Reads the record up to its end; calls `before` for each moment that is still to be added.
void readRecord(const DrawnRun& run, RunPicture& picture,
                const std::function<void(double)>& before) {
    RunReader reader(run.record);
    while (reader.next() && reader.time() <= endOf(run)) {
        before(reader.time());
        picture.add(reader);
    }
    if (reader.isCut())
        warn(run.common, "simrun", "the record ends in the midst of a step, which is left out");
}

/// Returns the time of the last moment; 0 without one. Drawing takes far longer.
double lastMoment(const DrawnRun& run) {
    double last = 0;
    RunReader reader(run.record);
    while (reader.next() && reader.time() <= endOf(run)) last = reader.time();
    return last;
}

/// Takes the pictures of a film: one each 1/fps s of it, and one of the end.
std::int64_t FilmOptions::takeFilm(const DrawnRun& run, RunPicture& picture,
                                   const std::function<void(const Image&, int)>& write) const {
    int count = 0;
    bool has_moment = false;
    double last = 0;
    const auto time_of = [&](int frame) { return seconds(run.from) + frame * speed_ / fps_; };
    const auto progress = makeProgress("simrun", run.common.progress, run.common.quiet);
    const double length = std::max(0.0, lastMoment(run) - seconds(run.from));
    progress->begin("pictures", 1 + std::llround(length * fps_ / speed_));
    readRecord(run, picture, [&](double time) {
        for (; has_moment && time_of(count) < time - kRounding; ++count) {
            write(picture.frame(), count);
            progress->advance(1);
        }
        has_moment = true;
        last = time;
    });
    if (last < time_of(0) - kRounding)
        throw UsageError("--from: the record ends at t=" + formatDouble(last));
    write(picture.frame(), count);
    progress->advance(1);
    progress->end();
    return count + 1;
}

std::int64_t FilmOptions::writeY4m(const DrawnRun& run, RunPicture& picture) const {
    FileStream file(run.common.output);
    const std::int64_t count = takeFilm(run, picture, [&](const Image& image, int frame) {
        if (frame == 0) file.stream() << y4mHeader(image.width, image.height, fps_);
        file.stream() << y4mFrame(image);
    });
    file.commit();
    return count;
}

std::int64_t FilmOptions::writeGif(const DrawnRun& run, RunPicture& picture) const {
    FileStream file(run.common.output);
    GifFilm film(fps_);
    const std::int64_t count = takeFilm(
        run, picture, [&](const Image& image, int /*frame*/) { file.stream() << film.add(image); });
    file.stream() << film.end();
    file.commit();
    return count;
}

std::int64_t FilmOptions::writePictures(const DrawnRun& run, const OutputSet& files,
                                        RunPicture& picture) const {
    const std::string name = "run";
    EncodeAhead pictures(encodePng, writeAll);
    const std::int64_t count = takeFilm(run, picture, [&](const Image& image, int frame) {
        if (frame == 0) files.prepare({name}, true, {".png"});
        pictures.add(files.fileOf(name, frame, ".png"), image);
    });
    pictures.finish();
    return count;
}

std::int64_t FilmOptions::draw(const DrawnRun& run) const {
    RunPicture picture(run.scene, {.width = width_, .title = run.title});
    if (const auto files = OutputSet::of(run.common.output))
        return writePictures(run, *files, picture);
    if (format_ == "y4m") return writeY4m(run, picture);
    if (format_ == "gif") return writeGif(run, picture);
    readRecord(run, picture, [](double) {});
    const PictureFormat format = format_ == "svg"   ? PictureFormat::Svg
                                 : format_ == "pdf" ? PictureFormat::Pdf
                                                    : PictureFormat::Png;
    writeAll(run.common.output, picture.write(format));
    return 1;
}

}  // namespace

std::unique_ptr<DrawingGroup> makeFilmOptions() { return std::make_unique<FilmOptions>(); }

}  // namespace ispace::films
