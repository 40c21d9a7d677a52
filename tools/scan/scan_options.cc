// SPDX-License-Identifier: GPL-3.0-or-later
#include "scan/scan_options.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "base/number.h"
#include "cli/common_options.h"
#include "cli/outputs.h"
#include "extensions.h"
#include "sense/formats/reading_format.h"

namespace ispace {

namespace {

double numberWithin(const std::string& text, double lowest, double highest) {
    const std::optional<double> number = parseDouble(text);
    if (!number || !(*number >= lowest && *number <= highest))
        throw UsageError("`" + text + "` is no number from " + formatDouble(lowest) + " to " +
                         formatDouble(highest));
    return *number;
}

DepthSpectrum depthSpectrum(const std::string& text) {
    constexpr double kMaxDepth = 1e6, kMinSpan = 0.001;
    const std::size_t comma = std::min(text.find(','), text.size());
    if (comma == text.size())
        throw UsageError("`" + text + "` is no pair WARM,COLD, such as 0.5,3");
    const DepthSpectrum spectrum{numberWithin(text.substr(0, comma), 0, kMaxDepth),
                                 numberWithin(text.substr(comma + 1), 0, kMaxDepth)};
    if (std::fabs(spectrum.warm - spectrum.cold) < kMinSpan)
        throw UsageError("the two ends must be a millimetre apart at least");
    return spectrum;
}

}  // namespace

ScanCommand::ScanCommand(int argc, const char* const* argv)
    : ToolCommand(
          "scan", "[ENV] [LAYOUT]",
          "Simulate the readings of sensors: lasers, 3-D rangers, cameras, ultrasonic receivers. "
          "Without LAYOUT read it from stdin unless ENV holds sensors with a pose.") {
    line_.built(extensions().names());
    ToolExtensions tool_extensions(extensions().options(), "scan");
    declare(tool_extensions);
    line_.essential({"--version", "--to", "--select", "--frames", "--noise", "--poses", "--model",
                     "--coordinates", "--size", "--samples", "--run", "--list-models", "--storey",
                     "--output", "--quiet", "--threads", "--seed"});
    line_.parse(argc, argv);
    ScanToolOptions& o = options_;
    o.task = tool_extensions.task(line_, {o.common, o.rules, o.operands});
    if (o.task) return;
    constexpr const char* kSingle[] = {"--run", "--list-models"};
    checkBatchOptions(line_, o.batch, o.common, o.operands, kSingle);
    if (!o.batch.list.empty() && o.poses == "-")
        throw UsageError("--poses: stdin is not read again for each line of LIST: give a file");
    // The suffix of a part does not name the format of its readings.
    const bool is_part =
        o.batch.shard && o.batch.list.empty() && suffixOf(o.common.output) == "part";
    const std::string output = is_part ? "-" : o.common.output;
    o.format = outputFormat(to_, output, readingFormats(),
                            {{"log", "carmen"}, {"jpg", "jpeg"}, {"rgb", "rgb24"}});
    o.noise = noise_.value_or(false);
    o.color = color_.value_or(true);
    o.encoding = encoding_ == "ascii" ? Encoding::Ascii : Encoding::Binary;
    if (compression_ == "zstd") o.compression = McapCompression::Zstd;
    if (las_version_ == "1.3") o.las_minor = 3;
    o.coordinates = coordinates_ == "sensor" ? Coordinates::Sensor : Coordinates::World;
    o.photo.light = light_ == "lamps" ? Illumination::Lamps
                    : light_ == "sky" ? Illumination::Sky
                                      : Illumination::Auto;
    o.photo.sensor_bodies = sensor_bodies_.value_or(false);
    o.photo.seed = o.common.seed;
    o.photo.with_noise = o.noise;
    check();
}

void ScanCommand::declare(ToolExtensions& tool_extensions) {
    ScanToolOptions& o = options_;
    line_.example("scan room.env layout.3dm --noise -o readings.jsonl",
                  "a reading of each sensor, with the noise of its device");
    line_.example("scan room.env --poses way.txt --model utm-30lx -o drive.mcap",
                  "readings of one scanner along a way, for ROS 2 and Foxglove");
    line_.operands(o.operands, 2);
    addListOption(line_, o.batch,
                  "-o names the folder or pattern of the readings, and stdout receives a line of "
                  "JSON for each");
    line_.choice("--to", to_, readingFormats(),
                 "format of the readings (default: by the suffix of -o, else jsonl)",
                 Enters::History);
    line_.texts("--select", "GLOB", o.select, "read only sensors whose ids match (* ? [a-z])",
                Enters::History);
    constexpr int kMaxFrames = 1'000'000'000;
    line_.count(
        "--frames", "N", o.frames, 1, kMaxFrames,
        "readings of each sensor, at its rate (default 1); with --motion, at most this many",
        Enters::History);
    line_.switchFlag("--noise", "--no-noise", noise_, "add the devices' noise, from --seed",
                     "read without noise (default)", Enters::History);
    line_.file("--poses", "FILE", o.poses,
               "one reading at each pose of a TUM trajectory, - for stdin: `t x y z qx qy qz qw`",
               Enters::BaseName);
    line_.text("--model", "MODEL[,KEY=VALUE...]", o.model,
               "sensor that takes the poses: a device or a bare kind, e.g. urg-04lx or "
               "laser,range=8,fov=270 (default: the one sensor there is)",
               Enters::History);
    line_.flag("--motion", o.motion,
               "drive along the poses at the sensor's rate, each beam from the pose at its time",
               Enters::History);
    line_.file("--run", "DIR", o.run,
               "a record of `simrun --record`: its scans, in the format of --to", Enters::BaseName);
    line_.choice("--coordinates", coordinates_, {"world", "sensor"},
                 "frame of the points in csv, pcd and ply (default world)", Enters::History);
    line_.choice("--encoding", encoding_, {"binary", "ascii"},
                 "encoding of pcd and ply (default binary)", Enters::History);
    line_.choice("--compression", compression_, {"none", "zstd"},
                 "mcap: compression of its chunks (default none)", Enters::History);
    line_.choice("--las-version", las_version_, {"1.4", "1.3"},
                 "version of las: 1.3 for older programs (default 1.4)", Enters::History);
    constexpr double kMaxScale = 1e6;
    line_.parsed(
        "--depth-scale", "N",
        [&o](const std::string& text) { o.depth_per_metre = numberWithin(text, 1, kMaxScale); },
        "depth png: units per metre (default 1000: millimetres)", Enters::History);
    line_.switchFlag("--color", "--no-color", color_,
                     "depth png: also NAME-color.png for people (default)",
                     "depth png: no such picture", Enters::History);
    line_.parsed(
        "--spectrum", "WARM,COLD",
        [&o](const std::string& text) { o.spectrum = depthSpectrum(text); },
        "NAME-color.png: depths in metres at the red and the blue end of the colours; 3,0.5 turns "
        "them round (default: the limits of the sensor, near is red)",
        Enters::History);
    line_.parsed(
        "--size", "W[,H]", [this](const std::string& text) { size_ = pictureSize(text); },
        "pixels of a view, W,H; or of each side of an obstacle map, W (default 800)",
        Enters::History);
    constexpr double kColdest = -100, kHottest = 100;
    line_.parsed(
        "--temperature", "C",
        [&o](const std::string& text) { o.celsius = numberWithin(text, kColdest, kHottest); },
        "air temperature for ultrasound, Celsius (default 20)", Enters::History);
    declarePictures();
    tool_extensions.declare(line_);
    line_.group("Jobs");
    addBatchOptions(line_, o.batch, "of its readings");
    line_.flag("--list-models", o.list_models, "list the sensors of the device catalogue, and end",
               Enters::Nothing);
    addSceneRules(line_, o.rules);
    addStoreyOption(line_, o.rules, "default: all storeys");
    addCommonOptions(line_, o.common,
                     "write the readings there: a file, a folder, or a pattern with %d (frame) and "
                     "%s (sensor) (default: stdout)");
}

void ScanCommand::declarePictures() {
    PhotoOptions& photo = options_.photo;
    constexpr int kMaxSamples = 4096;
    line_.count("--samples", "N", photo.samples, 1, kMaxSamples,
                "pictures: lines of sight for each pixel; more are smoother", Enters::History);
    line_.choice("--light", light_, {"auto", "lamps", "sky"},
                 "pictures: lamps under the ceiling, or sun and sky (default auto: "
                 "lamps where there is a ceiling)",
                 Enters::History);
    constexpr double kMaxStops = 20;
    line_.parsed(
        "--exposure", "EV",
        [&photo](const std::string& text) {
            photo.exposure = std::exp2(numberWithin(text, -kMaxStops, kMaxStops));
        },
        "pictures: stops brighter, negative darker (default 0: a white wall in full "
        "light is white)",
        Enters::History);
    line_.switchFlag("--sensor-bodies", "--no-sensor-bodies", sensor_bodies_,
                     "pictures of cameras: the bodies of other sensors are seen",
                     "pictures of cameras: sensors are not seen (default)", Enters::History);
    line_.parsed(
        "--layers", "labels,depth",
        [&photo](const std::string& text) {
            std::istringstream list(text);
            for (std::string layer; std::getline(list, layer, ',');) {
                if (layer != "labels" && layer != "depth")
                    throw UsageError("`" + layer + "` is none of labels|depth");
                (layer == "labels" ? photo.labels : photo.depths) = true;
            }
        },
        "png and jpeg of cameras: also NAME-labels.png with NAME-labels.csv, NAME-depth.png",
        Enters::History);
}

void ScanCommand::check() {
    ScanToolOptions& o = options_;
    checkBatch();
    if (!o.run.empty())
        for (const char* name : {"--frames", "--poses", "--model", "--motion", "--noise"})
            if (line_.given(name))
                throw UsageError(std::string(name) +
                                 " does not go with --run, whose readings are taken already");
    if (size_) {
        constexpr int kMinPixels = 200, kMaxPixels = 8000;
        o.map_pixels = size_->columns;
        if (size_->rows != 0 || o.map_pixels < kMinPixels || o.map_pixels > kMaxPixels)
            throw UsageError("--size: an obstacle map is a square of " +
                             std::to_string(kMinPixels) + " to " + std::to_string(kMaxPixels) +
                             " pixels a side");
    }
    if (line_.given("--las-version") && o.format != "las")
        throw UsageError("--las-version is about las, and --to says " + o.format);
    if (line_.given("--compression") && o.format != "mcap")
        throw UsageError("--compression is about mcap, and --to says " + o.format);
    if (line_.given("--coordinates") && o.format != "csv" && o.format != "pcd" &&
        o.format != "ply" && o.format != "las")
        throw UsageError("--coordinates is about points in csv, pcd and ply, and --to says " +
                         o.format);
    if (line_.given("--encoding") && o.format != "pcd" && o.format != "ply")
        throw UsageError("--encoding is about pcd and ply, and --to says " + o.format);
    if (line_.given("--layers") && o.format != "png" && o.format != "jpeg")
        throw UsageError("--layers are files beside pictures in png or jpeg, and --to says " +
                         o.format);
    if (o.list_models && !o.operands.empty())
        throw UsageError("--list-models reads no operands, and there is " + o.operands.front());
    if (o.poses.empty()) {
        if (!o.model.empty()) throw UsageError("--model is the sensor of --poses: give both");
        if (o.motion) throw UsageError("--motion goes along --poses: give both");
    } else {
        if (o.frames && !o.motion)
            throw UsageError(
                "--frames counts readings of placed sensors and of --motion; --poses has its own");
        if (!o.model.empty() && !o.select.empty())
            throw UsageError("--select and --model both say which sensor takes the poses");
    }
}

void ScanCommand::checkBatch() const {
    const ScanToolOptions& o = options_;
    const std::string option = o.batch.shard ? "--shard" : o.batch.resume ? "--resume" : "--merge";
    if (!o.batch.shard && !o.batch.resume && !o.batch.merge) return;
    if (!o.run.empty() || o.list_models)
        throw UsageError(option + " is for readings that are taken: leave out " +
                         (!o.run.empty() ? "--run" : "--list-models"));
    if (o.batch.merge && OutputSet::of(o.common.output))
        throw UsageError(
            "--merge: files of one reading each need no merging, their shards write "
            "them");
}

void ScanCommand::checkSensors(const std::vector<Sensor>& read) const {
    const auto reads = [&read](auto is_one) {
        return std::any_of(read.begin(), read.end(), is_one);
    };
    if (!reads([](const Sensor& sensor) { return sensor.is<Camera>(); }))
        for (const char* name :
             {"--samples", "--light", "--exposure", "--sensor-bodies", "--layers"})
            if (line_.given(name))
                throw UsageError(std::string(name) +
                                 " is for pictures of cameras, and no camera is read");
    const bool has_depths =
        options_.format == "png" && reads([](const Sensor& sensor) { return sensor.is<Ranger>(); });
    const bool has_map =
        options_.format == "png" && reads([](const Sensor& sensor) { return sensor.is<Laser>(); });
    if (size_ && !has_map)
        throw UsageError("--size is for views and for obstacle maps of lasers, and none is drawn");
    if (line_.given("--depth-scale") && !has_depths)
        throw UsageError("--depth-scale is for depth pictures of rangers, and none is written");
    if (line_.given("--color") && !has_depths)
        throw UsageError("--color is for depth pictures of rangers, and none is written");
    if (options_.spectrum && !(has_depths && options_.color))
        throw UsageError("--spectrum is for depth pictures in colours, and none is written");
}

}  // namespace ispace
