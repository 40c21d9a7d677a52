// SPDX-License-Identifier: GPL-3.0-or-later
// Files and frames of SDFormat (sdformat.org, specification 1.0 to 1.11; "Pose Frame Semantics",
// proposals for 1.7 and 1.8). No file is downloaded: a URI of Fuel is looked up in local folders.
// Each file is read once, each frame resolved once; cycles of includes and of frames are errors.
#include "extensions/gazebo/sdf_files.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/missed_files.h"
#include "base/number.h"
#include "io/exporters.h"
#include "io/import_records.h"
#include "io/importers.h"

namespace ispace::gazebo {

namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 3> kIncludable{"model", "light", "actor"};
/// Units of Budget for a file, however small: its nodes take 32 kB.
constexpr std::size_t kFileWork = 100;
std::size_t workOf(std::size_t bytes) { return kFileWork + Budget::unitsOf(bytes); }

/// Maximum number of missing models in a message.
constexpr std::size_t kMaxNamed = 8;

std::string joined(const std::string& folder, std::string_view path) {
    return (fs::path(folder) / path).lexically_normal().string();
}

/// Returns the path below a folder of models: the part after the last folder `models`.
std::string_view behindModels(std::string_view uri) {
    constexpr std::string_view kModels = "/models/";
    const std::size_t at = uri.rfind(kModels);
    if (at != std::string_view::npos) return uri.substr(at + kModels.size());
    const std::string_view first = kModels.substr(1);
    return uri.starts_with(first) ? uri.substr(first.size()) : std::string_view();
}

/// Returns the same for a model on Fuel, without its version: NAME/2, or NAME/tip/files/PATH.
std::string fuelPath(std::string_view uri) {
    const std::string_view path = behindModels(uri), name = path.substr(0, path.find('/'));
    constexpr std::string_view kFiles = "/files/";
    const std::size_t files = path.find(kFiles);
    return std::string(name) + '/' +
           std::string(files == std::string_view::npos ? "" : path.substr(files + kFiles.size()));
}

std::string withBlanks(std::string_view name) {
    std::string text(name);
    for (std::size_t at = 0; (at = text.find("%20", at)) != std::string::npos;)
        text.replace(at, 3, " ");
    return text;
}

bool isUrl(std::string_view uri) {
    return uri.starts_with("http://") || uri.starts_with("https://");
}

std::string_view uriOf(pugi::xml_node include) { return trimmed(include.child_value("uri")); }

/// Gazebo's sun and ground plane, from its own models or from Fuel.
bool isSurrounding(std::string_view uri) {
    const std::string_view path = isUrl(uri) ? behindModels(uri) : uri.substr(uri.rfind('/') + 1);
    const std::string_view last = path.substr(0, path.find('/'));
    std::string name = withBlanks(last);
    std::transform(name.begin(), name.end(), name.begin(), [](char c) {
        return c == ' ' ? '_' : c >= 'A' && c <= 'Z' ? char(c + 32) : c;
    });
    return name == "sun" || name == "ground_plane";
}

/// "1.10" is later than "1.9".
std::pair<int, int> versionOf(pugi::xml_node node) {
    const std::string_view text = node.attribute("version").value();
    std::pair<int, int> version{0, 0};
    const char* const end = text.data() + text.size();
    const auto [dot, error] = std::from_chars(text.data(), end, version.first);
    if (error == std::errc() && dot != end) std::from_chars(dot + 1, end, version.second);
    return version;
}

}  // namespace

std::vector<std::string> SdfFiles::pathsOf(pugi::xml_node node, std::string_view uri) const {
    std::vector<std::string> paths;
    const auto add_below_roots = [&](std::string_view path) {
        if (path.empty() || path.starts_with('/')) return;
        for (const std::string& root : roots_) paths.push_back(joined(root, path));
    };
    if (isUrl(uri)) {
        add_below_roots(withBlanks(fuelPath(uri)));
        return paths;
    }
    std::string_view path = uri;
    for (const std::string_view scheme : {"model://", "package://", "file://"})
        if (uri.starts_with(scheme)) path = uri.substr(scheme.size());
    if (path.empty()) return {};
    const std::string unescaped = withBlanks(path);
    const bool has_scheme = path.size() != uri.size();
    path = unescaped;
    const std::string& folder = fileOf(node).folder;
    if (!has_scheme || uri.starts_with("file://")) paths.push_back(joined(folder, path));
    if (has_scheme) {
        add_below_roots(path);
        if (!folder.empty()) paths.push_back(joined(joined(folder, ".."), path));
    }
    // The name may be that of the world's own folder, or of the package that both lie in.
    if (const std::size_t slash = path.find('/'); slash != std::string_view::npos && slash > 0) {
        paths.emplace_back(path.substr(slash + 1));
        paths.push_back(joined("..", path.substr(slash + 1)));
    }
    add_below_roots(behindModels(path));  // their position on another computer
    return paths;
}

