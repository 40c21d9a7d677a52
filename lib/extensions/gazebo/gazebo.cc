// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes of a world in SDF, with the frames of their models, as solids of lib/extensions/worlds.
// Collisions count, since they stop robots; visuals only of links without collisions.
#include "extensions/gazebo/gazebo.h"

#include <cmath>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <utility>

#include "base/message.h"
#include "base/number.h"
#include "extensions/gazebo/model_path.h"
#include "extensions/gazebo/sdf_files.h"
#include "extensions/worlds/world_import.h"
#include "io/import_records.h"
#include "io/mesh_files.h"

namespace ispace::gazebo {

namespace {

using Transform = Eigen::Isometry3d;

constexpr int kMaxDepth = 64;  // models in models

/// Units of Budget for a shape, which may become a wall, and for a point of a polyline.
constexpr std::size_t kShapeWork = 80, kPointWork = 10;

/// The rotation from one direction to another, less than half a turn away: that of
/// FromTwoVectors(), which takes seconds to compile for opposite ones.
Eigen::Quaterniond smallTurn(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const Eigen::Vector3d a = from.normalized(), b = to.normalized();
    const Eigen::Vector3d axis = a.cross(b);
    const double s = std::sqrt((1 + b.dot(a)) * 2), inverse = 1 / s;
    return {s * 0.5, axis.x() * inverse, axis.y() * inverse, axis.z() * inverse};
}

/// Turns a pose that physics has tilted a little, as by gravity on a floor, back upright.
Transform levelled(Transform pose) {
    constexpr double kSettled = 2e-3;  // sine of the angle
    for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d axis = pose.linear().col(i);
        if (std::hypot(axis.x(), axis.y()) > kSettled) continue;
        const Eigen::Vector3d upright(0, 0, std::copysign(1.0, axis.z()));
        pose.linear() = smallTurn(axis, upright) * pose.linear();
        break;
    }
    return pose;
}

class SdfReader {
  public:
    SdfReader(std::string_view bytes, const std::string& name,
              std::span<const std::string> model_folders, Budget& work)
        : files_(bytes, name, model_folders, work) {}

    worlds::WorldShapes read() {
        const pugi::xml_node root = files_.root();
        const pugi::xml_node world = root.child("world");
        if (world.next_sibling("world"))
            files_.fail(world.next_sibling("world"), "a second world in one file, wanted one");
        if (!world && !root.child("model")) files_.fail(root, "no `world` and no `model` in it");
        findStates(world);
        addModels(frames_.scopeOf(world ? world : root), Transform::Identity(), {});
        found_.sources = files_.sources();
        found_.missing = files_.missing();
        return std::move(found_);
    }

  private:
    /// The context of a link.
    struct Around {
        std::string model = "";  // the outermost one
        int line = 0;            // of the outermost include; 0: not included
        int depth = 0;
    };

    /// The poses in the world of a model and its links, as a running simulation saved them.
    struct State {
        std::optional<Transform> pose = {};
        std::map<std::string_view, Transform> links = {};
    };

    /// Reads the state of the world, which Gazebo applies after it has built the models.
    void findStates(pugi::xml_node world) {
        for (const pugi::xml_node model : world.child("state").children("model")) {
            State& state = states_[model.attribute("name").value()];
            if (model.child("pose")) state.pose = levelled(frames_.poseIn(model));
            for (const pugi::xml_node link : model.children("link"))
                if (link.child("pose"))
                    state.links[link.attribute("name").value()] = levelled(frames_.poseIn(link));
        }
    }

    /// Returns the state of a model of the world; null for others.
    [[nodiscard]] const State* stateOf(std::string_view model, const Around& around) const {
        const auto found = around.depth == 0 ? states_.find(model) : states_.end();
        return found == states_.end() ? nullptr : &found->second;
    }

    void addModels(const SdfScope& scope, const Transform& world_from_scope, const Around& around) {
        if (around.depth > kMaxDepth)
            files_.fail(scope.node,
                        "models nested more than " + std::to_string(kMaxDepth) + " deep");
        for (const pugi::xml_node node : scope.node.children()) {
            std::string_view kind = node.name();
            const bool is_include = kind == "include";
            if (is_include) kind = files_.included(node).name();
            if (kind == "model")
                addModel(node, scope, world_from_scope, around, is_include);
            else if (kind == "actor" || kind == "light" || kind == "population" || kind == "road")
                ++found_.left_out[std::string(kind)];
        }
    }

    void addModel(pugi::xml_node node, const SdfScope& scope, const Transform& world_from_scope,
                  Around around, bool is_include) {
        if (is_include) {
            files_.enter(node, includes_);
            includes_.push_back(node);
        }
        const SdfScope& inner = frames_.scopeOf(node);
        const State* const state = stateOf(frames_.nameOf(node), around);
        const Transform frame = state != nullptr && state->pose
                                    ? *state->pose
                                    : world_from_scope * frames_.frameOf(node, scope);
        if (around.model.empty()) around.model = frames_.nameOf(node);
        if (is_include && around.line == 0) around.line = files_.lineOf(node);
        ++around.depth;
        for (const pugi::xml_node link : inner.node.children("link"))
            addLink(link, frame, inner, around, state);
        addModels(inner, frame, around);
        if (is_include) includes_.pop_back();
    }

