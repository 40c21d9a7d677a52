// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of IFC import: builds small files from instances.
#pragma once

#include <string>

#include "base/file.h"
#include "support/test_paths.h"

namespace ispace::ifc {

inline std::string ifcPath(const std::string& name) {
    return testing::sourcePath("lib/extensions/ifc/golden/inputs/ifc/" + name);
}
inline std::string ifcBytes(const std::string& name) { return readAll(ifcPath(name)); }

/// Builds a file with these instances, and a project in metres and radians (#1 to #4).
inline std::string ifcWith(const std::string& data) {
    return "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\n"
           "#1=IFCPROJECT('p',$,$,$,$,$,$,$,#2);\n#2=IFCUNITASSIGNMENT((#3,#4));\n"
           "#3=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);\n"
           "#4=IFCSIUNIT(*,.PLANEANGLEUNIT.,$,.RADIAN.);\n" +
           data + "ENDSEC;\nEND-ISO-10303-21;\n";
}

}  // namespace ispace::ifc
