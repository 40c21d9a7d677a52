// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>

#include "extensions/ifc/ifc.h"
#include "extensions/ifc/ifc_write_model.h"
#include "record/text.h"
#include "scene/placement_schemas.h"

namespace ispace::ifc {

namespace ifc_write_test {

TEST(IfcWrite, TextIsAsciiWithTheEscapesOfPart21) {
    EXPECT_EQ(stepText("a b"), "'a b'");
    EXPECT_EQ(stepText("it's a\\b"), "'it''s a\\\\b'");
    EXPECT_EQ(stepText("K\xC3\xBC\xE2\x82\xAC"), "'K\\X2\\00FC\\X0\\\\X2\\20AC\\X0\\'");
    EXPECT_EQ(stepText("\xF0\x9F\x98\x80"), "'\\X4\\0001F600\\X0\\'");
    EXPECT_EQ(stepText("\t"), "'\\X2\\0009\\X0\\'");
}

TEST(IfcWrite, RealsHaveAPoint) {
    EXPECT_EQ(stepReal(6), "6.");
    EXPECT_EQ(stepReal(-0.0), "0.");
    EXPECT_EQ(stepReal(2.5), "2.5");
    EXPECT_EQ(stepReal(0.1 + 0.2), "0.3");
    EXPECT_EQ(stepReal(3e-6), "3.E-06");
}

TEST(IfcWrite, GuidsAreHashesInIfcsBase64) {
    // Of e3b0c442 98fc1c14 9afbf4c8 996fb924, the first half of sha256("").
    EXPECT_EQ(ifcGuid(""), "3ZiCH2cFmS59hxzCYPRxaa");
    EXPECT_NE(ifcGuid("a"), ifcGuid("b"));
}

std::string written(const char* records) {
    const Document document = readRecordText(records, "room", sceneSchemas());
    return writeIfc(makeScene(document, nullptr, DeviceCatalogue()), "room").product;
}

std::size_t count(const std::string& text, std::string_view word) {
    std::size_t found = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
        ++found;
    return found;
}

TEST(IfcWrite, AWallThatRoomsShareStandsOnceWithItsDoor) {
    const std::string text = written(
        "#env 1\nispace id=a size=4,3\nispace id=b at=4,0 size=4,3\ninside at=0,0\n"
        "door id=d wall=b at=2,0 open=yes\n");
    EXPECT_EQ(count(text, "=IFCWALL("), 7U);
    EXPECT_EQ(count(text, "=IFCOPENINGELEMENT("), 1U);
    EXPECT_EQ(count(text, "=IFCDOOR("), 1U);
    EXPECT_EQ(count(text, "=IFCRELVOIDSELEMENT("), 1U);
    EXPECT_EQ(count(text, "=IFCRELFILLSELEMENT("), 1U);
}

TEST(IfcWrite, EachFloorHasASlabBelowIt) {
    const std::string text = written(
        "#env 1\nispace id=a size=4,3\nispace id=b at=9,0 size=4,3\ninside at=0,0\ninside "
        "at=9,0\n");
    EXPECT_EQ(count(text, "=IFCSLAB("), 2U);
    EXPECT_EQ(count(text, ".FLOOR."), 2U);
    EXPECT_NE(text.find("'floor slab 1'"), std::string::npos);
    EXPECT_EQ(count(text, "'Qto_SlabBaseQuantities'"), 2U);
    EXPECT_NE(text.find("(0.,0.,-0.2)"), std::string::npos);
}

TEST(IfcWrite, AnOpeningThroughTwoWallsIsFilledOnce) {
    const std::string text = written(
        "#env 1\nispace size=6,4\nwall from=-1,-2 to=-1,2 thickness=0.2\n"
        "wall from=-0.85,-2 to=-0.85,2 thickness=0.2\nwindow at=-1,0 size=1,0.6\n");
    EXPECT_EQ(count(text, "=IFCOPENINGELEMENT("), 2U);
    EXPECT_EQ(count(text, "=IFCRELVOIDSELEMENT("), 2U);
    EXPECT_EQ(count(text, "=IFCRELFILLSELEMENT("), 1U);
    EXPECT_EQ(count(text, "=IFCWINDOW("), 1U);
}

constexpr const char* kTwoFaces =
    "#env 1\nfence path=0,0;6,0;6,4;0,4 closed=yes height=2.5\n"
    "fence path=0.3,0.3;2.9,0.3;2.9,3.7;0.3,3.7 closed=yes height=2.5\n"
    "fence path=3.1,0.3;5.7,0.3;5.7,3.7;3.1,3.7 closed=yes height=2.5\n"
    "door at=3.1,2 size=0.9,0.5 height=2 open=yes\nwindow at=0,2 size=1,0.7\ninside at=1,1\n"
    "zone id=z1 at=1,1 size=1,1 number=12 name=Hall\n";

TEST(IfcWrite, FacesThatAnOpeningJoinsAreOneWall) {
    const std::string text = written(kTwoFaces);
    EXPECT_EQ(count(text, "=IFCWALL("), 1U);
    EXPECT_EQ(count(text, "IFCARBITRARYPROFILEDEFWITHVOIDS"), 1U);
    EXPECT_EQ(count(text, "=IFCOPENINGELEMENT("), 2U);
    EXPECT_EQ(count(text, "=IFCDOOR("), 1U);
    EXPECT_EQ(count(text, "=IFCWINDOW("), 1U);
    EXPECT_EQ(count(text, "=IFCRELFILLSELEMENT("), 2U);
}

TEST(IfcWrite, RoomsThatAWindowJoinsAreNoWall) {
    const std::string text = written(
        "#env 1\nfence path=0,0;3,0;3,4;0,4 closed=yes\nfence path=3.8,0;6,0;6,4;3.8,4 closed=yes\n"
        "fence path=3,0;3.8,0 closed=no\nfence path=3,4;3.8,4 closed=no\n"
        "window at=3,2 size=1,1.8\ninside at=3.4,1\n");
    EXPECT_EQ(count(text, "IFCARBITRARYPROFILEDEFWITHVOIDS"), 0U);
    EXPECT_GT(count(text, "=IFCWALL("), 8U);
}

TEST(IfcWrite, ZonesArePartsOfTheirRoomWithNumberAndName) {
    const std::string text = written(kTwoFaces);
    EXPECT_EQ(count(text, "=IFCSPACE("), 2U);
    EXPECT_EQ(count(text, ",'12',$,'zone',"), 1U);
    EXPECT_EQ(count(text, ",'Hall',.PARTIAL."), 1U);
}

TEST(IfcWrite, FixturesHaveTheirClass) {
    const std::string ifc = written(
        "#env 1\nispace size=4,3\nlamp at=1,1\nheater at=1,0\nspeaker at=0,1\npanel at=0,0\n"
        "switch at=1,-1\nprojector at=-1,0\n");
    for (const char* type : {"=IFCLIGHTFIXTURE(", "=IFCSPACEHEATER(", ".SPEAKER.", ".PROJECTOR.",
                             "=IFCELECTRICDISTRIBUTIONBOARD(", "=IFCSWITCHINGDEVICE("})
        EXPECT_NE(ifc.find(type), std::string::npos) << type;
}

}  // namespace ifc_write_test

}  // namespace ispace::ifc
