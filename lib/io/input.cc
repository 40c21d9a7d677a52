// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/input.h"

#include <algorithm>
#include <optional>

#include "base/error.h"
#include "base/file.h"
#include "base/utf8.h"
#include "io/aria_map.h"
#include "io/dxf.h"
#include "io/glb.h"
#include "io/house_expo.h"
#include "io/mesh_file.h"
#include "io/ros_map.h"
#include "record/lexer.h"
#include "record/text.h"
#include "record/yaml.h"

namespace ispace {

namespace {

constexpr const char* kWanted =
    "wanted GLB, `#env 1`, `#3dm 1`, YAML, a ROS map, HouseExpo JSON, an ARIA map, DXF or a mesh";
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

/// The first line that holds more than blanks and a comment, from its first word on.
Line firstLine(std::string_view bytes) {
    Line line;
    while (!bytes.empty()) {
        ++line.number;
        const std::size_t end = std::min(bytes.find('\n'), bytes.size());
        line.text = bytes.substr(0, end);
        bytes.remove_prefix(std::min(end + 1, bytes.size()));
        line.text.remove_prefix(std::min(line.text.find_first_not_of(kBlanks), line.text.size()));
        if (!line.text.empty() && line.text.front() != '#') return line;
    }
    return {};
}

/// True for `desk at=2,3` and for a known keyword alone: records that lack their magic line.
bool isRecordLine(std::string_view line, const Schemas& schemas) {
    const std::string_view first = line.substr(0, line.find_first_of(kBlanks));
    if (first.find_first_of(":-{[") != std::string_view::npos) return false;  // YAML
    std::string_view rest = line.substr(first.size());
    rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
    if (rest.empty()) return schemas.find(first) != nullptr;
    const std::size_t equals = rest.find('=');
    return equals != 0 && equals < rest.find_first_of(" \t:{[\"'");
}

/// What a well-known foreign file is, with the way in; "" for others.
std::string foreignFile(std::string_view bytes) {
    if (bytes.starts_with("P2") || bytes.starts_with("P5"))
        return "a PGM picture: name the map.yaml that goes with it";
    if (bytes.starts_with("\x89PNG"))
        return "a PNG picture: for a ROS map name the map.yaml that goes with it";
    if (bytes.starts_with("AutoCAD Binary DXF"))
        return "binary DXF: save it as ASCII DXF, in AutoCAD with `SAVEAS`, type DXF, options";
    if (bytes.starts_with("AC10") && bytes.size() > 6 && bytes[4] >= '0' && bytes[4] <= '9')
        return "a DWG drawing: save it as ASCII DXF, or convert it, for example with `dwg2dxf`";
    return "";
}

/// JSON of others that is valid YAML, too.
std::string foreignJson(std::string_view bytes) {
    if (bytes.find("\"FeatureCollection\"") != std::string_view::npos)
        return "GeoJSON, which is written but not read";
    return "";
}

/// Formats whose first bytes tell them, text or not; nothing for others.
std::optional<Document> readByMagic(std::string_view bytes, const std::string& operand,
                                    const ImportOptions& options, const Schemas& schemas) {
    if (isRecordText(bytes)) return readRecordText(bytes, operand, schemas);
    if (isAriaMap(bytes)) return readAriaMap(bytes, operand, options, schemas);
    if (isDxf(bytes)) return readDxf(bytes, operand, options, schemas);
    if (isMeshFile(bytes)) return meshDocument(operand, options, schemas);
    return std::nullopt;
}

Document parseRecords(std::string_view bytes, const std::string& operand,
                      const ImportOptions& options, const Schemas& schemas) {
    const auto fail = [&operand](int line, const std::string& message) {
        throw FormatError(Diagnostic{displayName(operand), line, line == 0 ? 0 : 1, message});
    };
    if (isGlb(bytes))
        return glbHasRecords(bytes) ? readGlb(bytes, operand, schemas)
                                    : meshDocument(operand, options, schemas);
    bytes = withoutMark(bytes);
    if (bytes.find_first_not_of(kBlanks) == std::string_view::npos)
        fail(0, std::string("empty input: ") + kWanted);
    if (auto document = readByMagic(bytes, operand, options, schemas)) return *std::move(document);
    if (const std::string what = foreignFile(bytes); !what.empty())
        fail(0, "not an environment or layout but " + what);
    if (hasMeshSuffix(operand)) return meshDocument(operand, options, schemas);
    if (!isPlainText(bytes)) fail(0, std::string("not an environment or layout: ") + kWanted);
    if (isJson(bytes)) {
        if (bytes.find("\"verts\"") != std::string_view::npos)
            return readHouseExpo(bytes, operand, options, schemas);
        if (const std::string what = foreignJson(bytes); !what.empty())
            fail(0, "not an environment or layout but " + what);
    }
    const Line line = firstLine(bytes);
    if (isRecordLine(line.text, schemas))
        fail(line.number,
             "a record before the magic line: the first line must be `#env 1` or `#3dm 1`");
    if (isRosMap(bytes)) return readRosMap(bytes, operand, options, schemas);
    return readYaml(bytes, operand, schemas);
}

}  // namespace

Document parseDocument(std::string_view bytes, const std::string& operand,
                       const ImportOptions& options, const Schemas& schemas) {
    Document document = parseRecords(bytes, operand, options, schemas);
    if (options.load_meshes) loadMeshes(document, operand);
    return document;
}

Document readDocument(const std::string& operand, const ImportOptions& options,
                      const Schemas& schemas) {
    return parseDocument(readAll(operand), operand, options, schemas);
}

}  // namespace ispace
