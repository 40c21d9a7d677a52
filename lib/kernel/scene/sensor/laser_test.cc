// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor/laser.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "env/environment.h"
#include "scene/sensor/sensor_keys.h"
#include "support/test_sensors.h"

namespace ispace {

using testing::findings;

namespace laser_test {

using testing::deviceFor;
using testing::sensorRecord;

Laser laser(const std::string& keys) {
    const Record record = sensorRecord("laser " + keys);
    return parametersOf<Laser>(record, deviceFor(record));
}

std::string laserFindings(const std::string& keys) {
    return findings([&] { return laser(keys); });
}

TEST(LaserOf, BareLaserIsThePanelOfTheThesis) {
    const Laser bare = laser("");
    EXPECT_EQ(bare, Laser());
    EXPECT_EQ(bare.model, "");
    EXPECT_EQ(bare.min_range, 0);
    EXPECT_EQ(bare.max_range, 5);
    EXPECT_EQ(bare.beams, 181);
    EXPECT_EQ(bare.bearing(0).degrees(), -90);
    EXPECT_EQ(bare.bearing(90).degrees(), 0);
    EXPECT_EQ(bare.last().degrees(), 90);
}

TEST(LaserOf, RangeHasMaximumAloneOrBoth) {
    EXPECT_EQ(laser("range=4").max_range, 4);
    EXPECT_EQ(laser("range=4").min_range, 0);
    EXPECT_EQ(laser("range=0.5,4").min_range, 0.5);
    EXPECT_EQ(laser("range=0.5,4").max_range, 4);
    EXPECT_EQ(laser("model=urg-04lx range=4").min_range, 0.06);
    EXPECT_EQ(laser("range=50cm").max_range, 0.5);
}

TEST(LaserOf, RangeErrors) {
    EXPECT_NE(laserFindings("range=5,4").find("least range 5 m is above"), std::string::npos);
    EXPECT_NE(laserFindings("range=0").find("must be above 0"), std::string::npos);
    EXPECT_NE(laserFindings("range=0,0").find("must be above 0"), std::string::npos);
    EXPECT_NE(laserFindings("range=-1"), "");
    EXPECT_NE(laserFindings("model=urg-04lx range=0.05").find("above the greatest"),
              std::string::npos);
}

TEST(LaserOf, FovLaysTheBeamsAnew) {
    const Laser wide = laser("fov=270");
    EXPECT_EQ(wide.first.degrees(), -135);
    EXPECT_EQ(wide.beams, 271);
    const Laser fine = laser("fov=90 step=0.25");
    EXPECT_EQ(fine.first.degrees(), -45);
    EXPECT_EQ(fine.beams, 361);
    EXPECT_EQ(laser("fov=0").beams, 1);
    EXPECT_EQ(laser("fov=0").first.degrees(), 0);
    EXPECT_EQ(laser("fov=360").beams, 361);
    const Laser urg = laser("model=urg-04lx fov=180");
    EXPECT_EQ(urg.first.degrees(), -90);
    EXPECT_EQ(urg.beams, 513);  // 180 / 0.3515625 = 512
}

TEST(LaserOf, FovThatIsNoMultipleOfTheStepEndsEarly) {
    const Laser odd = laser("fov=10 step=3");
    EXPECT_EQ(odd.first.degrees(), -5);
    EXPECT_EQ(odd.beams, 4);
    EXPECT_EQ(odd.last().degrees(), 4);
}

TEST(LaserOf, DivisionByStepIsNotLostToRounding) {
    // 0.3 / 0.1 is a little below 3 in doubles.
    EXPECT_EQ(laser("fov=0.3 step=0.1").beams, 4);
    for (int beams = 2; beams < 2000; ++beams) {
        const double step = 0.1;
        const Record made = [&] {
            Record out = sensorRecord("laser");
            out.set("fov", step * (beams - 1) > 360 ? 360 : step * (beams - 1));
            out.set("step", step);
            return out;
        }();
        EXPECT_EQ(parametersOf<Laser>(made, nullptr).beams, beams);
    }
}

TEST(LaserOf, StepAloneKeepsFirstBeamAndSpan) {
    EXPECT_EQ(laser("step=0.5").beams, 361);
    EXPECT_EQ(laser("step=0.5").first.degrees(), -90);
    const Laser urg = laser("model=urg-04lx step=0.703125");
    EXPECT_EQ(urg.first.degrees(), -119.53125);
    EXPECT_EQ(urg.beams, 341);  // floor(681 / 2) + 1
}

TEST(LaserOf, FirstAndBeams) {
    const Laser turned = laser("first=0");
    EXPECT_EQ(turned.beams, 181);
    EXPECT_EQ(turned.last().degrees(), 180);
    const Laser few = laser("beams=3");
    EXPECT_EQ(few.first.degrees(), -90);
    EXPECT_EQ(few.last().degrees(), -88);
    const Laser all = laser("first=-135 beams=1081 step=0.25");
    EXPECT_EQ(all.last().degrees(), 135);
    const Laser half = laser("fov=90 first=0");
    EXPECT_EQ(half.last().degrees(), 90);
    EXPECT_EQ(laser("fov=90 step=0.5 beams=181").beams, 181);
}

TEST(LaserOf, BeamErrors) {
    EXPECT_NE(laserFindings("fov=180 step=1 beams=361").find("fov and step give 181"),
              std::string::npos);
    // Without step they are spread over the field of view.
    EXPECT_EQ(laser("fov=180 beams=361").step, Angle::degrees(0.5));
    EXPECT_EQ(laser("model=urg-04lx fov=90 beams=91").beams, 91);
    EXPECT_EQ(laser("fov=180 beams=361").last(), Angle::degrees(90));
    EXPECT_NE(laserFindings("beams=2.5").find("not a whole number"), std::string::npos);
    EXPECT_NE(laserFindings("beams=0"), "");
    EXPECT_NE(laserFindings("beams=1e7"), "");
    EXPECT_NE(laserFindings("step=0"), "");
    EXPECT_NE(laserFindings("step=1e-9").find("at most 1000000"), std::string::npos);
    EXPECT_NE(laserFindings("fov=361"), "");
    EXPECT_NE(laserFindings("beams=1000").find("more than a full turn"), std::string::npos);
    // Both findings at once.
    const std::string both = laserFindings("range=5,4 beams=2.5");
    EXPECT_EQ(std::count(both.begin(), both.end(), '\n'), 2);
}

TEST(Laser, BeamsWhoseStepsReachATurnCloseTheCircle) {
    for (const char* const keys :
         {"model=lds-01", "model=rplidar-a1", "model=rplidar-a2", "model=rplidar-a3", "fov=360",
          "fov=360 step=0.25", "fov=360 step=0.7", "first=-180 beams=360", "first=17 beams=360",
          "first=0 beams=1080 step=0.3333333333333333", "first=0 beams=1080 step=0.333333",
          "first=-180 beams=3 step=120", "model=lds-01 step=0.5", "model=rplidar-a2 step=1",
          "model=lds-01 first=-90"}) {
        const Laser round = laser(keys);
        EXPECT_TRUE(round.seesAround()) << keys;
        EXPECT_EQ(round.span(), Angle::degrees(360)) << keys;
        for (const double bearing : {-180.0, -179.5, 0.0, 179.99, 359.5})
            EXPECT_TRUE(round.sees(Angle::degrees(bearing))) << keys << ' ' << bearing;
        EXPECT_LE((round.last() - round.first).degrees(), 360 + 1e-9) << keys;
    }
    EXPECT_EQ(laser("model=lds-01 step=0.5").beams, 720);
    EXPECT_EQ(laser("model=lds-01 step=0.7").beams, 515);
    for (const char* const keys : {"", "fov=358", "fov=359 step=0.5", "first=0 beams=359",
                                   "model=utm-30lx", "fov=180 step=180", "first=0 beams=1",
                                   "model=lds-01 fov=300", "model=lds-01 beams=300"}) {
        const Laser open = laser(keys);
        EXPECT_FALSE(open.seesAround()) << keys;
        EXPECT_EQ(open.span(), open.last() - open.first) << keys;
        EXPECT_FALSE(open.sees(open.first - Angle::degrees(0.5))) << keys;
    }
}

TEST(Laser, ASweepOfHeadingsMayLookAroundToo) {
    EXPECT_TRUE(laser("sweep=heading").seesAround());
    EXPECT_EQ(laser("sweep=heading").span(), Angle::degrees(180)) << "of one scan";
    EXPECT_EQ(laser("sweep=heading sweep_span=90").sweptSpan(), Angle::degrees(270));
    EXPECT_FALSE(laser("sweep=heading sweep_span=90").seesAround());
    EXPECT_TRUE(laser("sweep=heading sweep_span=180").seesAround());
    EXPECT_TRUE(laser("fov=360 sweep=heading sweep_span=90").seesAround());
    // A heading matters to what nods.
    EXPECT_FALSE(laser("fov=360 sweep=tilt").seesAround());
}

TEST(LaserOf, ModelGivesTheParametersAndExplicitKeysWin) {
    const Laser urg = laser("model=urg-04lx");
    EXPECT_EQ(urg.model, "urg-04lx");
    EXPECT_EQ(urg.min_range, 0.06);
    EXPECT_EQ(urg.max_range, 4.095);
    EXPECT_EQ(urg.beams, 682);
    EXPECT_EQ(urg.step.degrees(), 360.0 / 1024);
    EXPECT_EQ(urg.bearing(384 - 44).degrees(), 0);
    EXPECT_EQ(urg.last().degrees(), 119.8828125);
    const Laser utm = laser("model=utm-30lx");
    EXPECT_EQ(utm.beams, 1081);
    EXPECT_EQ(utm.first.degrees(), -135);
    EXPECT_EQ(utm.last().degrees(), 135);
    EXPECT_EQ(utm.max_range, 30);
    EXPECT_EQ(laser("model=utm-30lx range=8").max_range, 8);
}

TEST(LaserOf, RateIsTheModelsElseTen) {
    EXPECT_EQ(laser("").rate, 10);
    EXPECT_EQ(laser("model=urg-04lx").rate, 10);
    EXPECT_EQ(laser("model=utm-30lx").rate, 40);
    EXPECT_EQ(laser("model=utm-30lx rate=12.5").rate, 12.5);
    EXPECT_EQ(laser("rate=5Hz").rate, 5);
    EXPECT_NE(laserFindings("rate=0").find("must be above 0"), std::string::npos);
    EXPECT_NE(laserFindings("rate=-1"), "");
    EXPECT_NE(laserFindings("rate=100001"), "");
}

TEST(LaserOf, SpinGoesWithTheRate) {
    const Laser urg = laser("model=urg-04lx");
    EXPECT_EQ(urg.spin, 10);
    EXPECT_NEAR(urg.duration(), 681 * 0.3515625 / 360 / 10, 1e-12);
    EXPECT_EQ(laser("model=urg-04lx rate=20").spin, 20);
    EXPECT_EQ(laser("model=urg-04lx spin=0").duration(), 0);
    EXPECT_EQ(laser("fov=90 rate=10").duration(), 0) << "the bare laser: all beams at once";
    // Clockwise the last beam is first.
    const Laser clockwise = laser("fov=90 step=1 rate=10 spin=-10");
    EXPECT_NEAR(clockwise.timeOf(0), 0.025, 1e-12);
    EXPECT_EQ(clockwise.timeOf(90), 0);
    EXPECT_EQ(laser("fov=90 step=1 rate=10 spin=10").timeOf(0), 0);
    EXPECT_NE(laserFindings("fov=90 rate=10 spin=2"), "") << "it takes 0.125 s";
    EXPECT_EQ(laserFindings("fov=90 rate=10 spin=2.5"), "");
    EXPECT_EQ(laserFindings("fov=360 rate=10 spin=10"), "") << "a full turn is just done";
}

TEST(LaserOf, SweepsAreBounded) {
    EXPECT_EQ(laser("sweep=heading").scans(), 360);
    EXPECT_EQ(laser("sweep=tilt sweep_span=90 sweep_step=45").scans(), 3);
    EXPECT_EQ(laser("sweep_span=90").scans(), 1);
    EXPECT_NE(laserFindings("step=0.001 sweep=heading sweep_step=0.01"), "");
    EXPECT_EQ(laserFindings("step=0.001 sweep_step=0.01"), "");
    EXPECT_NE(laserFindings("incidence=80,70"), "");
}

TEST(Laser, SeesBetweenFirstAndLastBeamAtAnyTurn) {
    const Laser half;  // -90 .. 90
    for (const double turn : {-720.0, -360.0, 0.0, 360.0, 1080.0}) {
        EXPECT_TRUE(half.sees(Angle::degrees(turn)));
        EXPECT_TRUE(half.sees(Angle::degrees(turn + 90)));
        EXPECT_TRUE(half.sees(Angle::degrees(turn - 90)));
        EXPECT_TRUE(half.sees(Angle::degrees(turn + 90 + 1e-10)));
        EXPECT_FALSE(half.sees(Angle::degrees(turn + 90.001)));
        EXPECT_FALSE(half.sees(Angle::degrees(turn - 90.001)));
        EXPECT_FALSE(half.sees(Angle::degrees(turn + 180)));
    }
    const Laser all = laser("fov=360");
    const Laser one = laser("fov=0 first=30");
    EXPECT_TRUE(one.sees(Angle::degrees(30)));
    EXPECT_TRUE(one.sees(Angle::degrees(-330)));
    EXPECT_FALSE(one.sees(Angle::degrees(30.01)));
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> any(-1000, 1000);
    for (int i = 0; i < 1000; ++i) {
        const double bearing = any(random);
        EXPECT_TRUE(all.sees(Angle::degrees(bearing)));
        const double near = std::remainder(bearing, 360.0);
        EXPECT_EQ(half.sees(Angle::degrees(bearing)), near >= -90 && near <= 90) << bearing;
    }
}

TEST(PoseOf, HeightIsThatOfAStandingSensorIfNotGiven) {
    const Pose3 pose = poseOf(sensorRecord("laser at=1,2 heading=30"));
    EXPECT_EQ(pose.position, (Point3{1, 2, kScanHeight}));
    EXPECT_EQ(pose.heading.degrees(), 30);
    EXPECT_TRUE(pose.isLevel());
    const Pose3 tilted = poseOf(sensorRecord("laser at=1,2,1.5 tilt=-30 roll=5"));
    EXPECT_EQ(tilted.position.z, 1.5);
    EXPECT_EQ(tilted.tilt.degrees(), -30);
    EXPECT_EQ(tilted.roll.degrees(), 5);
    EXPECT_FALSE(tilted.isLevel());
    EXPECT_EQ(poseOf(sensorRecord("laser on=r1 heading=5")),
              (Pose3{{0, 0, kScanHeight}, Angle::degrees(5), {}, {}}));
}

TEST(MountedPose, IsTheRobotsTurnedAndMoved) {
    const Pose3 local{{0.2, 0.1, 0.3}, Angle::degrees(45), Angle::degrees(-10), Angle::degrees(5)};
    const Pose3 pose = mountedPose({{1, 2}, Angle::degrees(90)}, local);
    EXPECT_DOUBLE_EQ(pose.position.x, 0.9);
    EXPECT_DOUBLE_EQ(pose.position.y, 2.2);
    EXPECT_EQ(pose.position.z, 0.3);
    EXPECT_EQ(pose.heading.degrees(), 135);
    EXPECT_EQ(pose.tilt.degrees(), -10);
    EXPECT_EQ(pose.roll.degrees(), 5);
    // Headings stay within half a turn, however often the robot has turned.
    EXPECT_EQ(mountedPose({{}, Angle::degrees(720 + 170)}, local).heading.degrees(), -145);
    EXPECT_FALSE(std::signbit(mountedPose({{}, Angle::degrees(-405)}, local).heading.degrees()));
}

}  // namespace laser_test

}  // namespace ispace
