// SPDX-License-Identifier: GPL-3.0-or-later
// Requirements are judged before products are written, as an unknown surface is an error of use; a
// requirement that is not met (UnmetError) leaves all products.
#include "extensions/projection/projection_options.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "extensions/projection/projection_report.h"
#include "extensions/projection/projector_coverage.h"

namespace ispace::projection {

namespace {

/// A bound of the area of a surface, or of all: `floor=2`, `total=5`.
struct AreaRequirement {
    std::string text, surface;
    double area = 0;
};

AreaRequirement parseAreaRequirement(const std::string& text) {
    const std::size_t equals = text.rfind('=');
    const std::optional<double> area =
        equals == std::string::npos ? std::nullopt : parseDouble(text.substr(equals + 1));
    if (!area || *area < 0 || equals == 0)
        throw UsageError("--require: " + excerpt(text) +
                         " is no area, wanted ID=M2 of an element or the floor, or total=M2");
    return {text, text.substr(0, equals), *area};
}

class ProjectionOptions : public OptionGroup {
  public:
    void declare(CommandLine& line) override {
        line.group("Pictures of projectors");
        line.parsed(
            "--projection", "PIXELS",
            [this](const std::string& text) { density_ = densityOf(text); },
            "report the surfaces on which projectors show pictures of at least PIXELS pixels a "
            "metre, with shadows, distortion and the largest rectangles, instead of measuring "
            "coverage; -o draws the surfaces side by side",
            Enters::History);
    }
    [[nodiscard]] bool isAsked() const override { return density_ > 0; }
    [[nodiscard]] std::span<const std::string_view> honours() const override {
        static constexpr std::string_view kOptions[] = {"--require", "--json", "--width", "--cell"};
        return kOptions;
    }
    void take(const CommandLine& line) override {
        const auto last = [&line](const std::string& name) {
            const std::vector<std::string> values = line.valuesOf(name);
            return values.empty() ? std::string() : values.back();
        };
        json_ = line.given("--json");
        if (const std::string width = last("--width"); !width.empty())
            width_ = static_cast<int>(*parseInteger(width));
        if (const std::string cell = last("--cell"); !cell.empty()) cell_ = lengthOf(cell);
        for (const std::string& text : line.valuesOf("--require"))
            requirements_.push_back(parseAreaRequirement(text));
    }

    void run(const TaskInput& input) override {
        std::optional<PictureFormat> format;
        if (input.common.output != "-") {
            const std::string name = outputFormat({}, input.common.output, {"png", "svg", "pdf"});
            format = name == "svg"   ? PictureFormat::Svg
                     : name == "pdf" ? PictureFormat::Pdf
                                     : PictureFormat::Png;
        }
        claimOutputs(input.common);
        const SceneInput room =
            readScene({input.operands, input.rules, false, [](const SensorKind&) { return true; }});
        warnOfImport(input.common, "coverage", room);
        const Scene& scene = room.scene;
        const ProjectionReport projection =
            projectionOf(scene, density_, cell_.value_or(projectionCell(scene.environment)));
        if (projection.projectors.empty())
            throw UsageError("--projection: " + displayName(room.environment_operand) +
                             " has no projector: add one (envc --add 'projector model=v-1100 "
                             "at=0,0' --to env)");
        std::string unmet;
        for (const AreaRequirement& one : requirements_) {
            const double area = areaOf(one, projection);
            if (area >= one.area) continue;
            unmet.append(unmet.empty() ? "" : "; ").append(one.surface).append(" carries ");
            unmet.append(formatFixed(area, 2)).append(" m2, required are ");
            unmet.append(formatDouble(one.area));
        }
        if (format)
            writeAll(
                input.common.output,
                projectionPicture(
                    projection,
                    "pictures of " + formatDouble(density_) + " pixels a metre and more", width_)
                    .write(*format));
        writeDependencies(input.common, filesOf(room));
        writeAll("-", json_ ? projectionJson(projection) : projectionText(projection));
        if (!unmet.empty()) throw UnmetError(unmet);
    }

  private:
    static double densityOf(const std::string& text) {
        constexpr double kMost = 1e6;
        const std::optional<double> pixels = parseDouble(text);
        if (!pixels || !(*pixels > 0 && *pixels <= kMost))
            throw UsageError("`" + text + "` is no number of pixels a metre above 0");
        return *pixels;
    }
    /// Reads a length that the tool has checked.
    static double lengthOf(const std::string& text) {
        const KeySpec length{.name = "", .type = KeyType::Number, .unit = Unit::Length, .help = ""};
        return parseNumber(length, text);
    }

    /// Returns the area that the surfaces of an element carry. \throws UsageError for unknown ids
    static double areaOf(const AreaRequirement& requirement, const ProjectionReport& projection) {
        double sum = 0;
        bool is_known = requirement.surface == "total";
        std::vector<std::string> ids = {"total"};
        for (std::size_t s = 0; s < projection.surfaces.size(); ++s) {
            const std::string& element = projection.surfaces[s].element;
            const bool is_meant = requirement.surface == "total" || requirement.surface == element;
            is_known = is_known || is_meant;
            if (is_meant) sum += projection.carried[s];
            if (ids.back() != element) ids.push_back(element);
        }
        if (!is_known)
            throw UsageError("--require: no surface is of " + excerpt(requirement.surface) +
                             didYouMean(requirement.surface, ids));
        return sum;
    }

    double density_ = 0;
    bool json_ = false;
    int width_ = 1200;
    std::optional<double> cell_;
    std::vector<AreaRequirement> requirements_;
};

}  // namespace

std::unique_ptr<OptionGroup> makeProjectionOptions() {
    return std::make_unique<ProjectionOptions>();
}

}  // namespace ispace::projection
