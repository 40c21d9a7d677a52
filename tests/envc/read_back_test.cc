// SPDX-License-Identifier: GPL-3.0-or-later
// A room with a record of each kind, written in each format and read back.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/file.h"
#include "env/level.h"
#include "extensions/cad/cad.h"
#include "extensions/gazebo/gazebo.h"
#include "extensions/meshes/meshes_test.h"
#include "io/exporters.h"
#include "io/importers.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "support/test_folder.h"
#include "support/test_layout.h"

namespace ispace {

namespace {

/// The keys of a record that its keyword requires, or that set it apart from the others; "" for
/// those that a position is enough for.
std::string ownKeys(const Schema& schema) {
    static const std::map<std::string_view, std::string_view> kOwn{
        {"ispace", " size=24,20"},         {"wall", " from=-9,8 to=-7,8"},
        {"fence", " path=-5,8;-4,8;-4,9"}, {"door", " at=0,-10"},
        {"window", " at=5,-10"},           {"inside", " at=0,0.5"},
        {"mesh", " file=body.obj"},        {"contact", " door=door-1"},
        {"thermometer", " zone=zone-1"}};
    const auto own = kOwn.find(schema.keyword);
    std::string text(own == kOwn.end() ? "" : own->second);
    for (const KeySpec& key : schema.keys)
        if (key.required && text.find(' ' + key.name + '=') == std::string::npos &&
            key.name != "at")
            text += ' ' + key.name + '=' +
                    (key.type == KeyType::Text     ? "x"
                     : key.type == KeyType::Number ? "1"
                                                   : "1,1,1");
    return text;
}

/// A room with one record of each keyword, on a grid so that none touches another. The list of
/// schemas gives the keywords, so that a new one is covered.
std::string roomOfEach() {
    std::string text = "#env 1\n";
    int column = 0, row = 0;
    for (const Schema& schema : sceneSchemas().all()) {
        // Files beside the room, and results of arrange.
        if (schema.type == RecordType::Meta) continue;
        text += schema.keyword + " id=" + schema.keyword + "-1" + ownKeys(schema);
        if (schema.find("at") != nullptr &&
            text.find(" at=", text.rfind('\n')) == std::string::npos &&
            schema.type != RecordType::Space && schema.keyword != "wall") {
            text += " at=" + std::to_string(-10 + 3 * column) + ',' + std::to_string(-8 + 3 * row);
            if (++column == 7) {
                column = 0;
                ++row;
            }
        } else if (schema.keyword == "zone") {
            text += " at=9,8 size=1,1";
        }
        text += '\n';
    }
    return text;
}

/// How a product of a format is read back, and which records it names by their ids.
struct ReadBack {
    std::string_view format;
    /// m2 by which area and free floor may differ; negative: the product is no room.
    double area = -1, free = -1;
    bool has_records = false;  ///< the same ones
    bool (*names)(const Record& record, bool has_body) = nullptr;
    void (*set)(ImportOptions&) = nullptr;
};

bool isPlaced(const Record& record, bool /*has_body*/) {
    return record.schema().type == RecordType::Placement && record.keyword() != "mat" &&
           record.keyword() != "gate";
}
bool isAny(const Record& /*record*/, bool /*has_body*/) { return true; }
bool isBodyOrPlaced(const Record& record, bool has_body) {
    return has_body || isPlaced(record, has_body);
}

// In an IFC file furniture and meshes are boxes; in a DXF drawing meshes are their outlines; lines
// of walls become 5 mm thick in IFC, and a cell of a map in ROS.
const ReadBack kReadBacks[] = {
    {"glb", 0, 0, true, isAny},
    {"env", 0, 0, true, isAny},
    {"3dm", -1, -1, true, isAny},
    {"yaml", 0, 0, true, isAny},
    {"obj", 0.5, -1, false, isBodyOrPlaced, [](ImportOptions& o) { o.slice_walls = 1.5; }},
    {"stl", 0.5, -1, false, nullptr, [](ImportOptions& o) { o.slice_walls = 1.5; }},
    {"sdf", 1e-6, 0.3, false, isBodyOrPlaced},
    {"urdf", -1, -1, false, isPlaced},
    {"ifc", 0.4, 6, false,
     [](const Record& record, bool /*has_body*/) {
         const std::string& keyword = record.keyword();
         return keyword != "inside" && keyword != "weather" && keyword != "robot" &&
                keyword != "human";
     }},
    {"svg", 1e-3, -1, false, isBodyOrPlaced,
     [](ImportOptions& o) {
         o.width_is = 24;
         o.wall_layers = {"walls"};
     }},
    {"png"},
    {"pdf"},
    {"geojson", -1, -1, false, isAny},
    {"dxf", 1e-6, 2, false, isPlaced},
    {"ros", 12, 12},
    {"nav2-keepout"},
};

double freeAreaOf(const Scene& scene) {
    double area = 0;
    for (const Region& part : scene.environment.level(kScanHeight)->freeFloor())
        area += part.area();
    return area;
}

std::map<std::string, int> countsOf(const std::vector<Record>& records) {
    std::map<std::string, int> counts;
    for (const Record& record : records) ++counts[record.keyword()];
    return counts;
}

// "A room with a lamp cannot become IFC" is an error of the format, never of the room.
TEST(ExportFormats, EachRecordThroughEachFormatAndBack) {
    testing::addMeshesOnce();
    addImporters(cad::cadImporters());
    addImporters(gazebo::gazeboImporters());
    const testing::TestFolder folder;
    writeAll(folder.file("body.obj"),
             "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    Document document = readRecordText(roomOfEach(), folder.file("room.env"), sceneSchemas());
    loadFiles(document, folder.file("room.env"), {});
    document.kind = DocumentKind::Environment;
    const Scene scene = makeScene(document, nullptr, testing::devices());
    const double area = scene.environment.indoor().area();
    const double free = freeAreaOf(scene);
    ASSERT_NEAR(area, 480, 1e-9);
    std::map<std::string_view, bool> has_body;
    for (const Element& element : scene.environment.elements())
        has_body[element.id] = !element.body.prisms.empty() || !element.body.sheets.empty() ||
                               !element.body.plates.empty() || !element.body.meshes.empty();
    for (const ExportFormat& format : exportFormats()) {
        SCOPED_TRACE(format.name);
        const auto* const back =
            std::find_if(std::begin(kReadBacks), std::end(kReadBacks),
                         [&](const ReadBack& row) { return row.format == format.name; });
        ASSERT_NE(back, std::end(kReadBacks)) << "say how it is read back";
        ExportOptions options;
        if (!format.beside_suffix.empty())
            options.beside = "again" + std::string(format.beside_suffix);
        if (format.takes_zones) options.zones = {"rect:1,1,2,2"};
        ExportedFiles files;
        if (format.write_records != nullptr)
            files.product = format.write_records(Document(document));
        else
            files = format.write(scene, document, options);
        const std::string name = folder.file("again." + std::string(format.suffix));
        writeAll(name, files.product);
        if (!files.beside.empty()) writeAll(folder.file(options.beside), files.beside);
        ASSERT_FALSE(files.product.empty());
        for (std::size_t i = 0; back->names != nullptr && i < scene.records.size(); ++i) {
            if (!back->names(scene.records[i], has_body[scene.ids[i]])) continue;
            EXPECT_NE(files.product.find(scene.ids[i]), std::string::npos) << scene.ids[i];
        }
        if (back->area < 0 && !back->has_records) continue;
        ImportOptions import;
        if (back->set != nullptr) back->set(import);
        const Document again = parseDocument(files.product, name, import, sceneSchemas());
        if (back->has_records) {
            EXPECT_EQ(countsOf(again.records), countsOf(document.records));
        }
        if (back->area < 0) continue;
        const Scene read = makeScene(again, nullptr, testing::devices());
        EXPECT_NEAR(read.environment.indoor().area(), area, back->area + 1e-9);
        if (back->free < 0) continue;
        EXPECT_NEAR(freeAreaOf(read), free, back->free + 1e-9);
    }
}

}  // namespace

}  // namespace ispace
