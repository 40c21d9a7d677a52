// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/file.h"
#include "extensions/ifc/ifc.h"
#include "extensions/ifc/ifc_test.h"
#include "extensions/ifc/tests/test_ifc.h"
#include "record/text.h"
#include "site/chosen_storeys.h"
#include "site/site_scene.h"
#include "site/storeys.h"
#include "support/test_folder.h"
#include "support/test_import.h"

namespace ispace::ifc {
namespace ifc_building_test {

/// Writes boxes as products of IFC4, in metres.
class IfcBoxes {
  public:
    /// Adds a storey and makes it the current one.
    void storey(const std::string& name, double z) {
        close();
        floor_ = z;
        storey_ = add("IFCBUILDINGSTOREY('" + guid() + "',$,'" + name + "',$,$," + placement(0, 0) +
                      ",$,$,.ELEMENT.," + real(z) + ")");
        storeys_ += (storeys_.empty() ? "" : ",") + storey_;
    }
    /// Adds a box that stands on the storey, by its middle and size. \param rest of the instance
    void box(const std::string& type, double x, double y, double length, double width,
             double height, const std::string& rest = ",$") {
        const std::string at = add("IFCCARTESIANPOINT((0.,0.))");
        const std::string axis = add("IFCAXIS2PLACEMENT2D(" + at + ",$)");
        const std::string profile = add("IFCRECTANGLEPROFILEDEF(.AREA.,$," + axis + "," +
                                        real(length) + "," + real(width) + ")");
        const std::string base = add("IFCAXIS2PLACEMENT3D(" + point(0, 0, 0) + ",$,$)");
        const std::string up = add("IFCDIRECTION((0.,0.,1.))");
        const std::string solid = add("IFCEXTRUDEDAREASOLID(" + profile + "," + base + "," + up +
                                      "," + real(height) + ")");
        const std::string shape =
            add("IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(" + solid + "))");
        const std::string whole = add("IFCPRODUCTDEFINITIONSHAPE($,$,(" + shape + "))");
        const std::string product =
            add(type + "('" + guid() + "',$,'x',$,$," + placement(x, y) + "," + whole + rest + ")");
        products_ += (products_.empty() ? "" : ",") + product;
    }
    std::string text() {
        close();
        const std::string building =
            add("IFCBUILDING('" + guid() + "',$,'House',$,$,$,$,$,.ELEMENT.,$,$,$)");
        add("IFCRELAGGREGATES('" + guid() + "',$,$,$,#1,(" + building + "))");
        add("IFCRELAGGREGATES('" + guid() + "',$,$,$," + building + ",(" + storeys_ + "))");
        return ifcWith(data_);
    }

  private:
    static std::string real(double value) {
        std::string text = std::to_string(value);
        return text;
    }
    std::string guid() const { return "0000000000000000000" + std::to_string(100 + next_); }
    std::string add(const std::string& instance) {
        const std::string name = '#' + std::to_string(next_++);
        data_.append(name).append("=").append(instance).append(";\n");
        return name;
    }
    std::string point(double x, double y, double z) {
        return add("IFCCARTESIANPOINT((" + real(x) + "," + real(y) + "," + real(z) + "))");
    }
    std::string placement(double x, double y) {
        const std::string axis = add("IFCAXIS2PLACEMENT3D(" + point(x, y, floor_) + ",$,$)");
        return add("IFCLOCALPLACEMENT($," + axis + ")");
    }
    void close() {
        if (!products_.empty())
            add("IFCRELCONTAINEDINSPATIALSTRUCTURE('" + guid() + "',$,$,$,(" + products_ + ")," +
                storey_ + ")");
        products_.clear();
    }

