// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/sdf_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <pugixml.hpp>
#include <unordered_map>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "io/import_records.h"
#include "io/input.h"

namespace ispace {

namespace {

using Transform = Eigen::Isometry3d;

constexpr int kDeepest = 64;        // models in models
constexpr int kLongestChain = 200;  // frames relative to frames

std::string_view nameOf(pugi::xml_node node) { return node.attribute("name").value(); }

/// A world or model: what its children's poses may be relative to.
struct Scope {
    pugi::xml_node node;
    Transform frame = Transform::Identity();
    std::unordered_map<std::string_view, pugi::xml_node> children = {};  ///< with a pose, by name
    mutable std::unordered_map<std::string_view, Transform> known = {};  ///< poses of them
};

class SdfReader {
  public:
    SdfReader(std::string_view bytes, const std::string& name, std::size_t most)
        : bytes_(bytes), name_(name), most_(most) {}

    SdfWorld read() {
        for (std::size_t i = 0; i < bytes_.size(); ++i)
            if (bytes_[i] == '\n') line_ends_.push_back(static_cast<std::ptrdiff_t>(i));
        const pugi::xml_parse_result result = file_.load_buffer(
            bytes_.data(), bytes_.size(), pugi::parse_default, pugi::encoding_utf8);
        if (!result) fail(lineAt(result.offset), std::string("bad XML: ") + result.description());
        const pugi::xml_node root = file_.document_element();
        const pugi::xml_node world = root.child("world");
        if (world.next_sibling("world"))
            fail(lineOf(world.next_sibling("world")), "a second world in one file, wanted one");
        if (!world && !root.child("model")) fail(lineOf(root), "no `world` and no `model` in it");
        addModels(scopeOf(world ? world : root, Transform::Identity()), "", 0);
        return std::move(found_);
    }

  private:
    [[noreturn]] void fail(int line, const std::string& message) const {
        failFile(name_, message, line);
    }
    [[nodiscard]] int lineAt(std::ptrdiff_t offset) const {
        const auto behind = std::lower_bound(line_ends_.begin(), line_ends_.end(), offset);
        return 1 + static_cast<int>(behind - line_ends_.begin());
    }
    [[nodiscard]] int lineOf(pugi::xml_node node) const { return lineAt(node.offset_debug()); }

    /// All numbers of a text. \throws FormatError unless there are `count`
    [[nodiscard]] std::vector<double> numbersOf(pugi::xml_node node, std::string_view text,
                                                std::size_t count) const {
        constexpr std::string_view kBlanks = " \t\r\n";
        std::vector<double> numbers;
        for (std::size_t at = 0;;) {
            at = std::min(text.find_first_not_of(kBlanks, at), text.size());
            if (at == text.size()) break;
            const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
            const auto number = parseDouble(text.substr(at, end - at));
            if (!number || numbers.size() == count)
                fail(lineOf(node), '`' + std::string(node.name()) + "`: found " + excerpt(text) +
                                       ", wanted " + countText(count, "number"));
            numbers.push_back(*number);
            at = end;
        }
        if (numbers.size() != count)
            fail(lineOf(node), '`' + std::string(node.name()) + "`: found " + excerpt(text) +
                                   ", wanted " + countText(count, "number"));
        return numbers;
    }
    [[nodiscard]] std::vector<double> numbersIn(pugi::xml_node parent, const char* key,
                                                std::size_t count) const {
        const pugi::xml_node node = parent.child(key);
        if (!node)
            fail(lineOf(parent), '`' + std::string(parent.name()) + "` without `" + key + '`');
        return numbersOf(node, node.child_value(), count);
    }
    [[nodiscard]] double lengthIn(pugi::xml_node parent, const char* key) const {
        const double length = numbersIn(parent, key, 1).front();
        if (!(length > 0))
            fail(lineOf(parent),
                 std::string("a ") + key + " of " + formatDouble(length) + ", wanted more than 0");
        return length;
    }

