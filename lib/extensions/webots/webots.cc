// SPDX-License-Identifier: GPL-3.0-or-later
// Solids of a world of Webots (Cyberbotics, Webots Reference Manual R2022a to R2023b): poses of
// nested nodes are multiplied, scales kept apart where a rotation does not mix their axes.
#include "extensions/webots/webots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "base/message.h"
#include "base/number.h"
#include "extensions/webots/vrml.h"
#include "extensions/worlds/world_import.h"
#include "geom/rotation.h"
#include "io/import_records.h"

namespace ispace::webots {

namespace {

using Transform = Eigen::Isometry3d;
using Eigen::Vector3d;

/// Units of Budget for a shape, which may become a wall.
constexpr std::size_t kShapeWork = 80;

constexpr double kQuarterTurn = std::numbers::pi / 2;
constexpr double kTurnDigits = 1e-5;  // radians: files have six digits
constexpr double kSameScale = 1e-9;

/// Doors at less than this aperture, in radians, are shut.
constexpr double kShutDoor = 0.1;

/// Nodes that have no shape: the surroundings, lights, and the meaning of materials.
const std::set<std::string_view>& shapelessTypes() {
    static const std::set<std::string_view> types = {"WorldInfo",
                                                     "Viewpoint",
                                                     "Background",
                                                     "TexturedBackground",
                                                     "DirectionalLight",
                                                     "PointLight",
                                                     "SpotLight",
                                                     "TexturedBackgroundLight",
                                                     "Fog",
                                                     "Physics",
                                                     "Billboard",
                                                     "Fluid"};
    return types;
}

/// Nodes with children in their frame.
bool isGroup(std::string_view type) {
    return type == "Solid" || type == "Pose" || type == "Transform" || type == "Group" ||
           type == "Slot" || type == "Charger" || type == "Connector" || type.ends_with("Joint");
}

/// Where a node stands: scaled first, then posed.
struct WebotsFrame {
    Transform pose = Transform::Identity();
    Vector3d scale = Vector3d::Ones();
};

/// What is known of the nodes around one.
struct WebotsContext {
    WebotsFrame frame = {};
    std::string model = {};    ///< name of the outermost solid
    bool takes_shapes = true;  ///< false: a boundingObject stands for them
    int depth = 0;
};

/// Sizes of a Wall, Door or Window, across the wall, along it and upwards, in metres.
struct WallSizes {
    std::array<double, 3> size{0.2, 1, 2.4}, frame{0.05, 0.05, 0.05};
    double sill = 0, opening_height = 2;
};

class WebotsReader {
  public:
    /// \param out for warnings
    WebotsReader(std::string_view bytes, const std::string& name, Budget& work, ImportRecords& out)
        : name_(name), work_(work), out_(out), file_(bytes, name, work) {}

    worlds::WorldShapes read() {
        checkVersion();
        const WebotsContext world{{worldFrame(), Vector3d::Ones()}};
        for (const VrmlNode* node : file_.roots()) visit(*node, world);
        return std::move(found_);
    }

  private:
    [[noreturn]] void fail(const VrmlNode& node, const std::string& message) const {
        failFile(name_, message, node.line);
    }

    /// \throws FormatError: before R2022a cylinders stood along y, and PROTOs had other sizes
    void checkVersion() const {
        const std::string_view version = file_.version();
        if (version.empty())
            failFile(name_, "the first line has no version, wanted one like #VRML_SIM R2023b utf8",
                     1);
        const auto year =
            version.starts_with('R') ? parseDouble(version.substr(1, 4)) : std::nullopt;
        if (!year || *year < 2022)
            failFile(name_,
                     "a world of Webots " + excerpt(version) +
                         ", which had other axes, wanted R2022a or later: convert it as Webots' "
                         "guide says under `How to adapt your world or PROTO to Webots R2022a`",
                     1);
    }

    /// Returns the pose of the file's axes in a frame with z up.
    [[nodiscard]] Transform worldFrame() const {
        Transform frame = Transform::Identity();
        for (const VrmlNode* node : file_.roots()) {
            if (node->type != "WorldInfo") continue;
            const std::string system = textOf(*node, "coordinateSystem", "ENU");
            if (system == "NUE" || system == "EUN") {  // x north, y up, z east
                frame.linear() << 0, 0, 1, 1, 0, 0, 0, 1, 0;
            } else if (system != "ENU") {
                fail(*node,
                     "coordinateSystem: " + excerpt(system) + " is none of ENU, NUE and EUN");
            }
        }
        return frame;
    }

