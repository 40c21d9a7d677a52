// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/formats/reading_format.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <utility>

#include "base/error.h"
#include "base/number.h"
#include "raster/codec.h"
#include "scene/sensor/sensor.h"
#include "sense/formats/camera_info.h"
#include "sense/formats/reading_text.h"

namespace ispace {

void FormatBase::accept(std::string_view format, std::string_view what,
                        bool (*is_held)(const Sensor&)) const {
    for (const Sensor& one : sensors_.read)
        if (!is_held(one)) refuse(format, what, one);
}

void FormatBase::refuse(std::string_view format, std::string_view what, const Sensor& one) {
    throw UsageError(std::string(format) + " holds " + std::string(what) + ", and " + one.id +
                     " is a " + std::string(kindOf(one.model).keyword) +
                     "; choose sensors with --select, or another format with --to");
}

std::string FormatBase::whole(std::size_t index, const Reading& reading) const {
    std::string bytes, appended;
    append(appended, index, reading);
    const auto file = stream([&bytes](std::string_view piece) { bytes += piece; });
    file->write(appended);
    file->finish();
    return bytes;
}

namespace {

/// Concatenates readings.
class PlainStream final : public ReadingStream {
  public:
    PlainStream(ByteSink write, const std::string& header) : write_(std::move(write)) {
        write_(header);
    }
    void write(std::string_view appended) override { write_(appended); }

  private:
    ByteSink write_;
};

}  // namespace

std::unique_ptr<ReadingStream> ReadingFormat::stream(ByteSink write) const {
    return std::make_unique<PlainStream>(std::move(write), header());
}

namespace {

class Jsonl final : public FormatBase {
  public:
    Jsonl(const Sensors& sensors, FormatOptions options)
        : FormatBase(sensors, std::move(options), ".jsonl") {}
    [[nodiscard]] std::string header() const override {
        return scanHeaderLine(options_.history, options_.seed);
    }
    void append(std::string& out, std::size_t index, const Reading& reading) const override {
        for (const ReadingView& view : viewsOf(sensor(index), reading, receivers(index)))
            appendLine(out, view);
    }
};

class Csv final : public FormatBase {
  public:
    Csv(const Sensors& sensors, FormatOptions options)
        : FormatBase(sensors, std::move(options), ".csv") {
        accept("csv", "numbers", [](const Sensor& one) { return !isCamera(one); });
    }
    [[nodiscard]] std::string header() const override { return csvHeader(sensors_.read.front()); }
    void checkStream() const override {
        for (const Sensor& one : sensors_.read)
            if (&kindOf(one.model) != &kindOf(sensors_.read.front().model))
                refuse("csv", "sensors of one kind", one);
    }
    [[nodiscard]] std::string whole(std::size_t index, const Reading& reading) const override {
        std::string bytes = csvHeader(sensor(index));
        append(bytes, index, reading);
        return bytes;
    }
    void append(std::string& out, std::size_t index, const Reading& reading) const override {
        appendRows(out, sensor(index), reading, options_.coordinates, receivers(index));
    }
};

/// Writes ranges and depths as raw float32, little-endian; no return is +infinity.
class Raw final : public FormatBase {
  public:
    Raw(const Sensors& sensors, FormatOptions options)
        : FormatBase(sensors, std::move(options), ".raw") {
        accept("raw", "ranges", hasRanges);
    }
    void append(std::string& out, std::size_t index, const Reading& reading) const override {
        static_assert(std::endian::native == std::endian::little);
        for (const ReadingView& view : viewsOf(sensor(index), reading))
            for (const ReadingField& field : readingKind(view.sensor.model).fields) {
                const FieldValue value =
                    (field.uses & kInArray) != 0 ? field.value(view) : FieldValue();
                if (const auto* const ranges = std::get_if<std::span<const float>>(&value))
                    out.append(reinterpret_cast<const char*>(ranges->data()), ranges->size_bytes());
            }
    }
    [[nodiscard]] bool isBinary() const override { return true; }
};

/// Writes points by `write`, one file per reading.
class Cloud : public FormatBase {
  public:
    using Writer = std::string (*)(const PointCloud& cloud, Encoding encoding);
    Cloud(const Sensors& sensors, FormatOptions options, const std::string& name, Writer write)
        : FormatBase(sensors, std::move(options), "." + name), write_(write) {
        accept(name, "points", hasRanges);
    }
    void append(std::string& out, std::size_t index, const Reading& reading) const override {
        out += write_(points(index, reading, options_.coordinates), options_.encoding);
    }
    [[nodiscard]] bool isStream() const override { return false; }
    [[nodiscard]] bool isBinary() const override { return options_.encoding == Encoding::Binary; }

