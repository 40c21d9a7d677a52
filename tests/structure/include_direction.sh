#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# include_direction.sh [ROOT]: dependencies between the folders of lib/ point one way, heavy libraries stay out of
# headers, headers that are private to a folder are included there alone, and only lib/engine/cli prints, exits or reads the
# environment. It first shows on a made-up tree that it can fail.
set -euo pipefail
root=${1:-$(cd "$(dirname "$0")/../.." && pwd)}

# Prints one line per violation. $1: a tree with lib/ and tools/.
violations() {
    (cd "$1" && find lib tools -not -path 'lib/extensions/*/tests/*' -not -path 'lib/extensions/*/bench/*' \( -name '*.h' -o -name '*.cc' \) | LC_ALL=C sort | xargs awk '
    function layer(folder, below,    names, i, n) {
        known[folder] = 1
        n = split(below, names, " ")
        for (i = 1; i <= n; i++) {
            may[folder, names[i]] = 1
            for (other in known) if ((names[i], other) in may) may[folder, other] = 1
        }
        may[folder, folder] = 1
    }
    function report(what) { print FILENAME ":" FNR ": " what }
    BEGIN {
        layer("base", ""); layer("geom", "base"); layer("raster", "geom"); layer("record", "geom")
        layer("env", "raster record"); layer("scene", "env"); layer("drawing", "scene")
        layer("io", "drawing"); layer("trace", "scene"); layer("sense", "trace")
        layer("coverage", "sense"); layer("arrange", "coverage"); layer("report", "arrange io")
        layer("site", "report"); layer("sim", "sense"); layer("server", "sim"); layer("client", "")
        layer("cli", "server site"); layer("extensions", "cli")
        heavy = "^(CGAL/|opencv2/|embree|rtcore|cairo|yaml-cpp/|tiny_gltf|tbb/|oneapi/|openssl/)"
        quiet = "(^|[^A-Za-z0-9_])(std::(cout|cerr|clog|cin)|(printf|fprintf|puts|fputs|putchar|" \
                "perror|exit|_exit|quick_exit|abort|terminate|getenv|secure_getenv|setenv)[ ]*[(]|" \
                "environ([^A-Za-z0-9_]|$))"
    }
    FNR == 1 {
        # Names in includes and in these rules are those below the ring, "geom/point.h".
        place = FILENAME
        sub(/^lib\/(kernel|engine)\//, "lib/", place)
        split(place, path, "/")
        in_lib = path[1] == "lib"
        folder = path[2]
        in_test = FILENAME ~ /_test\.(cc|h)$/
        # Separate programs and modules, which no tool links. So are sources that include the classes of ARIA, which
        # print, exit and read the environment, and the source that reads the search paths of Gazebo.
        is_apart = place ~ /^lib\/((base|raster)\/module|client\/sim_aria)\// ||
            place == "lib/extensions/gazebo/model_path.cc"
        is_fuzz = place ~ /^lib\/extensions\/[a-z_]+\/fuzz\//
        if (in_lib && !(folder in known)) report("folder lib/" folder " has no place in the order")
    }
    FNR < 6 && match($0, /Private to lib\/[a-z_\/]+/) {
        private_to[substr(place, 5)] = substr($0, RSTART + 11, RLENGTH - 11) "/"
    }
    /^[ \t]*#[ \t]*include/ {
        target = $0
        sub(/^[^<"]*[<"]/, "", target); sub(/[>"].*/, "", target)
        split(target, parts, "/")
        if (!in_test) included[FILENAME ":" FNR] = target
        if (in_lib && (parts[1] in known) && !((folder, parts[1]) in may))
            report("lib/" folder " must not include " target)
        if (in_lib && index($0, "\"") && !(parts[1] in known) && !(in_test && parts[1] == "support") &&
            !is_fuzz)
            report("name the folder: " target)
        # Rooms inside of folders have separate fences.
        if (!in_test && place ~ /^lib\/arrange\/search\// && index($0, "\"") && target !~ /^(base|arrange\/search)\//)
            report("lib/engine/arrange/search knows sets of cells alone: " target)
        own = target
        sub(/^extensions\/proofs\//, "", own)
        if (!in_test && place ~ /^lib\/extensions\/proofs\/gallery\// && index($0, "\"") &&
            own !~ /^(base|geom|arrange\/search|gallery)\/|^certificate_lines\.h$/)
            report("lib/extensions/proofs/gallery knows floors alone: " target)
        if (!in_test && place ~ /^lib\/extensions\/proofs\/poses\// && index($0, "\"") &&
            own !~ /^(base|geom|poses)\/|^certificate_lines\.h$/)
            report("lib/extensions/proofs/poses knows floors alone: " target)
        if (place ~ /^lib\/trace\/[^\/]*$/ && target ~ /^trace\/render\//)
            report("lib/kernel/trace must not include " target)
        # One private header hides the versions of Embree from the sources beside it.
        if (FILENAME == "lib/kernel/trace/embree_query.h" && target ~ /^embree/) next
        if (FILENAME ~ /\.h$/ && target ~ heavy) report("keep " target " out of headers")
        # Its headers are copied and installed without the library; tests have GoogleTest besides.
        if (folder == "client" && in_lib && !in_test && FILENAME !~ /^lib\/client\/aria\// &&
            (index($0, "\"") || (target ~ /\// && target !~ /^(ispace_client|sim_aria|arpa|sys|netinet)\//) ||
             (target ~ /\.h$/ && target !~ /\// && target !~ /^(fcntl|netdb|poll|unistd|signal|strings|termios)\.h$/)))
            report("lib/client stands by itself: " target)
        if (target ~ /^(ispace_client|sim_aria)[\/.]/ && folder != "client")
            report("lib/client is for other programs: " target)
        if (target ~ /^CLI\// && in_lib && folder != "cli") report("only lib/engine/cli may include " target)
        next
    }
    in_lib && folder != "cli" && !in_test && !is_apart {
        code = $0
        gsub(/"([^"\\]|\\.)*"/, "\"\"", code)
        sub(/\/\/.*/, "", code)
        if (code ~ quiet) report("below lib/engine/cli nothing prints, exits or reads the environment: " code)
    }
    END {
        for (at in included)
            if (included[at] in private_to && index(at, private_to[included[at]]) != 1)
                print at ": " included[at] " is private to " private_to[included[at]]
    }')
}

fail() {
    echo "include_direction: $*"
    exit 1
}

tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
# expect FILE LINE WANTED: a file with this line gives a violation iff WANTED is yes.
expect() {
    rm -rf "$tree/lib" "$tree/tools"
    mkdir -p "$tree/$(dirname "$1")" "$tree/lib" "$tree/tools"
    printf '%s\n' "$2" >"$tree/$1"
    local found
    found=$(violations "$tree")
    if [ "$3" = yes ]; then
        [ -n "$found" ] || fail "self-test: not noticed in $1: $2"
    else
        [ -z "$found" ] || fail "self-test: wrongly reported: $found"
    fi
}
expect lib/kernel/geom/a.h '#include "env/slice.h"' yes
expect lib/engine/io/a.cc '#include "trace/ray_world.h"' yes
expect lib/kernel/coverage/a.cc '#include "io/glb/glb_file.h"' yes
expect lib/engine/report/a.cc '#include "drawing/plan/plan.h"' no
expect lib/engine/report/map/a.cc '#include "io/glb/glb_write.h"' no
expect lib/kernel/coverage/a.cc '#include "report/map/map.h"' yes
expect lib/kernel/scene/findings/a.cc '#include "sense/scan.h"' yes
expect lib/kernel/raster/a_test.cc '#include "record/schema.h"' yes
expect lib/kernel/base/a.cc '#include <geom/pose.h>' yes
expect lib/engine/arrange/a.cc '#include "server/server.h"' yes
expect lib/engine/arrange/search/a.cc '#include "geom/point.h"' yes
expect lib/engine/arrange/search/a.cc '#include "base/error.h"' no
expect lib/extensions/proofs/gallery/a.cc '#include "scene/scene.h"' yes
expect lib/extensions/proofs/gallery/a.cc '#include "arrange/search/set_cover.h"' no
expect lib/extensions/proofs/poses/a.cc '#include "scene/scene.h"' yes
expect lib/extensions/proofs/poses/a.cc '#include "geom/polygon.h"' no
expect lib/extensions/proofs/poses/a.cc '#include "extensions/proofs/certificate_lines.h"' no
expect lib/extensions/proofs/poses/a.cc '#include "arrange/refine.h"' yes
expect lib/kernel/trace/a.cc '#include "trace/render/render.h"' yes
expect lib/engine/sim/a.cc '#include "server/server.h"' yes
expect lib/engine/sim/a.cc '#include "site/storeys.h"' yes
expect lib/engine/site/a.cc '#include "sim/world.h"' yes
expect lib/engine/server/a.cc '#include "extensions/passages/lift.h"' yes
expect lib/extensions/passages/a.cc '#include "sim/world.h"' no
expect lib/extensions/reality/a.cc '#include "cli/option_group.h"' no
expect lib/engine/cli/a.cc '#include "extensions/reality/a.h"' yes
expect lib/engine/sim/a.h $'//\n// Private to lib/engine/sim: parts\n#include "sim/a.h"' no
expect lib/extensions/passages/a.h $'//\n// Private to lib/engine/sim: parts\n#include "extensions/passages/a.h"' yes
expect lib/nowhere/a.cc '#include <vector>' yes
expect lib/kernel/geom/a.cc '#include "pose.h"' yes
expect lib/kernel/geom/a.h '#include <CGAL/Arrangement_2.h>' yes
expect lib/kernel/trace/a.h '#include <embree3/rtcore.h>' yes
expect lib/kernel/record/a.h '#include <yaml-cpp/yaml.h>' yes
expect lib/kernel/env/a.cc '#include <CLI/CLI.hpp>' yes
expect lib/client/a.h '#include "base/error.h"' yes
expect lib/client/ispace_client/a.h '#include <base/error.h>' yes
expect lib/client/a.h '#include <boost/asio.hpp>' yes
expect lib/client/a.h '#include <zlib.h>' yes
expect lib/client/a.h '#include <ispace_client/error.h>' no
expect lib/client/a.h '#include <sys/socket.h>' no
expect lib/engine/server/a.h '#include <ispace_client/error.h>' yes
expect lib/kernel/env/a.cc 'std::cerr << 1;' yes
expect lib/kernel/env/a.cc 'if (x) exit(1);' yes
expect lib/kernel/env/a.cc 'auto* v = std::getenv("HOME");' yes
expect lib/engine/arrange/a.cc '#include "base/error.h"' no
expect lib/kernel/env/a.cc '#include "raster/picture.h"' no
expect lib/engine/cli/a.cc '#include "arrange/arrange.h"' no
expect lib/engine/cli/a.cc 'std::cerr << 1;' no
expect lib/kernel/geom/a.cc '#include <CGAL/Arrangement_2.h>' no
expect lib/kernel/env/a.cc 'onExit(); snprintf(b, 1, ""); // exit(1)' no
expect lib/kernel/env/a.cc 'f("exit(1)");' no
expect tools/envc/main.cc '#include "cli/run.h"' no

found=$(violations "$root")
[ -z "$found" ] || fail "$(printf 'wrong direction\n%s' "$found")"
# The table of docs/architecture.md names a header of each folder to read first, whose first lines tell its job.
for folder in $(cd "$root" && find lib -mindepth 1 -name '*.h' -printf '%h\n' | grep -vE '^lib/client|/module|/(fuzz|tests)$' | sort -u); do
    sed -sn 2,3p "$root/$folder"/*.h | grep -q "^// $folder: " || fail "no header of $folder begins with its job"
done
[ -n "$(ls "$root"/lib/kernel/base/*.cc)" ] || fail "no sources in $root"