    int next_ = 10;
    double floor_ = 0;
    std::string data_, storey_, storeys_, products_;
};

/// Adds a hall of 8 m by 6 m with a shaft of 2 m by 2 m in its corner.
void addHall(IfcBoxes& ifc, bool has_door) {
    ifc.box("IFCWALL", 4, 0.1, 8, 0.2, 2.8);
    ifc.box("IFCWALL", 4, 5.9, 8, 0.2, 2.8);
    ifc.box("IFCWALL", 0.1, 3, 0.2, 5.6, 2.8);
    ifc.box("IFCWALL", 7.9, 3, 0.2, 5.6, 2.8);
    ifc.box("IFCWALL", 2.25, 4.75, 0.1, 2.1, 2.8);
    ifc.box("IFCWALL", 1.2, 3.75, 2, 0.1, 2.8);
    ifc.box("IFCDOOR", 5, 0.1, 1, 0.2, 2, ",$,2.,1.");
    if (has_door) ifc.box("IFCDOOR", 2.25, 4.8, 0.1, 0.9, 2, ",$,2.,0.9");
}

std::string tower(bool first_has_door, int cabins = 1) {
    IfcBoxes ifc;
    for (int i = 0; i < 3; ++i) {
        ifc.storey("level " + std::to_string(i), 3 * i);
        addHall(ifc, i != 1 && (i > 0 || first_has_door));
        if (i < cabins) ifc.box("IFCTRANSPORTELEMENT", 1.2, 4.8, 1.8, 1.6, 2.2);
    }
    return ifc.text();
}

TEST(IfcBuilding, LiftsStopWhereTheyHaveDoors) {
    for (const int cabins : {1, 3}) {
        const StoreyedDocument building = readIfcBuilding(tower(true, cabins), "tower.ifc", {});
        ASSERT_EQ(building.storeys.size(), 3U);
        ASSERT_EQ(building.passages.size(), 1U) << cabins;
        EXPECT_EQ(formatRecord(building.passages[0].record),
                  "lift id=lift storeys=level-0,level-2 at=1.2,4.8 size=1.6,1.8 door=0.9");
        SiteScene scene = makeSiteScene(building, {}, {});
        EXPECT_TRUE(checkBuilding(scene).empty()) << checkBuilding(scene).front().text();
    }
}

TEST(IfcBuilding, DoorsOfTheLobbyAreNotThoseOfTheLift) {
    IfcBoxes ifc;
    for (int i = 0; i < 3; ++i) {
        ifc.storey("level " + std::to_string(i), 3 * i);
        addHall(ifc, i != 1);
        ifc.box("IFCDOOR", 2.8, 5, 0.9, 0.1, 2, ",$,2.,0.9");  // at right angles
        if (i == 0) ifc.box("IFCTRANSPORTELEMENT", 1.2, 4.8, 1.8, 1.6, 2.2);
    }
    const StoreyedDocument building = readIfcBuilding(ifc.text(), "tower.ifc", {});
    ASSERT_EQ(building.passages.size(), 1U);
    EXPECT_EQ(formatRecord(building.passages[0].record),
              "lift id=lift storeys=level-0,level-2 at=1.2,4.8 size=1.6,1.8 door=0.9");
}

TEST(IfcBuilding, LiftsWithOneDoorAreLeftOut) {
    const StoreyedDocument building = readIfcBuilding(tower(false), "tower.ifc", {});
    EXPECT_TRUE(building.passages.empty());
    bool is_told = false;
    for (const std::string& note : building.notes)
        is_told = is_told || note.find("1 transport element left out") != std::string::npos;
    EXPECT_TRUE(is_told);
}

TEST(IfcBuilding, HasTheStoreysThatAPatternMatches) {
    testing::addIfcOnce();
    IfcBoxes ifc;
    for (int i = 0; i < 3; ++i) {
        ifc.storey(i == 2 ? "Roof" : "Level " + std::to_string(i), 3 * i);
        addHall(ifc, i != 1);
    }
    const std::string text = ifc.text();
    const auto read = [&](std::vector<std::string> words) {
        const StoreyChoice choice{std::move(words)};
        return chosenStoreys(readStoreys(text, "tower.ifc", {}, choice).value(), choice,
                             "tower.ifc");
    };
    const StoreyedDocument building = read({"level *"});
    EXPECT_EQ(building.storeyList(), "level-0, level-1");
    EXPECT_EQ(building.storeys[1].record.number("height"), 3) << "up to the roof";
    EXPECT_NE(std::find(building.notes.begin(), building.notes.end(), "left out by --storey: roof"),
              building.notes.end());
    EXPECT_EQ(read({"roof", "Level 0"}).storeyList(), "level-0, roof");
    EXPECT_EQ(read({"all"}).storeyList(), "level-0, level-1, roof");
    EXPECT_EQ(read({}).storeyList(), "level-0, level-1, roof");
    std::string error;
    try {
        (void)read({"Attic*"});
    } catch (const UsageError& failure) {
        error = failure.what();
    }
    EXPECT_EQ(error, "the building has no storey `Attic*` (level-0, level-1, roof)");
}

TEST(IfcBuilding, OfOneStoreyIsARoom) {
    testing::addIfcOnce();
    IfcBoxes ifc;
    ifc.storey("Roof", 3);
    ifc.storey("Ground", 0);
    addHall(ifc, true);
    const std::string text = ifc.text();
    EXPECT_TRUE(mayHoldStoreys(text, {}));
    EXPECT_FALSE(mayHoldStoreys(text, {{"Ground"}}));
    EXPECT_FALSE(readStoreys(text, "hut.ifc", {}, {}));
    EXPECT_EQ(readStoreys(text, "hut.ifc", {}, {{"all"}}).value().storeys.size(), 1U);
}

TEST(IfcBuilding, ComparingLiftsWithDoorsIsBounded) {
    IfcBoxes ifc;
    ifc.storey("hall", 0);
    addHall(ifc, true);
    for (int i = 0; i < 18; ++i)
        for (const double y : {0.1, 5.9})
            ifc.box("IFCDOOR", 0.5 + 0.4 * i, y, 0.3, 0.2, 2, ",$,2.,0.3");
    for (int i = 0; i < 300; ++i) ifc.box("IFCTRANSPORTELEMENT", 4, 2, 1.8, 1.6, 2.2);
    const std::string text = ifc.text();
    ImportOptions options;
    EXPECT_EQ(readIfcBuilding(text, "tower.ifc", options).storeys.size(), 1U);
    options.max_work.max = 12'000;
    std::string error;
    try {
        (void)readIfcBuilding(text, "tower.ifc", options);
    } catch (const FormatError& failure) {
        error = failure.diagnostics().front().text();
    }
    EXPECT_EQ(error,
              "tower.ifc: error: lifts and doors of the building make more than 12000 units of "
              "work (`--max-work 24000` allows more)");
}

TEST(IfcBuilding, AsRoomsOfABuildingPayItsBudget) {
    testing::addIfcOnce();
    const testing::TestFolder folder;
    const std::string ifc =
        "ISO-10303-21;\nFILE_SCHEMA(('IFC4'));\n" + std::string(8000, ' ') + "\n";
    std::string storeys = "#env 1\n";
    for (const char* id : {"a", "b", "c"}) {
        writeAll(folder.file(std::string(id) + ".ifc"), ifc);
        storeys += std::string("storey id=") + id + " file=" + id + ".ifc\n";
    }
    const std::string name = folder.file("house.env");
    writeAll(name, "");
    ImportOptions options;
    options.max_work.max = 1500;
    const std::string error = errorsOf([&] { readBuilding(storeys, name, options); });
    EXPECT_NE(error.find("a.ifc: error: truncated"), std::string::npos) << error;
    EXPECT_NE(error.find("b.ifc: error: the files of the building take more than 1500 "
                         "units of work (`--max-work 3000` allows more)"),
              std::string::npos)
        << error;
    EXPECT_EQ(error.find("c.ifc"), std::string::npos) << error;
}

}  // namespace ifc_building_test
}  // namespace ispace::ifc
