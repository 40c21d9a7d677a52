// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Moved; goes away with its last use.
#include "layout/figures.h"
