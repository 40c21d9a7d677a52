// SPDX-License-Identifier: GPL-3.0-or-later
// Checks a world as `ign sdf -k` does, reads it through libsdformat and prints its content, a line
// each, with all poses in the world's frame: read_sdf FILE [FOLDER...]. The folders hold included
// models. Exit status: 0 no errors, 1 errors, 2 usage.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <sdf/sdf.hh>
#include <string>

/// The command behind `ign sdf -k`, exported by libsdformat12 for Ruby: 0 and "Valid." on stdout,
/// or errors on stderr.
extern "C" int cmdCheck(const char* path);

namespace {

using ignition::math::Pose3d;

/// Maps minus zero, and rounding errors of zero, to zero.
double plain(double value) { return std::abs(value) < 5e-7 ? 0 : value; }

void print(const Pose3d& pose) {
    std::printf(" at %.6f %.6f %.6f rpy %.6f %.6f %.6f", plain(pose.Pos().X()),
                plain(pose.Pos().Y()), plain(pose.Pos().Z()), plain(pose.Rot().Roll()),
                plain(pose.Rot().Pitch()), plain(pose.Rot().Yaw()));
}

/// \return false if the frame's pose cannot be resolved
template <typename Item>
bool poseOf(const Item& item, const Pose3d& outer, Pose3d& pose) {
    const sdf::Errors errors = item.SemanticPose().Resolve(pose);
    for (const sdf::Error& error : errors) std::cerr << error.Message() << '\n';
    pose = outer * pose;
    return errors.empty();
}

void print(const sdf::Geometry& shape) {
    if (const auto* box = shape.BoxShape())
        std::printf(" box %.6f %.6f %.6f", box->Size().X(), box->Size().Y(), box->Size().Z());
    else if (const auto* cylinder = shape.CylinderShape())
        std::printf(" cylinder %.6f %.6f", cylinder->Radius(), cylinder->Length());
    else if (const auto* plane = shape.PlaneShape())
        std::printf(" plane %.6f %.6f", plane->Size().X(), plane->Size().Y());
    else if (const auto* mesh = shape.MeshShape())
        std::printf(" mesh %s %s", mesh->Uri().c_str(), mesh->Submesh().c_str());
    else if (shape.Element() != nullptr && shape.Element()->HasElement("polyline")) {
        int points = 0;
        auto polyline = shape.Element()->GetElement("polyline");
        for (auto p = polyline->GetElement("point"); p; p = p->GetNextElement("point")) ++points;
        std::printf(" polyline %d %.6f", points, polyline->Get<double>("height"));
    } else {
        std::printf(" nothing");
    }
}

void print(const sdf::Sensor& sensor) {
    std::printf(" rate %.6f", sensor.UpdateRate());
    if (const auto* lidar = sensor.LidarSensor())
        std::printf(" samples %u %u from %.6f to %.6f up %.6f %.6f range %.6f %.6f noise %.6f %.6f",
                    lidar->HorizontalScanSamples(), lidar->VerticalScanSamples(),
                    lidar->HorizontalScanMinAngle().Radian(),
                    lidar->HorizontalScanMaxAngle().Radian(),
                    lidar->VerticalScanMinAngle().Radian(), lidar->VerticalScanMaxAngle().Radian(),
                    lidar->RangeMin(), lidar->RangeMax(), lidar->LidarNoise().Mean(),
                    lidar->LidarNoise().StdDev());
    if (const auto* camera = sensor.CameraSensor())
        std::printf(" picture %u %u fov %.6f clip %.6f %.6f f %.6f %.6f c %.6f %.6f noise %.6f",
                    camera->ImageWidth(), camera->ImageHeight(), camera->HorizontalFov().Radian(),
                    camera->NearClip(), camera->FarClip(), camera->LensIntrinsicsFx(),
                    camera->LensIntrinsicsFy(), camera->LensIntrinsicsCx(),
                    camera->LensIntrinsicsCy(), camera->ImageNoise().StdDev());
}

bool printModel(const sdf::Model& model, const std::string& outer_name, const Pose3d& outer) {
    const std::string name = outer_name + model.Name();
    Pose3d frame;
    bool sound = poseOf(model, outer, frame);
    std::printf("model %s%s", name.c_str(), model.Static() ? " static" : "");
    print(frame);
    std::printf("\n");
    const auto item = [&](const char* kind, const auto& thing, const Pose3d& link) {
        Pose3d pose;
        sound = poseOf(thing, link, pose) && sound;
        std::printf("%s %s %s", kind, name.c_str(), thing.Name().c_str());
        print(pose);
    };
    for (uint64_t i = 0; i < model.LinkCount(); ++i) {
        const sdf::Link& link = *model.LinkByIndex(i);
        Pose3d place;
        sound = poseOf(link, frame, place) && sound;
        for (uint64_t k = 0; k < link.CollisionCount(); ++k) {
            item("collision", *link.CollisionByIndex(k), place);
            print(*link.CollisionByIndex(k)->Geom());
            std::printf("\n");
        }
        for (uint64_t k = 0; k < link.VisualCount(); ++k) {
            item("visual", *link.VisualByIndex(k), place);
            print(*link.VisualByIndex(k)->Geom());
            std::printf("\n");
        }
        for (uint64_t k = 0; k < link.SensorCount(); ++k) {
            item("sensor", *link.SensorByIndex(k), place);
            std::printf(" %s", link.SensorByIndex(k)->TypeStr().c_str());
            print(*link.SensorByIndex(k));
            std::printf("\n");
        }
    }
    for (uint64_t i = 0; i < model.ModelCount(); ++i)
        sound = printModel(*model.ModelByIndex(i), name + "::", frame) && sound;
    return sound;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        std::cerr << "read_sdf: wanted a file\n";
        return 2;
    }
    sdf::setFindCallback([&](const std::string& uri) {
        const std::string scheme = "model://";
        if (uri.rfind(scheme, 0) != 0) return std::string();
        for (int i = 2; i < argc; ++i) {
            std::string path = std::string(argv[i]) + '/' + uri.substr(scheme.size());
            if (std::filesystem::exists(path)) return path;
        }
        return std::string();
    });
    if (cmdCheck(argv[1]) != 0) return 1;
    sdf::Root root;
    const sdf::Errors errors = root.Load(argv[1]);
    for (const sdf::Error& error : errors) std::cerr << error.Message() << '\n';
    if (!errors.empty() || root.WorldCount() == 0) return 1;
    const sdf::World& world = *root.WorldByIndex(0);
    std::printf("world %s\n", world.Name().c_str());
    bool sound = true;
    for (uint64_t i = 0; i < world.ModelCount(); ++i)
        sound = printModel(*world.ModelByIndex(i), "", Pose3d()) && sound;
    return sound ? 0 : 1;
}