    [[nodiscard]] static std::string textOf(const VrmlNode& node, std::string_view field,
                                            const std::string& standard) {
        const VrmlValue* value = node.field(field);
        return value == nullptr || value->texts.empty() ? standard : value->texts.front();
    }

    template <std::size_t kCount>
    [[nodiscard]] std::array<double, kCount> numbersOf(const VrmlNode& node, std::string_view field,
                                                       std::array<double, kCount> standard) const {
        const VrmlValue* value = node.field(field);
        if (value == nullptr) return standard;
        if (value->numbers.size() != kCount)
            fail(node, std::string(field) + " has " + std::to_string(value->numbers.size()) +
                           " numbers, wanted " + std::to_string(kCount));
        std::copy(value->numbers.begin(), value->numbers.end(), standard.begin());
        return standard;
    }

    /// \throws FormatError unless all are above 0
    template <std::size_t kCount>
    [[nodiscard]] std::array<double, kCount> lengthsOf(const VrmlNode& node, std::string_view field,
                                                       std::array<double, kCount> standard) const {
        const auto lengths = numbersOf(node, field, standard);
        for (const double length : lengths)
            if (!(length > 0))
                fail(node, std::string(field) + " of " + std::string(printable(node.type)) +
                               " is " + formatDouble(length) + ", wanted a length above 0");
        return lengths;
    }
    [[nodiscard]] double lengthOf(const VrmlNode& node, std::string_view field,
                                  double standard) const {
        return lengthsOf<1>(node, field, {standard}).front();
    }

    /// Returns the axis of a rotation at length 1; for 0 0 0 z, as Webots.
    [[nodiscard]] static Vector3d axisOf(const Vector3d& axis) {
        const double longest = axis.cwiseAbs().maxCoeff();
        if (longest == 0) return Vector3d::UnitZ();
        return (axis / longest).normalized();  // the squares of 1e300 are infinite
    }

    /// Computes the frame of a node's children. A scale along axes that a later rotation mixes
    /// cannot be kept.
    [[nodiscard]] std::optional<WebotsFrame> innerFrame(const VrmlNode& node,
                                                        const WebotsFrame& outer) const {
        const auto place = numbersOf<3>(node, "translation", {0, 0, 0});
        const auto turn = numbersOf<4>(node, "rotation", {0, 0, 1, 0});
        const auto scale = lengthsOf<3>(node, "scale", {1, 1, 1});
        Transform local = Transform::Identity();
        local.translation() = Vector3d(outer.scale.x() * place[0], outer.scale.y() * place[1],
                                       outer.scale.z() * place[2]);
        double angle = turn[3];
        if (const double quarters = std::round(angle / kQuarterTurn);
            std::abs(angle - quarters * kQuarterTurn) < kTurnDigits)
            angle = quarters * kQuarterTurn;
        local.linear() = Eigen::AngleAxisd(angle, axisOf(Vector3d(turn[0], turn[1], turn[2])))
                             .toRotationMatrix();
        WebotsFrame inner{outer.pose * local, Vector3d(scale[0], scale[1], scale[2])};
        // The outer scale along the axes after the rotation.
        const Eigen::Matrix3d turned =
            local.linear().transpose() * outer.scale.asDiagonal() * local.linear();
        const Eigen::Matrix3d off = turned - Eigen::Matrix3d(turned.diagonal().asDiagonal());
        if (off.cwiseAbs().maxCoeff() > kSameScale * outer.scale.maxCoeff()) return std::nullopt;
        inner.scale = inner.scale.cwiseProduct(turned.diagonal());
        return inner;
    }

    void visit(const VrmlNode& node, const WebotsContext& around) {
        if (!work_.take(1))
            fail(node, "its nodes, as often as they are used, make " + work_.excess());
        if (around.depth > VrmlFile::kMaxDepth)
            fail(node, "nodes nested more than " + std::to_string(VrmlFile::kMaxDepth) + " deep");
        const std::string_view type = node.type;
        if (shapelessTypes().contains(type)) return;
        if (type == "Shape") {
            if (around.takes_shapes) visitAll(node, "geometry", around);
        } else if (type == "Robot") {
            ++found_.left_out["Robot"];
        } else if (isGroup(type)) {
            visitGroup(node, around);
        } else if (!addGeometry(node, around) && !addKnownProto(node, around)) {
            ++found_.left_out["PROTO " + printable(type)];
        }
    }

