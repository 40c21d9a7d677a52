// SPDX-License-Identifier: GPL-3.0-or-later
// Reads calibrations of cameras as ROS (camera_calibration_parsers, sensor_msgs/CameraInfo) and
// OpenCV (FileStorage) write them. Scaling to another size of the picture keeps its edges: (cx +
// 0.5) s - 0.5, since both count pixels from the middle of the first one. Coefficients of plumb_bob
// are in OpenCV's order, k1 k2 p1 p2 k3.
#include "io/calibration.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <initializer_list>
#include <map>
#include <optional>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "io/exporters.h"
#include "scene/sensor/sensor.h"

namespace ispace {

namespace {

/// A calibration takes some hundred bytes, more if OpenCV lists the corners it found.
constexpr std::size_t kMaxCalibration = std::size_t{1} << 20U;
/// Keys of a map: a search for one visits them all.
constexpr std::size_t kMaxKeys = 1000;

/// Reads one calibration file; throws the first error found.
class CalibrationReader {
  public:
    CalibrationReader(const YAML::Node& root, const std::string& name) : root_(root), name_(name) {}

    void applyTo(Record& camera) {
        checkKeys(root_);
        const std::vector<double> size = {number({"image_width", "width"}, 1, 16384),
                                          number({"image_height", "height"}, 1, 16384)};
        std::vector<double> k = matrix({"camera_matrix", "K", "k"}, 9);
        if (k[1] != 0)
            fail(find({"camera_matrix", "K", "k"}), "the axes are skewed, and cameras' are not");
        const double fx = k[0], fy = k[4], cx = k[2], cy = k[5];
        if (!(fx > 0 && fy > 0))
            fail(find({"camera_matrix", "K", "k"}), "the focal lengths must be above 0");
        // The record's picture has another size than the calibrated one.
        double wide = 1, high = 1;
        if (camera.has("pixels")) {
            wide = camera.tuple("pixels")[0] / size[0];
            high = camera.tuple("pixels")[1] / size[1];
        } else {
            camera.set("pixels", size);
        }
        camera.set("fx", fx * wide);
        camera.set("fy", fy * high);
        camera.set("cx", (cx + 0.5) * wide - 0.5);
        camera.set("cy", (cy + 0.5) * high - 0.5);
        setLens(camera);
    }

  private:
    [[noreturn]] void fail(const YAML::Node& node, const std::string& message) const {
        const YAML::Mark mark = node ? node.Mark() : YAML::Mark::null_mark();
        throw FormatError(Diagnostic{name_, std::max(0, mark.line + 1), 0, message});
    }

    void checkKeys(const YAML::Node& map) const {
        if (map.size() > kMaxKeys)
            fail(map,
                 std::to_string(map.size()) + " keys, wanted at most " + std::to_string(kMaxKeys));
    }

    [[nodiscard]] YAML::Node find(std::initializer_list<const char*> names) const {
        for (const char* name : names)
            if (const YAML::Node node = root_[name]) return node;
        return YAML::Node(YAML::NodeType::Undefined);
    }

    [[nodiscard]] double numberOf(const YAML::Node& node, const char* what, double least,
                                  double most) const {
        const auto value = node.IsScalar() ? parseDouble(node.Scalar()) : std::nullopt;
        if (value && *value >= least && *value <= most) return *value;
        fail(node, '`' + std::string(what) + "`: found " +
                       (node.IsScalar() ? excerpt(node.Scalar()) : "a list or map") +
                       ", wanted a number from " + formatDouble(least) + " to " +
                       formatDouble(most));
    }

    [[nodiscard]] double number(std::initializer_list<const char*> names, double least,
                                double most) const {
        const YAML::Node node = find(names);
        if (!node) fail(root_, "no `" + std::string(*names.begin()) + "`");
        return numberOf(node, *names.begin(), least, most);
    }