    /// What a `pose` says, in whatever frame.
    [[nodiscard]] Transform poseIn(pugi::xml_node parent) const {
        const pugi::xml_node node = parent.child("pose");
        const std::string_view text = node.child_value();
        if (trimmed(text).empty()) return Transform::Identity();
        Transform pose = Transform::Identity();
        if (std::string_view(node.attribute("rotation_format").value()) == "quat_xyzw") {
            const std::vector<double> n = numbersOf(node, text, 7);
            const Eigen::Quaterniond turn(n[6], n[3], n[4], n[5]);
            if (!(turn.norm() > 0)) fail(lineOf(node), "`pose`: a quaternion of length 0");
            pose.linear() = turn.normalized().toRotationMatrix();
            pose.translation() = Eigen::Vector3d(n[0], n[1], n[2]);
            return pose;
        }
        const std::vector<double> n = numbersOf(node, text, 6);
        const bool in_degrees = node.attribute("degrees").as_bool();
        const auto turn = [&](int axis, double angle) {
            return turnAbout(axis, in_degrees ? Angle::degrees(angle) : snappedAngle(angle));
        };
        pose.linear() = (turn(2, n[5]) * turn(1, n[4]) * turn(0, n[3])).toRotationMatrix();
        pose.translation() = Eigen::Vector3d(n[0], n[1], n[2]);
        return pose;
    }
    /// Radians as files have them: 1.5708 and its kin are meant to be quarter turns.
    static Angle snappedAngle(double radians) {
        constexpr double kClose = 1e-3;  // degrees
        const double degrees = Angle::radians(radians).degrees();
        const double quarter = std::round(degrees / 90) * 90;
        return Angle::degrees(std::abs(degrees - quarter) < kClose ? quarter : degrees);
    }

    [[nodiscard]] static Scope scopeOf(pugi::xml_node node, const Transform& frame) {
        Scope scope{node, frame};
        for (const pugi::xml_node child : node.children()) {
            const std::string_view kind = child.name();
            if (kind == "model" || kind == "link" || kind == "frame" || kind == "joint")
                scope.children.emplace(nameOf(child), child);
        }
        return scope;
    }

    /// The pose of a frame that an attribute names, in the world.
    [[nodiscard]] Transform frameCalled(std::string_view frame, const Scope& scope,
                                        pugi::xml_node user, int length) const {
        if (frame == "world" || frame == "__root__") return Transform::Identity();
        if (frame.empty() || frame == "__model__") return scope.frame;
        const std::size_t colons = frame.find("::");
        const auto child = scope.children.find(frame.substr(0, colons));
        if (child == scope.children.end())
            fail(lineOf(user), "no frame called " + excerpt(frame) + " beside it");
        if (colons == std::string_view::npos) return poseOf(child->second, scope, length + 1);
        return frameCalled(frame.substr(colons + 2), scopeIn(child->second, scope, length + 1),
                           user, length + 1);
    }

    /// The scope that a model in another one is; each is made once.
    [[nodiscard]] const Scope& scopeIn(pugi::xml_node model, const Scope& scope, int length) const {
        if (const auto known = scopes_.find(model.offset_debug()); known != scopes_.end())
            return *known->second;
        auto made = std::make_unique<Scope>(scopeOf(model, modelFrame(model, scope, length)));
        return *scopes_.emplace(model.offset_debug(), std::move(made)).first->second;
    }

    /// Pose of a link, joint, frame or model in the world.
    [[nodiscard]] Transform poseOf(pugi::xml_node node, const Scope& scope, int length) const {
        if (const auto known = scope.known.find(nameOf(node));
            known != scope.known.end() && scope.children.at(nameOf(node)) == node)
            return known->second;
        if (length > kLongestChain)
            fail(lineOf(node), "its pose is relative to itself, by more than " +
                                   std::to_string(kLongestChain) + " frames");
        const std::string_view kind = node.name();
        const pugi::xml_attribute relative = node.child("pose").attribute("relative_to");
        std::string_view base = relative.value();
        if (base.empty() && kind == "frame") base = node.attribute("attached_to").value();
        if (base.empty() && kind == "joint") base = trimmed(node.child_value("child"));
        Transform pose = frameCalled(base, scope, node, length) * poseIn(node);
        scope.known.emplace(nameOf(node), pose);
        return pose;
    }

    /// Where a model's own frame is: its pose may be that of a frame in it.
    [[nodiscard]] Transform modelFrame(pugi::xml_node model, const Scope& scope, int length) const {
        Transform pose = poseOf(model, scope, length);
        const std::string_view placed = model.attribute("placement_frame").value();
        if (placed.empty()) return pose;
        const Scope inner = scopeOf(model, Transform::Identity());
        return pose * frameCalled(placed, inner, model, length + 1).inverse();
    }