    void visitAll(const VrmlNode& node, std::string_view field, WebotsContext context) {
        ++context.depth;
        if (const VrmlValue* value = node.field(field))
            for (const VrmlNode* child : value->nodes) visit(*child, context);
    }

    /// Returns the context of the nodes in one; std::nullopt, which is counted, for a scale that
    /// cannot be kept.
    std::optional<WebotsContext> enter(const VrmlNode& node, WebotsContext context,
                                       const char* standard_name) {
        const auto frame = innerFrame(node, context.frame);
        if (!frame) {
            ++found_.left_out["stretched node that is turned"];
            return std::nullopt;
        }
        context.frame = *frame;
        if (context.model.empty()) {
            context.model = textOf(node, "name", "");
            if (context.model.empty()) context.model = std::string(node.def);
            if (context.model.empty()) context.model = standard_name;
        }
        return context;
    }

    void visitGroup(const VrmlNode& node, const WebotsContext& around) {
        auto context = enter(node, around, "");
        if (!context) return;
        if (node.type == "Solid") {
            const VrmlValue* bound = node.field("boundingObject");
            context->takes_shapes = true;
            if (bound != nullptr && !bound->nodes.empty()) {
                visitAll(node, "boundingObject", *context);
                context->takes_shapes = false;
            }
        }
        visitAll(node, "children", *context);
        visitAll(node, "endPoint", *context);
    }

    void add(const VrmlNode& node, worlds::WorldShape shape) {
        if (!work_.take(kShapeWork))
            fail(node, "its shapes, as often as they are used, make " + work_.excess());
        if (!shape.world_from_shape.matrix().allFinite() ||
            !(shape.world_from_shape.translation().norm() <= kMaxPlanCoordinate))
            fail(node, "lies more than " + formatDouble(kMaxPlanCoordinate / 1000) +
                           " km from the origin");
        found_.shapes.push_back(std::move(shape));
    }

    /// Adds a box by its centre and sizes in the frame of the context.
    void addBox(const VrmlNode& node, const WebotsContext& around, const Vector3d& center,
                const Vector3d& size, bool is_wall = false,
                std::optional<worlds::WorldOpening> opening = {}) {
        const Vector3d& scale = around.frame.scale;
        worlds::WorldBox box;
        for (Eigen::Index i = 0; i < 3; ++i)
            box.size[static_cast<std::size_t>(i)] = scale(i) * size(i);
        box.opening = opening;
        box.is_wall = is_wall;
        Transform pose = around.frame.pose;
        pose.translate(Vector3d(scale.cwiseProduct(center)));
        add(node, {box, pose, around.model, node.line});
    }

    /// Adds a cylinder that stands along z.
    void addRound(const VrmlNode& node, const WebotsContext& around, double radius, double height,
                  bool is_ball = false) {
        const Vector3d& scale = around.frame.scale;
        if (std::abs(scale.x() - scale.y()) > kSameScale * scale.x() ||
            (is_ball && std::abs(scale.x() - scale.z()) > kSameScale * scale.x())) {
            addUnread("stretched " + printable(node.type), node, around, {});
            return;
        }
        Transform pose = around.frame.pose;
        if (is_ball) pose.linear().setIdentity();
        add(node, {worlds::WorldCylinder{scale.x() * radius, scale.z() * height}, pose,
                   around.model, node.line});
    }

    void addUnread(const std::string& kind, const VrmlNode& node, const WebotsContext& around,
                   const Box2& extent) {
        ++found_.left_out[kind];
        found_.unread.push_back({kind,
                                 {},
                                 worlds::floorOf(around.frame.pose.translation()),
                                 node.line,
                                 around.model.empty() ? "" : "the solid " + printable(around.model),
                                 extent});
    }