    /// Reads the numbers of a list, or of the `data` of a matrix. \param count 0: any
    [[nodiscard]] std::vector<double> matrix(std::initializer_list<const char*> names,
                                             std::size_t count) const {
        constexpr double kMaxSize = 1e7;
        const char* const what = *names.begin();
        const YAML::Node node = find(names);
        if (!node) fail(root_, "no `" + std::string(what) + "`");
        if (node.IsMap()) checkKeys(node);
        const YAML::Node data = node.IsMap() ? node["data"] : node;
        if (!data || !data.IsSequence() || (count > 0 && data.size() != count))
            fail(node, '`' + std::string(what) + "`: wanted a list" +
                           (count > 0 ? " of " + std::to_string(count) + " numbers" : "") +
                           ", or a matrix with `data`");
        constexpr std::size_t kMaxCoefficients = 14;
        if (data.size() > kMaxCoefficients)
            fail(node, '`' + std::string(what) + "`: " + std::to_string(data.size()) +
                           " numbers, wanted at most " + std::to_string(kMaxCoefficients));
        std::vector<double> values;
        for (const YAML::Node& one : data)
            values.push_back(numberOf(one, what, -kMaxSize, kMaxSize));
        return values;
    }

    /// Returns "pinhole", "fisheye" or "omni".
    [[nodiscard]] std::string lensOf(const Record& camera) const {
        if (const YAML::Node node = root_["distortion_model"]) {
            const std::string model = node.IsScalar() ? node.Scalar() : "";
            if (model == "plumb_bob" || model == "rational_polynomial" || model.empty())
                return "pinhole";
            if (model == "equidistant" || model == "fisheye") return "fisheye";
            if (model == "omnidir") return "omni";
            fail(node, "`distortion_model`: " + excerpt(model) +
                           " is none of plumb_bob, rational_polynomial, equidistant, fisheye and "
                           "omnidir");
        }
        if (const YAML::Node node = root_["fisheye_model"]; node && node.IsScalar())
            return node.Scalar() == "0" || node.Scalar() == "false" ? "pinhole" : "fisheye";
        if (root_["xi"]) return "omni";
        const bool is_fisheye =
            (camera.has("distortion") && camera.text("distortion") == "fisheye") ||
            (camera.has("projection") && camera.text("projection") == "fisheye");
        return is_fisheye ? "fisheye" : "pinhole";
    }

    void setLens(Record& camera) {
        const std::string lens = lensOf(camera);
        if (camera.has("projection") && camera.text("projection") != lens)
            fail(root_, "it calibrates a lens of projection=" + lens +
                            ", and the camera has projection=" + camera.text("projection"));
        camera.set("projection", lens);
        const auto names = {"distortion_coefficients", "D", "d"};
        std::vector<double> d = find(names) ? matrix(names, 0) : std::vector<double>();
        while (!d.empty() && d.back() == 0) d.pop_back();
        const std::size_t most = lens == "pinhole" ? 5 : lens == "fisheye" ? 4 : 0;
        if (const YAML::Node model = root_["distortion_model"];
            d.size() > most && model && model.IsScalar() && model.Scalar() == "rational_polynomial")
            fail(model,
                 "rational_polynomial is not supported beyond its first 5 coefficients: calibrate "
                 "with plumb_bob (OpenCV without CALIB_RATIONAL_MODEL)");
        if (d.size() > most)
            fail(find(names), "`distortion_coefficients`: number " + std::to_string(d.size()) +
                                  " is not 0, and a camera with projection=" + lens + " has " +
                                  std::to_string(most));
        if (lens == "omni") {
            camera.set("mirror", number({"xi"}, 1e-9, 1));
            return;
        }
        if (d.empty()) return;
        camera.set("distortion", std::string(lens == "pinhole" ? "plumb_bob" : "fisheye"));
        camera.set("coefficients", d);
    }

