#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# include_direction.sh [ROOT]: dependencies between the folders of lib/ point one way, heavy libraries stay out of
# headers, and only lib/cli prints, exits or reads the environment. It first shows on a made-up tree that it can fail.
set -euo pipefail
root=${1:-$(cd "$(dirname "$0")/../.." && pwd)}

# Prints one line per violation. $1: a tree with lib/ and tools/.
violations() {
    (cd "$1" && find lib tools \( -name '*.h' -o -name '*.cc' \) | LC_ALL=C sort | xargs awk '
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
        layer("base", ""); layer("solve", "base"); layer("geom", "base"); layer("raster", "geom")
        layer("draw", "raster"); layer("record", "geom"); layer("env", "draw raster record")
        layer("sensor", "env"); layer("layout", "sensor"); layer("plan", "layout")
        layer("model", "layout"); layer("io", "plan model"); layer("trace", "layout"); layer("render", "trace")
        layer("sense", "render")
        layer("cover", "sense plan model"); layer("view", "cover")
        layer("place", "cover solve"); layer("sim", "sense"); layer("wire", "sim")
        layer("net", "wire plan"); layer("client", "")
        layer("cli", "place view net io")
        heavy = "^(CGAL/|opencv2/|embree|rtcore|cairo|yaml-cpp/|tiny_gltf|tbb/|oneapi/|openssl/)"
        quiet = "(^|[^A-Za-z0-9_])(std::(cout|cerr|clog|cin)|(printf|fprintf|puts|fputs|putchar|" \
                "perror|exit|_exit|quick_exit|abort|terminate|getenv|secure_getenv|setenv)[ ]*[(]|" \
                "environ([^A-Za-z0-9_]|$))"
    }
    FNR == 1 {
        split(FILENAME, path, "/")
        in_lib = path[1] == "lib"
        folder = path[2]
        in_test = FILENAME ~ /_test\.cc$/
        # Separate programs and modules, which no tool links. So are sources that include the classes of ARIA, which
        # print, exit and read the environment.
        is_apart = FILENAME ~ /^lib\/((base|io|raster)\/module|client\/sim_aria)\//
        if (in_lib && !(folder in known)) report("folder lib/" folder " has no place in the order")
    }
    /^[ \t]*#[ \t]*include/ {
        target = $0
        sub(/^[^<"]*[<"]/, "", target); sub(/[>"].*/, "", target)
        split(target, parts, "/")
        if (in_lib && (parts[1] in known) && !((folder, parts[1]) in may))
            report("lib/" folder " must not include " target)
        if (in_lib && index($0, "\"") && !(parts[1] in known))
            report("name the folder: " target)
        # One private header hides the versions of Embree from the sources beside it.
        if (FILENAME == "lib/trace/embree_query.h" && target ~ /^embree/) next
        if (FILENAME ~ /\.h$/ && target ~ heavy) report("keep " target " out of headers")
        # Its headers are copied and installed without the library; tests have GoogleTest besides.
        if (folder == "client" && in_lib && !in_test && FILENAME !~ /^lib\/client\/aria\// &&
            (index($0, "\"") || (target ~ /\// && target !~ /^(ispace_client|sim_aria|sys|netinet)\//) ||
             (target ~ /\.h$/ && target !~ /\// && target !~ /^(fcntl|netdb|poll|unistd|signal|strings)\.h$/)))
            report("lib/client stands by itself: " target)
        if (target ~ /^(ispace_client|sim_aria)[\/.]/ && folder != "client")
            report("lib/client is for other programs: " target)
        if (target ~ /^CLI\// && in_lib && folder != "cli") report("only lib/cli may include " target)
        next
    }
    in_lib && folder != "cli" && !in_test && !is_apart {
        code = $0
        gsub(/"([^"\\]|\\.)*"/, "\"\"", code)
        sub(/\/\/.*/, "", code)
        if (code ~ quiet) report("below lib/cli nothing prints, exits or reads the environment: " code)
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
expect lib/geom/a.h '#include "env/slice.h"' yes
expect lib/io/a.cc '#include "trace/ray_world.h"' yes
expect lib/cover/a.cc '#include "io/glb.h"' yes
expect lib/cover/a.cc '#include "plan/plan.h"' no
expect lib/cover/a.cc '#include "model/model.h"' no
expect lib/model/a.cc '#include "plan/plan.h"' yes
expect lib/sense/a.cc '#include "plan/plan.h"' yes
expect lib/draw/a_test.cc '#include "record/schema.h"' yes
expect lib/base/a.cc '#include <geom/pose.h>' yes
expect lib/place/a.cc '#include "net/server.h"' yes
expect lib/wire/a.cc '#include "net/server.h"' yes
expect lib/nowhere/a.cc '#include <vector>' yes
expect lib/geom/a.cc '#include "pose.h"' yes
expect lib/geom/a.h '#include <CGAL/Arrangement_2.h>' yes
expect lib/trace/a.h '#include <embree3/rtcore.h>' yes
expect lib/record/a.h '#include <yaml-cpp/yaml.h>' yes
expect lib/env/a.cc '#include <CLI/CLI.hpp>' yes
expect lib/client/a.h '#include "base/error.h"' yes
expect lib/client/ispace_client/a.h '#include <base/error.h>' yes
expect lib/client/a.h '#include <boost/asio.hpp>' yes
expect lib/client/a.h '#include <zlib.h>' yes
expect lib/client/a.h '#include <ispace_client/error.h>' no
expect lib/client/a.h '#include <sys/socket.h>' no
expect lib/net/a.h '#include <ispace_client/error.h>' yes
expect lib/env/a.cc 'std::cerr << 1;' yes
expect lib/env/a.cc 'if (x) exit(1);' yes
expect lib/env/a.cc 'auto* v = std::getenv("HOME");' yes
expect lib/place/a.cc '#include "base/error.h"' no
expect lib/env/a.cc '#include "draw/picture.h"' no
expect lib/cli/a.cc '#include "place/grid.h"' no
expect lib/cli/a.cc 'std::cerr << 1;' no
expect lib/geom/a.cc '#include <CGAL/Arrangement_2.h>' no
expect lib/env/a.cc 'onExit(); snprintf(b, 1, ""); // exit(1)' no
expect lib/env/a.cc 'f("exit(1)");' no
expect tools/envc/main.cc '#include "cli/run.h"' no

found=$(violations "$root")
[ -z "$found" ] || fail "$(printf 'wrong direction\n%s' "$found")"
[ -n "$(ls "$root"/lib/base/*.cc)" ] || fail "no sources in $root"
