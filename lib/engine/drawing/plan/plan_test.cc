// SPDX-License-Identifier: GPL-3.0-or-later
#include "drawing/plan/plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "base/number.h"
#include "drawing/drawing.h"
#include "support/test_layout.h"

namespace ispace {
namespace plan_test {

using ispace::testing::scene;

const char* const kRoom =
    "fence id=outer path=0,0;8,0;8,6;3,6;3,5;0,5 closed=yes thickness=0.2\n"
    "wall id=thin from=3,5 to=3,3.6\ninside at=1,1\n"
    "zone id=a/b at=6.5,1.2 size=2.4,2\nfloor id=carpet at=2,3.2 size=2.5,2 kind=checker\n"
    "desk id=d1 at=1.2,4.4\ndesk id=2d at=6.4,0.6 kind=closed\ntable id=t1 at=4.2,4.6\n"
    "laser id=l1 at=0.3,0.4 heading=45 fov=90\ncamera id=c1 at=4,3,2.4 tilt=-90\n"
    "tag id=tag1 at=2,2.4\nmat id=m1 at=1.2,0.8 size=0.8,0.6\ngate id=g1 at=2.2,1\n"
    "robot id=r1 at=4,2 heading=30 path=4,1;3.5,0.5\nhuman id=h1 at=2.4,4 heading=200\n";

std::string picture(const std::string& room, const PlanOptions& options = {}) {
    return drawPlan(scene(room), options);
}

std::string svg(const std::string& room, const std::string& title = "",
                std::optional<double> slice = {}) {
    PlanOptions options;
    options.format = PictureFormat::Svg;
    options.title = title;
    options.slice = slice;
    return picture(room, options);
}

std::uint32_t pixelOf(Color color) {
    const auto part = [](double share) {
        return static_cast<std::uint32_t>(std::lround(share * 255));
    };
    return part(color.red) << 16 | part(color.green) << 8 | part(color.blue);
}

/// Where the plan lies on the page, as drawPlan lays it out.
struct Found {
    Image image;
    double left, top, scale;

