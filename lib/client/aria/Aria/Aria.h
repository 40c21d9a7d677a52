// SPDX-License-Identifier: GPL-3.0-or-later
// For programs that include "Aria/Aria.h": add this folder to the include path.
#include <Sim_Aria.h>