  private:
    Writer write_;
};

struct Pcd final : Cloud {
    Pcd(const Sensors& sensors, FormatOptions options)
        : Cloud(sensors, std::move(options), "pcd", pcdOf) {}
};

struct Ply final : Cloud {
    Ply(const Sensors& sensors, FormatOptions options)
        : Cloud(sensors, std::move(options), "ply", plyOf) {}
};

class Carmen final : public FormatBase {
  public:
    Carmen(const Sensors& sensors, FormatOptions options)
        : FormatBase(sensors, std::move(options), ".log") {
        accept("carmen", "scans of level lasers",
               [](const Sensor& one) { return one.is<Laser>(); });
        for (const Sensor& laser : sensors.read)
            if (!laser.pose.isLevel() || laser.as<Laser>().sweep == SweepAxis::Tilt ||
                laser.as<Laser>().sweep == SweepAxis::Roll)
                throw UsageError("carmen holds scans of level lasers, and " + laser.id +
                                 " is tilted or rolled; choose sensors with --select, or another "
                                 "format with --to");
    }
    [[nodiscard]] std::string header() const override { return carmenHeader(); }
    void append(std::string& out, std::size_t index, const Reading& reading) const override {
        append(out, index + 1, sensor(index), std::get<std::vector<Scan>>(reading));
    }
    [[nodiscard]] std::string whole(std::size_t index, const Reading& reading) const override {
        std::string bytes = header();
        append(bytes, 1, sensor(index), std::get<std::vector<Scan>>(reading));
        return bytes;
    }
    void checkStream() const override {
        // Maximum that readers know: ROBOTLASER1 and ROBOTLASER2.
        constexpr std::size_t kMaxLasers = 2;
        if (sensors_.read.size() > kMaxLasers)
            throw UsageError("a CARMEN log tells two lasers apart, and these are " +
                             std::to_string(sensors_.read.size()) +
                             ": name a folder (-o DIR/), or choose some with --select");
    }

