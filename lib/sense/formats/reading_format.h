// SPDX-License-Identifier: GPL-3.0-or-later
// For the formats of readings: what they have in common, and those that have a file of their own.
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
#include "sense/formats/reading_picture.h"
#include "sense/reading.h"

namespace ispace {

/// A file made of one reading; its name is the reading's with this ending.
struct ReadingFile {
    std::string ending;  ///< ".png", "-color.png"
    std::string bytes;
};

/// Makes one file of many readings, in their order, by one thread. Memory is bounded.
class ReadingStream {
  public:
    virtual ~ReadingStream() = default;
    /// What ReadingFormat::append() made of the next readings.
    virtual void write(std::string_view appended) = 0;
    /// After the last one.
    virtual void finish() {}
};

/// Writes readings in one format. Thread-safe.
class ReadingFormat {
  public:
    virtual ~ReadingFormat() = default;
    /// Bytes before the first reading.
    [[nodiscard]] virtual std::string header() const { return ""; }
    /// Appends a reading of a sensor (in Sensors::read): its bytes, or what stream() makes them of.
    virtual void append(std::string& out, std::size_t sensor, const Reading& reading) const = 0;
    /// Appends where everybody in a recorded run is at a moment of it, and what robots believe, in
    /// formats that have words for it. \param states of FormatOptions::members
    virtual void appendMoment(std::string& /*out*/, std::uint32_t /*sequence*/, double /*time*/,
                              std::span<const RunState> /*states*/) const {}
    /// One file of many readings: header(), and what append() made of each, unless a format says
    /// otherwise. The format outlives the stream.
    [[nodiscard]] virtual std::unique_ptr<ReadingStream> stream(ByteSink write) const;
    /// True if that file is nothing else, so that parts of it can be joined.
    [[nodiscard]] virtual bool isPlain() const { return true; }
    /// A reading as separate files.
    [[nodiscard]] virtual std::vector<ReadingFile> files(std::size_t sensor,
                                                         const Reading& reading) const = 0;
    /// Endings that those files may have, that of the reading itself first.
    [[nodiscard]] virtual std::vector<std::string> endings() const = 0;
    /// True if readings may follow each other in one file; else each needs its own.
    [[nodiscard]] virtual bool isStream() const { return true; }
    /// \throws UsageError if one file cannot hold the readings of all these sensors
    virtual void checkStream() const {}
    /// What it may lose of the readings, a phrase each.
    [[nodiscard]] virtual std::vector<std::string> warnings() const { return {}; }
    /// True for bytes that are not text.
    [[nodiscard]] virtual bool isBinary() const { return false; }
};

struct FormatOptions {
    History history;
    std::uint64_t seed = 0;
    Coordinates coordinates = Coordinates::World;         ///< of points: csv, pcd, ply
    Encoding encoding = Encoding::Binary;                 ///< of pcd and ply
    double depth_per_metre = 1000;                        ///< of png
    bool color = true;                                    ///< of png: a picture for people, too
    std::optional<DepthSpectrum> spectrum;                ///< of that picture
    int map_pixels = 800;                                 ///< of png: side of an obstacle map
    McapCompression compression = McapCompression::None;  ///< of mcap
    /// Of png and jpeg: pictures have these files beside them; the table of labels needs the scene.
    bool labels = false, depths = false;
    const Scene* scene = nullptr;
    std::vector<RunMember> members = {};  ///< everybody in a recorded run
};

/// Names of the formats.
std::vector<std::string> readingFormats();

/// \throws UsageError for sensors that the format cannot hold
/// \pre the name is one of readingFormats()
std::unique_ptr<ReadingFormat> makeFormat(std::string_view name, const Sensors& sensors,
                                          FormatOptions options);

/// Adds what stands beside the picture of a camera (labels and their table, depths, camera_info),
/// and the endings of these files where they are not there yet.
void addFilesBeside(const Sensor& sensor, const Photo& photo, const FormatOptions& options,
                    std::vector<ReadingFile>& files);
void addEndingsBeside(const FormatOptions& options, std::vector<std::string>& endings);

/// The points of a reading; empty for a burst.
PointCloud cloudOf(const Sensors& sensors, std::size_t sensor, const Reading& reading,
                   Coordinates in);

/// The sensors of a format, and one file a reading.
class FormatBase : public ReadingFormat {
  public:
    FormatBase(const Sensors& sensors, FormatOptions options, std::string ending)
        : sensors_(sensors), options_(std::move(options)), ending_(std::move(ending)) {}

    [[nodiscard]] std::vector<ReadingFile> files(std::size_t index,
                                                 const Reading& reading) const override {
        return {{ending_, whole(index, reading)}};
    }

    [[nodiscard]] std::vector<std::string> endings() const override { return {ending_}; }

  protected:
    [[nodiscard]] const Sensor& sensor(std::size_t index) const { return sensors_.read[index]; }
    /// \throws UsageError for the first sensor that is none of these
    void accept(std::string_view format, std::string_view what,
                bool (*is_held)(const Sensor&)) const;
    [[noreturn]] static void refuse(std::string_view format, std::string_view what,
                                    const Sensor& one);
    /// A reading as a file of its own.
    [[nodiscard]] virtual std::string whole(std::size_t index, const Reading& reading) const;
    static bool hasRanges(const Sensor& one) { return readingKind(one.model).points != nullptr; }
    static bool isCamera(const Sensor& one) { return one.is<Camera>(); }

    static constexpr const char* kCameraInfo = ".yaml";

    const Sensors& sensors_;
    const FormatOptions options_;

  private:
    std::string ending_;
};

/// MCAP with messages of ROS 2.
std::unique_ptr<ReadingFormat> makeMcap(const Sensors& sensors, FormatOptions options);
/// NumPy: arrays of all sensors, or the one of a single sensor.
std::unique_ptr<ReadingFormat> makeNpz(const Sensors& sensors, FormatOptions options);
std::unique_ptr<ReadingFormat> makeNpy(const Sensors& sensors, FormatOptions options);
/// LAS 1.4: the points of all lasers and rangers.
std::unique_ptr<ReadingFormat> makeLas(const Sensors& sensors, FormatOptions options);

}  // namespace ispace
