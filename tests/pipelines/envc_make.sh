#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# make rebuilds a room exactly when something it is made of has changed: the file itself, an include
# of an include, a mesh; and goes on when an include is no longer there and no longer named.
. "$(dirname "$0")/common.sh"

# The make that runs the tests is another one.
unset MAKEFLAGS MFLAGS MAKELEVEL

mkdir parts meshes rules "a folder"
cp "$data"/include/parts/* parts
cp "$data"/include/building.yaml building.yaml
cp "$scenes"/meshes/steps.obj meshes
printf '%s\n' '#env 1' 'mesh id=steps at=0,-0.6 file=meshes/steps.obj scale=0.5' >mesh.env
printf '  - include: mesh.env\n' >>building.yaml

cat >Makefile <<'END'
all: building.glb map.png
building.glb: building.yaml
	@echo building
	@envc $< -o $@ -MD
map.png: building.glb
	@echo map
	@coverage $< -o $@ -MD -MF rules/map.d >/dev/null
-include building.glb.d rules/map.d
END

# expect_made WORDS REASON: the targets that make reports.
expect_made() {
    local said
    said=$(make 2>&1 | tr '\n' ' ')
    [ "$said" = "$1 " ] || fail "$2: make said \"$said\", expected \"$1\""
}
# Later than anything made so far: some file systems tell only milliseconds apart.
touch_later() { sleep 0.02 && touch "$@"; }

expect_made "building map" "the first time"
expect_made "make: Nothing to be done for 'all'." "nothing has changed"
for file in building.yaml parts/furniture.yaml parts/lamp.env meshes/steps.obj mesh.env; do
    grep -q "$file" building.glb.d || fail "no $file in: $(cat building.glb.d)"
    touch_later "$file"
    expect_made "building map" "$file has changed"
    expect_made "make: Nothing to be done for 'all'." "nothing has changed since"
done

# A file that was deleted and is named no more is no reason to stop.
sleep 0.02
sed -i '/include: mesh.env/d' building.yaml
rm mesh.env meshes/steps.obj
expect_made "building map" "an include is gone"

# The Makefile of docs/batch.md, for an office of a file, an include, a mesh and a texture, and a hall of a map's
# picture: make updates exactly the products that a change affects.
mkdir readme
cd readme
sed -n '/^    all: office.jsonl/,/^    -include/s/^    //p' "$source_dir/docs/batch.md" >Makefile
[ "$(wc -l <Makefile)" -eq 13 ] || fail "docs/batch.md has another Makefile: $(cat Makefile)"
sed -i '1s/$/ hall.jsonl hall.svg hall.png/' Makefile
cp "$scenes"/meshes/steps.obj "$data"/map.pgm .
cp "$data"/map.yaml hall.yaml
envc "$data/room.env" -o wood.png
printf '%s\n' 'include: parts.yaml' 'ispace: {size: 8 x 6}' 'records:' \
    '  - cube: {at: [2, 1], size: [1, 1, 0.5], texture: wood.png}' \
    '  - mesh: {at: [-2, -1], file: steps.obj, scale: 0.5}' >office.yaml
printf -- '- desk: {at: [2, -1]}\n' >parts.yaml

# expect_again FILES WHY: the products that `make -j2` writes.
expect_again() {
    touch -d '1 hour ago' *
    touch -d '30 minutes ago' -- $(ls | grep -E '\.(glb|3dm|jsonl|svg|png|txt|d)$' | grep -v wood.png)
    [ -z "$3" ] || touch "$3"
    touch -d '10 minutes ago' since
    make -j2 >said 2>&1 || fail "$2: $(cat said)"
    local made
    made=$(find . -newer since \( -name '*.glb' -o -name '*.3dm' -o -name '*.jsonl' -o -name '*.svg' -o -name '*.png' \) \
        ! -name wood.png -printf '%f\n' | sort | tr '\n' ' ')
    [ "$made" = "$1" ] || fail "$2: made again: $made, expected: $1"
}
make -j2 >said 2>&1 || fail "the first time: $(cat said)"
office="office.3dm office.glb office.jsonl office.png office.svg "
expect_again "" "nothing has changed" ""
expect_again "$office" "an include has changed" parts.yaml
expect_again "$office" "a mesh has changed" steps.obj
expect_again "hall.3dm hall.glb hall.jsonl hall.png hall.svg " "a map's picture has changed" map.pgm
expect_again "office.png " "a texture has changed" wood.png
expect_again "office.3dm office.jsonl office.png office.svg " "a layout has changed" office.3dm
cd ..

# Names with blanks.
cp parts/lamp.env "a folder/my lamp.env"
printf 'ispace: {size: 8 x 6}\ninclude: "a folder/my lamp.env"\n' >lamp.yaml
envc lamp.yaml -o lamp.glb -MD
printf 'lamp.glb: lamp.yaml\n\t@echo lamp\n\t@envc $< -o $@ -MD\n-include lamp.glb.d\n' >lamp.mk
[ "$(make -f lamp.mk)" = "make: 'lamp.glb' is up to date." ] || fail "a name with blanks: rebuilt"
touch_later "a folder/my lamp.env"
[ "$(make -f lamp.mk)" = lamp ] || fail "a name with blanks: not rebuilt"

# Names with all characters that make interprets, beside files that a wildcard would match.
mkdir names
cd names
touch axb
cat >Makefile <<'END'
all: out.glb
out.glb:
	@echo made
	@touch out.glb
-include out.glb.d
END
for name in 'a|b.env' '|' 'a |b|c' 'a\|b' 'a*b' 'a?b' 'a[x]b' '[' 'a~b' 'a&b' 'a&' '&' \
    'a\b' 'a\ b' 'a\:b' ' a' "a'b" 'a"b' 'a$b' '$(b)c' 'a#b' 'a\#b' 'a:b' 'C:\b' 'a%b' '%' 'a(b)c' 'a,b' \
    '-b' '@b' '+b' '!b' '.PHONY'; do
    cp "$data/room.env" "./$name"
    touch -d '1 hour ago' "./$name"
    envc -o out.glb -MD -- "$name" || fail "refused: $name"
    expect_made "make: Nothing to be done for 'all'." "$name has not changed"
    touch -d '1 hour ago' out.glb
    touch -d '30 minutes ago' "./$name"
    expect_made "made" "$name has changed"
    rm -- "./$name"
    expect_made "made" "$name is gone"
done
for name in 'a=b' 'a;b' $'a\tb' $'a\rb' 'a%b%' 'a\*' 'a ' 'a\' 'a(b)' '~' '~root'; do
    cp "$data/room.env" "./$name"
    expect_error 2 envc -o out.glb -MD -- "$name"
    grep -q "make cannot read the name" err || fail "$name: $(cat err)"
    rm -- "./$name" err out
done
# The product's name.
printf '%%:\n\t@echo made\ninclude out.d\n' >Makefile
for name in 'a|b' 'a*b' 'a&' 'a%b' ' a$b'; do
    envc "$data/room.env" -o "./$name" -MD -MF out.d
    [ "$(make -q -- "$name" 2>&1; echo $?)" = 0 ] || fail "$name is up to date"
    touch -d '2001-01-01' "./$name"
    [ "$(make -q -- "$name" 2>&1; echo $?)" = 1 ] || fail "$name is out of date"
done