    /// Adds a geometry. \return false for other nodes
    bool addGeometry(const VrmlNode& node, const WebotsContext& around) {
        const std::string_view type = node.type;
        if (type == "Box") {
            const auto size = lengthsOf<3>(node, "size", {2, 2, 2});
            addBox(node, around, Vector3d::Zero(), Vector3d(size[0], size[1], size[2]));
        } else if (type == "Cylinder") {
            addRound(node, around, lengthOf(node, "radius", 1), lengthOf(node, "height", 2));
        } else if (type == "Cone") {  // stands on floor that its base covers
            addRound(node, around, lengthOf(node, "bottomRadius", 1), lengthOf(node, "height", 2));
        } else if (type == "Capsule") {
            const double radius = lengthOf(node, "radius", 1);
            addRound(node, around, radius, lengthOf(node, "height", 2) + 2 * radius);
        } else if (type == "Sphere") {
            const double radius = lengthOf(node, "radius", 1);
            addRound(node, around, radius, 2 * radius, true);
        } else if (type == "IndexedFaceSet") {
            addFaces(node, around);
        } else if (type == "Mesh" || type == "CadShape") {
            addUnread(std::string(type), node, around, {});
        } else if (type == "Plane") {
            ++found_.left_out["floor"];
        } else if (type == "ElevationGrid" || type == "IndexedLineSet" || type == "PointSet") {
            ++found_.left_out[std::string(type)];
        } else {
            return false;
        }
        return true;
    }

    /// Adds faces if their corners are those of a box along the axes.
    void addFaces(const VrmlNode& node, const WebotsContext& around) {
        const VrmlValue* coord = node.field("coord");
        const VrmlValue* points = coord == nullptr || coord->nodes.empty()
                                      ? nullptr
                                      : coord->nodes.front()->field("point");
        if (points == nullptr || points->numbers.empty()) return;  // no shape
        const std::vector<double>& numbers = points->numbers;
        if (numbers.size() % 3 != 0)
            fail(*coord->nodes.front(),
                 "point has " + std::to_string(numbers.size()) + " numbers, wanted three for each");
        if (!work_.take(numbers.size() / 3))
            fail(node, "its points, as often as they are used, make " + work_.excess());
        std::set<std::array<double, 3>> corners;
        Vector3d low = Vector3d::Constant(HUGE_VAL), high = -low;
        Box2 extent;
        for (std::size_t i = 0; i < numbers.size(); i += 3) {
            const Vector3d p(numbers[i], numbers[i + 1], numbers[i + 2]);
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
            extent.add(worlds::floorOf(around.frame.pose * around.frame.scale.cwiseProduct(p)));
            if (corners.size() <= 8) corners.insert({p.x(), p.y(), p.z()});
        }
        const bool is_box = corners.size() == 8 && std::ranges::all_of(corners, [&](const auto& p) {
                                for (Eigen::Index i = 0; i < 3; ++i)
                                    if (const double at = p[static_cast<std::size_t>(i)];
                                        at != low(i) && at != high(i))
                                        return false;
                                return true;
                            });
        if (is_box)
            addBox(node, around, (low + high) / 2, high - low);
        else
            addUnread("IndexedFaceSet", node, around, extent);
    }

    /// Adds one of the PROTOs that Webots has for rooms: x is across a wall, y along it.
    /// \return false for other nodes
    bool addKnownProto(const VrmlNode& node, const WebotsContext& around) {
        const std::string_view type = node.type;
        if (type == "Floor" || type == "Ceiling") {
            ++found_.left_out[type == "Floor" ? "floor" : "ceiling"];
            return true;
        }
        const bool is_wall = type == "Wall" || type == "Door" || type == "Window";
        if (!is_wall && type != "SolidBox" && type != "RectangleArena") return false;
        const auto context = enter(node, around,
                                   type == "Door"       ? "door"
                                   : type == "Window"   ? "window"
                                   : type == "SolidBox" ? "box"
                                                        : "wall");
        if (!context) return true;
        if (type == "RectangleArena") {
            addArena(node, *context);
        } else if (type == "SolidBox") {
            const auto size = lengthsOf<3>(node, "size", {2, 2, 2});
            addBox(node, *context, Vector3d::Zero(), Vector3d(size[0], size[1], size[2]));
        } else {
            const WallSizes sizes = type == "Window" ? windowSizesOf(node) : wallSizesOf(node);
            const auto& [x, y, z] = sizes.size;
            addBox(node, *context, Vector3d(0, 0, z / 2), Vector3d(x, y, z), true,
                   openingOf(node, context->frame.scale, sizes));
        }
        return true;
    }

    /// Reads those of a Wall or Door.
    [[nodiscard]] WallSizes wallSizesOf(const VrmlNode& node) const {
        WallSizes sizes;
        sizes.size = lengthsOf<3>(node, "size", sizes.size);
        if (node.type == "Wall") return sizes;
        sizes.frame = lengthsOf<3>(node, "frameSize", sizes.frame);
        sizes.opening_height = lengthOf(node, "frameHeight", sizes.opening_height);
        return sizes;
    }