SdfFiles::SdfFiles(std::string_view bytes, std::string name,
                   std::span<const std::string> model_folders, Budget& work)
    : roots_{"", "models", "../models"}, work_(work) {
    std::error_code ignored;
    const fs::path home = fs::absolute(name == "-" ? "." : fs::path(name).parent_path(), ignored);
    for (const std::string& folder : model_folders)
        if (std::string root = fs::proximate(fs::absolute(folder), home, ignored).string();
            !ignored)
            roots_.push_back(std::move(root));
    std::string identity = fs::weakly_canonical(name, ignored).string();
    files_.push_back(
        std::unique_ptr<File>(new File{XmlFile(bytes, std::move(name)), "", std::move(identity)}));
    by_document_.emplace(root().root().hash_value(), files_.back().get());
}

const SdfFiles::File& SdfFiles::fileOf(pugi::xml_node node) const {
    return *by_document_.at(node.root().hash_value());
}

bool SdfFiles::isThere(const std::string& path) const {
    try {
        return openSideFile(name(), path, false, roots_).has_value();
    } catch (const FormatError&) {
        noteMissed(sideFilePath(name(), path));
        return false;  // elsewhere, or not readable
    }
}

std::optional<std::string> SdfFiles::fileNamed(pugi::xml_node node, std::string_view uri) const {
    for (const std::string& path : pathsOf(node, uri)) {
        if (!isThere(path)) continue;
        if (!fs::path(path).is_absolute()) return path;
        std::error_code ignored;
        return fs::proximate(path, fs::absolute(sideFilePath(name(), "."), ignored), ignored)
            .string();
    }
    return std::nullopt;
}

void SdfFiles::spend(pugi::xml_node node, std::size_t units) {
    if (!work_.take(units))
        fail(node, "what the world includes and repeats makes " + work_.excess());
}

std::string SdfFiles::read(pugi::xml_node user, const std::string& path) {
    const std::string file = sideFilePath(name(), path);
    const std::size_t size = openRegular(file).size;
    if (std::find(sources_.begin(), sources_.end(), file) == sources_.end()) {
        sources_.push_back(file);
        work_.grant(size);
    }
    spend(user, workOf(size));
    return readAll(file);
}

/// Returns the file of a model, given its folder or file: the latest that its model.config names.
std::optional<std::string> SdfFiles::modelFile(pugi::xml_node include, const std::string& path) {
    std::error_code ignored;
    if (!fs::is_directory(sideFilePath(name(), path), ignored))
        return isThere(path) ? std::optional(path) : std::nullopt;
    std::string file = "model.sdf";
    if (const std::string config = joined(path, "model.config"); isThere(config)) {
        const XmlFile xml(read(include, config), sideFilePath(name(), config));
        std::pair<int, int> latest{-1, 0};
        for (const pugi::xml_node sdf : xml.root().children("sdf"))
            if (const auto version = versionOf(sdf); version > latest) {
                latest = version;
                file = trimmed(sdf.child_value());
            }
    }
    file = joined(path, file);
    return isThere(file) ? std::optional(file) : std::nullopt;
}

const std::optional<std::string>& SdfFiles::includedFile(pugi::xml_node include) {
    const auto [known, is_new] =
        found_.try_emplace({fileOf(include).folder, std::string(uriOf(include))});
    std::optional<std::string>& file = known->second;
    if (!is_new) return file;
    for (const std::string& path : pathsOf(include, uriOf(include)))
        if (file = modelFile(include, path); file) break;
    return file;
}

pugi::xml_node SdfFiles::load(pugi::xml_node include, const std::string& path) {
    pugi::xml_node& thing = loaded_[path];
    if (thing) return thing;
    std::error_code ignored;
    const std::string file = sideFilePath(name(), path);
    const std::string bytes = read(include, path);
    files_.push_back(std::unique_ptr<File>(
        new File{XmlFile(bytes, file), fs::path(path).parent_path().string(),
                 fs::weakly_canonical(file, ignored).string(), workOf(bytes.size())}));
    const XmlFile& xml = files_.back()->xml;
    by_document_.emplace(xml.root().root().hash_value(), files_.back().get());
    for (const char* kind : kIncludable)
        if (!thing) thing = xml.root().child(kind);
    if (!thing) xml.fail(xml.root(), "no `model` in it, but a world includes it");
    return thing;
}

