// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/ifc/reader/step_file.h"

#include <gtest/gtest.h>

namespace ispace::ifc {
namespace step_file_test {

StepFile fileOf(std::string_view data) { return StepFile(data); }

TEST(StepFile, FindsInstancesInAnyOrder) {
    const StepFile file = fileOf(
        "ISO-10303-21;\nHEADER;FILE_DESCRIPTION(('a;b'),'2;1');ENDSEC;DATA;\r\n"
        "#12 = IFCWALL ( 'x' , #3 ) ;#3=IFCSLAB(\n$,\n*);\n"
        "/* #4=IFCWALL(); */ #7/*;*/=IFCWALL(/*'*/1);\n"
        "#5=(IFCA()IFCB());#=IFCWALL();#6 IFCWALL();#99999999999999999999=IFCWALL();ENDSEC;");
    EXPECT_EQ(file.size(), 3U);
    EXPECT_EQ(file.typeOf(12), "IFCWALL");
    EXPECT_EQ(file.typeOf(3), "IFCSLAB");
    EXPECT_EQ(file.typeOf(4), "");
    ASSERT_EQ(file.ofType("IFCWALL").size(), 2U);
    EXPECT_EQ(file.ofType("IFCWALL")[0], 7U);
    EXPECT_TRUE(file.ofType("IFCDOOR").empty());
    const StepInstance wall = file.read(12);
    EXPECT_EQ(wall[0].text(), "x");
    EXPECT_EQ(wall[1].reference(), 3U);
    EXPECT_TRUE(wall[2].isNull());
    EXPECT_TRUE(file.read(3)[0].isNull());
    EXPECT_TRUE(file.read(3)[1].isNull());
    EXPECT_EQ(file.read(7)[0].number(), 1);
    EXPECT_EQ(file.read(1).type, "");
}

TEST(StepFile, SurvivesWhatIsCutOff) {
    const std::string_view whole =
        "#1=IFCWALL('a''b',(1.,(2,3)),/* c */ IFCLABEL('d'),.T.);#2=IFCSLAB();";
    for (std::size_t i = 0; i <= whole.size(); ++i) {
        const StepFile file(whole.substr(0, i));
        for (StepId id = 1; id < 3; ++id)
            for (const StepValue& value : file.read(id).arguments) {
                (void)value.text();
                (void)value.number();
                (void)value.list();
            }
    }
    // An instance that does not close ends where the statement does.
    EXPECT_EQ(StepFile("#1=IFCWALL('a',(1;#2=IFCWALL('b');").read(2)[0].text(), "b");
}

TEST(StepValue, Kinds) {
    const auto values = StepValue("(#12,-1.5E-3,2.,.AREA.,$,*,'t',IFCLABEL('u'),(1,2),())").list();
    ASSERT_EQ(values.size(), 10U);
    EXPECT_EQ(values[0].reference(), 12U);
    EXPECT_EQ(values[1].number(), -0.0015);
    EXPECT_EQ(values[2].number(), 2);
    EXPECT_EQ(values[3].word(), "AREA");
    EXPECT_TRUE(values[4].isNull() && values[5].isNull());
    EXPECT_EQ(values[6].text(), "t");
    EXPECT_EQ(values[7].text(), "u");
    EXPECT_EQ(values[7].type(), "IFCLABEL");
    EXPECT_EQ(StepValue("IFCAREAMEASURE(2.5)").number(), 2.5);
    EXPECT_EQ(values[8].list().size(), 2U);
    EXPECT_TRUE(values[9].list().empty());
    // None is another.
    EXPECT_EQ(values[1].reference(), 0U);
    EXPECT_EQ(values[1].text(), "");
    EXPECT_EQ(values[1].word(), "");
    EXPECT_FALSE(values[6].number());
    EXPECT_TRUE(values[0].list().empty());
    EXPECT_EQ(StepValue("#12x").reference(), 0U);
}

TEST(StepValue, Strings) {
    const auto text = [](const char* value) { return StepValue(value).text(); };
    EXPECT_EQ(text("'it''s'"), "it's");
    EXPECT_EQ(text(R"('K\X2\00FC\X0\che')"), "Küche");
    EXPECT_EQ(text(R"('\X2\00E400DF\X0\')"), "äß");
    EXPECT_EQ(text(R"('\X2\D83DDE00\X0\')"), "😀");
    EXPECT_EQ(text(R"('\X4\0001F600\X0\')"), "😀");
    EXPECT_EQ(text(R"('\X\E9')"), "é");
    EXPECT_EQ(text(R"('N\S\0')"), "N°");
    EXPECT_EQ(text(R"('\PA\a\\b')"), "a\\b");
    EXPECT_EQ(text(R"('\X2\00')"), "00");  // damaged, but text
    EXPECT_EQ(text("'a\nb'"), "a?b");
    EXPECT_EQ(text("'open"), "");
}

}  // namespace step_file_test
}  // namespace ispace::ifc