    explicit Found(const std::string& room, double metres_wide, const PlanOptions& options = {})
        : image(decodePng(picture(room, options))) {
        const double em = std::max(9.0, image.width / 1200.0 * 15);
        left = 3.4 * em;
        top = 1.4 * em;
        scale = (image.width - 5 * em) / metres_wide;
    }
    /// Metres from the upper left corner of the plan.
    [[nodiscard]] std::uint32_t at(double right, double down) const {
        return image.at(static_cast<int>(left + right * scale),
                        static_cast<int>(top + down * scale));
    }
};

TEST(PlanPng, ShowsWallsFloorAndThingsWhereTheyAre) {
    const Found plan(
        "ispace size=8,8\nwall from=0.5,0.52 to=3,0.52 thickness=0.2\n"
        "cube id=x at=-2.5,2.5 size=1,1,1\n",
        8);
    EXPECT_EQ(plan.image.width, 1200);
    EXPECT_EQ(plan.at(5.3, 2.3), pixelOf(palette::kFloor));
    EXPECT_EQ(plan.at(5.3, 4 - 0.55), pixelOf(palette::kWall));
    const Color box = mixed(displayColor(Material::Box), palette::kWhite, 0.3);
    EXPECT_EQ(plan.at(1.2, 1.7), pixelOf(box));
    EXPECT_EQ(plan.at(0.8, 1.5), pixelOf(palette::kFloor));
    EXPECT_EQ(plan.image.at(4, 4), 0xFFFFFFU);
}

TEST(PlanPng, HigherThingsLieOnTop) {
    // Whatever the order of the records.
    const Found plan(
        "ispace size=8,8\ncube at=0.5,0.5 size=2,2,1\nfloor at=0.5,0.5 size=4,4\n"
        "cylinder at=0.5,0.5 size=3,3 height=0.5\n",
        8);
    EXPECT_EQ(plan.at(4.75, 3.75),
              pixelOf(mixed(displayColor(Material::Box), palette::kWhite, 0.3)));
    const Found covering("ispace size=8,8\nfloor at=0.5,0.5 size=4,4\n", 8);
    const Color light = mixed(displayColor(Material::Floor), palette::kWhite, 0.45);
    EXPECT_NEAR((covering.at(4.75, 3.25) & 0xFFU), light.blue * 255, 1);
}

TEST(PlanPng, SliceShowsWhatStandsAtTheHeight) {
    PlanOptions options;
    options.slice = 0.3;
    const std::string room = "ispace size=8,8\ndesk at=0.5,0.5 size=2,2\n";
    const Found low(room, 8, options);
    EXPECT_EQ(low.at(4.7, 3.3), 0xFFFFFFU);
    options.slice = 0.69;
    const Found high(room, 8, options);
    EXPECT_EQ(high.at(4.7, 3.3), pixelOf(palette::kSolidEdge));
}

TEST(PlanPng, KeepsTheWidthThatIsAskedForAtAnyAspect) {
    for (const std::string size : {"50,1", "1,50", "5,5", "0.01,0.01", "9000,7000"}) {
        for (const int width : {200, 1200}) {
            PlanOptions options;
            options.width = width;
            options.title = "a room";
            const Image image =
                decodePng(picture("ispace size=" + size + "\nlaser at=0,0\n", options));
            EXPECT_EQ(image.width, width);
            EXPECT_LT(image.height, 3 * width) << size;
            EXPECT_GT(image.height, width / 8) << size;
        }
    }
}

TEST(Plan, RefusesWhatItCannotDraw) {
    PlanOptions options;
    options.width = 100;
    EXPECT_THROW(picture("ispace", options), UsageError);
    options.width = 1'000'000;
    EXPECT_THROW(picture("ispace", options), UsageError);
}

TEST(Plan, EqualScenesGiveEqualBytes) {
    for (const PictureFormat format :
         {PictureFormat::Png, PictureFormat::Svg, PictureFormat::Pdf}) {
        PlanOptions options;
        options.format = format;
        options.title = "room.env";
        const std::string first = picture(kRoom, options);
        EXPECT_GT(first.size(), 5000U);
        EXPECT_TRUE(first == picture(kRoom, options));
    }
}

TEST(Plan, FarThingsDoNotShrinkTheRoom) {
    const Scene room = scene("ispace size=8,6\ncube at=500,0 size=1,1,1\nlaser at=1e5,0\n");
    const Box2 box = planBox(room);
    EXPECT_EQ(box, (Box2{{-4, -3}, {4, 3}}));
    EXPECT_EQ(planBox(scene("ispace size=8,6\ncube at=4,0 size=1,1,1\n")),
              (Box2{{-4, -3}, {4.5, 3}}));
    EXPECT_EQ(decodePng(drawPlan(room, {})).width, 1200);
}

TEST(Plan, SmallRoomsFarOutAndManySensorsTakeNoTime) {
    const std::string far =
        "fence path=900000,900000;900000.001,900000;900000,900000.001 closed=yes\n";
    for (const PictureFormat format : {PictureFormat::Png, PictureFormat::Svg}) {
        PlanOptions options;
        options.format = format;
        EXPECT_FALSE(picture(far, options).empty());
    }
    std::string many = "ispace size=20,20\n";
    for (int i = 0; i < 3000; ++i)
        many.append("laser at=").append(std::to_string(i % 19 - 9)).append(",0\n");
    EXPECT_FALSE(picture(many).empty());
}

/// The values of an attribute, in order.
std::vector<std::string> valuesOf(const std::string& xml, const std::string& attribute) {
    std::vector<std::string> values;
    const std::string start = ' ' + attribute + "=\"";
    for (std::size_t at = xml.find(start); at != std::string::npos; at = xml.find(start, at)) {
        at += start.size();
        values.push_back(xml.substr(at, xml.find('"', at) - at));
    }
    return values;
}

TEST(PlanSvg, IsToScale) {
    // 8 m at 1:25 are 320 mm.
    const std::string plan = svg("ispace id=room size=8,6\n", "room.env");
    EXPECT_NE(plan.find(" 1:25"), std::string::npos);
    const std::size_t room = plan.find("<g id=\"room\">");
    ASSERT_NE(room, std::string::npos);
    const std::size_t path = plan.find("d=\"M", room) + 4;
    const double x0 = parseDouble(plan.substr(path, plan.find(',', path) - path)).value();
    const std::size_t next = plan.find('L', path) + 1;
    const double x1 = parseDouble(plan.substr(next, plan.find(',', next) - next)).value();
    EXPECT_NEAR(std::abs(x1 - x0), 320, 1e-6);
    const std::string width = valuesOf(plan, "width").front();
    EXPECT_EQ(width.substr(width.size() - 2), "mm");
    EXPECT_EQ(valuesOf(plan, "viewBox")
                  .front()
                  .rfind("0 0 " + width.substr(0, width.size() - 2) + ' ', 0),
              0U);
}

TEST(PlanSvg, FitsPaperAtUsualScales) {
    const std::set<std::string> usual = {
        "1",   "2",    "5",    "10",   "20",   "25",    "50",    "100",   "200",    "500",
        "250", "1000", "2000", "2500", "5000", "10000", "25000", "50000", "5000000"};
    for (const std::string size :
         {"0.1,0.1", "1,1", "3,2", "8,6", "6,8", "20,3", "60,50", "400,3", "9000,7000"}) {
        const std::string plan = svg("ispace size=" + size + "\n", "room");
        const std::size_t at = plan.find("paper, 1:") + 9;
        EXPECT_TRUE(usual.contains(plan.substr(at, plan.find(". ", at) - at)))
            << plan.substr(at, 12);
        const std::string width = valuesOf(plan, "width").front();
        const std::string height = valuesOf(plan, "height").front();
        const double w = parseDouble(width.substr(0, width.size() - 2)).value();
        const double h = parseDouble(height.substr(0, height.size() - 2)).value();
        EXPECT_LE(std::max(w, h), 420) << size;
        EXPECT_LE(std::min(w, h), 297) << size;
    }
}

TEST(PlanSvg, LayersHoldElementsWithNamesOfTheirOwn) {
    const std::string plan = svg(kRoom, "room");
    const std::vector<std::string> layers = valuesOf(plan, "inkscape:label");
    EXPECT_EQ(layers,
              (std::vector<std::string>{"floor", "grid", "zones", "fields of view", "objects",
                                        "walls", "robots", "sensors", "labels", "frame"}));
    const std::vector<std::string> ids = valuesOf(plan, "id");
    const std::set<std::string> names(ids.begin(), ids.end());
    EXPECT_EQ(names.size(), ids.size());
    for (const char* id : {"outer", "thin", "a_b", "_2d", "carpet", "t1", "l1", "c1", "tag1", "m1",
                           "g1", "r1", "h1", "layer-walls"})
        EXPECT_TRUE(names.contains(id)) << id;
    // Elements lie in their layers.
    const std::size_t objects = plan.find("inkscape:label=\"objects\"");
    EXPECT_LT(objects, plan.find("<g id=\"t1\">"));
    EXPECT_LT(plan.find("<g id=\"t1\">"), plan.find("inkscape:label=\"walls\""));
    EXPECT_NE(plan.find("<title>t1: table, from 0 to 0.7 m</title>"), std::string::npos);
}

/// Where on the page the text of a zone's name begins.
struct NamePlace {
    double x = 0, y = 0;
};
std::optional<NamePlace> nameOf(const std::string& plan, const std::string& id) {
    const std::size_t end = plan.find('>' + id + "</text>");
    if (end == std::string::npos) return std::nullopt;
    const std::string text = plan.substr(plan.rfind("<text ", end), 60);
    return NamePlace{parseDouble(valuesOf(text, "x").front()).value(),
                     parseDouble(valuesOf(text, "y").front()).value()};
}

TEST(PlanSvg, NamesOfZonesStayOnThePlan) {
    const std::string plan =
        svg("ispace size=8,6\n"
            "zone id=within at=0,0 size=6,4\nzone id=reaches_far_out at=-9,1 size=14,3\n"
            "zone id=narrow_at_the_edge at=3.9,-1 size=0.2,1\nzone id=below at=0,-6 size=2,8\n"
            "zone id=elsewhere at=20,0 size=2,2\n",
            "room");
    const auto within = nameOf(plan, "within"), out = nameOf(plan, "reaches_far_out");
    const auto edge = nameOf(plan, "narrow_at_the_edge"), below = nameOf(plan, "below");
    ASSERT_TRUE(within && out && edge && below);
    EXPECT_FALSE(nameOf(plan, "elsewhere"));
    const std::size_t view = plan.find("viewBox=\"0 0 ") + 13;
    const double page = parseDouble(plan.substr(view, plan.find(' ', view) - view)).value();
    // The room lies within the page's margins.
    EXPECT_GT(out->x, 0.02 * page);
    EXPECT_LT(out->x, within->x);
    EXPECT_LT(edge->x, 0.92 * page);
    EXPECT_GT(edge->x, within->x);
    EXPECT_GT(below->y, within->y);
    const std::size_t rest = plan.find(' ', view) + 1;
    const double height = parseDouble(plan.substr(rest, plan.find('"', rest) - rest)).value();
    EXPECT_LT(below->y, 0.95 * height);
    // Above the walls.
    EXPECT_GT(plan.find(">within</text>"), plan.find("inkscape:label=\"labels\""));
}

TEST(PlanSvg, TextIsEscapedAndIdsAreUnique) {
    const std::string plan =
        svg("ispace id=layer-walls size=2,2\ncube id=a/b at=0.3,0\ncube id=a@b at=-0.3,0\n",
            "a <b> & \"c\"\n\x01");
    EXPECT_NE(plan.find("a &lt;b&gt; &amp; &quot;c&quot;??"), std::string::npos);
    const std::vector<std::string> ids = valuesOf(plan, "id");
    EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), ids.size());
    EXPECT_TRUE(std::find(ids.begin(), ids.end(), "layer-walls_2") != ids.end());
    EXPECT_TRUE(std::find(ids.begin(), ids.end(), "a_b_2") != ids.end());
}

