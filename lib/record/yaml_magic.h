// SPDX-License-Identifier: GPL-3.0-or-later
// The first line of a YAML file of records, which it may lack.
#pragma once

#include <string_view>

namespace ispace {

constexpr std::string_view kYamlMagic = "# ispace yaml ", kYamlVersion = "1",
                           kYamlLayoutVersion = "1 layout";

}  // namespace ispace
