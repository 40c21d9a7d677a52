// SPDX-License-Identifier: GPL-3.0-or-later
// For programs that say "Aria/Aria.h": this folder in their include path is all they need.
#include <Sim_Aria.h>
