// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/cad/cad.h"

#include <cmath>
#include <numbers>

#include "extensions/cad/svg.h"
#include "geom/predicates.h"
#include "support/test_import.h"

namespace ispace::cad {
namespace svg_test {

Document read(const std::string& svg, const ImportOptions& options = {}) {
    return readSvg(svg, "plan.svg", options, sceneSchemas());
}
std::string textOf(const std::string& svg, const ImportOptions& options = {}) {
    return writeRecordText(read(svg, options));
}
std::string errorOf(const std::string& svg, const ImportOptions& options = {}) {
    return errorsOf([&] { read(svg, options); });
}
double areaOf(const std::string& svg, const ImportOptions& options = {}) {
    return environmentOf(read(svg, options)).indoor().area();
}

/// A page of 20 m x 10 m, in metres.
std::string page(const std::string& content) {
    return "<svg width=\"20000mm\" height=\"10000mm\" viewBox=\"0 0 20 10\">" + content + "</svg>";
}
std::string path(const std::string& data) { return page("<path d=\"" + data + "\"/>"); }

TEST(Svg, Known) {
    EXPECT_TRUE(isSvg("<svg/>"));
    EXPECT_TRUE(
        isSvg("\n<?xml version=\"1.0\"?>\n<!DOCTYPE svg PUBLIC \"x\">\n<!-- <g> -->\n<svg a='b'>"));
    EXPECT_TRUE(isSvg("<svg:svg xmlns:svg=\"x\">"));
    EXPECT_FALSE(isSvg("<?xml?><COLLADA>"));
    EXPECT_FALSE(isSvg("<html><svg/></html>"));
    EXPECT_FALSE(isSvg("<svgz>"));
    EXPECT_FALSE(isSvg("<!-- <svg>"));
    EXPECT_FALSE(isSvg("svg"));
    EXPECT_FALSE(isSvg(""));
}

TEST(Svg, LowerLeftCornerIsTheOrigin) {
    const std::string svg = page("<polygon points=\"1,2 5,2 5,5 1,5\"/>");
    EXPECT_EQ(textOf(svg), "#env 1\nfence path=1,8;5,8;5,5;1,5 closed=yes\ninside at=3,6.5\n");
    EXPECT_EQ(notesOf(read(svg)),
              "a unit of the drawing is 1000 mm, as its size says\n"
              "layers of walls: (none) (1)\n"
              "kept the largest region, 12.0 m2 in 1 room\n");
}

TEST(Svg, PathCommands) {
    EXPECT_EQ(textOf(path("M1 1H5V4H1Z")),
              "#env 1\nfence path=1,9;5,9;5,6;1,6 closed=yes\ninside at=3,7.5\n");
    for (const char* same :
         {"m1,1h4v3h-4z", "M1 1 5 1 5 4 1 4Z", "m1 1 4 0 0 3-4 0z", "M1 1L5 1l0 3L1 4z",
          "M0 0M1 1H5V4H1Z", "M1e0+1.0H5.V4h-40e-1Z", "M1,1C1 1 5 1 5 1V4H1Z"})
        EXPECT_NEAR(areaOf(path(same)), 12, 1e-9) << same;
    // Behind Z a path goes on where it began.
    EXPECT_NEAR(areaOf(path("M1 1h4v3h-4z h9v8h-9z")), 60, 1e-9);
}

TEST(Svg, Curves) {
    const double pi = std::numbers::pi;
    // Half discs of radius 2, either way about; pieces lie inside by a millimetre at most.
    for (const char* half : {"M2 5A2 2 0 0 1 6 5Z", "M2 5a2 2 0 1 1 4 0z", "M6 5A2,2 0 00 2,5z",
                             "M2 5A1 1 0 0 1 6 5Z"})
        EXPECT_NEAR(areaOf(path(half)), 2 * pi, 0.007) << half;
    EXPECT_NEAR(areaOf(path("M2 5A4 2 90 0 1 6 5Z")), 4 * pi, 0.02);
    EXPECT_NEAR(areaOf(page("<circle cx=\"10\" cy=\"5\" r=\"2\"/>")), 4 * pi, 0.014);
    EXPECT_NEAR(areaOf(page("<ellipse cx=\"10\" cy=\"5\" rx=\"3\" ry=\"1\"/>")), 3 * pi, 0.014);
    EXPECT_NEAR(areaOf(page("<rect x=\"1\" y=\"1\" width=\"6\" height=\"4\" rx=\"1\"/>")),
                24 - (4 - pi), 0.007);
    // A parabola's segment is two thirds of its box; T goes on to the other side of the base.
    EXPECT_NEAR(areaOf(path("M2 5Q4 1 6 5Z")), 2.0 / 3 * 4 * 2, 0.007);
    EXPECT_NEAR(areaOf(path("M2 5Q3 3 4 5T6 5Z")), 2.0 / 3 * 2 * 1, 0.005);
    EXPECT_NEAR(areaOf(path("M2 5C2 2 6 2 6 5S2 8 2 5Z")), 2 * 0.6 * 4 * 3, 0.02);
}

TEST(Svg, CurvesStayWithinAMillimetre) {
    const CubicCurve curve{Point2{0, 0}, Point2{9, 30}, Point2{-5, 12}, Point2{20, 1}};
    Polygon points{curve[0]};
    appendCubic(curve, points);
    double worst = 0;
    for (int i = 0; i <= 5000; ++i) {
        const double t = i / 5000.0, s = 1 - t;
        const double a = s * s * s, b = 3 * s * s * t, c = 3 * s * t * t, d = t * t * t;
        const Point2 p{b * 9 - c * 5 + d * 20, b * 30 + c * 12 + d};
        (void)a;
        double nearest = 1e9;
        for (std::size_t k = 1; k < points.size(); ++k)
            nearest = std::min(nearest, distance(p, Segment2{points[k - 1], points[k]}));
        worst = std::max(worst, nearest);
    }
    EXPECT_LE(worst, kCurveSagitta);
    EXPECT_GT(worst, kCurveSagitta / 20);
}

TEST(Svg, CubicsThatAreArcs) {
    const double k = 0.5522847498;
    const auto center = arcCenter({Point2{1, 0}, Point2{1, k}, Point2{k, 1}, Point2{0, 1}});
    ASSERT_TRUE(center);
    EXPECT_NEAR(center->x, 0, 1e-9);
    EXPECT_NEAR(center->y, 0, 1e-9);
    EXPECT_FALSE(arcCenter({Point2{0, 0}, Point2{1, 0}, Point2{2, 0}, Point2{3, 0}}));
    EXPECT_FALSE(arcCenter({Point2{1, 0}, Point2{1, 1}, Point2{1, 1}, Point2{0, 1}}));
}

TEST(Svg, TransformsNest) {
    EXPECT_EQ(textOf(page("<g transform=\"translate(4,1) scale(2)\"><g transform='rotate(90)'>"
                          "<rect width='3' height='1'/></g></g>")),
              "#env 1\nfence path=4,9;4,3;2,3;2,9 closed=yes\ninside at=3,6\n");
    EXPECT_NEAR(
        areaOf(page("<rect transform='matrix(1 .5 0 2 3 1) skewX(20)' width='2' height='1'/>")), 4,
        1e-4);
    EXPECT_NEAR(
        areaOf(page("<rect transform='rotate(30,10,5)' x='9' y='4' width='3' height='2'/>")), 6,
        1e-4);
    EXPECT_NEAR(areaOf(page("<svg x='2' y='1' width='8' height='4' viewBox='0 0 80 40'>"
                            "<rect width='80' height='40'/></svg>")),
                32, 1e-9);
}

TEST(Svg, Uses) {
    const std::string defs =
        "<defs><rect id='r' width='2' height='1'/><symbol id='s' viewBox='0 0 4 2'>"
        "<rect width='4' height='2'/></symbol></defs>";
    EXPECT_EQ(textOf(page(defs + "<use href='#r' x='3' y='4'/>")),
              "#env 1\nfence path=3,6;5,6;5,5;3,5 closed=yes\ninside at=4,5.5\n");
    EXPECT_EQ(textOf(page(defs + "<use xlink:href='#s' x='3' y='4' width='8' height='4'/>")),
              "#env 1\nfence path=3,6;11,6;11,2;3,2 closed=yes\ninside at=7,4\n");
    EXPECT_NE(notesOf(read(page(defs + "<use href='#r'/><use href='#none'/>")))
                  .find("left out: uses of what the file lacks (1)"),
              std::string::npos);
}

TEST(Svg, Scale) {
    const std::string room = "<rect width='4' height='3'/></svg>";
    EXPECT_NEAR(areaOf("<svg width='1000mm' height='100cm' viewBox='0 0 1 1'>" + room), 12, 1e-9);
    EXPECT_NEAR(areaOf("<svg width='40in' viewBox='0 0 1 1'>" + room), 12 * 1.016 * 1.016, 1e-5);
    EXPECT_NEAR(areaOf("<svg width='720pt' height='60pc' viewBox='0 0 1 1'>" + room),
                12 * 0.254 * 0.254, 1e-6);
    EXPECT_NEAR(areaOf("<svg width='1000px' height='1000mm' viewBox='0 0 1 1'>" + room), 12, 1e-9)
        << "paper wins over pixels";
    // Both directions count where the drawing is stretched.
    EXPECT_NEAR(areaOf("<svg width='1000mm' height='2000mm' viewBox='0 0 1 1' "
                       "preserveAspectRatio='none'>" +
                       room),
                24, 1e-9);
    EXPECT_NEAR(areaOf(page("<svg width='8' height='8' viewBox='0 0 4 8' "
                            "preserveAspectRatio='none'><rect width='4' height='3'/></svg>")),
                24, 1e-9);
    ImportOptions options;
    options.units = "foot";
    EXPECT_NEAR(areaOf("<svg width='1mm' height='1mm' viewBox='0 0 9 9'>" + room, options),
                12 * 0.3048 * 0.3048, 1e-5);
    EXPECT_NEAR(areaOf("<svg>" + room, options), 12 * 0.3048 * 0.3048, 1e-5);
}

TEST(Svg, WithoutAScale) {
    const std::string room = "<rect width='400' height='300'/></svg>";
    const std::string hint =
        "; most likely is cm, in which the plan is 4.0 m wide, then inch, in which the plan is "
        "10.2 m wide, then m, in which the plan is 400.0 m wide: say its unit, for example with "
        "--units cm, or how wide it is, with --width-is 4.00\n";
    const std::string begin =
        "plan.svg:1:1: error: `svg`: the drawing has no scale, as its size is ";
    for (const char* size :
         {"", "width='100%'", "viewBox='0 0 9 9'", "width='100%' viewBox='0 0 9 9'"})
        EXPECT_EQ(errorOf("<svg " + std::string(size) + ">" + room), begin + "not said" + hint)
            << size;
    for (const char* size : {"width='800'", "width='100%' height='800px'"})
        EXPECT_EQ(errorOf("<svg " + std::string(size) + ">" + room), begin + "in pixels" + hint)
            << size;
    ImportOptions options;
    options.width_is = 8;
    EXPECT_NEAR(areaOf("<svg width='800'>" + room, options), 8 * 6, 1e-5);
    EXPECT_EQ(errorOf("<svg width='800'><path d='M1 1V9'/></svg>", options),
              "plan.svg: error: the lines of walls have no width: --width-is needs some\n");
    options.wall_layers = {"Wals"};
    EXPECT_EQ(errorOf("<svg><g id='Walls'><path d='M1 1H9'/></g></svg>", options),
              "plan.svg: error: no line on the layers of walls; layers with lines: Walls (1)\n");
    options.wall_layers.clear();
    // Curves are measured at the scale they come to: a disc 8 m wide.
    EXPECT_NEAR(areaOf("<svg><circle r='2'/></svg>", options), 16 * std::numbers::pi, 0.02);
}

TEST(Svg, DashedLinesCloseNoRoom) {
    const auto area_with = [](const std::string& style) {
        return areaOf(
            "<svg width='1000cm' viewBox='0 0 10 10'><rect x='1' y='1' width='8' height='8' "
            "fill='none' stroke='black'/><path d='M4 1V9' fill='none' stroke='black' " +
            style + "/></svg>");
    };
    EXPECT_NEAR(area_with("stroke-dasharray='1,2'"), 64, 1e-9);
    EXPECT_NEAR(area_with("style='stroke-dasharray:0.5 0.2'"), 64, 1e-9);
    EXPECT_NEAR(area_with("stroke-dasharray='none'"), 40, 1e-9);
    EXPECT_NEAR(area_with("stroke-dasharray='0 0'"), 40, 1e-9);
    EXPECT_NEAR(area_with("id='walls' stroke-dasharray='1 2'"), 40, 1e-9);
}

// Each element is compared with all names of a list.
TEST(Svg, SelectorsWithLongListsCost) {
    std::string list;
    for (int k = 0; k < 4000; ++k) list += (k == 0 ? ".c" : ",.c") + std::to_string(k);
    std::string svg = "<svg width='1000cm' viewBox='0 0 10 10'><style>:not(" + list +
                      "){stroke:red}</style><rect x='1' y='1' width='8' height='8'/>";
    for (int k = 0; k < 400; ++k) svg += "<g/>";
    svg += "</svg>";
    EXPECT_NEAR(areaOf(svg), 64, 1e-9);
    ImportOptions options;
    options.max_work.max = 50'000;
    EXPECT_NE(errorOf(svg, options).find("uses and curves of the drawing make more than 50000 "),
              std::string::npos);
}

TEST(Svg, MasksOnLayersOfOtherThingsAreNoWalls) {
    const auto warnings = [](const std::string& layer) {
        return warningsOf(
            readSvg("<svg width='1000cm' viewBox='0 0 10 10'><mask id='m'/>"
                    "<rect x='1' y='1' width='8' height='8' fill='none'/><g id='" +
                        layer + "' mask='url(#m)'><path d='M2 2H4V5'/></g></svg>",
                    "plan.svg", {}, sceneSchemas()));
    };
    EXPECT_NE(warnings("Layer1").find("element with a mask (1), on the layer Layer1"),
              std::string::npos)
        << warnings("Layer1");
    EXPECT_EQ(warnings("Furniture").find("not read"), std::string::npos) << warnings("Furniture");
}

TEST(Svg, OfNoBuildingsSize) {
    const std::string paper = "<svg width='200mm' viewBox='0 0 10 10'>";
    const std::string room = "<rect width='8' height='5'/></svg>";
    EXPECT_EQ(
        errorOf(paper + room),
        "plan.svg: error: the plan is 0.16 m wide: is its unit right? It is read in units of "
        "20 mm; most likely is 1:50, in which the plan is 8.0 m wide, then 1:100, in which the "
        "plan is 16.0 m wide, then 1:200, in which the plan is 32.0 m wide: say how wide it is, "
        "for example with --width-is 8.00\n");
    EXPECT_EQ(errorOf("<svg width='900cm' viewBox='0 0 1 1'><rect width='400' height='400'/></svg>")
                  .find("plan.svg: error: the plan is 3600 m wide: is its unit right?"),
              0U);
    EXPECT_NE(
        errorOf("<svg width='60mm' viewBox='0 0 600 400'><rect width='400' height='300'/></svg>")
            .find("It is read in units of 0.1 mm; "),
        std::string::npos);
    ImportOptions options;
    options.units = "cm";
    EXPECT_NEAR(areaOf(paper + room, options), 0.004, 1e-9) << "said, it is believed";
}

TEST(Svg, NamesOfWalls) {
    // A room of 8 m x 4 m, and a cupboard that parts it.
    const std::string walls = "<path d='M0 0H8V4H0Z'/>", rest = "<path d='M5 0V4'/>";
    const auto warned = [](const std::string& svg) { return warningsOf(read(page(svg))); };
    const auto noted = [](const std::string& svg) { return notesOf(read(page(svg))); };
    EXPECT_NE(noted("<g id='plan'><g id='Walls'>" + walls + "</g>" + rest + "</g>")
                  .find("only lines named as walls are taken, the others clutter or frame their "
                        "room: --wall-layer Walls; --wall-layer '*' takes all\n"),
              std::string::npos);
    EXPECT_NE(noted("<g id='g1' inkscape:label='W\u00c4NDE 1'>" + walls + "</g>" + rest)
                  .find("--wall-layer 'W\u00c4NDE 1';"),
              std::string::npos);
    EXPECT_EQ(warned("<g id='Walls'>" + walls + rest + "</g>"), "") << "all are";
    EXPECT_EQ(warned("<g id='Walls'>" + walls + "</g><path d='M1 1H2'/>"), "") << "the same room";
    EXPECT_EQ(warned("<g id='wallpaper'>" + walls + "</g>" + rest), "");
}

TEST(Svg, Layers) {
    const std::string svg = page(
        "<g id='a' inkscape:groupmode='layer' inkscape:label='Walls'><g id='g1'><rect width='4' "
        "height='3'/></g></g>"
        "<g id='Furniture'><g id='g2'><path d='M1 0V3'/></g></g><rect id='odd' x='8' width='9' "
        "height='9'/>");
    EXPECT_NE(notesOf(read(svg)).find("layers of walls: (none) (1), Walls (1)\n"),
              std::string::npos);
    ImportOptions options;
    for (const char* glob : {"walls", "a", "g1"}) {
        options.wall_layers = {glob};
        EXPECT_NEAR(areaOf(svg, options), 12, 1e-9) << glob;
    }
    options.wall_layers = {"odd"};
    EXPECT_NEAR(areaOf(svg, options), 81, 1e-9);
    options.wall_layers = {"none of them"};
    EXPECT_EQ(errorOf(svg, options),
              "plan.svg: error: no line on the layers of walls; layers with lines: (none) (1), "
              "Furniture (1), Walls (1)\n");
}

TEST(Svg, DoorsSwing) {
    ImportOptions options;
    options.wall_layers = {"W"};
    options.door_layers = {"D"};
    const std::string walls = "<g id='W'><path d='M0 0H8V4H0ZM4 0V1M4 2V4'/></g><g id='D'>";
    for (const char* leaf :
         {"<path d='M4 2A1 1 0 0 1 3 1'/>", "<path d='M4 2C3.4477 2 3 1.5523 3 1'/>",
          "<line x1='4' y1='1' x2='4' y2='2'/>"}) {
        const Document document = read(page(walls + leaf + "</g>"), options);
        EXPECT_EQ(countOf(document, "door"), 1U) << leaf;
        EXPECT_NEAR(environmentOf(document).indoor().area(), 32, 1e-6) << leaf;
    }
}

TEST(Svg, LeavesOutWhatShowsNothing) {
    const std::string room = "<rect x='1' y='1' width='4' height='3'/>";
    for (const char* nothing :
         {"<rect width='20' height='10' fill='white'/>", "<rect width='100%' height='100%'/>",
          "<rect width='9' height='9' style='display:none'/>",
          "<g display='none'><rect width='9' height='9'/></g>",
          "<g visibility='hidden'><rect width='9' height='9'/></g>",
          "<rect width='9' height='9' style=' stroke : none; fill:none'/>",
          "<defs><rect width='9' height='9'/></defs>",
          "<clipPath><rect width='9' height='9'/></clipPath>", "<text x='1'>a</text>",
          "<rect width='0' height='9'/>", "<path d=''/>", "<path d='M9 9'/>", "<circle r='0'/>",
          "<polyline points='3,4'/>"})
        EXPECT_EQ(textOf(page(nothing + room)),
                  "#env 1\nfence path=1,9;5,9;5,6;1,6 closed=yes\ninside at=3,7.5\n")
            << nothing;
    const std::string css =
        "<style>/* .a{display:none} */ .b, g.c{fill:none;stroke : none} .d{display:none}"
        "#e{visibility:hidden}.f{display:none}.f{display:inline}ellipse{display:none}</style>";
    for (const char* hidden :
         {"<rect class='b' width='9' height='9'/>",
          "<g class='x d'><rect width='9' height='9'/></g>", "<rect id='e' width='9' height='9'/>",
          "<ellipse cx='9' cy='5' rx='4' ry='4'/>"})
        EXPECT_NEAR(areaOf(page(css + hidden + room)), 12, 1e-9) << hidden;
    for (const char* shown :
         {"<rect class='a' width='9' height='9'/>", "<rect class='f' width='9' height='9'/>",
          "<rect class='b' style='stroke:red' width='9' height='9'/>",
          "<g class='d' style='display:inline'><rect width='9' height='9'/></g>"})
        EXPECT_NEAR(areaOf(page(css + shown)), 81, 1e-9) << shown;
    // A frame is drawn.
    EXPECT_NEAR(areaOf(page("<rect width='20' height='10' stroke='black'/>")), 200, 1e-9);
}

TEST(Svg, RefusesWithLine) {
    const auto in_line_2 = [](const std::string& element) { return errorOf(page("\n" + element)); };
    EXPECT_EQ(in_line_2("<path d='M1 1 L2 x'/>"),
              "plan.svg:2:1: error: `path`: found `x`, wanted a number\n");
    EXPECT_EQ(in_line_2("<path d='L2 2'/>"),
              "plan.svg:2:1: error: `path`: it does not begin with M\n");
    EXPECT_EQ(in_line_2("<path d='M1 1 B2'/>"),
              "plan.svg:2:1: error: `path`: unknown command `B`\n");
    EXPECT_EQ(in_line_2("<path d='M1 1 A1 1 0 2 0 3 3'/>"),
              "plan.svg:2:1: error: `path`: found `2 0 3 3`, wanted a flag, 0 or 1\n");
    EXPECT_EQ(in_line_2("<path d='M1 1 C1 2 3'/>"),
              "plan.svg:2:1: error: `path`: it ends early, wanted a number\n");
    EXPECT_EQ(in_line_2("<g transform='spin(3)'/>"),
              "plan.svg:2:1: error: `g`: unknown transform `spin`\n");
    EXPECT_EQ(in_line_2("<rect width='x' height='1'/>").find("plan.svg:2:1: error: `rect`: "), 0U);
    EXPECT_EQ(in_line_2("<rect width='-1' height='1'/>"),
              "plan.svg:2:1: error: `rect`: width is -1\n");
    EXPECT_EQ(in_line_2("<polyline points='1,2 3'/>"),
              "plan.svg:2:1: error: `polyline`: points: a number is missing\n");
    EXPECT_NE(in_line_2("<path d='M0 0H1e9'/>").find("more than 900 km"), std::string::npos);
    EXPECT_NE(in_line_2("<path d='M0 0H1e300'/>").find("wanted a number"), std::string::npos);
    EXPECT_EQ(errorOf("<svg>\n<g>\n</svg>").find("plan.svg:3:1: error: bad XML: "), 0U);
    EXPECT_NE(errorOf(page("")).find("no line to make a wall of"), std::string::npos);
    EXPECT_NE(errorOf("<svg viewBox='0 0 0 9'/>").find("viewBox: wanted"), std::string::npos);
}

TEST(Svg, BombsAndNests) {
    EXPECT_NE(errorOf(page("<g id='a'><use href='#a'/></g>")).find("does one use itself?"),
              std::string::npos);
    std::string deep, bomb = "<defs><rect id='x0' width='1' height='1'/>";
    for (int i = 0; i < 100'000; ++i) deep += "<g>";
    EXPECT_NE(errorOf("<svg width='1' height='1'>" + deep).find("bad XML"), std::string::npos);
    for (int i = 0; i < 100'000; ++i) deep += "</g>";
    EXPECT_NE(errorOf(page(deep)).find("nested more than 200 deep"), std::string::npos);
    for (int i = 1; i < 12; ++i) {
        const std::string use = "<use href='#x" + std::to_string(i - 1) + "'/>";
        bomb += "<g id='x";
        bomb += std::to_string(i) + "'>";
        for (int k = 0; k < 10; ++k) bomb += use;
        bomb += "</g>";
    }
    EXPECT_NE(errorOf(page(bomb + "</defs><use href='#x11'/>"))
                  .find("uses and curves of the drawing make more"),
              std::string::npos);
    // Entities of the document's own are not expanded.
    EXPECT_NE(errorOf("<!DOCTYPE svg [<!ENTITY a 'M0 0H9V9Z'>]><svg width='9mm' height='9mm'><path "
                      "d='&a;'/></svg>")
                  .find("`path`"),
              std::string::npos);
}

TEST(Svg, SurvivesDamage) {
    surviveDamage(
        "<svg width='9m' height='9mm' viewBox='0 0 9 "
        "9'>\n<style>.a,#r{fill:none}/*c*/</style>\n<defs><rect id='r' rx='.1' width='2' "
        "height='1'/></defs>\n"
        "<g transform='scale(2)rotate(3 4 5)' inkscape:label='W'>\n<path d='M1 1h4v3A2 1 9 0 1 1 "
        "4C1 2 3 4 5 6Q1 2 3 4T1 1z'/>\n"
        "<use href='#r' x='1'/><polygon points='1,2 3,4 5,1'/><circle r='.5'/></g></svg>\n",
        [](const std::string& bytes) {
            ImportOptions options;
            options.units = "m";
            options.max_work.max = 2000;
            read(bytes, options);
        });
}

/// The floor of a room of 8 x 6 m with more elements.
double areaWith(const std::string& more) {
    const std::string svg =
        "<svg xmlns='http://www.w3.org/2000/svg' width='10000mm' height='10000mm' viewBox='0 0 10 "
        "10'>"
        "<rect x='1' y='1' width='8' height='6'/>" +
        more + "</svg>";
    return environmentOf(readSvg(svg, "plan.svg", {}, sceneSchemas())).indoor().area();
}

TEST(SvgCss, AsBrowsersApplyIt) {
    const std::string line = " d='M5 1v6'/>";
    for (const std::string hidden : {
             "<style>svg .q{display:none}</style><path class='q'",
             "<style>.a.b{display:none}</style><path class='a b'",
             "<style>path[id='p']{display:none}</style><path id='p'",
             "<style>style + path{display:none}</style><path",
             "<style>rect ~ path{display:none}</style><path",
             "<style>:root > path{display:none}</style><path",
             "<style>@media screen{path{display:none}}</style><path",
             "<style>.a{display:none!important} #p{display:inline}</style><path id='p' class='a'",
             "<style>.a{display:none !important}</style><path style='display:inline' class='a'",
             "<style>.b{display:inline} .a{display:none}</style><path class='a b'",
             "<style>.b{display:inline} .a{display:none}</style><path class=' b\ta  b a '",
             "<style>#p{display:none} path.a{display:inline}</style><path id='p' class='a'",
             "<path style='display:none!important'",
             "<path opacity='0'",
             "<path style='opacity:0%'",
             "<path fill='none' stroke='#000' stroke-opacity='0'",
             "<path style='fill-opacity:0;stroke:none'",
         })
        EXPECT_NEAR(areaWith(hidden + line), 48, 1e-9) << hidden;
    for (const std::string shown : {
             "<style>g path{display:none}</style><path",
             "<style>path > path{display:none}</style><path",
             "<style>@media print{path{display:none}}</style><path",
             "<style>.a.b{display:none}</style><path class='a'",
             "<style>#p{display:inline} .a{display:none}</style><path id='p' class='a'",
             "<style>.a{display:none}</style><path style='display:inline' class='a'",
             "<path opacity='0.5'",
             "<path style='display:none!x'",
         })
        EXPECT_NEAR(areaWith(shown + line), 24, 1e-9) << shown;
}

TEST(SvgCss, PseudoClassesAndConditions) {
    const std::string line = " d='M5 1v6'/>";
    for (const std::string hidden : {
             "<style>path:not(.w){display:none}</style><path",
             "<style>path:not(.w, #b){display:none}</style><path",
             "<style>:is(path, line){display:none}</style><path",
             "<style>:where(g, path){display:none}</style><path",
             "<style>g > path:first-child{display:none}</style><g><path class='a' "
             "d=''/></g><g><path",
             "<style>path:last-child{display:none}</style><path",
             "<style>@supports (display: grid){path{display:none}}</style><path",
         }) {
        const bool is_open = hidden.ends_with("<g><path");
        EXPECT_NEAR(areaWith(hidden + line + (is_open ? "</g>" : "")), 48, 1e-9) << hidden;
    }
    for (const std::string shown : {
             "<style>path:hover{display:none}</style><path",
             "<style>path::before{display:none}</style><path",
             "<style>path:not(.a){display:none}</style><path class='a'",
             "<style>@supports not (display: grid){p{display:none}}</style><path",
             "<style>:where(#p){display:inline} path{display:none}"
             "path:is(#p){display:inline}</style><path id='p'",
         })
        EXPECT_NEAR(areaWith(shown + line), 24, 1e-9) << shown;
}

TEST(SvgCss, WhatIsNotReadWarns) {
    const auto warnings = [](const std::string& body, const std::string& prolog = "") {
        return warningsOf(readSvg(prolog + page("<rect x='1' y='1' width='8' height='6'/>" + body),
                                  "plan.svg", {}, sceneSchemas()));
    };
    const std::string line = "<path d='M5 1v6'/>";
    for (const auto& [body, kind] :
         {std::pair{"<style>g { path{display:none} }</style>", "the CSS rule `g { … }`"},
          {"<style>:root{--d:none} path{display:var(--d)}</style>", "`path { var() }`"},
          {"<style>@layer a{path{display:none}}</style>", "`@layer a`"},
          {"<use href='other.svg#wall'/>", "use of `other.svg#wall`"},
          {"<g mask='url(#m)'><path d='M5 1v6'/></g>", "element with a mask"},
          {"<g style='clip-path:circle(3px)'><path d='M5 1v6'/></g>",
           "element with a clip-path that is not read"}})
        EXPECT_NE(warnings(body).find(kind), std::string::npos) << body << warnings(body);
    EXPECT_NE(warnings("", "<?xml-stylesheet href='a.css'?>").find("the file of a style sheet"),
              std::string::npos);
    EXPECT_EQ(warnings("<g mask='url(#m)'><path d='M15 1v6'/></g>"), "");  // off the room
    EXPECT_EQ(warnings("<style>path:hover{fill:red} @font-face{font-family:a}</style>"), "");
}

TEST(Svg, StrokesAsWideAsWallsAreTheirThickness) {
    const auto thick = [](const std::string& more) {
        const std::string text =
            textOf(page("<g " + more + "><rect x='1' y='1' width='8' height='6'/></g>"));
        return text.find("thickness=0.2") != std::string::npos;
    };
    EXPECT_TRUE(thick("fill='none' stroke='#000' stroke-width='0.2'"));
    EXPECT_TRUE(thick("style='fill:none;stroke:#000;stroke-width:.2'"));
    EXPECT_TRUE(thick("fill='none' stroke='#000' stroke-width='0.1' transform='scale(2)'"));
    EXPECT_FALSE(thick("stroke='#000' stroke-width='0.2'"));  // filled: a face of the wall
    EXPECT_FALSE(thick("fill='none' stroke='#000' transform='scale(.2)'"));  // the usual width
    EXPECT_FALSE(thick("fill='none' stroke='#000' stroke-width='0.01'"));
    EXPECT_FALSE(thick("fill='none' stroke='#000' stroke-width='2'"));
    EXPECT_EQ(textOf(page("<rect fill='none' stroke='#000' stroke-width='.2' "
                          "vector-effect='non-scaling-stroke' x='1' y='1' width='8' height='6'/>"))
                  .find("thickness"),
              std::string::npos);
}

TEST(Svg, LinesThatShowNothing) {
    for (const char* hidden : {"stroke='rgba(0,0,0,0)'", "stroke='#00000000'", "stroke='#0000'",
                               "stroke='hsl(0 0% 0% / 0%)'", "stroke='#000' stroke-width='0'"})
        EXPECT_NEAR(areaOf(page("<rect x='1' y='1' width='8' height='6'/><path fill='none' d='M5 "
                                "1v6' " +
                                std::string(hidden) + "/>")),
                    48, 1e-9)
            << hidden;
}

TEST(Svg, ClipsCutLines) {
    const std::string room = "<rect x='1' y='1' width='8' height='6'/>";
    const auto with = [&](const std::string& clip, const std::string& body) {
        return areaOf(page(room + "<clipPath id='c'>" + clip + "</clipPath>" + body));
    };
    const std::string line = "<g clip-path='url(#c)'><path d='M5 1v6'/></g>";
    EXPECT_NEAR(with("<rect width='4' height='10'/>", line), 48, 1e-9);
    EXPECT_NEAR(with("<rect width='14' height='10'/>", line), 24, 1e-9);
    EXPECT_NEAR(with("", line), 48, 1e-9);
    // A triangle shows the lower half of the line.
    EXPECT_NEAR(with("<path d='M0 0L10 0L10 8Z'/>", line), 48, 1e-9);
    // Of a larger rectangle the part within remains: two sides of an inner room.
    EXPECT_NEAR(with("<rect x='1' y='1' width='8' height='6'/>",
                     "<rect clip-path='url(#c)' fill='none' stroke='#000' x='5' y='-5' width='20' "
                     "height='20'/>"),
                24, 1e-9);
    // The union of shapes, each by its own rule; hidden ones do not count.
    const std::string all = "<rect width='14' height='10'/>";
    EXPECT_NEAR(with(all + "<rect width='9' height='9'/>", line), 24, 1e-9);
    EXPECT_NEAR(with(all + "<rect width='14' height='10' display='none'/>", line), 24, 1e-9);
    EXPECT_NEAR(with("<rect width='5' height='10'/><rect x='5' width='5' height='10'/>", line), 24,
                1e-9);
    const std::string rings = "d='M0 0h10v10h-10zM4 0h2v10h-2z'/>";
    EXPECT_NEAR(with("<path " + rings, line), 24, 1e-9);
    EXPECT_NEAR(with("<path clip-rule='evenodd' " + rings, line), 48, 1e-9);
    EXPECT_NEAR(with("<path style='fill:none; clip-rule : evenodd' " + rings, line), 48, 1e-9);
    EXPECT_NEAR(with("<style>#c{clip-rule:evenodd}</style><path " + rings, line), 48, 1e-9);
}

TEST(Svg, SharesOfTheViewport) {
    const auto area = [](const std::string& body) { return areaOf(page(body)); };
    EXPECT_NEAR(area("<rect x='10%' y='10%' width='50%' height='60%'/>"), 60, 1e-9);
    EXPECT_NEAR(area("<svg x='50%' width='50%' height='100%'><rect x='10%' y='10%' width='50%' "
                     "height='50%'/></svg>"),
                25, 1e-9);
    EXPECT_NEAR(area("<svg x='1' y='1' width='5' height='4' viewBox='0 0 50 40'><svg width='100%' "
                     "height='100%' viewBox='0 0 500 400'><rect width='500' height='400'/></svg>"
                     "</svg>"),
                20, 1e-9);
    EXPECT_NEAR(area("<rect x='1' y='1' width='8' height='6'/><path d='M6 4h8' "
                     "style='transform:rotate(90deg);transform-origin:50% 40%'/>"),
                48, 1e-9);
    EXPECT_NEAR(area("<rect x='6' y='1' width='8' height='6'/><path d='M7 4h6' "
                     "style='transform:rotate(90deg);transform-origin:50% 40%'/>"),
                24, 1e-9);
}

TEST(Svg, SwitchesShowOneChild) {
    EXPECT_NEAR(areaOf(page("<rect x='1' y='1' width='8' height='6'/><switch>"
                            "<g systemLanguage='de'><path d='M5 1v6'/></g>"
                            "<g><path d='M3 1v6'/></g><g><path d='M7 1v6'/></g></switch>")),
                36, 1e-9);
    EXPECT_NEAR(areaOf(page("<rect x='1' y='1' width='8' height='6'/><switch>"
                            "<g systemLanguage='de, en'><path d='M5 1v6'/></g>"
                            "<g><path d='M3 1v6'/></g></switch>")),
                24, 1e-9);
}

TEST(SvgCss, UnreadSelectorsWarn) {
    const std::string svg =
        "<svg xmlns='http://www.w3.org/2000/svg' width='10000mm' height='10000mm' viewBox='0 0 10 "
        "10'>"
        "<style>path:nth-child(2){display:none}</style><rect x='1' y='1' width='8' "
        "height='6'/></svg>";
    const Document document = readSvg(svg, "plan.svg", {}, sceneSchemas());
    EXPECT_NE(warningsOf(document).find("the CSS rule `path:nth-child(2)`"), std::string::npos);
}

TEST(SvgCss, Transforms) {
    // A quarter turn about 5,4 of a line that lies level.
    EXPECT_NEAR(areaWith("<path style='transform:rotate(90deg);transform-origin:5px 4px' "
                         "d='M2 4h6'/>"),
                24, 1e-9);
    EXPECT_NEAR(areaWith("<path transform='rotate(90)' transform-origin='5 4' d='M2 4h6'/>"), 24,
                1e-9);
    EXPECT_NEAR(areaWith("<svg width='100%' height='100%' viewBox='0 0 20 20'>"
                         "<path d='M10 2v12'/></svg>"),
                24, 1e-9);
}

}  // namespace svg_test
}  // namespace ispace::cad
