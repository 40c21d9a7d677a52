// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/ifc/reader/ifc_shapes.h"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>

#include "extensions/ifc/reader/ifc_sections.h"
#include "extensions/ifc/storey_plan.h"
#include "extensions/ifc/tests/test_ifc.h"
#include "geom/arrangement.h"
#include "support/test_work.h"

namespace ispace::ifc {
namespace ifc_shapes_test {

/// Items of one shape: `item` is #100; #10 is the origin, #11 to #13 are the axes.
struct ShapeOf {
    explicit ShapeOf(const std::string& data, Budget& work = ampleWork())
        : bytes(ifcWith("#10=IFCCARTESIANPOINT((0.,0.,0.));\n#11=IFCDIRECTION((1.,0.,0.));\n"
                        "#12=IFCDIRECTION((0.,1.,0.));\n#13=IFCDIRECTION((0.,0.,1.));\n"
                        "#14=IFCAXIS2PLACEMENT3D(#10,$,$);\n#15=IFCAXIS2PLACEMENT2D(#10,$);\n"
                        "#90=IFCPRODUCTDEFINITIONSHAPE($,$,(#91));\n"
                        "#91=IFCSHAPEREPRESENTATION($,'Body','x',(#100));\n" +
                        data)),
          file(bytes, &work),
          frames(file),
          shapes(frames, work),
          shape(shapes.shapeOf(90)) {}

    /// Area of the cut at a height.
    [[nodiscard]] double at(double height) const {
        return totalArea(areaOf(sectionOf(shape, height)));
    }

