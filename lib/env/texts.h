// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "env/environment.h"

namespace ispace {

/// "wall w3", "door d1": how findings name an element.
std::string nameOf(const Element& element);

/// A length as findings give it: at least millimetres and at least two digits: "0.12", "0.0012".
std::string lengthText(double length);

}  // namespace ispace
