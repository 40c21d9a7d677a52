// SPDX-License-Identifier: GPL-3.0-or-later
// The interface of reading formats, their shared base, and constructors of formats in separate
// files.
//
// Formats are deterministic: equal readings give equal bytes, without times of writing. Pieces are
// made by several threads (append(), files()) and joined in order by one (ReadingStream).
//
//     const std::unique_ptr<ReadingFormat> format = makeFormat("csv", sensors, {});
//     std::string text = format->header();
//     format->append(text, 0, reading);  // of sensors.read[0]
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/file.h"
#include "base/message.h"
#include "scene/run/run_reader.h"
#include "sense/formats/mcap_writer.h"
#include "sense/formats/point_cloud.h"
#include "sense/formats/reading_fields.h"
#include "sense/reading.h"
#include "sense/site_sensors.h"

namespace ispace {

/// A file of one reading; its name is the reading's name with this ending.
struct ReadingFile {
    std::string ending;  ///< ".png", "-color.png"
    std::string bytes;
};

/// Combines many readings in one file, in order, in one thread. Memory is bounded.
class ReadingStream {
  public:
    virtual ~ReadingStream() = default;
    /// Writes the output of ReadingFormat::append() for the next readings.
    virtual void write(std::string_view appended) = 0;
    /// Writes the rest, after the last reading.
    virtual void finish() {}
};

/// Writes readings in one format. Thread-safe.
class ReadingFormat {
  public:
    virtual ~ReadingFormat() = default;
    /// Returns the bytes before the first reading.
    [[nodiscard]] virtual std::string header() const { return ""; }
    /// Appends a reading of a sensor (index in Sensors::read): its bytes, or the input of stream().
    virtual void append(std::string& out, std::size_t sensor, const Reading& reading) const = 0;
    /// Appends the poses of all members of a recorded run at a moment, and robots' odometry, in
    /// formats that can store them. \param room of these states \param states of
    /// FormatOptions::members
    virtual void appendMoment(std::string& /*out*/, std::uint32_t /*sequence*/, double /*time*/,
                              std::size_t /*room*/, std::span<const RunState> /*states*/) const {}
    /// Creates a stream to one file of many readings: by default header(), then the output of
    /// append(). The format outlives the stream.
    [[nodiscard]] virtual std::unique_ptr<ReadingStream> stream(ByteSink write) const;
    /// True if the file is only that, so that its parts can be concatenated.
    [[nodiscard]] virtual bool isPlain() const { return true; }
    /// Writes a reading as separate files.
    [[nodiscard]] virtual std::vector<ReadingFile> files(std::size_t sensor,
                                                         const Reading& reading) const = 0;
    /// Returns the possible endings of those files, that of the reading itself first.
    [[nodiscard]] virtual std::vector<std::string> endings() const = 0;
    /// True if readings may follow each other in one file; else each requires a separate file.
    [[nodiscard]] virtual bool isStream() const { return true; }
    /// Checks the sensors. \throws UsageError if one file cannot hold the readings of all of them
    virtual void checkStream() const {}
    /// Returns warnings about lost data, a phrase each.
    [[nodiscard]] virtual std::vector<std::string> warnings() const { return {}; }
    /// Returns the points of a reading, see cloudOf().
    [[nodiscard]] virtual PointCloud points(std::size_t sensor, const Reading& reading,
                                            Coordinates in) const = 0;
    /// True for bytes that are not text.
    [[nodiscard]] virtual bool isBinary() const { return false; }
};

/// Depths of the colours at the ends of a scale, in metres. Colour is linear in depth between them
/// and constant beyond; either may be greater.
struct DepthSpectrum {
    double warm = 0, cold = 1;
};

/// Draws readings for people, as PNG; equal input gives equal bytes. See report/reading_picture.h.
struct ReadingDrawings {
    /// \param pixels of each side
    std::string (*obstacles)(const Sensor& sensor, const Scan& scan, int pixels);
    std::string (*depths)(const Sensor& sensor, const DepthFrame& frame,
                          std::optional<DepthSpectrum> spectrum);
};

/// Choices of all formats; each reads those that concern it.
struct FormatOptions {
    History history;
    std::uint64_t seed = 0;
    Coordinates coordinates = Coordinates::World;  ///< of points: csv, pcd, ply
    Encoding encoding = Encoding::Binary;          ///< of pcd and ply
    double depth_per_metre = 1000;                 ///< of png
    bool color = true;                      ///< of png: also writes a colour picture for people
    std::optional<DepthSpectrum> spectrum;  ///< of the colour picture
    /// Of png: obstacle maps require it; null: no colour pictures.
    const ReadingDrawings* drawings = nullptr;
    int map_pixels = 800;                                 ///< of png: side of an obstacle map
    McapCompression compression = McapCompression::None;  ///< of mcap
    int las_minor = 4;                                    ///< of las: version 1.3 or 1.4
    /// Of png and jpeg: writes these files beside pictures; the table of labels requires the rooms.
    bool labels = false, depths = false;
    std::vector<SensorRoom> rooms = {};   ///< of the sensors; empty: one without a name
    std::vector<RunMember> members = {};  ///< all movers of a recorded run
    double moment_interval = 0;           ///< seconds between its moments; 0: not known
};

/// Returns the names of the formats.
std::vector<std::string> readingFormats();

/// Creates a format. \throws UsageError for sensors that the format cannot hold
/// \pre the name is one of readingFormats(); `sensors` outlive the format
std::unique_ptr<ReadingFormat> makeFormat(std::string_view name, const Sensors& sensors,
                                          FormatOptions options);

/// Adds the files beside the picture of a camera (labels and their table, depths, camera_info), and
/// their endings unless they are listed.
void addFilesBeside(const Sensor& sensor, const SensorRoom* room, const Photo& photo,
                    const FormatOptions& options, std::vector<ReadingFile>& files);
void addEndingsBeside(const FormatOptions& options, std::vector<std::string>& endings);

/// Returns the points of a reading; empty for a burst. \param room null: world coordinates are
/// those of its poses; else of the site if the room has a frame in that
PointCloud cloudOf(const Sensor& sensor, const SensorRoom* room, const Reading& reading,
                   Coordinates in);

/// Base of formats: stores the sensors, and writes one file a reading.
class FormatBase : public ReadingFormat {
  public:
    FormatBase(const Sensors& sensors, FormatOptions options, std::string ending)
        : sensors_(sensors), options_(std::move(options)), ending_(std::move(ending)) {}

