// SPDX-License-Identifier: GPL-3.0-or-later
// The table of formats: an extension adds rows, and a build without it knows their names for its
// messages. A format writes from the scene, or from the records alone, which reads no other file.
#include "io/exporters.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/missed_files.h"
#include "base/run_files.h"
#include "drawing/plan/plan.h"
#include "io/glb/glb_read.h"
#include "io/importers.h"
#include "record/text.h"
#include "record/yaml/yaml.h"

namespace ispace {

namespace {

namespace fs = std::filesystem;

template <DocumentKind kKind>
std::string recordsAs(Document&& document) {
    document.kind = kKind;
    return writeRecordText(document);
}

template <PictureFormat kFormat>
ExportedFiles drawnAs(const Scene& scene, const Document& /*document*/,
                      const ExportOptions& options) {
    return {drawPlan(scene, {kFormat, options.slice, options.width, options.title, options.found}),
            ""};
}

constexpr ExportFormat kCoreFormats[] = {
    {.name = "glb",
     .suffix = "glb",
     .help = "glTF 2.0, which any viewer opens: one named node for each element, sensor and robot, "
             "in metres, y up. It holds the records as text and the meshes they name, without "
             "loss. The view of a sensor is a translucent sheet of the material sensor-view, no "
             "longer than the width of the plan; no other format has it.",
     .binary = "a GLB",
     .write = [](const Scene& scene, const Document& document,
                 const ExportOptions& /*options*/) -> ExportedFiles {
         return {writeGlb(scene, document), ""};
     },
     .write_to = [](const Scene& scene, const Document& document,
                    const ByteSink& sink) { writeGlb(scene, document, sink); }},
    {.name = "env",
     .suffix = "env",
     .help = "Records of an environment. From records to records no other file is read.",
     .write_records = recordsAs<DocumentKind::Environment>},
    {.name = "3dm",
     .suffix = "3dm",
     .help = "Records of a layout.",
     .write_records = recordsAs<DocumentKind::Layout>},
    {.name = "yaml",
     .suffix = "yaml",
     .help = "Records of either kind in YAML.",
     .write_records = [](Document&& document) { return writeYaml(document); }},
    {.name = "obj",
     .suffix = "obj",
     .help = "A mesh in metres, y up as Blender and most programs read OBJ (x, y, z of the file "
             "are x, z, -y of the room; its first line states that), with its materials in "
             "FILE.mtl beside it. Walls without thickness, panes and floors are single surfaces, "
             "visible from both sides.",
     .write = [](const Scene& scene, const Document& /*document*/,
                 const ExportOptions& options) { return writeObj(scene, options.beside); },
     .beside_suffix = ".mtl",
     .beside_role = "materials",
     .naming_hint = "FILE.mtl holds the materials of an OBJ: name the model FILE.obj"},
    {.name = "stl",
     .suffix = "stl",
     .help = "The same mesh, z up, as one surface without names and materials, in binary STL.",
     .binary = "an STL",
     .write = [](const Scene& scene, const Document& /*document*/,
                 const ExportOptions& /*options*/) -> ExportedFiles {
         return {writeStl(scene), ""};
     }},
    {.name = "sdf",
     .suffix = "sdf",
     .help =
         "A world for Gazebo (SDF 1.9): a static model for each element, with boxes, cylinders and "
         "polylines, a ground plane, and the sensors with their fields of view, samples, ranges, "
         "rates and noise; robots and people are bodies at rest. Walls without thickness become 2 "
         "mm thick. FILE.meshes.obj beside it holds meshes. SDF has no sweeps (envc writes the "
         "first scan) and no mirrors. Ultrasound and tags become mere bodies; envc skips mats and "
         "gates, and reports the number of all these; it also skips zones.",
     .write =
         [](const Scene& scene, const Document& /*document*/, const ExportOptions& options) {
             return writeSdf(scene, options.title, options.beside);
         },
     .beside_suffix = ".meshes.obj",
     .beside_role = "meshes",
     .beside_as_needed = true,
     .naming_hint = "FILE.meshes.obj holds the meshes of an SDF world: name it FILE.sdf"},
    {.name = "urdf",
     .suffix = "urdf",
     .help = "The sensors with a pose as links with fixed joints from the link world, or from the "
             "robot or person that carries them; cameras and rangers with a lens have a second "
             "link, ID_optical, with z forward, as ROS requires it.",
     .write = [](const Scene& scene, const Document& /*document*/,
                 const ExportOptions& options) -> ExportedFiles {
         return {writeUrdf(scene, options.title), "",
                 scene.sensors.empty() ? "the file has no sensors, as none is placed: give a "
                                         "layout, too (envc room.env best.3dm -o FILE.urdf)"
                                       : ""};
     }},
    {.name = "svg",
     .suffix = "svg",
     .help =
         "A drawing to scale, on paper of A3 or less: print it at 100 % and measure. It has one "
         "layer per type, and its ids are those of the records.",
     .takes_slice = true,
     .draws_rooms = true,
     .write = drawnAs<PictureFormat::Svg>},
    {.name = "png",
     .suffix = "png",
     .help = "The view from above with a grid of 1 m.",
     .binary = "a PNG",
     .takes_slice = true,
     .draws_rooms = true,
     .write = drawnAs<PictureFormat::Png>},
    {.name = "pdf",
     .suffix = "pdf",
     .help = "The drawing of svg as PDF, to the same scale; the page is as large as the drawing.",
     .binary = "a PDF",
     .takes_slice = true,
     .draws_rooms = true,
     .write = drawnAs<PictureFormat::Pdf>},
    {.name = "geojson",
     .suffix = "geojson",
     .help = "The indoor region and the footprints. Coordinates are metres in the frame of the "
             "room, which the members coordinate_system (local-metres) and crs state, the latter "
             "for GDAL and QGIS; programs that read neither treat them as degrees.",
     .takes_slice = true,
     .write = [](const Scene& scene, const Document& /*document*/,
                 const ExportOptions& options) -> ExportedFiles {
         return {writeGeoJson(scene, options.slice), ""};
     }},
    {.name = "ros",
     .suffix = "yaml",
     .help = "FILE.yaml and FILE.pgm: the free floor at 0.15 m, or at the height of --slice, as "
             "cells. A thin wall occupies the cells it runs through; free_thresh is 0.196, so that "
             "every reader takes cells of value 205 as unknown.",
     .takes_slice = true,
     .write =
         [](const Scene& scene, const Document& /*document*/, const ExportOptions& options) {
             return writeRosMap(scene, options.slice.value_or(kScanHeight),
                                options.resolution.value_or(kMapResolution), options.beside);
         },
     .beside_suffix = ".pgm",
     .beside_role = "the picture of the map",
     .needs_beside = true,
     .naming_hint = "a ROS map is two files, FILE.yaml and FILE.pgm: name it with -o FILE.yaml"},
};

std::vector<ExportFormat>& allFormats() {
    static std::vector<ExportFormat> formats(std::begin(kCoreFormats), std::end(kCoreFormats));
    return formats;
}

/// A format of an extension that is not in this build.
struct MissingExporter {
    std::string_view name, extension;
};

std::vector<MissingExporter>& missingExporters() {
    static std::vector<MissingExporter> formats;
    return formats;
}

}  // namespace

void addExporters(std::span<const ExportFormat> formats) {
    allFormats().insert(allFormats().end(), formats.begin(), formats.end());
}

void addMissingExporter(std::string_view name, std::string_view extension) {
    missingExporters().push_back({name, extension});
}

std::string_view missingExporter(std::string_view name) {
    for (const MissingExporter& format : missingExporters())
        if (format.name == name) return format.extension;
    return "";
}

void refuseMissing(const std::string& output) {
    const std::string suffix = fs::path(output).extension().string();
    if (suffix.empty()) return;
    const std::string extension(missingExporter(suffix.substr(1)));
    if (!extension.empty())
        throw UsageError(output + ": `" + suffix + "` belongs to the extension " + extension +
                         ", which this build lacks");
}

std::span<const ExportFormat> exportFormats() { return allFormats(); }

const ExportFormat& exportFormat(std::string_view name) {
    const std::vector<ExportFormat>& formats = allFormats();
    return *std::find_if(formats.begin(), formats.end(),
                         [name](const ExportFormat& format) { return format.name == name; });
}

namespace {

fs::path folderOf(const std::string& path) {
    const fs::path folder = fs::path(path).parent_path();
    return folder.empty() ? "." : folder;
}

}  // namespace

std::string sideFilePath(const std::string& path, const std::string& name) {
    return (fs::path(path).parent_path() / name).string();
}

std::optional<RegularFile> openSideFile(const std::string& path, const std::string& name,
                                        bool anywhere, std::span<const std::string> others) {
    std::error_code error;
    const fs::path place = fs::canonical(sideFilePath(path, name), error);
    if (error || !mayBeRead(place.string())) {
        noteMissed(sideFilePath(path, name));
        return std::nullopt;
    }
    const bool is_in_others =
        std::any_of(others.begin(), others.end(), [&](const std::string& other) {
            std::error_code missing;
            const fs::path folder = fs::canonical(sideFilePath(path, other), missing);
            return !missing && liesIn(folder, place);
        });
    if (!anywhere && !is_in_others && !liesIn(fs::canonical(folderOf(path)), place))
        failFile(path, "it names the file " + excerpt(name) +
                           ", which lies outside its folder: put it there, or allow it in a `mesh` "
                           "record with side_files=anywhere");
    try {
        return openRegular(place.string());
    } catch (const FormatError&) {
        failFile(path, "it names the file " + excerpt(name) + ", which is no regular file");
    } catch (const std::system_error& cause) {
        failFile(path, "it names the file " + excerpt(name) +
                           ", which cannot be opened: " + cause.code().message());
    }
}

}  // namespace ispace
