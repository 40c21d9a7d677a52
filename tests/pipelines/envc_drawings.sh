#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Plans that other programs draw or convert: areas of an SVG against librsvg's pixels, and of a map with a picture that
# ImageMagick writes again.
. "$(dirname "$0")/common.sh"

area() { envc "$@" --info --json | sed -n 's/.*"indoor_area":\([0-9.e+-]*\).*/\1/p'; }

# expect_near FOUND WANTED SHARE MESSAGE
expect_near() {
    awk -v f="$1" -v w="$2" -v s="$3" 'BEGIN { d = f - w; if (d < 0) d = -d; exit !(w > 0 && d <= s * w) }' ||
        fail "$4: $1 m2 instead of $2"
}

# 10 m x 8 m, 100 pixels a metre; each shape is filled white on black, so that its pixels are floor.
if command -v rsvg-convert >/dev/null; then
    count=0
    while IFS= read -r shape; do
        cat >shape.svg <<END2
<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="10000mm" height="8000mm" viewBox="0 0 100 80">
<rect width="100" height="80" fill="black"/><g fill="white" transform="translate(3 2)">$shape</g></svg>
END2
        sed 's/10000mm/1000/; s/8000mm/800/' shape.svg >small.svg
        rsvg-convert small.svg -o shape.png
        expect_near "$(area shape.svg)" "$(area shape.png --resolution 0.01)" 0.01 "$shape"
        count=$((count + 1))
    done <<'END2'
<path d="M10 40a20 10 30 1 1 30 20z"/>
<path d="M10 40A30,20 -20 0040,60L60 20z"/>
<path d="M10 10c20-15 50 20 70 0s5 50-10 55-45-40-60-5z"/>
<path d="M10 10q30 20 60 0t5 40l-40 10z"/>
<path d="M10 10H80V60H10Z"/>
<rect x="10" y="10" width="60" height="40" rx="12" ry="7"/>
<ellipse cx="45" cy="35" rx="30" ry="12" transform="rotate(25 45 35)"/>
<circle cx="30" cy="30" r="20" transform="matrix(1.2 .3 -.2 .9 5 4)"/>
<polygon points="10,10 80,20 60,60 20,50" transform="skewX(-10) translate(8)"/>
<defs><symbol id="s" viewBox="0 0 10 10"><rect x="1" y="2" width="8" height="5"/></symbol></defs><use xlink:href="#s" x="10" y="5" width="60" height="50"/>
<svg x="10" y="10" width="60" height="30" viewBox="0 0 20 20"><path d="M2 2L18 5 12 18z"/></svg>
END2
    [ "$count" -eq 11 ] || fail "only $count shapes"
    echo "svg: $count shapes as librsvg paints them"
fi

# Splines that ezdxf makes of ellipses and of points, and flattens itself.
if /usr/bin/python3 -c 'import ezdxf' 2>/dev/null; then
    /usr/bin/python3 - >wanted <<'END2'
import ezdxf
from ezdxf.math import BSpline, ConstructionArc, Vec3, fit_points_to_cad_cv, rational_bspline_from_ellipse, ConstructionEllipse

def area(points):
    return abs(sum(p.x * q.y - q.x * p.y for p, q in zip(points, points[1:] + points[:1]))) / 2

ellipse = rational_bspline_from_ellipse(ConstructionEllipse(major_axis=(4000, 1000), ratio=0.5))
points = [(0, 0), (3000, -1500), (7000, 500), (6000, 5000), (2500, 3000), (-1000, 4000), (0, 0)]
smooth = fit_points_to_cad_cv([Vec3(p) for p in points])
for name, spline in (("ellipse", ellipse), ("smooth", smooth)):
    drawing = ezdxf.new("R2000", units=4)
    entity = drawing.modelspace().add_spline()
    entity.apply_construction_tool(spline)
    drawing.saveas(name + ".dxf")
    print(name, area(list(spline.flattening(0.01))) / 1e6)
END2
    while read -r name wanted; do
        expect_near "$(area "$name.dxf")" "$wanted" 0.001 "the spline $name"
    done <wanted
    [ "$(wc -l <wanted)" -eq 2 ] || fail "not two splines"
    echo "dxf: splines as ezdxf flattens them"
fi

# ImageMagick's own name: others have a `convert`, too.
if command -v convert-im6.q16 >/dev/null; then
    map=$data/pictures/map.yaml
    wanted=$(area "$data/pictures/room.pgm" --resolution 0.05)
    if [ -e "${ISPACE_TEST_DATA:-}/turtlebot3.yaml" ]; then
        map=$ISPACE_TEST_DATA/turtlebot3.yaml
        wanted=$(area "$map")
    fi
    picture=$(dirname "$map")/$(sed -n 's/^image: *//p' "$map")
    for format in png bmp jpg tif webp ppm; do
        convert-im6.q16 "$picture" "copy.$format"
        sed "s/^image:.*/image: copy.$format/" "$map" >copy.yaml
        expect_near "$(area copy.yaml)" "$wanted" 0.01 "$format"
    done
    echo "pictures: bmp jpg tif webp ppm"
fi