void SdfFiles::enter(pugi::xml_node include, std::span<const pugi::xml_node> around) {
    const File& file = fileOf(included(include));
    spend(include, file.work);
    std::vector<const File*> users = {files_.front().get()};
    for (const pugi::xml_node other : around) users.push_back(&fileOf(included(other)));
    const auto same = std::find_if(users.begin(), users.end(), [&file](const File* user) {
        return user->identity == file.identity;
    });
    if (same == users.end()) return;
    std::string cycle;
    for (auto user = same; user != users.end(); ++user)
        cycle.append(displayName((*user)->xml.name())).append(" -> ");
    fail(include, "files include each other in a circle: " + cycle + file.xml.name());
}

void SdfFiles::loadIncludes(pugi::xml_node parent) {
    for (const pugi::xml_node include : parent.children("include")) {
        if (included_.contains(include.hash_value())) continue;
        if (const std::optional<std::string>& file = includedFile(include)) {
            included_[include.hash_value()] = load(include, *file);
            continue;
        }
        included_[include.hash_value()] = {};
        const std::string_view uri = uriOf(include);
        if (uri.empty()) fail(include, "`include` without `uri`");
        if (isSurrounding(uri)) continue;
        if (missing_.empty()) first_missing_ = include;
        if (std::string name = excerpt(uri);
            std::find(missing_.begin(), missing_.end(), name) == missing_.end())
            missing_.push_back(std::move(name));
    }
}

std::optional<Diagnostic> SdfFiles::missing() const {
    if (missing_.empty()) return std::nullopt;
    std::string names;
    for (std::size_t i = 0; i < std::min(missing_.size(), kMaxNamed); ++i)
        names += (i == 0 ? "" : ", ") + missing_[i];
    if (missing_.size() > kMaxNamed)
        names += " and " + std::to_string(missing_.size() - kMaxNamed) + " more";
    const XmlFile& xml = fileOf(first_missing_).xml;
    return Diagnostic{.file = xml.name(),
                      .line = xml.lineOf(first_missing_),
                      .column = 1,
                      .message = names + (missing_.size() == 1 ? " is" : " are") +
                                 " not in the world's folder, in ../models or below: say with "
                                 "--models DIR (or GAZEBO_MODEL_PATH) which folder holds the "
                                 "models, write the world with everything in it (`gz sdf -p`), or "
                                 "delete the `include`"};
}

pugi::xml_node SdfFiles::included(pugi::xml_node include) const {
    return included_.at(include.hash_value());
}

std::vector<double> SdfFiles::numbersOf(pugi::xml_node node, std::string_view text,
                                        std::size_t count) const {
    constexpr std::string_view kBlanks = " \t\r\n";
    std::vector<double> numbers;
    const auto refuse = [&] {
        fail(node, '`' + std::string(node.name()) + "`: found " + excerpt(text) + ", wanted " +
                       countText(count, "number"));
    };
    for (std::size_t at = 0;;) {
        at = std::min(text.find_first_not_of(kBlanks, at), text.size());
        if (at == text.size()) break;
        const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
        const auto number = parseDouble(text.substr(at, end - at));
        if (!number || numbers.size() == count) refuse();
        numbers.push_back(*number);
        at = end;
    }
    if (numbers.size() != count) refuse();
    return numbers;
}

std::vector<double> SdfFiles::numbersIn(pugi::xml_node parent, const char* key,
                                        std::size_t count) const {
    const pugi::xml_node node = parent.child(key);
    if (!node) fail(parent, '`' + std::string(parent.name()) + "` without `" + key + '`');
    return numbersOf(node, node.child_value(), count);
}

double SdfFiles::lengthIn(pugi::xml_node parent, const char* key) const {
    const double length = numbersIn(parent, key, 1).front();
    if (!(length > 0))
        fail(parent,
             std::string("a ") + key + " of " + formatDouble(length) + ", wanted more than 0");
    return length;
}

namespace {

constexpr int kMaxChain = 200;  // frames relative to frames

using Transform = Eigen::Isometry3d;

bool isInclude(pugi::xml_node node) { return std::string_view(node.name()) == "include"; }

/// Converts angles of files to radians: 1.5708 and the like become quarter turns.
Angle snappedAngle(double radians) {
    constexpr double kClose = 1e-3;  // degrees
    const double degrees = Angle::radians(radians).degrees();
    const double quarter = std::round(degrees / 90) * 90;
    return Angle::degrees(std::abs(degrees - quarter) < kClose ? quarter : degrees);
}

}  // namespace

pugi::xml_node SdfFrames::modelOf(pugi::xml_node node) const {
    return isInclude(node) ? files_.included(node) : node;
}

std::string_view SdfFrames::nameOf(pugi::xml_node node) const {
    const std::string_view own =
        isInclude(node) ? trimmed(node.child_value("name")) : std::string_view();
    return own.empty() ? modelOf(node).attribute("name").value() : own;
}