    void addModels(const Scope& scope, const std::string& outermost, int depth) {
        if (depth > kDeepest)
            fail(lineOf(scope.node),
                 "models nested more than " + std::to_string(kDeepest) + " deep");
        for (const pugi::xml_node include : scope.node.children("include"))
            // In nearly all worlds, and nothing that stands in the room.
            if (const std::string uri = printable(trimmed(include.child_value("uri")));
                uri != "model://sun" && uri != "model://ground_plane")
                ++found_.includes[uri];
        for (const pugi::xml_node model : scope.node.children("model")) {
            const Scope& inner = scopeIn(model, scope, 0);
            const std::string name = outermost.empty() ? std::string(nameOf(model)) : outermost;
            for (const pugi::xml_node link : model.children("link"))
                addLink(link, poseOf(link, inner, 0), inner, name);
            addModels(inner, name, depth + 1);
        }
        for (const char* kind : {"actor", "light", "population", "road"})
            for (const pugi::xml_node node : scope.node.children(kind)) {
                static_cast<void>(node);
                ++found_.left_out[kind];
            }
    }

    void addLink(pugi::xml_node link, const Transform& frame, const Scope& scope,
                 const std::string& model) {
        const char* kind = link.child("collision") ? "collision" : "visual";
        for (const pugi::xml_node node : link.children(kind)) {
            // Some sensors do not see it: it is a mark, or the body of a sensor.
            if (node.child("visibility_flags")) continue;
            const std::string_view base = node.child("pose").attribute("relative_to").value();
            const bool is_own = base.empty() || base == nameOf(link);
            const Transform pose =
                (is_own ? frame : frameCalled(base, scope, node, 0)) * poseIn(node);
            addShape(node.child("geometry").first_child(), pose, model);
        }
        for (const pugi::xml_node sensor : link.children("sensor")) {
            static_cast<void>(sensor);
            ++found_.left_out["sensor"];
        }
    }

    void addShape(pugi::xml_node node, const Transform& pose, const std::string& model) {
        while (node && node.type() != pugi::node_element) node = node.next_sibling();
        if (!node) return;
        const std::string_view kind = node.name();
        SdfShape shape{SdfBox(), pose, model, lineOf(node)};
        std::size_t cost = 1;
        if (kind == "box") {
            const std::vector<double> size = numbersIn(node, "size", 3);
            for (const double side : size)
                if (!(side > 0)) fail(lineOf(node), "a box with a side of " + formatDouble(side));
            shape.shape = SdfBox{{size[0], size[1], size[2]}};
        } else if (kind == "cylinder") {
            shape.shape = SdfCylinder{lengthIn(node, "radius"), lengthIn(node, "length")};
        } else if (kind == "polyline") {
            SdfPolyline polyline{{}, lengthIn(node, "height")};
            for (const pugi::xml_node point : node.children("point")) {
                const std::vector<double> at = numbersOf(point, point.child_value(), 2);
                polyline.points.push_back({at[0], at[1]});
            }
            cost += polyline.points.size();
            shape.shape = std::move(polyline);
        } else if (kind == "mesh") {
            SdfMesh mesh{std::string(trimmed(node.child_value("uri")))};
            if (node.child("scale")) {
                const std::vector<double> scale = numbersIn(node, "scale", 3);
                mesh.scale = {scale[0], scale[1], scale[2]};
            }
            if (node.child("submesh")) {
                ++found_.left_out["part of a mesh"];
                return;
            }
            shape.shape = std::move(mesh);
        } else {
            if (kind != "plane" && kind != "empty") ++found_.left_out[printable(kind)];
            return;
        }
        spent_ += cost;
        if (spent_ > most_)
            fail(lineOf(node),
                 "the world comes to more than " + std::to_string(most_) + " shapes and points");
        if (!pose.matrix().allFinite() || !(pose.translation().norm() <= kFarthestPlan))
            fail(lineOf(node),
                 "lies more than " + formatDouble(kFarthestPlan / 1000) + " km from the origin");
        found_.shapes.push_back(std::move(shape));
    }

    std::string_view bytes_;
    const std::string& name_;
    std::size_t most_, spent_ = 0;
    pugi::xml_document file_;
    mutable std::unordered_map<std::ptrdiff_t, std::unique_ptr<Scope>> scopes_;  // by their offset
    std::vector<std::ptrdiff_t> line_ends_;
    SdfWorld found_;
};

}  // namespace

SdfWorld readSdfShapes(std::string_view bytes, const std::string& name, std::size_t most) {
    return SdfReader(bytes, name, most).read();
}

}  // namespace ispace
