#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# make rebuilds a room exactly when something it is made of has changed: the file itself, an include
# of an include, a mesh; and goes on when an include is no longer there and no longer named.
. "$(dirname "$0")/common.sh"

# The make that runs the tests is another one.
unset MAKEFLAGS MFLAGS MAKELEVEL

mkdir parts meshes "a folder"
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
	@coverage $< -o $@ -MD -MF map.d >/dev/null
-include building.d map.d
END

# expect_made WORDS WHY: what make says it does.
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
    grep -q "$file" building.d || fail "no $file in: $(cat building.d)"
    touch_later "$file"
    expect_made "building map" "$file has changed"
    expect_made "make: Nothing to be done for 'all'." "nothing has changed since"
done

# A file that was deleted and is named no more is no reason to stop.
sleep 0.02
sed -i '/include: mesh.env/d' building.yaml
rm mesh.env meshes/steps.obj
expect_made "building map" "an include is gone"

# Names with blanks.
cp parts/lamp.env "a folder/my lamp.env"
printf 'ispace: {size: 8 x 6}\ninclude: "a folder/my lamp.env"\n' >lamp.yaml
envc lamp.yaml -o lamp.glb -MD
printf 'lamp.glb: lamp.yaml\n\t@echo lamp\n\t@envc $< -o $@ -MD\n-include lamp.d\n' >lamp.mk
[ "$(make -f lamp.mk)" = "make: 'lamp.glb' is up to date." ] || fail "a name with blanks: rebuilt"
touch_later "a folder/my lamp.env"
[ "$(make -f lamp.mk)" = lamp ] || fail "a name with blanks: not rebuilt"

# Names with all that has a meaning to make. Beside a wildcard stands what it would match.
mkdir names
cd names
touch axb
cat >Makefile <<'END'
all: out.glb
out.glb:
	@echo made
	@touch out.glb
-include out.d
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
