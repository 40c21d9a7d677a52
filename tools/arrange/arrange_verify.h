// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "arrange/arrange_options.h"

namespace ispace {

/// Checks the certificate of --verify for a room and its layout, and reports both sides.
/// \throws UnmetError if its trees prove a larger bound than it states
void verifyCertificate(const ArrangeToolOptions& options);

}  // namespace ispace
