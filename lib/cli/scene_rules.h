// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include "record/yaml.h"

namespace ispace {

/// How tools take what the files of a scene say of other files.
struct SceneRules {
    /// If a layout records another digest than that of the environment: an error (true) or accepted
    /// (false). Unset: a warning if the environment is an operand, an error if the layout's record
    /// names it.
    std::optional<bool> same_environment = {};
    IncludeFiles includes = IncludeFiles::InFolder;
    std::optional<std::uint64_t> max_work = {};  ///< of each input, see Budget; unset: by its size
};

}  // namespace ispace
