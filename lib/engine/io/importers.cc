// SPDX-License-Identifier: GPL-3.0-or-later
// Recognises formats by content, in an order that makes tests cheap and mistakes rare: records,
// formats of extensions, formats with magic bytes, foreign formats that are refused by name, then
// text. A suffix decides only where content cannot: some meshes have no magic.
#include "io/importers.h"

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include "base/budget.h"
#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "io/calibration.h"
#include "io/glb/glb_read.h"
#include "io/import_records.h"
#include "io/mesh_files.h"
#include "raster/picture.h"
#include "record/text.h"

namespace ispace {

namespace {

constexpr std::string_view kBlanks = " \t\r\n";

/// UTF-8 without control characters other than those of plain text.
bool isPlainText(std::string_view bytes) {
    while (!bytes.empty()) {
        const auto first = static_cast<unsigned char>(bytes.front());
        if (first < 0x20 && kBlanks.find(bytes.front()) == std::string_view::npos) return false;
        const std::size_t length = utf8Length(bytes);
        if (length == 0) return false;
        bytes.remove_prefix(length);
    }
    return true;
}

/// A line of text and its number.
struct Line {
    std::string_view text;
    int number = 0;
};

/// Finds the first line that holds more than blanks and a comment, from its first word on.
Line firstLine(std::string_view bytes) {
    LineReader lines(bytes);
    while (const auto line = lines.next())
        if (const auto text = trimmed(*line); !text.empty() && text.front() != '#')
            return {text, lines.number()};
    return {};
}

/// Returns true for `desk at=2,3` and for a known keyword alone: records that lack their magic
/// line.
bool isRecordLine(std::string_view line, const Schemas& schemas) {
    const std::string_view first = line.substr(0, line.find_first_of(kBlanks));
    if (first.find_first_of(":-{[") != std::string_view::npos) return false;  // YAML
    std::string_view rest = line.substr(first.size());
    rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
    if (rest.empty()) return schemas.find(first) != nullptr;
    const std::size_t equals = rest.find('=');
    return equals != 0 && equals < rest.find_first_of(" \t:{[\"'");
}

/// Magic bytes of known formats that are not read, and descriptions of these.
constexpr std::pair<std::string_view, const char*> kForeign[] = {
    {"%PDF-",
     "a PDF: if it was drawn, not scanned, convert it to SVG, for example with `pdftocairo -svg "
     "FILE plan.svg`, or to a picture with `pdftoppm -png`"},
    {"%!PS", "PostScript: convert it to PDF with `ps2pdf`, then to SVG with `pdftocairo -svg`"},
    {"8BPS", "a Photoshop picture: convert it, for example with `convert FILE[0] plan.png`"},
    {"ISO-10303-21",
     "a STEP file without a building (IFC): export it as STL or OBJ, for example with FreeCAD"},
    {"gimp xcf", "a GIMP picture: export it as PNG"},
    {"GIF8", "a GIF picture: convert it, for example with `convert FILE plan.png`"},
    {std::string_view("\0\0\0\x0cjP  ", 8),
     "a JPEG 2000 picture: convert it, for example with `convert FILE plan.png`"},
    {std::string_view("\xff\xfe\xff\x0e"
                      "S\0k\0e\0t\0c\0h\0U\0p\0",
                      20),
     "a SketchUp model: export it as COLLADA, and cut walls from it with --slice-walls"},
    {"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
     "an OLE file, as Revit (.rvt) and Visio (.vsd) write: export it as IFC, DXF or SVG"},
    {std::string_view("PK\3\4", 4),
     "a zip archive: unpack it; of a drawing of Visio or LibreOffice export SVG"},
    {"ASTM-E57", "an E57 point cloud: convert it to PCD or PLY, for example with CloudCompare"},
    {"BLENDER", "a Blender scene: export it as glTF or COLLADA"},
    {std::string_view("\xff\xfe<\0", 4),
     "XML in UTF-16: convert it, for example with `iconv -f UTF-16 -t UTF-8 FILE`"},
    {"\x1f\x8b", "compressed with gzip: unpack it with `gunzip` (a .svgz becomes .svg)"},
};

/// Returns the name and the converter of a well-known foreign format; "" for other bytes.
std::string foreignFile(std::string_view bytes) {
    if (bytes.starts_with("AutoCAD Binary DXF"))
        return "binary DXF: save it as ASCII DXF, for example with LibreCAD or FreeCAD";
    if (bytes.starts_with("AC10") && bytes.size() > 6 && bytes[4] >= '0' && bytes[4] <= '9')
        return "a DWG drawing: convert it to DXF, for example with `dwg2dxf FILE` (LibreDWG)";
    for (const auto& [magic, what] : kForeign)
        if (bytes.starts_with(magic)) return what;
    return "";
}

/// Names foreign XML; "" for other bytes.
std::string foreignXml(std::string_view bytes) {
    const std::string root(xmlRootName(bytes));
    if (root.empty()) return "";
    return "XML of a kind that is not read (" + excerpt(root) + "): SVG, SDF and COLLADA are" +
           (root == "robot" ? "; `gz sdf -p FILE` converts URDF to SDF" : "");
}

/// Returns true for lines of three numbers or more, as clouds of points in text have them, after a
/// line with a title or their number.
bool isPointText(std::string_view bytes) {
    constexpr int kEnough = 3;
    int found = 0;
    bool is_first = true;
    for (LineReader lines(bytes); found < kEnough;) {
        const auto line = lines.next();
        if (!line) return false;
        std::string_view rest = trimmed(*line);
        if (rest.empty() || rest.front() == '#') continue;
        std::size_t numbers = 0;
        while (!rest.empty()) {
            const std::string_view word = rest.substr(0, rest.find_first_of(" \t,;"));
            if (!parseDouble(word)) break;
            ++numbers;
            rest.remove_prefix(word.size());
            rest.remove_prefix(std::min(rest.find_first_not_of(" \t,;"), rest.size()));
        }
        const bool is_point = numbers >= 3 && rest.empty();
        if (!is_point && !is_first) return false;
        is_first = false;
        found += is_point ? 1 : 0;
    }
    return true;
}

/// Names foreign JSON, which would parse as YAML.
std::string foreignJson(std::string_view bytes) {
    if (bytes.find("\"FeatureCollection\"") != std::string_view::npos)
        return "GeoJSON, which is written but not read";
    return "";
}

/// Bytes of a confined format that are a unit of the Budget of the building around it.
constexpr std::size_t kConfinedBytesPerUnit = 8;

Document readRecordsOfGlb(const ImportSource& source) {
    return readGlb(source.bytes, source.operand, source.schemas);
}
Document readRecords(const ImportSource& source) {
    return readRecordText(source.bytes, source.operand, source.schemas);
}
Document readYamlRecords(const ImportSource& source) {
    return readYaml(source.bytes, source.operand, source.schemas, {}, source.options.max_work,
                    source.options.includes);
}

/// The formats in which records are written. They come first.
constexpr Importer kFormatsOfRecords[] = {
    {"", false,
     [](const ImportSource& source) { return isGlb(source.bytes) && glbHasRecords(source.bytes); },
     readRecordsOfGlb},
    {"`#3dm 1`, `#env 1`", false,
     [](const ImportSource& source) { return isRecordText(source.bytes); }, readRecords},
};

/// Formats recognised by their first bytes, after those of extensions.
constexpr Importer kFormatsByMagic[] = {
    {"GLB", false, [](const ImportSource& source) { return isGlb(source.bytes); },
     readRecordsOfGlb},
    importer<isPicture, readBarePicture>("a picture"),
};

/// Formats recognised within plain text; the last accepts any text.
constexpr Importer kFormatsOfText[] = {
    importer<isRosMap, readRosMap>("a ROS map"),
    {"YAML", false, [](const ImportSource&) { return true; }, readYamlRecords},
};

std::vector<Importer>& addedImporters() {
    static std::vector<Importer> importers;
    return importers;
}

std::vector<std::vector<std::string> (*)()>& addedSurroundings() {
    static std::vector<std::vector<std::string> (*)()> functions;
    return functions;
}

/// A format of an extension that is not in this build.
struct MissingFormat {
    std::string_view sign, extension;
};

std::vector<MissingFormat>& missingFormats() {
    static std::vector<MissingFormat> formats;
    return formats;
}

bool hasJsonKey(std::string_view bytes, std::string_view key) {
    const std::string quoted = '"' + std::string(key) + '"';
    return isJson(bytes) && bytes.find(quoted) != std::string_view::npos;
}

/// Lists the formats, in the order of their names: "wanted DXF, GLB or SVG".
std::string wanted() {
    std::vector<std::string_view> names;
    const auto add = [&names](std::span<const Importer> rows) {
        for (const Importer& row : rows)
            if (!row.name.empty()) names.push_back(row.name);
    };
    add(kFormatsOfRecords);
    add(kFormatsByMagic);
    add(kFormatsOfText);
    add(addedImporters());
    std::sort(names.begin(), names.end());
    std::string text = "wanted ";
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) text += i + 1 < names.size() ? ", " : " or ";
        text += names[i];
    }
    return text;
}

