// SPDX-License-Identifier: GPL-3.0-or-later
// A room with furniture, zones, lasers and cameras, for tests of what mounting and failures do.
#pragma once

#include <string>

namespace ispace::testing {

inline const std::string kMixedRoom =
    "ispace size=10,8,3\npillar id=p at=1,1\ndesk id=d at=-2,1.5 heading=20\n"
    "wall from=-1,-4 to=-1,-1 height=3\n"
    "zone id=door path=-5,-3;-3,-3;-3,-1;-5,-1\nzone id=far at=20,0 size=1,1\n"
    "laser id=l1 at=-4.9,0 heading=0 range=6 fov=90\n"
    "laser id=l2 at=4.9,0 heading=180 range=6 fov=120\n"
    "laser id=l3 at=0,-3.9 heading=90 range=4 fov=180\n"
    "camera id=c1 at=-4.9,-3.9,2.8 heading=40 tilt=-35 fov=80 pixels=1920,1080\n"
    "camera id=c2 at=4.9,3.9,2.8 heading=-140 tilt=-35 fov=70 pixels=1280,720\n";

}  // namespace ispace::testing
