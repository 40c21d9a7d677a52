// SPDX-License-Identifier: GPL-3.0-or-later
#include "simrun/drawing.h"

#include <functional>
#include <optional>
#include <ostream>

#include "base/file.h"
#include "base/number.h"
#include "cli/outputs.h"
#include "layout/run_reader.h"
#include "view/encode_ahead.h"
#include "view/gif_film.h"
#include "view/run_picture.h"

namespace ispace {

namespace {

constexpr double kRounding = 1e-9;  // s

double endOf(const SimrunOptions& options) {
    return seconds(options.until.value_or(kLongestTime)) + kRounding;
}

/// Reads the record up to --until; `before` hears of each moment that is still to be added.
void readRecord(const SimrunOptions& options, RunPicture& picture,
                const std::function<void(double)>& before) {
    RunReader reader(options.replay);
    while (reader.next() && reader.time() <= endOf(options)) {
        before(reader.time());
        picture.add(reader);
    }
    if (reader.isCut())
        warn(options.common, "simrun", "the record ends in the midst of a step, which is left out");
}

/// Takes the pictures of a film: one each 1/fps s of it, and one of the end.
std::int64_t takeFilm(const SimrunOptions& options, RunPicture& picture,
                      const std::function<void(const Image&, int)>& write) {
    const DrawingOptions& film = options.drawing;
    int count = 0;
    bool has_moment = false;
    const auto time_of = [&](int frame) {
        return seconds(options.from) + frame * film.speed / film.fps;
    };
    readRecord(options, picture, [&](double time) {
        for (; has_moment && time_of(count) < time - kRounding; ++count)
            write(picture.frame(), count);
        has_moment = true;
    });
    write(picture.frame(), count);
    return count + 1;
}

std::int64_t writeY4m(const SimrunOptions& options, RunPicture& picture) {
    FileStream file(options.common.output);
    const std::int64_t count = takeFilm(options, picture, [&](const Image& image, int frame) {
        if (frame == 0) file.stream() << y4mHeader(image.width, image.height, options.drawing.fps);
        file.stream() << y4mFrame(image);
    });
    file.commit();
    return count;
}

std::int64_t writeGif(const SimrunOptions& options, RunPicture& picture) {
    FileStream file(options.common.output);
    GifFilm film(options.drawing.fps);
    const std::int64_t count = takeFilm(options, picture, [&](const Image& image, int /*frame*/) {
        file.stream() << film.add(image);
    });
    file.stream() << film.end();
    file.commit();
    return count;
}

std::int64_t writePictures(const SimrunOptions& options, const OutputSet& files,
                           RunPicture& picture) {
    const std::string name = "run";
    files.prepare({name}, true, {".png"});
    EncodeAhead pictures(encodePng, writeAll);
    const std::int64_t count = takeFilm(options, picture, [&](const Image& image, int frame) {
        pictures.add(files.fileOf(name, frame, ".png"), image);
    });
    pictures.finish();
    return count;
}

}  // namespace

void drawRecord(const SimrunOptions& options, const Scene& scene, const std::string& title) {
    RunPicture picture(scene, {.width = options.drawing.width, .title = title});
    std::int64_t count = 1;
    if (const auto files = OutputSet::of(options.common.output)) {
        count = writePictures(options, *files, picture);
    } else if (options.drawing.format == "y4m") {
        count = writeY4m(options, picture);
    } else if (options.drawing.format == "gif") {
        count = writeGif(options, picture);
    } else {
        readRecord(options, picture, [](double) {});
        const PictureFormat format = options.drawing.format == "svg"   ? PictureFormat::Svg
                                     : options.drawing.format == "pdf" ? PictureFormat::Pdf
                                                                       : PictureFormat::Png;
        writeAll(options.common.output, picture.write(format));
    }
    writeDependencies(options.common,
                      std::vector<std::string>{RecordedFiles(options.replay).robots});
    talk(options.common, "simrun",
         std::to_string(count) + (count == 1 ? " picture" : " pictures") + " drawn");
}

}  // namespace ispace