const Importer* findFormat(std::span<const Importer> formats, const ImportSource& source,
                           bool by_name = false) {
    const auto found = std::find_if(formats.begin(), formats.end(), [&](const auto& format) {
        return format.by_name == by_name && format.recognises(source);
    });
    return found == formats.end() ? nullptr : &*found;
}

/// Returns the format of the source; calls `refuse(line, message)` if there is none.
template <typename Refuse>
const Importer* formatOf(const ImportSource& source, Refuse refuse) {
    const std::string_view bytes = source.bytes;
    if (bytes.find_first_not_of(kBlanks) == std::string_view::npos)
        return refuse(0, "empty input: " + wanted()), nullptr;
    if (const Importer* format = findFormat(kFormatsOfRecords, source)) return format;
    if (const Importer* format = findFormat(addedImporters(), source)) return format;
    if (const Importer* format = findFormat(kFormatsByMagic, source)) return format;
    if (const std::string lacks = missingReader(bytes, source.operand); !lacks.empty())
        return refuse(0, lacks), nullptr;
    if (const std::string what = foreignFile(bytes); !what.empty())
        return refuse(0, "not an environment or layout but " + what), nullptr;
    if (const std::string what = foreignMesh(source.operand); !what.empty())
        return refuse(0, "not an environment or layout but " + what), nullptr;
    if (const Importer* format = findFormat(addedImporters(), source, true)) return format;
    if (!isPlainText(bytes)) return refuse(0, "not an environment or layout: " + wanted()), nullptr;
    if (isJson(bytes))
        if (const std::string what = foreignJson(bytes); !what.empty())
            return refuse(0, "not an environment or layout but " + what), nullptr;
    if (const std::string what = foreignXml(bytes); !what.empty())
        return refuse(0, "not an environment or layout but " + what), nullptr;
    if (isPointText(bytes))
        return refuse(0,
                      "not an environment or layout but points as text: convert them to PCD or "
                      "PLY, for example with CloudCompare"),
               nullptr;
    const Line line = firstLine(bytes);
    if (isRecordLine(line.text, source.schemas))
        return refuse(line.number,
                      "a record before the magic line: the first line must be "
                      "`#env 1` or `#3dm 1`"),
               nullptr;
    return findFormat(kFormatsOfText, source);
}

}  // namespace

