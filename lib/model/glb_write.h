// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "base/byte_sink.h"
#include "layout/scene.h"
#include "record/record.h"

namespace ispace {

/// A picture that covers a rectangle of the floor, its upper edge at the high y.
struct FloorPicture {
    std::string name;  ///< of the material
    Box2 limits;
    std::string png;
};

/// The compiled form: binary glTF 2.0, one named node per element (and sensor body), shared
/// materials with colours, normals, metres, +Y up; the records of `document` as canonical text
/// with magic and history in a buffer view of their own whose index is `extras.ispace` of the
/// top level. Equal input gives equal bytes.
///
/// The contents of mesh files are stored once each, in the file's own numbers: nodes turn, scale
/// and move them. `extras.ispace_meshes` names digest, positions (3 floats a vertex) and indices
/// (3 uint32 a triangle) of each by their buffer views; records find theirs by `digest`.
/// \param picture laid on the floor of the indoor region instead of its colour; null for none
/// \throws FormatError for a model of more than 2 GiB
std::string writeGlb(const Scene& scene, const Document& document,
                     const FloorPicture* picture = nullptr);
/// The same piece by piece: nobody holds the file as a whole.
void writeGlb(const Scene& scene, const Document& document, const ByteSink& sink,
              const FloorPicture* picture = nullptr);

}  // namespace ispace