    const YAML::Node& root_;
    const std::string& name_;
};

/// Keys that a calibration file sets; a record with `calibration` must not contain them.
constexpr std::array<const char*, 9> kCalibrated = {"fov", "focal", "sensor", "fx",          "fy",
                                                    "cx",  "cy",    "mirror", "coefficients"};

void checkNotTwice(const Record& camera) {
    for (const char* key : kCalibrated)
        if (camera.has(key))
            throw FormatError(camera.finding(
                key, '`' + std::string(key) + "` and `calibration` say the same: leave one out"));
}

std::string readCalibration(const std::string& path) {
    if (const RegularFile file = openRegular(path); file.size > kMaxCalibration)
        throw FormatError(Diagnostic{path, 0, 0,
                                     std::to_string(file.size) + " bytes, wanted at most " +
                                         std::to_string(kMaxCalibration)});
    return readAll(path);
}

/// Calls `read`; errors of YAML become those of the file.
template <typename Read>
auto guarded(const std::string& name, Read read) {
    try {
        return read();
    } catch (const YAML::Exception& error) {
        throw FormatError(Diagnostic{name, error.mark.line + 1, 0, "bad YAML: " + error.msg});
    }
}

YAML::Node parsedCalibration(std::string text, const std::string& name) {
    // OpenCV's first line, `%YAML:1.0`, is no directive of YAML.
    if (text.starts_with("%YAML:")) text[0] = '#';
    if (text.starts_with("<?xml") || text.starts_with("<opencv_storage"))
        throw FormatError(
            Diagnostic{name, 0, 0, "XML is not read: save the calibration as .yaml or .yml"});
    return guarded(name, [&] {
        YAML::Node root = YAML::Load(text);
        if (!root.IsMap())
            throw FormatError(Diagnostic{
                name, 0, 0, "no calibration: wanted YAML with `image_width`, `camera_matrix`, …"});
        return root;
    });
}

/// The calibrations of cameras, each file read once.
class CalibrationFiles {
  public:
    /// \throws FormatError, std::system_error; for a file that failed before, the same error
    const YAML::Node& read(const std::string& path) {
        const auto [known, is_new] = files_.try_emplace(path);
        File& file = known->second;
        if (is_new) try {
                file.root = parsedCalibration(readCalibration(path), path);
            } catch (...) {
                file.failure = std::current_exception();
            }
        if (file.failure) std::rethrow_exception(file.failure);
        return file.root;
    }

  private:
    struct File {
        YAML::Node root;
        std::exception_ptr failure;
    };
    std::map<std::string, File> files_;
};

}  // namespace

void applyCalibration(Record& camera, std::string_view yaml, const std::string& name) {
    const YAML::Node root = parsedCalibration(std::string(yaml), name);
    guarded(name, [&] { CalibrationReader(root, name).applyTo(camera); });
}

void loadCalibrations(Document& document, const std::string& operand) {
    Diagnostics findings;
    CalibrationFiles files;
    for (Record& record : document.records) {
        if (record.keyword() != Camera::kKind.keyword || !record.has("calibration")) continue;
        const std::string path = sideFilePath(operand, record.text("calibration"));
        const auto fail = [&](const std::string& what) {
            findings.add(
                record.finding("calibration", "calibration file `" + printable(path) + '`' + what));
        };
        try {
            checkNotTwice(record);
        } catch (const FormatError& error) {
            findings.add(error);
            continue;
        }
        try {
            const YAML::Node& root = files.read(path);
            std::vector<std::string>& sources = document.sources;
            if (std::find(sources.begin(), sources.end(), path) == sources.end())
                sources.push_back(path);
            Record calibrated = record;
            calibrated.erase("calibration");
            guarded(path, [&] { CalibrationReader(root, path).applyTo(calibrated); });
            record = std::move(calibrated);
        } catch (const std::system_error& error) {
            fail(" cannot be opened: " + error.code().message());
        } catch (const FormatError& error) {
            const Diagnostic& first = error.diagnostics().front();
            fail((first.line > 0 ? ", line " + std::to_string(first.line) : "") + ": " +
                 first.message);
        }
    }
    findings.throwIfAny();
}

}  // namespace ispace