bool isJson(std::string_view bytes) {
    const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos || (bytes[begin] != '{' && bytes[begin] != '['))
        return false;
    // YAML's flow form begins likewise; in JSON a quoted key or another bracket follows.
    const std::size_t next = bytes.find_first_not_of(" \t\r\n", begin + 1);
    return next != std::string_view::npos &&
           std::string_view("\"[{").find(bytes[next]) != std::string_view::npos;
}

void addImporters(std::span<const Importer> importers) {
    addedImporters().insert(addedImporters().end(), importers.begin(), importers.end());
}

void addImportSurroundings(std::vector<std::string> (*surroundings)()) {
    addedSurroundings().push_back(surroundings);
}

std::vector<std::string> importSurroundings() {
    std::vector<std::string> texts;
    for (const auto& surroundings : addedSurroundings())
        for (std::string& text : surroundings()) texts.push_back(std::move(text));
    return texts;
}

void addMissingFormat(std::string_view sign, std::string_view extension) {
    missingFormats().push_back({sign, extension});
}

std::string missingReader(std::string_view bytes, const std::string& operand) {
    for (const auto& [sign, extension] : missingFormats()) {
        const bool is_its = sign.front() == '.'   ? fileSuffix(operand) == sign
                            : sign.front() == '{' ? hasJsonKey(bytes, sign.substr(1))
                            : sign.front() == '<' ? xmlRootName(bytes) == sign.substr(1)
                                                  : bytes.starts_with(sign);
        if (is_its)
            return "this build lacks the extension " + std::string(extension) +
                   ", which reads such files";
    }
    return "";
}

bool isPlan(std::string_view bytes, const std::string& operand, const ImportOptions& options,
            const Schemas& schemas) {
    const Importer* format = formatOf({withoutBom(bytes), operand, options, schemas},
                                      [](int /*line*/, const std::string& /*message*/) {});
    return format != nullptr && format->is_plan;
}

Document parseDocument(std::string_view bytes, const std::string& operand,
                       const ImportOptions& options, const Schemas& schemas) {
    const ImportSource source{withoutBom(bytes), operand, options, schemas};
    const Importer* format = formatOf(
        source, [&](int line, const std::string& message) { failFile(operand, message, line); });
    Budget* building = options.max_work.whole;
    if (format->is_confined && building != nullptr &&
        !building->take(bytes.size() / kConfinedBytesPerUnit))
        failFile(operand, "the files of the building take " + building->excess());
    Document document = format->read(source);
    if (options.load_files) loadFiles(document, operand, options);
    return document;
}

void ImportReport::addChoice(const std::string& operand, const std::string& sentence) {
    choices.push_back({operand, 0, 0, sentence, Severity::Note});
}

void ImportReport::add(ImportReport other) {
    const auto append = [](std::vector<Diagnostic>& to, std::vector<Diagnostic>& from) {
        to.insert(to.end(), std::move_iterator(from.begin()), std::move_iterator(from.end()));
    };
    append(choices, other.choices);
    append(doubts, other.doubts);
    has_storeys |= other.has_storeys;
}

void loadFiles(Document& document, const std::string& operand, const ImportOptions& options) {
    loadMeshes(document, operand, options);
    loadCalibrations(document, operand);
}

Document readDocument(const std::string& operand, const ImportOptions& options,
                      const Schemas& schemas) {
    if (auto document = operand == "-" ? std::nullopt : readGlbFile(operand, schemas)) {
        if (options.load_files) loadFiles(*document, operand, options);
        return std::move(*document);
    }
    return parseDocument(readAll(operand), operand, options, schemas);
}

}  // namespace ispace