  private:
    static void append(std::string& out, std::size_t number, const Sensor& laser,
                       const std::vector<Scan>& scans) {
        for (const Scan& scan : scans) {
            if (!scan.pose.isLevel())
                throw FormatError({"", 0, 0,
                                   laser.id +
                                       " is tilted or rolled at t=" + formatDouble(scan.time) +
                                       ", and a CARMEN log is flat; take jsonl, csv or pcd"});
            appendCarmenLine(out, number, laser, scan, carrierOf(laser, scan));
        }
    }
    static Pose2 carrierOf(const Sensor& sensor, const Scan& scan) {
        const Pose2 own{scan.pose.position.onFloor(), scan.pose.heading};
        if (!sensor.mount) return own;
        const Pose3& mount = sensor.mount->robot_from_sensor;
        const Angle heading = own.heading - mount.heading;
        const Pose2 turned{{}, heading};
        const Vec2 way = turned * Vec2{mount.position.x, mount.position.y};
        return {own.position - way, heading};
    }
};

/// Writes pictures, depths and obstacle maps.
class Png final : public FormatBase {
  public:
    Png(const Sensors& sensors, FormatOptions options)
        : FormatBase(sensors, std::move(options), ".png") {
        accept("png", "pictures, depths and obstacle maps",
               [](const Sensor& one) { return hasRanges(one) || isCamera(one); });
        for (const Sensor& one : sensors.read)
            if (one.is<Laser>() && one.as<Laser>().scans() > 1)
                throw UsageError("an obstacle map shows one scan, and " + one.id +
                                 " sweeps; take pcd or ply");
    }
    void append(std::string& out, std::size_t index, const Reading& reading) const override {
        if (const auto* scans = std::get_if<std::vector<Scan>>(&reading)) {
            out += options_.drawings->obstacles(sensor(index), scans->front(), options_.map_pixels);
        } else if (const auto* photo = std::get_if<Photo>(&reading)) {
            const Camera& camera = sensor(index).as<Camera>();
            out += pngOfRgb(camera.columns, camera.rows, photo->rgb);
        } else {
            const Ranger& ranger = sensor(index).as<Ranger>();
            out += depthPng(ranger.columns, ranger.rows, std::get<DepthFrame>(reading).depths,
                            options_.depth_per_metre);
        }
    }
    [[nodiscard]] std::vector<ReadingFile> files(std::size_t index,
                                                 const Reading& reading) const override {
        std::vector<ReadingFile> files = FormatBase::files(index, reading);
        if (const auto* photo = std::get_if<Photo>(&reading))
            addFilesBeside(sensor(index), room(index), *photo, options_, files);
        if (const auto* frame = std::get_if<DepthFrame>(&reading)) {
            const Sensor& placed = sensor(index);
            if (isColored())
                files.push_back(
                    {kColor, options_.drawings->depths(placed, *frame, options_.spectrum)});
            if (placed.as<Ranger>().projection == Projection::Pinhole)
                files.push_back(
                    {kCameraInfo, cameraInfoYaml(cameraInfoOf(placed.as<Ranger>()), placed.id)});
        }
        return files;
    }
    [[nodiscard]] std::vector<std::string> warnings() const override {
        std::vector<std::string> found;
        const double farthest = kMaxDepth / options_.depth_per_metre;
        for (const Sensor& placed : sensors_.read) {
            if (!placed.is<Ranger>()) continue;
            const Ranger& ranger = placed.as<Ranger>();
            const double most = ranger.ambiguity > 0 ? std::min(ranger.ambiguity, ranger.max_range)
                                                     : ranger.max_range;
            if (most > farthest)
                found.push_back(placed.id + " sees as far as " + formatDouble(most) +
                                " m, and 16 bits end at " + formatDouble(farthest) +
                                " m, beyond which depths are 0; lower --depth-scale");
        }
        return found;
    }
    [[nodiscard]] std::vector<std::string> endings() const override {
        std::vector<std::string> endings = FormatBase::endings();
        if (std::any_of(sensors_.read.begin(), sensors_.read.end(),
                        [](const Sensor& one) { return one.is<Ranger>(); })) {
            if (isColored()) endings.emplace_back(kColor);
            endings.emplace_back(kCameraInfo);
        }
        if (std::any_of(sensors_.read.begin(), sensors_.read.end(), isCamera))
            addEndingsBeside(options_, endings);
        return endings;
    }
    [[nodiscard]] bool isStream() const override { return false; }
    [[nodiscard]] bool isBinary() const override { return true; }

  private:
    [[nodiscard]] bool isColored() const { return options_.color && options_.drawings != nullptr; }

    static constexpr double kMaxDepth = 65535;
    static constexpr const char* kColor = "-color.png";
};

class Jpeg final : public FormatBase {
  public:
    Jpeg(const Sensors& sensors, FormatOptions options)
        : FormatBase(sensors, std::move(options), ".jpg") {
        accept("jpeg", "pictures of cameras", isCamera);
    }
    void append(std::string& out, std::size_t index, const Reading& reading) const override {
        const Camera& camera = sensor(index).as<Camera>();
        out += jpegOfRgb(camera.columns, camera.rows, std::get<Photo>(reading).rgb);
    }
    [[nodiscard]] std::vector<ReadingFile> files(std::size_t index,
                                                 const Reading& reading) const override {
        std::vector<ReadingFile> files = FormatBase::files(index, reading);
        addFilesBeside(sensor(index), room(index), std::get<Photo>(reading), options_, files);
        return files;
    }
    [[nodiscard]] std::vector<std::string> endings() const override {
        std::vector<std::string> endings = FormatBase::endings();
        addEndingsBeside(options_, endings);
        return endings;
    }
    [[nodiscard]] bool isStream() const override { return false; }
    [[nodiscard]] bool isBinary() const override { return true; }
};

/// Concatenates the pictures of one camera, for programs that encode films.
class Film : public FormatBase {
  public:
    using Header = std::string (*)(const Camera& camera);
    using Append = void (*)(std::string& out, const Photo& photo);
    Film(const Sensors& sensors, FormatOptions options, std::string name, const std::string& ending,
         Header header, Append append)
        : FormatBase(sensors, std::move(options), ending),
          name_(std::move(name)),
          header_(header),
          append_(append) {
        accept(name_, "pictures of cameras", isCamera);
    }
    void checkStream() const override {
        if (sensors_.read.size() == 1) return;
        throw UsageError(name_ + " is the film of one camera, and there are " +
                         std::to_string(sensors_.read.size()) +
                         ": choose one with --select, or name a folder (-o DIR/) for a file each");
    }
    [[nodiscard]] std::string header() const override { return header_(sensor(0).as<Camera>()); }
    [[nodiscard]] std::string whole(std::size_t index, const Reading& reading) const override {
        std::string bytes = header_(sensor(index).as<Camera>());
        append(bytes, index, reading);
        return bytes;
    }
    void append(std::string& out, std::size_t /*index*/, const Reading& reading) const override {
        append_(out, std::get<Photo>(reading));
    }
    [[nodiscard]] bool isBinary() const override { return true; }

