// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/carmen_log.h"

#include <gtest/gtest.h>

#include <numbers>
#include <sstream>

#include "sense/sample_readings.h"

namespace ispace {
namespace {

TEST(CarmenLog, HeaderIsComments) {
    std::istringstream lines(carmenHeader());
    int count = 0;
    for (std::string line; std::getline(lines, line); ++count)
        EXPECT_TRUE(line.starts_with("# ")) << line;
    EXPECT_GT(count, 2);
    EXPECT_TRUE(carmenHeader().ends_with('\n'));
}

TEST(CarmenLog, FieldsInOrder) {
    Sensor sensor = threeBeams();
    sensor.as<Laser>().noise.sigma[0] = 0.01;
    Scan scan = scanOf({{1, -2, 0.15}, Angle::degrees(180), {}, {}}, {0.1F, kNone, 3.999F});
    scan.time = 0.25;
    std::string out = "before\n";
    appendCarmenLine(out, 1, sensor, scan, {{0.5, -2}, Angle::degrees(-180)});
    EXPECT_EQ(out,
              "before\nROBOTLASER1 3 -1.5707963267948966 3.141592653589793 1.5707963267948966 4 "
              "0.01 0 3 0.1 4 3.999 0 1 -2 3.141592653589793 0.5 -2 3.141592653589793 "
              "0 0 0 0 0 0.25 sim 0.25\n");
}

/// What a reader makes of the line: where a beam points, if the fan begins at start_angle, and if
/// it is taken for one about the laser's heading.
struct Beam {
    double by_start, by_fov;
};
Beam beamOf(const Sensor& sensor, const Scan& scan, int beam) {
    std::string line;
    appendCarmenLine(line, 1, sensor, scan, {});
    std::istringstream words(line);
    std::string name;
    int type = 0, mode = 0;
    std::size_t count = 0, remissions = 1;
    double start = 0, fov = 0, step = 0, limit = 0, accuracy = 0, range = 0, x = 0, y = 0,
           theta = 0;
    words >> name >> type >> start >> fov >> step >> limit >> accuracy >> mode >> count;
    for (std::size_t i = 0; i < count; ++i) words >> range;
    words >> remissions >> x >> y >> theta;
    EXPECT_EQ(remissions, 0U);
    return {theta + start + beam * step,
            theta - fov / 2 + beam * fov / static_cast<double>(count - 1)};
}

TEST(CarmenLog, ReadersAgreeOnBeamsOfAFanThatIsNotSymmetric) {
    Sensor sensor;
    Laser& laser = sensor.as<Laser>();
    laser.step = Angle::degrees(360.0 / 1024);
    laser.first = (44.0 - 384) * laser.step;
    laser.beams = 682;
    const Scan scan = scanOf({{}, Angle::degrees(30), {}, {}}, std::vector<float>(682, 1));
    for (const int beam : {0, 340, 681}) {
        const double wanted = (Angle::degrees(30) + laser.bearing(beam)).radians();
        const Beam seen = beamOf(sensor, scan, beam);
        EXPECT_NEAR(seen.by_start, wanted, 1e-12);
        EXPECT_NEAR(seen.by_fov, wanted, 1e-12);
    }
    // All around from bearing 0.
    laser.first = {};
    laser.step = Angle::degrees(1);
    laser.beams = 360;
    const Scan around = scanOf({}, std::vector<float>(360, 1));
    EXPECT_NEAR(beamOf(sensor, around, 90).by_fov, std::numbers::pi / 2, 1e-12);
    EXPECT_NEAR(beamOf(sensor, around, 90).by_start, std::numbers::pi / 2, 1e-12);
}

}  // namespace
}  // namespace ispace