    /// Reads those of a Window. Webots replaces all by its own where they contradict each other.
    [[nodiscard]] WallSizes windowSizesOf(const VrmlNode& node) {
        constexpr WallSizes kStandard{{0.2, 0.8, 2.4}, {0.05, 0.02, 0.05}, 0.7, 1.4};
        WallSizes sizes = kStandard;
        sizes.size = lengthsOf<3>(node, "size", sizes.size);
        sizes.frame = lengthsOf<3>(node, "frameSize", sizes.frame);
        sizes.sill = numbersOf<1>(node, "bottomWallHeight", {sizes.sill}).front();
        sizes.opening_height = lengthOf(node, "windowHeight", sizes.opening_height);
        if (sizes.sill < 0) fail(node, "bottomWallHeight is below 0");
        std::string fault;
        if (sizes.opening_height <= 2 * sizes.frame[2])
            fault =
                "frameSize leaves no glass of windowHeight " + formatDouble(sizes.opening_height);
        else if (sizes.opening_height + sizes.sill > sizes.size[2])
            fault = "bottomWallHeight " + formatDouble(sizes.sill) + " and windowHeight " +
                    formatDouble(sizes.opening_height) + " are more than the height in size, " +
                    formatDouble(sizes.size[2]);
        else if (sizes.size[0] <= 2 * sizes.frame[0])
            fault = "frameSize leaves no glass of the thickness in size, " +
                    formatDouble(sizes.size[0]);
        if (fault.empty()) return sizes;
        if (warned_.insert(&node).second)
            out_.warn(
                "Window: " + fault + ": taken with the sizes that Webots gives it, 0.2 0.8 2.4",
                node.line);
        return kStandard;
    }

    /// Returns false for a Door without a joint, which `position` does not move.
    [[nodiscard]] static bool canBeOpen(const VrmlNode& door) {
        const VrmlValue* value = door.field("canBeOpen");
        return value == nullptr || value->word != "FALSE";
    }

    /// Returns the opening in a Door or Window, between the posts of its frame.
    [[nodiscard]] std::optional<worlds::WorldOpening> openingOf(const VrmlNode& node,
                                                                const Vector3d& scale,
                                                                const WallSizes& sizes) const {
        if (node.type == "Wall") return std::nullopt;
        worlds::WorldOpening opening;
        opening.width = scale.y() * (sizes.size[1] - 2 * sizes.frame[1]);
        if (!(opening.width > 0)) fail(node, "its frame is as wide as the opening");
        opening.is_window = node.type == "Window";
        opening.sill = scale.z() * sizes.sill;
        opening.height = scale.z() * sizes.opening_height;
        const double position = numbersOf<1>(node, "position", {0}).front();
        opening.is_open = canBeOpen(node) && std::abs(position) > kShutDoor;
        return opening;
    }

    /// Adds the four walls around a floor.
    void addArena(const VrmlNode& node, const WebotsContext& context) {
        const auto [length, width] = lengthsOf<2>(node, "floorSize", {1, 1});
        const double thickness = lengthOf(node, "wallThickness", 0.01);
        const double height = lengthOf(node, "wallHeight", 0.1);
        ++found_.left_out["floor"];
        for (const double side : {1.0, -1.0}) {
            addBox(node, context, Vector3d(side * (length + thickness) / 2, 0, height / 2),
                   Vector3d(thickness, width, height), true);
            addBox(node, context, Vector3d(0, side * (width + thickness) / 2, height / 2),
                   Vector3d(length + 2 * thickness, thickness, height), true);
        }
    }

    const std::string& name_;
    Budget& work_;
    ImportRecords& out_;
    VrmlFile file_;
    worlds::WorldShapes found_;
    std::set<const VrmlNode*> warned_;  // those that USE repeats
};

}  // namespace

bool isWebotsWorld(std::string_view bytes) { return bytes.starts_with("#VRML_SIM"); }

Document readWebots(std::string_view bytes, const std::string& name, const ImportOptions& options,
                    const Schemas& schemas) {
    ImportRecords out(schemas, name, options);
    Budget work(bytes.size(), options.max_work);
    withFileName(name, [&] {
        worlds::writeWorldRoom(WebotsReader(bytes, name, work, out).read(), name, options, schemas,
                               work, out);
    });
    return out.take();
}

std::span<const Importer> webotsImporters() {
    static constexpr Importer kRows[] = {
        importer<isWebotsWorld, readWebots>("a Webots world"),
    };
    return kRows;
}

}  // namespace ispace::webots
