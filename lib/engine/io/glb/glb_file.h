// SPDX-License-Identifier: GPL-3.0-or-later
// The container of GLB files, and the builder that glb_write.cc writes them with. glTF 2.0 (Khronos
// Group, 2021; ISO/IEC 12113): metres, +Y up, faces counter-clockwise, quaternions x y z w,
// little-endian 32-bit floats.
//
// glbChunks() is for untrusted bytes: each length is checked before it is used. The builder keeps
// JSON in sections of 1 MiB and vertices in blocks, so a large model is held once, not twice.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/json_writer.h"
#include "env/mesh.h"
#include "geom/rotation.h"
#include "io/glb/glb_write.h"
#include "record/record.h"

namespace ispace {

/// The chunks of a binary glTF 2.0 file that readers need.
struct GlbChunks {
    std::string_view json;    ///< never empty
    std::string_view binary;  ///< empty if the chunk is missing
};

/// Splits the container into chunks and checks every length against the available bytes. The chunks
/// point into `bytes`. \throws FormatError \pre isGlb(bytes)
GlbChunks glbChunks(std::string_view bytes, const std::string& name);

/// Writes the container: JSON, and the parts one after another as its binary data.
/// \throws FormatError for more than 2 GiB, which some readers take for a negative length
std::string glbContainer(std::string_view json, std::span<const std::string_view> parts);
/// Writes the container piece by piece; each piece of JSON is freed once it is written.
/// \throws FormatError as above, before anything is written
void writeGlbContainer(std::vector<std::string> json, std::span<const std::string_view> parts,
                       const ByteSink& sink);

/// Converts a vector to glTF's axes: its (X, Y, Z) are our (x, z, -y).
std::array<double, 3> gltfAxes(Vec3 v);

/// Rz(heading) Ry(-tilt) Rx(roll) in glTF's axes.
Eigen::Quaterniond rotationOf(const Pose3& pose);

/// Triangles as glTF draws them, in its axes, with a normal a face: vertices are shared only where
/// the normal is the same.
struct GlbSurface {
    using Vector = std::array<float, 3>;
    std::vector<Vector> positions, normals;
    std::vector<std::uint32_t> indices;
    std::vector<std::array<float, 2>> places =
        {};  ///< texture coordinates of each vertex; empty: untextured
};

/// Converts the mesh to floats relative to `origin`; skips slivers that floats cannot tell from a
/// line.
GlbSurface surfaceOf(const Mesh& mesh, Point3 origin);

/// A node of the file.
struct GlbNode {
    std::string name;
    std::string keyword;  ///< in its extras; "" omits it
    int mesh = -1;        ///< index as of GlbBuilder; -1: no mesh
    /// Pose of its mesh in glTF's axes; null: that of the whole room.
    struct Frame {
        std::array<double, 3> translation{};
        Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
        double scale = 1;
    };
    std::unique_ptr<const Frame> frame;
};

/// A sequence stored in blocks: it grows without moving its items.
template <typename T>
class Blocks {
  public:
    void append(const std::vector<T>& items) {
        if (blocks_.empty() || blocks_.back().capacity() - blocks_.back().size() < items.size()) {
            blocks_.emplace_back();
            blocks_.back().reserve(std::max(std::clamp(size_, kMinBlock, kMaxBlock), items.size()));
        }
        blocks_.back().insert(blocks_.back().end(), items.begin(), items.end());
        size_ += items.size();
    }
    [[nodiscard]] std::size_t bytes() const { return size_ * sizeof(T); }
    [[nodiscard]] std::vector<std::string_view> parts() const {
        std::vector<std::string_view> parts;
        for (const auto& block : blocks_)
            parts.emplace_back(reinterpret_cast<const char*>(block.data()),
                               block.size() * sizeof(T));
        return parts;
    }

  private:
    static constexpr std::size_t kMinBlock = 1 << 10, kMaxBlock = 1 << 17;

    std::vector<std::vector<T>> blocks_;
    std::size_t size_ = 0;
};

/// Collects nodes, meshes and data of a file, and writes it. The JSON begins with the members that
/// record readers need.
class GlbBuilder {
  public:
    struct Primitive {
        int positions = 0, normals = -1, places = -1, indices = 0;  ///< accessors; -1: absent
        int material = 0;
    };

    /// Creates a material on first use. \return its index
    int material(Material material, bool double_sided);
    /// Creates a material with a picture (PNG) as texture: coordinates are 0,0 at its upper left
    /// corner and 1,1 at the lower right one; beyond these its edge pixels repeat. \return its
    /// index
    /// \pre the picture is valid until finish(), and is the only one
    int pictureMaterial(std::string_view name, std::string_view png);
    /// \pre the surface has triangles; with texture coordinates it is valid until finish()
    Primitive add(const GlbSurface& surface, int material);
    /// Stores the mesh of a file in separate views, once per digest.
    /// \pre it has triangles and is valid until finish()
    Primitive add(const TriangleMesh& mesh, int material);
    /// \return its index \pre there are primitives
    int addMesh(std::string_view name, const std::vector<Primitive>& primitives);
    void addNode(const GlbNode& node);
    /// Returns the number of nodes so far.
    [[nodiscard]] int nodes() const { return nodes_; }
    /// Adds a node without mesh whose children are the nodes from this number on.
    void addGroup(const GlbNode& node, int first);

    /// Writes the whole file. All nodes, or all groups if there are any, are children of a node
    /// `root` at `origin`, in glTF's axes.
    /// \throws FormatError as writeGlbContainer does
    void finish(std::string_view records, const std::array<double, 3>& origin, const ByteSink& sink,
                std::string_view root = "room");

  private:
    // Accessors name views before the later ones are known: those of files follow the four.
    enum View : int { kRecords, kPositions, kNormals, kIndices, kFiles };
    struct ViewSpec {
        std::vector<std::string_view> data;  ///< in pieces
        int stride = 0;                      ///< bytes; 0 omits it
        int target = 0;                      ///< how glTF uses it; 0: not at all
    };
    struct FileMesh {
        std::string digest;
        int view = 0;  ///< of its positions; that of its indices follows
        Primitive primitive;
    };

    /// The items of a list in the file. Full blocks are moved to `full`.
    struct Section {
        JsonWriter json;
        std::vector<std::string> full;

        void putAside();
        [[nodiscard]] bool isEmpty() const { return full.empty() && json.text().empty(); }
    };

    int addAccessor(int view, std::size_t offset, std::size_t count, const char* type);
    int addView(const ViewSpec& view);
    JsonWriter& beginMaterial(std::string_view name);
    int addPositions(int view, std::size_t offset, const std::vector<GlbSurface::Vector>& points);
    void writeExtras(JsonWriter& json) const;
    static std::vector<std::string_view> writeViews(JsonWriter& json,
                                                    const std::vector<ViewSpec>& views);
    JsonWriter& beginNode(const GlbNode& node);
    void endNode(JsonWriter& json, const GlbNode& node);
    void writeScene(JsonWriter& json, const std::array<double, 3>& origin, std::string_view root);

    Blocks<GlbSurface::Vector> positions_, normals_;
    Blocks<std::uint32_t> indices_;
    std::vector<ViewSpec> file_views_;
    std::vector<FileMesh> files_;
    std::map<std::pair<Material, bool>, int> materials_;
    Section materials_json_, meshes_json_, accessors_json_, nodes_json_;
    int material_count_ = 0, meshes_ = 0, accessors_ = 0, nodes_ = 0;
    std::vector<int> groups_;
    int picture_view_ = -1;  ///< buffer view of the picture; -1: no picture
};

}  // namespace ispace
