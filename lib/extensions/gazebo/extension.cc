// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/gazebo/gazebo.h"
#include "io/importers.h"

namespace ispace::extension {

Extension gazebo() {
    return {.name = "gazebo", .add = [] { addImporters(gazebo::gazeboImporters()); }};
}

}  // namespace ispace::extension