    std::string bytes;
    StepFile file;
    IfcFrames frames;
    IfcShapes shapes;
    IfcShape shape;
};

const std::string kBox = "#20=IFCRECTANGLEPROFILEDEF(.AREA.,$,$,4.,2.);\n";
const std::string kUp = kBox + "#100=IFCEXTRUDEDAREASOLID(#20,#14,#13,3.);\n";

TEST(IfcShapes, ExtrusionsUpAndDownAndAcross) {
    EXPECT_NEAR(ShapeOf(kUp).at(1), 8, 1e-9);
    EXPECT_NEAR(ShapeOf(kUp).at(0), 8, 1e-9);  // the lower end belongs to it
    EXPECT_NEAR(ShapeOf(kUp).at(3), 0, 1e-9);
    const ShapeOf down(kBox +
                       "#21=IFCDIRECTION((0.,0.,-1.));\n"
                       "#100=IFCEXTRUDEDAREASOLID(#20,#14,#21,3.);\n");
    EXPECT_NEAR(down.at(-1), 8, 1e-9);
    // The profile stands upright: 4 m along y, 2 m high, swept 3 m along x.
    const ShapeOf across(kBox +
                         "#21=IFCAXIS2PLACEMENT3D(#10,#11,#12);\n"
                         "#100=IFCEXTRUDEDAREASOLID(#20,#21,#13,3.);\n");
    EXPECT_NEAR(across.at(0.5), 12, 1e-9);
    EXPECT_NEAR(across.at(1.5), 0, 1e-9);
}

TEST(IfcShapes, ProfilesAndCurves) {
    const auto area = [](const std::string& profile) {
        return ShapeOf(profile + "#100=IFCEXTRUDEDAREASOLID(#20,#14,#13,3.);\n").at(1);
    };
    const double pi = std::numbers::pi;
    EXPECT_NEAR(area("#20=IFCCIRCLEPROFILEDEF(.AREA.,$,#15,2.);\n"), 4 * pi, 5e-4);
    EXPECT_NEAR(area("#20=IFCCIRCLEHOLLOWPROFILEDEF(.AREA.,$,#15,2.,0.5);\n"), 1.75 * pi, 5e-4);
    EXPECT_NEAR(area("#20=IFCRECTANGLEHOLLOWPROFILEDEF(.AREA.,$,#15,4.,2.,0.5,$,$);\n"), 5, 1e-9);
    EXPECT_NEAR(area("#20=IFCTRAPEZIUMPROFILEDEF(.AREA.,$,#15,4.,2.,3.,1.);\n"), 9, 1e-9);
    // A half disc of arc and chord.
    const std::string half =
        "#20=IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,#21);\n#21=IFCCOMPOSITECURVE((#22,#23),.F.);\n"
        "#22=IFCCOMPOSITECURVESEGMENT(.CONTINUOUS.,.T.,#24);\n"
        "#23=IFCCOMPOSITECURVESEGMENT(.CONTINUOUS.,.F.,#26);\n"
        "#24=IFCTRIMMEDCURVE(#25,(IFCPARAMETERVALUE(0.)),(IFCPARAMETERVALUE(3.141592653589793)),.T."
        ",.PARAMETER.);\n"
        "#25=IFCCIRCLE(#15,2.);\n#26=IFCPOLYLINE((#27,#28));\n"
        "#27=IFCCARTESIANPOINT((2.,0.));\n#28=IFCCARTESIANPOINT((-2.,0.));\n";
    EXPECT_NEAR(area(half), 2 * pi, 5e-4);
    // The same as an indexed curve.
    EXPECT_NEAR(area("#20=IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,#21);\n"
                     "#21=IFCINDEXEDPOLYCURVE(#22,(IFCARCINDEX((1,2,3)),IFCLINEINDEX((3,1))),$);\n"
                     "#22=IFCCARTESIANPOINTLIST2D(((2.,0.),(0.,2.),(-2.,0.)));\n"),
                2 * pi, 5e-4);
    // A hole.
    EXPECT_NEAR(area("#20=IFCARBITRARYPROFILEDEFWITHVOIDS(.AREA.,$,#21,(#22));\n"
                     "#21=IFCCIRCLE(#15,2.);\n#22=IFCCIRCLE(#15,1.);\n"),
                3 * pi, 5e-4);
    // A line with a corner, 0.2 m thick.
    EXPECT_NEAR(
        area("#20=IFCCENTERLINEPROFILEDEF(.AREA.,$,#21,0.2);\n#21=IFCPOLYLINE((#22,#10,#23));\n"
             "#22=IFCCARTESIANPOINT((3.,0.));\n#23=IFCCARTESIANPOINT((0.,2.));\n"),
        1, 1e-6);
}

TEST(IfcShapes, HalfSpacesAreTakenAway) {
    // Of a box from x = -2 to 2 what lies beyond x = 1, on the side the flag says.
    const auto clipped = [](const char* flag) {
        return ShapeOf(
            kBox +
            "#22=IFCEXTRUDEDAREASOLID(#20,#14,#13,3.);\n"
            "#100=IFCBOOLEANCLIPPINGRESULT(.DIFFERENCE.,#22,#23);\n"
            "#23=IFCHALFSPACESOLID(#24," +
            flag +
            ");\n#24=IFCPLANE(#25);\n"
            "#25=IFCAXIS2PLACEMENT3D(#26,#11,#12);\n#26=IFCCARTESIANPOINT((1.,0.,0.));\n");
    };
    EXPECT_NEAR(clipped(".T.").at(1), 2, 1e-9);
    EXPECT_NEAR(clipped(".F.").at(1), 6, 1e-9);
    // A roof: what lies above a plane that rises along x.
    const ShapeOf roof(kBox +
                       "#22=IFCEXTRUDEDAREASOLID(#20,#14,#13,3.);\n"
                       "#100=IFCBOOLEANCLIPPINGRESULT(.DIFFERENCE.,#22,#23);\n"
                       "#23=IFCHALFSPACESOLID(#24,.F.);\n#24=IFCPLANE(#25);\n"
                       "#25=IFCAXIS2PLACEMENT3D(#26,#27,$);\n#26=IFCCARTESIANPOINT((0.,0.,1.));\n"
                       "#27=IFCDIRECTION((-1.,0.,1.));\n");
    EXPECT_NEAR(roof.at(0.5), 5, 1e-9);
    EXPECT_NEAR(roof.at(2), 2, 1e-9);
    EXPECT_NEAR(topAbove(roof.shape, 0.5, [] {}), 3, 2e-3);
    std::string lower = roof.bytes;
    lower.replace(lower.find("(0.,0.,1.));\n#27"), 8, "(0.,0.,0");
    const StepFile file(lower, &ampleWork());
    const IfcFrames frames(file);
    const IfcShape low = IfcShapes(frames, ampleWork()).shapeOf(90);
    int paid = 0;
    EXPECT_NEAR(topAbove(low, 0.5, [&] { ++paid; }), 2, 2e-3);
    EXPECT_GT(paid, 5);
    // The same half-space within a boundary of 1 m by 1 m.
    const ShapeOf limited(
        kBox +
        "#22=IFCEXTRUDEDAREASOLID(#20,#14,#13,3.);\n"
        "#100=IFCBOOLEANRESULT(.DIFFERENCE.,#22,#23);\n"
        "#23=IFCPOLYGONALBOUNDEDHALFSPACE(#24,.F.,#14,#28);\n#24=IFCPLANE(#25);\n"
        "#25=IFCAXIS2PLACEMENT3D(#26,#11,#12);\n#26=IFCCARTESIANPOINT((1.,0.,0.));\n"
        "#28=IFCPOLYLINE((#29,#30,#31,#32,#29));\n"
        "#29=IFCCARTESIANPOINT((0.5,0.));\n#30=IFCCARTESIANPOINT((1.5,0.));\n"
        "#31=IFCCARTESIANPOINT((1.5,1.));\n#32=IFCCARTESIANPOINT((0.5,1.));\n");
    EXPECT_NEAR(limited.at(1), 7.5, 1e-9);
}

TEST(IfcShapes, SolidsAreTakenAwayAndAdded) {
    const auto result = [](const char* operation) {
        return ShapeOf(kBox + "#22=IFCEXTRUDEDAREASOLID(#20,#14,#13,3.);\n#100=IFCBOOLEANRESULT(." +
                       operation + ".,#22,#23);\n#23=IFCBLOCK(#14,1.,5.,9.);\n");
    };
    EXPECT_NEAR(result("DIFFERENCE").at(1), 7, 1e-9);
    EXPECT_NEAR(result("UNION").at(1), 8 + 4, 1e-9);
    const ShapeOf shared = result("INTERSECTION");
    EXPECT_NEAR(shared.at(1), 8, 1e-9);
    EXPECT_EQ(shared.shapes.unread().size(), 1U);
}

TEST(IfcShapes, MapsTurnScaleAndMirror) {
    // A triangle of 1 m2, twice as large, turned by a quarter, moved by 5 m.
    const ShapeOf mapped(
        "#100=IFCMAPPEDITEM(#30,#31);\n#30=IFCREPRESENTATIONMAP(#14,#32);\n"
        "#31=IFCCARTESIANTRANSFORMATIONOPERATOR3D(#12,$,#33,2.,#13);\n"
        "#32=IFCSHAPEREPRESENTATION($,'Body','x',(#34));\n#33=IFCCARTESIANPOINT((5.,0.,0.));\n"
        "#34=IFCEXTRUDEDAREASOLID(#35,#14,#13,1.);\n#35=IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,#36);"
        "\n"
        "#36=IFCPOLYLINE((#10,#37,#38,#10));\n#37=IFCCARTESIANPOINT((2.,0.,0.));\n"
        "#38=IFCCARTESIANPOINT((0.,1.,0.));\n");
    EXPECT_NEAR(mapped.at(1.9), 4, 1e-9);
    const auto regions = areaOf(sectionOf(mapped.shape, 1));
    ASSERT_EQ(regions.size(), 1U);
    const Box2 box = bounds(regions[0].outline);
    EXPECT_NEAR(box.low.x, 3, 1e-9);
    EXPECT_NEAR(box.high.x, 5, 1e-9);
    EXPECT_NEAR(box.high.y, 4, 1e-9);
}

TEST(IfcShapes, BrepsAndFaceSets) {
    const std::string points =
        "#40=IFCCARTESIANPOINTLIST3D(((0.,0.,0.),(2.,0.,0.),(2.,1.,0.),(0.,1.,0.),"
        "(0.,0.,3.),(2.,0.,3.),(2.,1.,3.),(0.,1.,3.)));\n";
    const ShapeOf set(points +
                      "#100=IFCPOLYGONALFACESET(#40,.T.,(#41,#42,#43,#44,#45,#46),$);\n"
                      "#41=IFCINDEXEDPOLYGONALFACE((1,4,3,2));\n"
                      "#42=IFCINDEXEDPOLYGONALFACE((5,6,7,8));\n"
                      "#43=IFCINDEXEDPOLYGONALFACE((1,2,6,5));\n"
                      "#44=IFCINDEXEDPOLYGONALFACE((2,3,7,6));\n"
                      "#45=IFCINDEXEDPOLYGONALFACE((3,4,8,7));\n"
                      "#46=IFCINDEXEDPOLYGONALFACE((4,1,5,8));\n");
    EXPECT_NEAR(set.at(1), 2, 1e-9);
    const std::string triangles =
        "((1,3,2),(1,4,3),(5,6,7),(5,7,8),(1,2,6),(1,6,5),(2,3,7),(2,7,6),(3,4,8),(3,8,7),"
        "(4,1,5),(4,5,8))";
    EXPECT_NEAR(
        ShapeOf(points + "#100=IFCTRIANGULATEDFACESET(#40,$,.T.," + triangles + ",$);\n").at(1), 2,
        1e-9);
    const ShapeOf wrong(points + "#100=IFCTRIANGULATEDFACESET(#40,$,.T.,((1,2,9)),$);\n");
    EXPECT_TRUE(wrong.shape.empty());
    EXPECT_EQ(wrong.shapes.unread().size(), 1U);
    // A surface with a rim is a line where it is cut.
    const ShapeOf sheet(
        "#100=IFCSHELLBASEDSURFACEMODEL((#50));\n#50=IFCOPENSHELL((#51));\n"
        "#51=IFCFACE((#52));\n#52=IFCFACEOUTERBOUND(#53,.T.);\n"
        "#53=IFCPOLYLOOP((#10,#54,#55,#56));\n#54=IFCCARTESIANPOINT((3.,0.,0.));\n"
        "#55=IFCCARTESIANPOINT((3.,0.,2.));\n#56=IFCCARTESIANPOINT((0.,0.,2.));\n");
    const BuildingSection cut = sectionOf(sheet.shape, 1);
    EXPECT_TRUE(cut.parts.empty());
    ASSERT_EQ(cut.sheets.size(), 1U);
    EXPECT_NEAR(distance(cut.sheets[0][0], cut.sheets[0][1]), 3, 1e-9);
}

TEST(IfcShapes, RevolvedAndRound) {
    const ShapeOf pipe(
        "#100=IFCREVOLVEDAREASOLID(#20,#14,#21,6.283185307179586);\n"
        "#20=IFCRECTANGLEPROFILEDEF(.AREA.,$,#22,1.,1.);\n#22=IFCAXIS2PLACEMENT2D(#23,$);\n"
        "#23=IFCCARTESIANPOINT((2.,0.));\n#21=IFCAXIS1PLACEMENT(#10,#12);\n");
    // Cut through the axis: two squares.
    EXPECT_NEAR(pipe.at(1e-6), 2, 1e-3);
    const ShapeOf post("#100=IFCRIGHTCIRCULARCYLINDER(#14,3.,0.2);\n");
    const auto box = boxAround(post.shape, {});
    ASSERT_TRUE(box);
    EXPECT_TRUE(box->is_round);
    EXPECT_NEAR(box->length, 0.4, 1e-2);
    EXPECT_FALSE(boxAround(ShapeOf(kUp).shape, {1, 0})->is_round);
}

/// Levels of elements, each of which uses the one below twice: #901 + 2 k is level k.
std::string twice(int levels, const std::function<std::string(int own, int below)>& level) {
    std::string data;
    for (int k = 1; k <= levels; ++k) data += level(901 + 2 * k, 899 + 2 * k);
    return data;
}

std::string reference(int id) { return "#" + std::to_string(id); }

TEST(IfcShapes, ThatDoubleAtEachLevelAreRefusedAtOnce) {
    const std::string up =
        "#20=IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,#963);\n"
        "#100=IFCEXTRUDEDAREASOLID(#20,#14,#13,3.);\n";
    const std::string curves = twice(31, [](int own, int below) {
        return reference(own - 1) + "=IFCCOMPOSITECURVESEGMENT(.CONTINUOUS.,.T.," +
               reference(below) + ");\n" + reference(own) + "=IFCCOMPOSITECURVE((" +
               reference(own - 1) + "," + reference(own - 1) + "),.F.);\n";
    });
    const std::string profiles = twice(31, [](int own, int below) {
        return reference(own) + "=IFCCOMPOSITEPROFILEDEF(.AREA.,$,(" + reference(below) + "," +
               reference(below) + "),$);\n";
    });
    const std::string unions = twice(31, [](int own, int below) {
        return reference(own) + "=IFCBOOLEANRESULT(.UNION.," + reference(below) + "," +
               reference(below) + ");\n";
    });
    for (const std::string& data :
         {"#901=IFCPOLYLINE(());\n" + curves + up, "#901=IFCPOLYLINE((#10,#10));\n" + curves + up,
          "#901=IFCRECTANGLEPROFILEDEF(.AREA.,$,$,4.,2.);\n" + profiles +
              "#100=IFCEXTRUDEDAREASOLID(#963,#14,#13,3.);\n",
          "#901=IFCBLOCK(#14,1.,1.,1.);\n" + unions + "#100=IFCCSGSOLID(#963);\n"}) {
        Budget work(data.size());
        EXPECT_THROW(ShapeOf(data, work), std::runtime_error);
        EXPECT_TRUE(work.isExceeded());
    }
}

TEST(IfcShapes, ElementsThatShareAPointListReadItOnce) {
    std::string data = "#20=IFCCARTESIANPOINTLIST2D(((0.,0.),(4.,0.),(4.,2.)";
    for (int i = 0; i < 10'000; ++i) data += ",(0.,0.)";
    data += "));\n#100=IFCGEOMETRICCURVESET((";
    for (int i = 0; i < 1000; ++i) data += reference(1000 + i) + ",";
    data.back() = ')';
    data += ");\n";
    for (int i = 0; i < 1000; ++i)
        data += reference(1000 + i) + "=IFCINDEXEDPOLYCURVE(#20,(IFCLINEINDEX((1,2,3,1))),$);\n";
    Budget work(data.size());
    EXPECT_EQ(ShapeOf(data, work).shape.size(), 1U);
    EXPECT_LT(work.limit() - work.left(), 100'000U);
}

TEST(IfcShapes, LoopsOfMapsEnd) {
    const ShapeOf loop(
        "#20=IFCREPRESENTATIONMAP(#14,#21);\n"
        "#21=IFCSHAPEREPRESENTATION($,'Body','x',(#100,#100));\n#100=IFCMAPPEDITEM(#20,#22);\n"
        "#22=IFCCARTESIANTRANSFORMATIONOPERATOR3D($,$,#10,$,$);\n");
    EXPECT_TRUE(loop.shape.empty());
    EXPECT_TRUE(loop.shapes.unread().contains("shapes in a loop"));
}

}  // namespace ifc_shapes_test
}  // namespace ispace::ifc