/// An include without a pose leaves the model's own.
pugi::xml_node SdfFrames::poseNode(pugi::xml_node node) const {
    const pugi::xml_node own = node.child("pose");
    return own ? own : modelOf(node).child("pose");
}

Transform SdfFrames::poseIn(pugi::xml_node node) const {
    const pugi::xml_node pose_node = poseNode(node);
    const std::string_view text = pose_node.child_value();
    if (trimmed(text).empty()) return Transform::Identity();
    Transform pose = Transform::Identity();
    if (std::string_view(pose_node.attribute("rotation_format").value()) == "quat_xyzw") {
        const std::vector<double> n = files_.numbersOf(pose_node, text, 7);
        const Eigen::Quaterniond turn(n[6], n[3], n[4], n[5]);
        if (!(turn.norm() > 0)) files_.fail(pose_node, "`pose`: a quaternion of length 0");
        pose.linear() = turn.normalized().toRotationMatrix();
        pose.translation() = Eigen::Vector3d(n[0], n[1], n[2]);
        return pose;
    }
    const std::vector<double> n = files_.numbersOf(pose_node, text, 6);
    const bool in_degrees = pose_node.attribute("degrees").as_bool();
    const auto turn = [&](int axis, double angle) {
        return turnAbout(axis, in_degrees ? Angle::degrees(angle) : snappedAngle(angle));
    };
    pose.linear() = (turn(2, n[5]) * turn(1, n[4]) * turn(0, n[3])).toRotationMatrix();
    pose.translation() = Eigen::Vector3d(n[0], n[1], n[2]);
    return pose;
}

const SdfScope& SdfFrames::scopeOf(pugi::xml_node node) {
    if (const auto known = scopes_.find(node.hash_value()); known != scopes_.end())
        return *known->second;
    SdfScope scope{modelOf(node)};
    files_.loadIncludes(scope.node);
    for (const pugi::xml_node child : scope.node.children()) {
        const std::string_view kind = child.name();
        const bool is_include = kind == "include" && files_.included(child);
        if (is_include && child.attribute("merge").as_bool())
            scope.merged.push_back(child);
        else if (is_include || kind == "model" || kind == "link" || kind == "frame" ||
                 kind == "joint")
            scope.children.emplace(nameOf(child), child);
    }
    auto& made = scopes_[node.hash_value()];
    made = std::make_unique<SdfScope>(std::move(scope));
    return *made;
}

Transform SdfFrames::frameCalled(std::string_view name, const SdfScope& scope, pugi::xml_node user,
                                 int length) {
    const bool is_world = std::string_view(scope.node.name()) == "world";
    if (name.empty() || name == "__model__" || (is_world && name == "world"))
        return Transform::Identity();
    const std::size_t colons = name.find("::");
    const std::string_view first = name.substr(0, colons);
    const auto child = scope.children.find(first);
    if (child != scope.children.end()) {
        const Transform& frame = frameOf(child->second, scope, length + 1);
        if (colons == std::string_view::npos) return frame;
        return frame *
               frameCalled(name.substr(colons + 2), scopeOf(child->second), user, length + 1);
    }
    for (const pugi::xml_node include : scope.merged)
        if (const SdfScope& inner = scopeOf(include); inner.children.contains(first))
            return frameOf(include, scope, length + 1) * frameCalled(name, inner, user, length + 1);
    files_.fail(user, "no frame called " + excerpt(name) + " beside it");
}

const Transform& SdfFrames::frameOf(pugi::xml_node node, const SdfScope& scope, int length) {
    if (const auto known = frames_.find(node.hash_value()); known != frames_.end())
        return *known->second;
    if (length > kMaxChain)
        files_.fail(node, "its pose is relative to itself, by more than " +
                              std::to_string(kMaxChain) + " frames");
    const std::string_view kind = node.name();
    std::string_view base = poseNode(node).attribute("relative_to").value();
    if (base.empty() && kind == "frame") base = node.attribute("attached_to").value();
    if (base.empty() && kind == "joint") base = trimmed(node.child_value("child"));
    Transform frame = frameCalled(base, scope, node, length) * poseIn(node);
    // The pose may be that of `placement_frame` in the model: convert it to the model's own frame.
    std::string_view placed = trimmed(node.child_value("placement_frame"));
    if (placed.empty()) placed = modelOf(node).attribute("placement_frame").value();
    if (!placed.empty()) frame = frame * frameCalled(placed, scopeOf(node), node, length).inverse();
    auto& made = frames_[node.hash_value()];
    made = std::make_unique<Transform>(frame);
    return *made;
}

}  // namespace ispace::gazebo