    [[nodiscard]] std::vector<ReadingFile> files(std::size_t index,
                                                 const Reading& reading) const override {
        return {{ending_, whole(index, reading)}};
    }

    [[nodiscard]] std::vector<std::string> endings() const override { return {ending_}; }

    [[nodiscard]] PointCloud points(std::size_t index, const Reading& reading,
                                    Coordinates in) const override {
        return cloudOf(sensor(index), room(index), reading, in);
    }

  protected:
    [[nodiscard]] const Sensor& sensor(std::size_t index) const { return sensors_.read[index]; }
    [[nodiscard]] std::span<const Sensor> receivers(std::size_t index) const {
        return receiversIn(options_.rooms, roomOf(options_.rooms, index), sensors_);
    }
    /// Returns the room of a sensor; null without FormatOptions::rooms.
    [[nodiscard]] const SensorRoom* room(std::size_t index) const {
        return options_.rooms.empty() ? nullptr : &options_.rooms[roomOf(options_.rooms, index)];
    }
    /// Checks the sensors' kinds. \throws UsageError for the first sensor of another kind
    void accept(std::string_view format, std::string_view what,
                bool (*is_held)(const Sensor&)) const;
    [[noreturn]] static void refuse(std::string_view format, std::string_view what,
                                    const Sensor& one);
    /// Writes a reading as a separate file.
    [[nodiscard]] virtual std::string whole(std::size_t index, const Reading& reading) const;
    static bool hasRanges(const Sensor& one) {
        const ReadingKind& kind = readingKind(one.model);
        return kind.points != nullptr && !kind.varies;
    }
    static bool isCamera(const Sensor& one) { return one.is<Camera>(); }

    static constexpr const char* kCameraInfo = ".yaml";

    const Sensors& sensors_;
    const FormatOptions options_;

  private:
    std::string ending_;
};

/// Creates the format MCAP with messages of ROS 2.
std::unique_ptr<ReadingFormat> makeMcap(const Sensors& sensors, FormatOptions options);
/// Creates the format NumPy: arrays of all sensors, or the array of a single sensor.
std::unique_ptr<ReadingFormat> makeNpz(const Sensors& sensors, FormatOptions options);
std::unique_ptr<ReadingFormat> makeNpy(const Sensors& sensors, FormatOptions options);
/// Creates the format LAS 1.4: the points of all lasers and rangers.
std::unique_ptr<ReadingFormat> makeLas(const Sensors& sensors, FormatOptions options);

}  // namespace ispace
