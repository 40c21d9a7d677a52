// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/ros/ros_type_hash.h"

#include <gtest/gtest.h>

#include <utility>

namespace ispace::ros {
namespace ros_type_hash_test {

// As `ros2 topic info -v` of Jazzy prints them: nested types, lists, arrays, bytes, no fields.
TEST(RosTypeHash, EqualsThatOfRos) {
    constexpr std::pair<RosType, const char*> kKnown[] = {
        {RosType::Twist, "9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a"},
        {RosType::TwistStamped, "5f0fcd4f81d5d06ad9b4c4c63e3ea51b82d6ae4d0558f1d475229b1121db6f64"},
        {RosType::LaserScan, "64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828"},
        {RosType::Odometry, "3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0"},
        {RosType::OccupancyGrid,
         "8d348150c12913a31ee0ec170fbf25089e4745d17035792a1ba94d6f0bc0cfc7"},
        {RosType::CameraInfo, "b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275"},
        {RosType::MarkerArray, "86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf"},
        {RosType::DiagnosticArray,
         "5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e"},
        {RosType::Imu, "7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b"},
        {RosType::Illuminance, "b954b25f452fcf81a91c9c2a7e3b3fd85c4c873d452aecb3cfd8fd1da732a22d"},
        {RosType::Temperature, "72514a14126ab9f8a9abec974c78e5610a367b59db5da355ff1fb982d5bad4b8"},
        {RosType::Int32, "b6578ded3c58c626cfe8d1a6fb6e04f706f97e9f03d2727c9ff4e74b1cef0deb"},
        {RosType::Float64, "705ba9c3d1a09df43737eb67095534de36fd426c0587779bda2bc51fe790182a"},
        {RosType::String, "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"},
        {RosType::BatteryState, "4bee5dfce981c98faa6828b868307a0a73f992ed0789f374ee96c8f840e69741"},
        {RosType::JointState, "a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e"},
        {RosType::LiftState, "ce0553cd08eeeb321bdae554efdb6d2ebb2be9755df2e34895cbef55b51f4c06"},
        {RosType::LiftRequest, "e8f1e0aa4d172703d0d7840c1876448c6c5d75ab58955faf7de7dddc17c096ac"},
        {RosType::DoorRequest, "3145b5d97064f89b0a0db953b8167ddeeefbc2914c24a603c3bdc51f122f143e"},
        {RosType::FleetState, "9ea5bb9f2c076a587b20c04974581c8d8e2ec7d02300244f9e39e37d7d9192f4"},
        {RosType::Empty, "20b625256f32d5dbc0d04fee44f43c41e51c70d3502f84b4a08e7a9c26a96312"}};
    for (const auto& [type, hash] : kKnown)
        EXPECT_EQ(rosTypeHash(type), "RIHS01_" + std::string(hash)) << nameOf(type);
}

}  // namespace ros_type_hash_test
}  // namespace ispace::ros
