// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor/density_classes.h"

#include <gtest/gtest.h>

#include "scene/sensor/camera.h"

namespace ispace {
namespace density_classes_test {

using enum DensityStandard;

TEST(DensityClasses, HoldBothStandards) {
    ASSERT_EQ(densityClasses().size(), 11U);
    EXPECT_EQ(classesOf(Classes2015).size(), pixelDensities().size());
    EXPECT_EQ(classesOf(Levels2025).size(), pixelLevels().size());
    for (std::size_t i = 0; i < pixelDensities().size(); ++i) {
        const std::size_t index = classesOf(Classes2015)[i];
        EXPECT_EQ(index, i) << "as pixelDensities()";
        EXPECT_EQ(className(index, Classes2015), pixelDensities()[i].name);
        EXPECT_EQ(densityClasses()[index].pixels_per_metre, pixelDensities()[i].pixels_per_metre);
    }
    for (std::size_t i = 0; i < pixelLevels().size(); ++i) {
        const std::size_t index = classesOf(Levels2025)[i];
        EXPECT_EQ(className(index, Levels2025), pixelLevels()[i].name);
        EXPECT_EQ(densityClasses()[index].pixels_per_metre, pixelLevels()[i].pixels_per_metre);
    }
}

TEST(DensityClasses, AreSortedByDensity) {
    double before = 0;
    for (const std::size_t index : classesByDensity()) {
        EXPECT_GT(densityClasses()[index].pixels_per_metre, before);
        before = densityClasses()[index].pixels_per_metre;
    }
    EXPECT_EQ(before, 1500);
}

TEST(DensityClasses, AreFoundByEitherName) {
    ASSERT_TRUE(findClass("identify") && findClass("characterize") && findClass("overview"));
    EXPECT_EQ(findClass("identify")->index, findClass("characterise")->index);
    EXPECT_EQ(findClass("identify")->standard, Classes2015);
    EXPECT_EQ(findClass("characterize")->standard, Levels2025);
    EXPECT_EQ(classNames(findClass("identify")->index), "identify / characterise");
    EXPECT_EQ(classNames(findClass("overview")->index), "overview");
    EXPECT_EQ(classNames(findClass("monitor")->index), "monitor");
    for (const char* name : {"", "250", "size", "ize", "Identify"})
        EXPECT_FALSE(findClass(name)) << name;
}

}  // namespace density_classes_test
}  // namespace ispace