    void addLink(pugi::xml_node link, const Transform& world_from_model, const SdfScope& model,
                 const Around& around, const State* state) {
        Transform frame = frames_.frameOf(link, model);
        if (state != nullptr)
            if (const auto moved = state->links.find(frames_.nameOf(link));
                moved != state->links.end())
                frame = world_from_model.inverse() * moved->second;
        const char* kind = link.child("collision") ? "collision" : "visual";
        for (const pugi::xml_node node : link.children(kind)) {
            // Some sensors do not see it: it is a mark, or the body of a sensor.
            if (node.child("visibility_flags")) continue;
            const std::string_view base = node.child("pose").attribute("relative_to").value();
            const bool is_own = base.empty() || base == frames_.nameOf(link);
            const Transform pose =
                (is_own ? frame : frames_.frameCalled(base, model, node)) * frames_.poseIn(node);
            addShape(node.child("geometry").first_child(), world_from_model * pose, around);
        }
        for (const pugi::xml_node sensor : link.children("sensor")) {
            static_cast<void>(sensor);
            ++found_.left_out["sensor"];
        }
    }

    void addShape(pugi::xml_node node, const Transform& pose, const Around& around) {
        while (node && node.type() != pugi::node_element) node = node.next_sibling();
        if (!node) return;
        const std::string_view kind = node.name();
        worlds::WorldShape shape{worlds::WorldBox(), pose, around.model,
                                 around.line == 0 ? files_.lineOf(node) : around.line};
        files_.spend(node, kShapeWork);
        if (kind == "box") {
            const std::vector<double> size = files_.numbersIn(node, "size", 3);
            for (const double side : size)
                if (!(side > 0)) files_.fail(node, "a box with a side of " + formatDouble(side));
            shape.shape = worlds::WorldBox{{size[0], size[1], size[2]}};
        } else if (kind == "cylinder" || kind == "cone") {
            // A cone stands on floor that its base covers.
            shape.shape = worlds::WorldCylinder{files_.lengthIn(node, "radius"),
                                                files_.lengthIn(node, "length")};
        } else if (kind == "capsule") {
            const double radius = files_.lengthIn(node, "radius");
            shape.shape =
                worlds::WorldCylinder{radius, files_.lengthIn(node, "length") + 2 * radius};
        } else if (kind == "sphere") {
            const double radius = files_.lengthIn(node, "radius");
            shape.shape = worlds::WorldCylinder{radius, 2 * radius};
            shape.world_from_shape.linear().setIdentity();
        } else if (kind == "ellipsoid") {
            const std::vector<double> radii = files_.numbersIn(node, "radii", 3);
            for (const double radius : radii)
                if (!(radius > 0))
                    files_.fail(node, "an ellipsoid with a radius of " + formatDouble(radius));
            if (radii[0] == radii[1])
                shape.shape = worlds::WorldCylinder{radii[0], 2 * radii[2]};
            else
                shape.shape = worlds::WorldBox{{2 * radii[0], 2 * radii[1], 2 * radii[2]}};
        } else if (kind == "polyline") {
            worlds::WorldPolyline polyline{{}, files_.lengthIn(node, "height")};
            for (const pugi::xml_node point : node.children("point")) {
                const std::vector<double> at = files_.numbersOf(point, point.child_value(), 2);
                polyline.points.push_back({at[0], at[1]});
            }
            files_.spend(node, kPointWork * polyline.points.size());
            shape.shape = std::move(polyline);
        } else if (kind == "mesh") {
            worlds::WorldMesh mesh{std::string(trimmed(node.child_value("uri"))), {}};
            if (hasMeshSuffix(mesh.uri)) mesh.file = files_.fileNamed(node, mesh.uri);
            if (node.child("scale")) {
                const std::vector<double> scale = files_.numbersIn(node, "scale", 3);
                mesh.scale = {scale[0], scale[1], scale[2]};
            }
            mesh.is_part = node.child("submesh");
            shape.shape = std::move(mesh);
        } else {
            // Planes and heightmaps are ground.
            if (kind == "heightmap")
                ++found_.left_out[std::string(kind)];
            else if (kind != "plane" && kind != "empty")
                addUnread(printable(kind), shape, pose);
            return;
        }
        if (!pose.matrix().allFinite() || !(pose.translation().norm() <= kMaxPlanCoordinate))
            files_.fail(node, "lies more than " + formatDouble(kMaxPlanCoordinate / 1000) +
                                  " km from the origin");
        found_.shapes.push_back(std::move(shape));
    }

    void addUnread(const std::string& kind, const worlds::WorldShape& shape,
                   const Transform& pose) {
        ++found_.left_out[kind];
        found_.unread.push_back({kind,
                                 {},
                                 Point2{pose.translation().x(), pose.translation().y()},
                                 shape.line,
                                 "the model " + printable(shape.model)});
    }

    SdfFiles files_;
    SdfFrames frames_{files_};
    std::vector<pugi::xml_node> includes_;      // that led to the model being read
    std::map<std::string_view, State> states_;  // of the world's models, by name
    worlds::WorldShapes found_;
};

}  // namespace

bool isSdf(std::string_view bytes) { return xmlRootName(bytes) == "sdf"; }

Document readSdf(std::string_view bytes, const std::string& name, const ImportOptions& options,
                 const Schemas& schemas) {
    ImportRecords out(schemas, name, options);
    Budget work(bytes.size(), options.max_work);
    withFileName(name, [&] {
        std::vector<std::string> folders = options.own.get<ModelFolders>().folders;
        for (std::string& folder : modelPath()) folders.push_back(std::move(folder));
        worlds::WorldShapes world = SdfReader(bytes, name, folders, work).read();
        worlds::writeWorldRoom(std::move(world), name, options, schemas, work, out);
    });
    return out.take();
}

std::span<const Importer> gazeboImporters() {
    static constexpr Importer kRows[] = {importer<isSdf, readSdf>("SDF")};
    return kRows;
}

}  // namespace ispace::gazebo
