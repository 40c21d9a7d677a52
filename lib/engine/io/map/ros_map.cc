// SPDX-License-Identifier: GPL-3.0-or-later
// Reads map.yaml and its picture as ROS' map_server does (nav2_map_server, map_io.cpp): darkness
// above `occupied_thresh` is occupied, below `free_thresh` free. Findings of the YAML are
// collected, so that one run reports all of them.
#include "io/importers.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "base/run_files.h"
#include "geom/pose.h"
#include "io/exporters.h"
#include "io/import_records.h"
#include "io/map/cell_map.h"
#include "raster/picture.h"

namespace ispace {

namespace {

/// A millimetre a cell: a smaller value is not in metres.
constexpr double kFinestResolution = 0.001;

/// The keys of map.yaml.
struct MapHeader {
    std::string image;
    int image_line = 0, image_column = 0;  ///< where it is named
    double resolution = 0;                 ///< metres a cell
    Pose2 map_from_grid;                   ///< the lower left corner of the picture
    OccupancyRule rule;
};

/// Reads map.yaml, collecting findings.
class HeaderReader {
  public:
    HeaderReader(const YAML::Node& root, const std::string& name) : root_(root), name_(name) {}

    MapHeader read() {
        MapHeader header;
        header.image = text("image");
        if (const YAML::Node node = root_["image"]; node) {
            header.image_line = node.Mark().line + 1;
            header.image_column = node.Mark().column + 1;
        }
        header.resolution = resolution();
        header.map_from_grid = origin();
        header.rule = rule();
        findings_.throwIfAny();
        return header;
    }

  private:
    void fail(const YAML::Node& node, std::string message) {
        const YAML::Mark mark = node.Mark();
        findings_.add(
            Diagnostic{displayName(name_), mark.line + 1, mark.column + 1, std::move(message)});
    }

    YAML::Node required(const std::string& key) {
        YAML::Node node = root_[key];
        if (!node) fail(root_, "missing key `" + key + "` of a ROS map");
        return node;
    }

    std::string text(const std::string& key) {
        const YAML::Node node = required(key);
        if (!node) return {};
        if (node.IsScalar() && !node.Scalar().empty()) return node.Scalar();
        fail(node, '`' + key + "`: wanted the name of a picture");
        return {};
    }

    double number(const YAML::Node& node, const std::string& key, double lowest, double highest) {
        const auto value = node.IsScalar() ? parseDouble(node.Scalar()) : std::nullopt;
        if (value && *value >= lowest && *value <= highest) return *value;
        const std::string found = node.IsScalar() ? excerpt(node.Scalar()) : "a list or map";
        fail(node, '`' + key + "`: found " + found + ", wanted a number from " +
                       formatDouble(lowest) + " to " + formatDouble(highest));
        return std::numeric_limits<double>::quiet_NaN();
    }

    double resolution() {
        const YAML::Node node = required("resolution");
        return node ? number(node, "resolution", kFinestResolution, 1000) : 0;
    }

    Pose2 origin() {
        const YAML::Node node = required("origin");
        if (!node) return {};
        if (!node.IsSequence() || node.size() < 2 || node.size() > 3) {
            fail(node, "`origin`: wanted a list of two or three numbers, [x, y, yaw]");
            return {};
        }
        const auto entry = [&](std::size_t i) {
            return number(node[i], "origin", -kMaxSurveyed, kMaxSurveyed);
        };
        Pose2 pose;
        pose.position = {entry(0), entry(1)};
        if (node.size() == 3) pose.heading = Angle::radians(entry(2));
        return pose;
    }

    OccupancyRule rule() {
        OccupancyRule rule;
        if (const YAML::Node node = root_["mode"]; node) {
            const std::vector<std::string> names{"trinary", "scale", "raw"};
            const std::string found = node.IsScalar() ? node.Scalar() : std::string();
            if (found == "scale")
                rule.mode = OccupancyRule::Mode::Scale;
            else if (found == "raw")
                rule.mode = OccupancyRule::Mode::Raw;
            else if (found != "trinary")
                fail(node, "`mode`: found " + excerpt(found) + ", wanted trinary, scale or raw" +
                               didYouMean(found, names));
        }
        if (const YAML::Node node = root_["negate"]; node) rule.negate = flag(node, "negate");
        if (const YAML::Node node = root_["occupied_thresh"]; node)
            rule.occupied_thresh = number(node, "occupied_thresh", 0, 1);
        if (const YAML::Node node = root_["free_thresh"]; node)
            rule.free_thresh = number(node, "free_thresh", 0, 1);
        return rule;
    }

