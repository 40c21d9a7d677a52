// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/navigation/navigation_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace ispace::navigation {
namespace navigation_metrics_test {

/// A run along x with the robot at `place(t)`, every 0.1 s from 0 to `end`.
NavigationRun runOf(double end, const std::function<double(double)>& place) {
    NavigationRun run;
    for (int i = 0; 0.1 * i <= end + 1e-9; ++i) {
        const double t = 0.1 * i;
        run.moments.push_back({t, {place(t), 0}, 0, {}});
    }
    return run;
}

TEST(NavigationMetrics, ARunEndsWhereTheGoalIsReached) {
    const NavigationRun run = runOf(10, [](double t) { return t; });
    const NavigationFigures figures = navigationFigures(run, {{5, 0}, 0, 0.55, 4.45});
    EXPECT_TRUE(figures.success);
    EXPECT_NEAR(*figures.time, 4.5, 1e-9);
    EXPECT_NEAR(figures.path, 4.5, 1e-9);
    EXPECT_NEAR(*figures.spl, 4.45 / 4.5, 1e-9);
    EXPECT_NEAR(*figures.ratio, 4.5 / 4.45, 1e-9);
    EXPECT_NEAR(figures.speed, 1, 1e-9);
    EXPECT_FALSE(figures.nearest);
}

TEST(NavigationMetrics, AFailureHasNoTimeAndAnSplOfZero) {
    const NavigationRun run = runOf(3, [](double t) { return t; });
    const NavigationFigures figures = navigationFigures(run, {{5, 0}, 0, 0.5, 4.5});
    EXPECT_FALSE(figures.success);
    EXPECT_FALSE(figures.time);
    EXPECT_FALSE(figures.ratio);
    EXPECT_EQ(*figures.spl, 0);
    EXPECT_NEAR(figures.duration, 3, 1e-9);
    // The goal of another room at the same place is another goal.
    EXPECT_FALSE(navigationFigures(run, {{2, 0}, 1, 0.5, {}}).success);
}

TEST(NavigationMetrics, IntrusionsCountEntriesOfEachPerson) {
    NavigationRun run = runOf(2, [](double t) { return t; });
    // Person 7 comes near for 3 moments, leaves, and comes for one; person 8 is near throughout.
    for (std::size_t i = 0; i < run.moments.size(); ++i) {
        const bool is_near = (i >= 2 && i < 5) || i == 9;
        run.moments[i].people = {{7, is_near ? 0.4 : 2.0}, {8, 1.0}};
    }
    const NavigationFigures figures = navigationFigures(run, {{9, 0}, 0, 0.5, {}});
    EXPECT_EQ(figures.intimate.count, 2U);
    EXPECT_NEAR(figures.intimate.seconds, 0.4, 1e-9);
    EXPECT_EQ(figures.personal.count, 3U);
    EXPECT_NEAR(figures.personal.seconds, 2, 1e-9);
    EXPECT_NEAR(*figures.nearest, 0.4, 1e-12);
    EXPECT_FALSE(figures.spl);
}

TEST(NavigationMetrics, StopsAreHaltsAfterItHasSetOut) {
    // It stands for a second, goes for one, halts for 0.3 s, goes, and halts for 0.6 s and for
    // ever.
    const NavigationRun run = runOf(6, [](double t) {
        const auto within = [t](double a, double b) { return std::clamp(t, a, b) - a; };
        return within(1, 2) + within(2.3, 3) + within(3.6, 4);
    });
    const NavigationFigures figures = navigationFigures(run, {{9, 0}, 0, 0.5, {}});
    EXPECT_EQ(figures.stops, 2U);
    EXPECT_NEAR(figures.still, 1 + 0.3 + 0.6 + 2, 1e-6);
}

TEST(NavigationMetrics, JerkIsTheThirdDifferenceOfThePlace) {
    // x = t^3 has the jerk 6.
    const NavigationRun run = runOf(2, [](double t) { return t * t * t; });
    const NavigationFigures figures = navigationFigures(run, {{99, 0}, 0, 0.5, {}});
    EXPECT_NEAR(*figures.jerk, 6, 1e-6);
    EXPECT_NEAR(*figures.greatest_jerk, 6, 1e-6);
    // Of a finer record every second moment is taken.
    NavigationRun fine;
    for (int i = 0; i < 40; ++i) {
        const double t = 0.05 * i;
        fine.moments.push_back({t, {t * t * t + (i % 2 == 0 ? 0 : 0.1), 0}, 0, {}});
    }
    EXPECT_NEAR(*navigationFigures(fine, {{99, 0}, 0, 0.5, {}}).jerk, 6, 1e-6);
    // Without equal intervals it is unknown.
    fine.moments[7].time += 0.01;
    EXPECT_FALSE(navigationFigures(fine, {{99, 0}, 0, 0.5, {}}).jerk);
}

TEST(NavigationMetrics, ContactsOfAPairWithinASecondAreOne) {
    using Kind = NavigationContact::Kind;
    NavigationRun run = runOf(9, [](double) { return 0; });
    run.contacts = {{1.0, Kind::Person, "ann robot"}, {1.5, Kind::Person, "ann robot"},
                    {1.6, Kind::Thing, "robot wall"}, {2.4, Kind::Person, "ann robot"},
                    {4.0, Kind::Person, "ann robot"}, {4.0, Kind::BetweenPeople, "ann bob"},
                    {8.0, Kind::Robot, "other robot"}};
    const NavigationFigures figures = navigationFigures(run, {{9, 0}, 0, 0.5, {}});
    EXPECT_EQ(figures.with_people, 2U);
    EXPECT_EQ(figures.with_things, 1U);
    EXPECT_EQ(figures.with_robots, 1U);
    EXPECT_EQ(figures.between_people, 1U);
    // After the arrival none counts.
    EXPECT_EQ(navigationFigures(run, {{0, 0}, 0, 0.5, 0}).with_people, 0U);
}

TEST(NavigationMetrics, AChangeOfRoomsIsNoWay) {
    NavigationRun run = runOf(4, [](double t) { return t; });
    for (std::size_t i = 20; i < run.moments.size(); ++i) {
        run.moments[i].room = 1;
        run.moments[i].place.x += 100;
    }
    const NavigationFigures figures = navigationFigures(run, {{103, 0}, 1, 0.05, {}});
    EXPECT_TRUE(figures.success);
    EXPECT_NEAR(figures.path, 2.9, 1e-9);
    EXPECT_LT(*figures.greatest_jerk, 1e-6);
}

}  // namespace navigation_metrics_test
}  // namespace ispace::navigation
