// SPDX-License-Identifier: GPL-3.0-or-later
// read-building building CUT PARENT SIZE MEMORY SECONDS UNITS: reads the IFC building on standard
// input, cut at a height or, with "", above each floor, and answers by the socket that is standard
// output, see base/confined.h; read-building mesh "" … reads its surfaces. Started by ifc.cc alone.
#include <stdexcept>
#include <string>
#include <string_view>

#include "base/budget.h"
#include "base/module/confine.h"
#include "base/number.h"
#include "extensions/ifc/reader/building.h"
#include "extensions/ifc/reader/building_limits.h"
#include "extensions/ifc/reader/ifc_mesh.h"
#include "io/packed_mesh.h"

namespace {

using namespace ispace;

std::string answer(bool is_building, const std::string& cut, std::size_t size, Budget& work) {
    const MappedInput input(size);
    try {
        return is_building
                   ? ifc::packedBuilding(ifc::readBuilding(input.bytes(), parseDouble(cut), work))
                   : packedMesh(ifc::ifcMesh(input.bytes(), work));
    } catch (const std::runtime_error& error) {
        if (!work.isExceeded()) throw;
        const std::string what = error.what();
        throw TooMuchWork(what.substr(0, what.find(" make ")));
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 9) return 2;
    return runConfined(argc, argv, ifc::buildingLimits(SIZE_MAX), [argv](auto size, Budget& work) {
        return answer(std::string_view(argv[1]) == "building", argv[2], size, work);
    });
}
