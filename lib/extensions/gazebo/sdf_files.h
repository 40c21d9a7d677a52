// SPDX-License-Identifier: GPL-3.0-or-later
// Worlds of Gazebo in SDF: their files, and the frames of poses in them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <pugixml.hpp>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/budget.h"
#include "base/error.h"
#include "geom/rotation.h"
#include "io/xml_file.h"

namespace ispace::gazebo {

/// A world in SDF and the files that it names: models and meshes. They must lie, links followed,
/// below one of its folders of models: the world's folder, `models` in and beside it, and
/// `model_folders`.
///
/// The name in `model://NAME/…` and `package://NAME/…` is that of a folder in one of these, in this
/// order, or beside the model that names it; or the world's own folder or package. `file://` leads
/// to a file by its path, relative to the file that holds it or to one of the folders. Other paths
/// are relative to the file that holds them. A URI of Fuel counts as the model's name: the library
/// never downloads.
class SdfFiles {
  public:
    /// \param model_folders relative to the current one
    /// \param work of the world; outlives this object
    /// \throws FormatError with the line: bad XML
    SdfFiles(std::string_view bytes, std::string name, std::span<const std::string> model_folders,
             Budget& work);

    [[nodiscard]] pugi::xml_node root() const { return files_.front()->xml.root(); }

    /// Reads the files that a world or model includes, each once.
    /// \throws FormatError with the line: files without a model, light or actor, and as spend()
    void loadIncludes(pugi::xml_node parent);
    /// Returns the message about all files so far that are missing, at the first `include` of one.
    /// Gazebo's sun and ground plane are no part of a room and never missing.
    [[nodiscard]] std::optional<Diagnostic> missing() const;
    /// Returns the included model, light or actor; all includes of a file share its nodes. Null if
    /// the file is missing.
    /// \pre loadIncludes(its parent)
    [[nodiscard]] pugi::xml_node included(pugi::xml_node include) const;
    /// Takes the work of visiting the nodes of an included file.
    /// \param around includes that led to this one, the outermost first
    /// \throws FormatError if one of them, or the world, is the same file; and as spend()
    void enter(pugi::xml_node include, std::span<const pugi::xml_node> around);

    /// Files read besides the world, each once, as opened.
    [[nodiscard]] const std::vector<std::string>& sources() const { return sources_; }
    /// Finds the file that a node names, relative to the folder of the world; std::nullopt if
    /// missing.
    [[nodiscard]] std::optional<std::string> fileNamed(pugi::xml_node node,
                                                       std::string_view uri) const;
    [[nodiscard]] int lineOf(pugi::xml_node node) const { return fileOf(node).xml.lineOf(node); }
    /// Takes units of work for a node, see Budget. \throws FormatError at the node if fewer units
    /// are left
    void spend(pugi::xml_node node, std::size_t units);
    /// \throws FormatError at the node's line of its file
    [[noreturn]] void fail(pugi::xml_node node, const std::string& message) const {
        fileOf(node).xml.fail(node, message);
    }

    /// Parses all numbers of a text. \throws FormatError unless there are `count`
    [[nodiscard]] std::vector<double> numbersOf(pugi::xml_node node, std::string_view text,
                                                std::size_t count) const;
    /// Parses all numbers of a child's text.
    [[nodiscard]] std::vector<double> numbersIn(pugi::xml_node parent, const char* key,
                                                std::size_t count) const;
    /// Parses a number above 0.
    [[nodiscard]] double lengthIn(pugi::xml_node parent, const char* key) const;

  private:
    struct File {
        XmlFile xml;
        std::string folder;    // relative to that of the world
        std::string identity;  // its path without links and detours
        std::size_t work = 0;  // of visiting it
    };
    [[nodiscard]] const File& fileOf(pugi::xml_node node) const;
    /// Returns the paths that a URI may mean, relative to the folder of the world, the likeliest
    /// first.
    [[nodiscard]] std::vector<std::string> pathsOf(pugi::xml_node node, std::string_view uri) const;
    [[nodiscard]] bool isThere(const std::string& path) const;
    std::optional<std::string> modelFile(pugi::xml_node include, const std::string& path);
    const std::optional<std::string>& includedFile(pugi::xml_node include);
    /// \throws FormatError as spend()
    std::string read(pugi::xml_node user, const std::string& path);
    /// Returns the model, light or actor of a file.
    pugi::xml_node load(pugi::xml_node include, const std::string& path);
    [[nodiscard]] const std::string& name() const { return files_.front()->xml.name(); }

    std::vector<std::string> roots_;            // folders of models, relative to the world's
    std::vector<std::unique_ptr<File>> files_;  // the world first
    std::unordered_map<std::size_t, const File*> by_document_;
    std::unordered_map<std::size_t, pugi::xml_node> included_;  // by the include
    std::unordered_map<std::string, pugi::xml_node> loaded_;    // by path
    // The file that a URI means in a folder.
    std::map<std::pair<std::string, std::string>, std::optional<std::string>> found_;
    std::vector<std::string> sources_;
    std::vector<std::string> missing_;  // as the first includes name them
    pugi::xml_node first_missing_;
    Budget& work_;
};

/// A world or model of SDF, and the children that poses in it can refer to.
struct SdfScope {
    pugi::xml_node node;  ///< of a model included, in its own file
    /// Children with a pose, by name; for included models, their `include`.
    std::unordered_map<std::string_view, pugi::xml_node> children = {};
    std::vector<pugi::xml_node> merged =
        {};  ///< includes with children that count as children of this scope
};

/// Computes poses of SDF 1.0 to 1.11, each in the scope's own frame: nested models, frames,
/// `relative_to`, `attached_to`, `placement_frame`, and includes with a pose. Each pose is resolved
/// once, in O(1).
///
/// All functions throw FormatError with the line: malformed numbers, frames that are missing or
/// depend on each other, and the errors of SdfFiles.
class SdfFrames {
  public:
    using Transform = Eigen::Isometry3d;

    explicit SdfFrames(SdfFiles& files) : files_(files) {}

    /// Returns the scope of a world, a `model`, or an `include` with one.
    const SdfScope& scopeOf(pugi::xml_node node);
    /// Computes the frame of a link, joint, frame, model or include in the scope. \param length of
    /// the chain
    /// of frames that led to it
    const Transform& frameOf(pugi::xml_node node, const SdfScope& scope, int length = 0);
    /// Computes the frame that an attribute of `user` names; "": the scope's own.
    Transform frameCalled(std::string_view name, const SdfScope& scope, pugi::xml_node user,
                          int length = 0);
    /// Parses the `pose` in the node, regardless of its frame.
    [[nodiscard]] Transform poseIn(pugi::xml_node node) const;
    [[nodiscard]] std::string_view nameOf(pugi::xml_node node) const;

  private:
    [[nodiscard]] pugi::xml_node modelOf(pugi::xml_node node) const;
    [[nodiscard]] pugi::xml_node poseNode(pugi::xml_node node) const;

    SdfFiles& files_;
    std::unordered_map<std::size_t, std::unique_ptr<SdfScope>> scopes_;  // by node
    std::unordered_map<std::size_t, std::unique_ptr<Transform>> frames_;
};

}  // namespace ispace::gazebo
