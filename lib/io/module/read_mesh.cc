// SPDX-License-Identifier: GPL-3.0-or-later
// read-mesh SUFFIX UP mesh PARENT SIZE MEMORY SECONDS: reads the mesh on standard input and answers
// by the socket that is standard output, see base/confined.h; read-mesh SUFFIX CUT building ...
// reads an IFC building, cut at a height or, with "", above each floor. Started by mesh_reader.cc
// alone.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/module/confine.h"
#include "base/number.h"
#include "io/ifc/building.h"
#include "io/ifc/ifc_mesh.h"
#include "io/mesh_parts.h"
#include "io/module/read_mesh.h"

namespace {

using namespace ispace;

/// What the bytes tell before assimp has them.
struct MeshHead {
    MeshFormat format;
    std::optional<std::string> obj_up;
};

MeshHead checkedHead(std::size_t size, const std::string& suffix) {
    const MappedInput input(size);
    MeshHead head{meshFormat(input.bytes(), suffix), {}};
    checkMesh(head.format, input.bytes());
    if (head.format == MeshFormat::Obj) head.obj_up = objUpComment(input.bytes());
    return head;
}

bool isStep(std::size_t size) { return MappedInput(size).bytes().starts_with("ISO-10303-21"); }

std::string answer(bool is_building, const std::string& suffix, const std::string& setting,
                   std::size_t size) {
    if (is_building)
        return packedBuilding(readBuilding(MappedInput(size).bytes(), parseDouble(setting)));
    if (isStep(size)) return packedMesh(ifcMesh(MappedInput(size).bytes()));
    const MeshHead head = checkedHead(size, suffix);
    return packedMesh(importMesh(head.format, size, setting, head.obj_up));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 8) return 2;
    return runConfined(argc, argv, meshLimits(SIZE_MAX, true), [argv](std::size_t size) {
        return answer(std::string_view(argv[3]) == "building", argv[1], argv[2], size);
    });
}