TEST(PlanSvg, ElementsOpenAndCloseInOrder) {
    const std::string plan = svg(kRoom, "room", 0.3) + svg(kRoom, "room");
    std::vector<std::string> open;
    for (std::size_t at = plan.find('<'); at != std::string::npos; at = plan.find('<', at)) {
        const std::size_t end = plan.find('>', at);
        ASSERT_NE(end, std::string::npos);
        const std::string tag = plan.substr(at + 1, end - at - 1);
        at = end;
        if (tag[0] == '?' || tag.back() == '/') continue;
        EXPECT_EQ(std::count(tag.begin(), tag.end(), '"') % 2, 0) << tag;
        if (tag[0] != '/') {
            open.push_back(tag.substr(0, tag.find(' ')));
            continue;
        }
        ASSERT_FALSE(open.empty());
        EXPECT_EQ(open.back(), tag.substr(1));
        open.pop_back();
    }
    EXPECT_TRUE(open.empty());
}

TEST(PlanSvg, ManyWallsStaySmall) {
    std::string lines = "ispace size=300,300\n";
    for (int i = 0; i < 5000; ++i) {
        const std::string x = std::to_string(i % 100 * 2 - 99),
                          y = std::to_string(i / 100 * 2 - 49);
        lines.append("wall from=").append(x).append(",").append(y);
        lines.append(" to=").append(x).append(".5,").append(y).append("\n");
    }
    EXPECT_LT(svg(lines).size(), 5000U * 200);
}

}  // namespace plan_test
}  // namespace ispace