  private:
    std::string name_;
    Header header_;
    Append append_;
};

class Rgb24 final : public Film {
  public:
    Rgb24(const Sensors& sensors, FormatOptions options)
        : Film(
              sensors, std::move(options), "rgb24", ".rgb",
              [](const Camera&) { return std::string(); }, appendRgb24) {}
};

class Y4m final : public Film {
  public:
    Y4m(const Sensors& sensors, FormatOptions options)
        : Film(sensors, std::move(options), "y4m", ".y4m", y4mHeader, appendY4mFrame) {}
};

using Maker = std::unique_ptr<ReadingFormat> (*)(const Sensors& sensors, FormatOptions options);

template <typename Format>
std::unique_ptr<ReadingFormat> make(const Sensors& sensors, FormatOptions options) {
    return std::make_unique<Format>(sensors, std::move(options));
}

/// A new format requires a class, above or in a separate file, and a row here.
constexpr std::pair<std::string_view, Maker> kFormats[] = {
    {"jsonl", make<Jsonl>}, {"csv", make<Csv>},       {"raw", make<Raw>}, {"pcd", make<Pcd>},
    {"ply", make<Ply>},     {"carmen", make<Carmen>}, {"png", make<Png>}, {"jpeg", make<Jpeg>},
    {"rgb24", make<Rgb24>}, {"y4m", make<Y4m>},       {"mcap", makeMcap}, {"npz", makeNpz},
    {"npy", makeNpy},       {"las", makeLas}};

}  // namespace

std::vector<std::string> readingFormats() {
    std::vector<std::string> names;
    for (const auto& format : kFormats) names.emplace_back(format.first);
    return names;
}

std::unique_ptr<ReadingFormat> makeFormat(std::string_view name, const Sensors& sensors,
                                          FormatOptions options) {
    const auto* const found =
        std::find_if(std::begin(kFormats), std::end(kFormats),
                     [&](const auto& format) { return format.first == name; });
    assert(found != std::end(kFormats));
    return found->second(sensors, std::move(options));
}

namespace {

void move(PointCloud& cloud, const Frame3& frame) {
    for (std::size_t i = 0; i + 2 < cloud.xyz.size(); i += 3) {
        float* const point = &cloud.xyz[i];
        const Point3 moved = frame.origin + frame * Vec3{point[0], point[1], point[2]};
        point[0] = static_cast<float>(moved.x);
        point[1] = static_cast<float>(moved.y);
        point[2] = static_cast<float>(moved.z);
    }
}

}  // namespace

PointCloud cloudOf(const Sensor& sensor, const SensorRoom* room, const Reading& reading,
                   Coordinates in) {
    const ReadingKind& kind = readingKind(sensor.model);
    if (kind.points == nullptr) return {};
    PointCloud cloud = kind.points(sensor, reading, in);
    if (in == Coordinates::World && room != nullptr && room->site_from_room)
        move(cloud, Frame3(*room->site_from_room));
    return cloud;
}

}  // namespace ispace