    bool flag(const YAML::Node& node, const std::string& key) {
        const std::string found = node.IsScalar() ? node.Scalar() : std::string();
        if (found == "1" || found == "true" || found == "yes") return true;
        if (found != "0" && found != "false" && found != "no")
            fail(node, '`' + key + "`: found " + excerpt(found) + ", wanted 0 or 1");
        return false;
    }

    const YAML::Node& root_;
    const std::string& name_;
    Diagnostics findings_;
};

MapHeader readHeader(std::string_view yaml, const std::string& name) {
    try {
        const YAML::Node root = YAML::Load(std::string(yaml));
        if (!root.IsMap())
            throw FormatError(Diagnostic{displayName(name), 0, 0,
                                         "not a ROS map: wanted `image`, `resolution`, `origin`"});
        return HeaderReader(root, name).read();
    } catch (const YAML::Exception& error) {
        throw FormatError(Diagnostic{displayName(name), error.mark.line + 1, error.mark.column + 1,
                                     "bad YAML: " + error.msg});
    }
}

/// Returns the reason that the picture cannot be read, or "". Rejects devices and pipes: they may
/// never end.
std::string reasonNotToRead(const std::string& path) {
    std::error_code error;
    if (!mayBeRead(path)) return std::generic_category().message(ENOENT);
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (error) return error.message();
    return std::filesystem::is_regular_file(status) ? "" : "it is no regular file";
}

/// \throws FormatError at the position of `image` in map.yaml
std::string readImage(const MapHeader& header, const std::string& path, const std::string& name) {
    const auto refuse = [&](const std::string& reason, const char* hint) {
        throw FormatError(Diagnostic{
            displayName(name), header.image_line, header.image_column,
            "picture `" + printable(header.image) + "` cannot be opened: " + reason + hint});
    };
    if (const std::string reason = reasonNotToRead(path); !reason.empty())
        refuse(reason, std::filesystem::path(header.image).is_absolute()
                           ? ""
                           : "; it is looked for beside the map");
    try {
        return readAll(path);
    } catch (const std::system_error& error) {
        refuse(error.code().message(), "");
        throw;
    }
}

CellMap readCells(MapHeader header, const std::string& path, const std::string& name,
                  const ImportOptions& options, ImportRecords& out) {
    const std::string bytes = readImage(header, path, name);
    if (Budget* building = options.max_work.whole; building != nullptr)
        building->grant(bytes.size());
    const GreyPicture image = parsePicture(bytes, path);
    checkCellMap(image.width, image.height, header.resolution, path, options.max_work);
    header.rule.unknown_is_free = options.unknown == "free";
    if (const std::size_t count = unknownCountedFree(image, header.rule);
        count > 0 && !header.rule.unknown_is_free)
        out.warn(countText(count, "pixel") +
                 " of shade 205, which map_server writes for unknown, are unknown, though "
                 "`free_thresh` is " +
                 formatDouble(header.rule.free_thresh) + "; --unknown free takes them as free");
    return {freeCells(image, header.rule), occupiedCells(image, header.rule), header.resolution,
            header.map_from_grid};
}

}  // namespace

bool isRosMap(std::string_view bytes) {
    // A cheap test rejects most YAML without a second parse.
    if (bytes.find("image") == std::string_view::npos ||
        bytes.find("resolution") == std::string_view::npos)
        return false;
    try {
        const YAML::Node root = YAML::Load(std::string(bytes));
        return root.IsMap() && root["image"] && root["resolution"];
    } catch (const YAML::Exception&) {
        return false;  // the YAML reader reports the error
    }
}

Document readRosMap(std::string_view yaml, const std::string& name, const ImportOptions& options,
                    const Schemas& schemas) {
    MapHeader header = readHeader(yaml, name);
    const std::string path = sideFilePath(name, header.image);
    ImportRecords out(schemas, name, options);
    out.source(path);
    if (const auto way = wayFromSurvey(header.map_from_grid.position)) {
        header.map_from_grid.position = header.map_from_grid.position - *way;
        out.report(surveyText(*way, "map"));
    }
    const CellMap map = readCells(header, path, name, options, out);
    writeCellMap(map, {path, "check `negate` and `free_thresh` of the map"}, options, out);
    return out.take();
}

}  // namespace ispace
